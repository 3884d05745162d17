"""Exact numbers between Python and the library, and packings made of them."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Iterable, Sequence

from ._core import ExactPacking, Number
from ._words import BadInput

_digits = 4000  # Python refuses decimal texts of more than 4300 digits at once


def _integer(text: str) -> int:
    if len(text) <= _digits:
        return int(text)
    half = len(text) // 2
    sign = -1 if text[0] == "-" else 1
    return _integer(text[:half]) * 10 ** (len(text) - half) + sign * _integer(text[half:])


def fraction(text: str) -> Fraction:
    """The Fraction of ``"-7/3"`` or ``"2"``, of any length."""
    numerator, _, denominator = text.partition("/")
    return Fraction(_integer(numerator), _integer(denominator or "1"))


def _quoted(value: Any) -> str:
    return f'"{Number(value)}"'


def _row(values: Iterable[Any]) -> str:
    return "[" + ", ".join('"none"' if value is None else _quoted(value) for value in values) + "]"


def _one_or_row(value: Any, axes: int) -> str:
    if axes == 2:
        return _quoted(value)
    return _row(value if isinstance(value, (list, tuple)) else [value] * 3)


def _words(values: Sequence[str]) -> str:
    return "[" + ", ".join(f'"{value}"' for value in values) + "]"


def exact_packing(
    disks: Iterable[Sequence[object]],
    *,
    length: Sequence[object] | None = None,
    lower: Sequence[str] | None = None,
    upper: Sequence[str] | None = None,
    fixed: Iterable[int] = (),
    period: Sequence[object] | None = None,
    tilt: object = 0,
    moves: Sequence[str] = (),
    pin: int = 0,
    wall_force: Sequence[object] | None = None,
    tilt_force: object = None,
    disk_force: Iterable[Sequence[object]] = (),
) -> ExactPacking:
    """A packing in exact numbers.

    Parameters
    ----------
    disks : rows (x, y, radius), of spheres (x, y, z, radius)
        Numbers: ``int``, ``fractions.Fraction``, ``isostat.Number``, text such as ``"1/2*sqrt(3)"``,
        or ``float``, which is the dyadic number that it stores. Unit: yours.
    length : (Lx, Ly), of spheres (Lx, Ly, Lz), optional
        Positions of the right, the top (and the front) wall, None along an axis that repeats; without it there are no
        walls.
    lower, upper : for each axis "fixed" (default of `lower`), "absent", and for `upper` "movable" (default)
        Left, bottom (and back) wall; right, top (and front) wall.
    fixed : numbers of disks
        Disks that cannot move.
    period : (Lx, Ly), of spheres three, optional
        A cell; None along an axis that does not repeat.
    tilt, moves, pin : of a cell
        x of the second period, of spheres three numbers xy, xz, yz; which of "x", "y", "xy" ("z", "xz", "yz") are degrees
        of freedom; the grain that stays where it is.
    wall_force : (Fx, Fy), of spheres (Fx, Fy, Fz), optional
        Inward forces on the right, the top (and the front) wall, or on the periods.
    tilt_force : optional
        The same on the tilt, of spheres on three.
    disk_force : rows (disk, Fx, Fy), of spheres (disk, Fx, Fy, Fz)
        External forces on grains.

    Raises
    ------
    BadInput
        A value that makes no sense, named.
    """
    rows = [tuple(row) for row in disks]
    sizes = {len(row) for row in rows}
    if len(sizes) != 1 or not sizes <= {3, 4}:
        raise BadInput("disks: expected rows (x, y, radius), or of spheres (x, y, z, radius)")
    axes = sizes.pop() - 1
    grain = "disk" if axes == 2 else "sphere"
    held = set(fixed)
    lines = ['format = "isostat-packing 1"']
    for number, row in enumerate(rows):
        lines.append(f"[[{grain}]]")
        lines += [f"{name} = {_quoted(value)}" for name, value in zip("xyzr" if axes == 3 else "xyr", row)]
        if number in held:
            lines.append("fixed = true")
    if length is not None:
        free = [value is None for value in length]  # an axis that repeats, or has no walls
        lines += ["[box]", f"length = {_row(length)}"]
        lines.append(f"lower = {_words(lower or ['absent' if none else 'fixed' for none in free])}")
        lines.append(f"upper = {_words(upper or ['absent' if none else 'movable' for none in free])}")
    if period is not None:
        lines += ["[cell]", f"period = {_row(period)}", f"tilt = {_one_or_row(tilt, axes)}"]
        lines += [f"moves = {_words(moves)}", f"pin = {pin}"]
    elif moves or tilt_force is not None:
        raise BadInput("moves and tilt_force belong to a cell: expected `period` too")
    forces = [f"[{disk}, {', '.join(map(_quoted, force))}]" for disk, *force in disk_force]
    load = [] if wall_force is None else [f"wall = {_row(wall_force)}"]
    load += [] if tilt_force is None else [f"tilt = {_one_or_row(tilt_force, axes)}"]
    load += [f"{grain} = [{', '.join(forces)}]"] if forces else []
    lines += ["[load]", *load] if load else []
    return ExactPacking.parse("\n".join(lines) + "\n", "exact_packing")
