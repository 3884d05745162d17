"""What `repr` says of each class of the compiled part: what it is, not where it is in memory."""

from __future__ import annotations

from typing import Any, Callable

from . import _core


def _grains(of: Any) -> str:
    return f"{len(of)} {'disks' if of.positions.shape[1] == 2 else 'spheres'}"


def _box(of: Any) -> str:
    sides = " x ".join(f"{side:.6g}" for side in of.length)
    repeats = [axis for axis, again in zip("xyz", of.periodic) if again]
    if not repeats:
        return f"box {sides}"
    tilt = "" if of.tilt in (None, 0.0, (0.0, 0.0, 0.0)) else f", tilt {of.tilt}"
    return f"cell {sides}{tilt}, periodic along {''.join(repeats)}"


def _state(of: Any) -> str:
    stress = ", ".join(f"{value:.9g}" for value in of.stress)
    return f"{_grains(of)}, {_box(of)}, {len(of.contacts)} contacts, {of.load} stress ({stress})"


def _interval(low: float, high: float) -> str:
    return f"[{low:.9g}, {high:.9g}]"


_words: dict[type, Callable[[Any], str]] = {
    _core.Packing: lambda p: f"{_grains(p)}, {_box(p)}",
    _core.State: _state,
    _core.Certificate: lambda c: (
        f"{'' if c.minimum is None else 'not '}isostatic, stable equilibrium without overlap: {c.verdict}; of {_grains(c.state)}, {len(c.undecided)} claims absent"
    ),
    _core.Inspection: lambda s: (
        f"isostatic equilibrium: {s.verdict}, stable: {s.stable}; h = {s.counting.h}, k = {s.counting.k}, "
        f"{len(s.rattlers)} rattlers, sigma2 = {s.sigma2:.9g} in {_interval(s.sigma2_low, s.sigma2_high)}"
    ),
    _core.Jamming: lambda j: ", ".join(f"{what}: {verdict}" for what, verdict in j.verdicts.items()),
    _core.JammedIfClosed: lambda j: f"{j.verdict} if {j.contacts} contacts close within {j.within:.2g}",
    _core.Arc: lambda a: f"step {a.step}, {a.kind}: {a.opened} opens, {a.closed} closes",
    _core.Equilibrium: lambda e: (
        f"number {e.number}, {e.arcs} arcs, sigma2 = {e.sigma2:.9g} in {_interval(e.sigma2_low, e.sigma2_high)}, {e.verdict}"
    ),
    _core.ClaimCheck: lambda c: f"{c.claim}: {c.verdict if c.claimed else 'not claimed'}",
    _core.Verification: lambda v: f"certificate: {v.verdict}; {', '.join(c.claim for c in v.checks if c.claimed)}",
    _core.RunVerification: lambda v: f"run: {v.words}; {v.equilibria_proved} of {v.equilibria} equilibria, {v.arcs_proved} of {v.arcs} arcs",
    _core.ExactPacking: lambda p: f"{_grains(p.packing)}, {_box(p.packing)}{', ' + p.title if p.title else ''}",
    _core.ExactInspection: lambda s: f"{s.verdict}: N_f = {s.dofs}, N = {len(s.contacts)}, rank = {s.rank}, h = {s.h}, k = {s.k}",
    _core.PlateauCounts: lambda c: f"N_f = {c.dofs}, N = {c.contacts}, rank = {c.rank}, h = {c.h}, k = {c.k}",
    _core.PlateauStep: lambda s: f"gap <= {s.threshold:.6g}: {s.backbone!r}, {s.rattlers} rattlers",
    _core.PlateauRange: lambda r: f"gap from {r.first:.6g} to {r.last:.6g}: N = {r.contacts}, {r.rattlers} rattlers",
    _core.Plateau: lambda p: f"{len(p.ranges)} ranges isostatic, {'none' if p.widest is None else p.widest!r} the widest",
    _core.Snap: lambda s: f"{s.outcome}, h = {s.h}, k = {s.k}, within {s.distance:.3g}",
    _core.Genericity: lambda g: (
        f"{g.proved} of {len(g.samples)} proved isostatic, {g.ties} ties, {g.undecided} undecided, {g.failed} failed"
    ),
}


def _repr(self: Any) -> str:
    return f"<isostat.{type(self).__name__}: {_words[type(self)](self)}>"


for _kind in _words:
    setattr(_kind, "__repr__", _repr)
