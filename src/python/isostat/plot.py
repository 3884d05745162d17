"""Pictures with matplotlib: packings with forces and mechanisms, staircases, increments.

Each draws in the axes `ax`, or in those of a new figure, and returns them.
"""

from __future__ import annotations

from typing import Optional

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection

from ._core import Packing, State
from ._records import Records
from ._state import disk_velocities
from ._words import BadInput


def _axes(ax: Optional[Axes]) -> Axes:
    if ax is None:
        import matplotlib.pyplot as plt

        ax = plt.figure(constrained_layout=True).add_subplot()
    return ax


def _shifts(packing: State | Packing, images: np.ndarray) -> np.ndarray:
    """(N, 2): by how much images are moved; 0 in a box."""
    return images @ [[packing.length[0], 0], [packing.tilt or 0, packing.length[1]]]


def _lines(state: State) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of the contacts that are drawn, and their lines (lines, 2, 2).

    From centre to centre, or to the wall. A contact with an image is drawn twice, through either border of the cell.
    """
    numbers = np.flatnonzero(state.contacts[:, 1] > -9)  # no held coordinates, no bars
    contacts, shifts = state.contacts[numbers], _shifts(state, state.images[numbers])
    first = state.positions[contacts[:, 0]]
    second = first.copy()
    pairs = contacts[:, 1] >= 0
    second[pairs] = state.positions[contacts[pairs, 1]] + shifts[pairs]
    for code, axis, place in (
        (-1, 0, 0.0),
        (-2, 1, 0.0),
        (-3, 0, state.length[0]),
        (-4, 1, state.length[1]),
    ):
        second[contacts[:, 1] == code, axis] = place
    lines = np.stack((first, second), axis=1)
    through = state.images[numbers].any(axis=1)
    back = lines[through] - shifts[through][:, None, :]
    return np.concatenate((numbers, numbers[through])), np.concatenate((lines, back))


def _draw_forces(state: State, forces: np.ndarray, ax: Axes) -> np.ndarray:
    """Lines of width in proportion to the force; returns which disks carry one."""
    numbers, ends = _lines(state)
    contacts, forces = state.contacts[numbers], np.asarray(forces)[numbers]
    carried = forces != 0
    mean = np.abs(forces[carried]).mean() if carried.any() else 1.0
    ax.add_collection(LineCollection(ends[~carried], colors="0.6", linewidths=0.4))
    for sign, colour in ((1, "#a50f15"), (-1, "#08519c")):
        chosen = carried & (np.sign(forces) == sign)
        widths = 1.5 * np.abs(forces[chosen]) / mean
        ax.add_collection(
            LineCollection(
                ends[chosen], colors=colour, linewidths=widths, capstyle="round", zorder=2
            )
        )
    holding = np.zeros(len(state), dtype=bool)
    holding[contacts[carried, 0]] = True
    holding[contacts[carried & (contacts[:, 1] >= 0), 1]] = True
    return holding


def _images(state: State) -> tuple[np.ndarray, np.ndarray]:
    """The images of disks that contacts reach through a border of the cell: numbers (k,), centres (k, 2)."""
    through = state.images.any(axis=1)
    (first, second), images = state.contacts[through].T, state.images[through]
    shown = np.column_stack((np.concatenate((second, first)), np.concatenate((images, -images))))
    disks, *periods = np.unique(shown, axis=0).T
    return disks, state.positions[disks] + _shifts(state, np.column_stack(periods))


def _outline(packing: State | Packing, ring: tuple[int, ...]) -> np.ndarray:
    """Points on the arcs that bound a body."""
    at, radii = packing.positions[list(ring)], packing.radii[list(ring)]
    joint = (at - np.roll(at, -1, axis=0)) * np.sign(np.roll(radii, -1) - radii)[:, None]
    end = np.unwrap(np.arctan2(joint[:, 1], joint[:, 0]))
    begin = end - (end - np.roll(end, 1)) % (2 * np.pi)
    angle = begin[:, None] + (end - begin)[:, None] * np.linspace(0, 1, 24)
    outward = np.stack((np.cos(angle), np.sin(angle)), axis=2)
    return (at[:, None] + radii[:, None, None] * outward).reshape(-1, 2)


def _draw_arcs(packing: State | Packing, holding: np.ndarray, ax: Axes) -> None:
    outlines = [_outline(packing, ring) for ring in packing.arcs]
    colours = ["#d9d9d9" if holding[list(ring)].any() else "#deebf7" for ring in packing.arcs]
    ax.add_collection(PolyCollection(outlines, facecolors=colours, edgecolors="0.35", linewidths=0.4, zorder=1))


def _draw_disks(
    packing: State | Packing, disks: np.ndarray, places: np.ndarray, holding: np.ndarray, ax: Axes, alpha: float = 1
) -> None:
    for carries, colour in ((True, "#d9d9d9"), (False, "#deebf7")):
        chosen = holding[disks] == carries
        size = 2 * packing.radii[disks[chosen]]
        ax.add_collection(
            EllipseCollection(
                size,
                size,
                np.zeros(len(size)),
                units="xy",
                offsets=places[chosen],
                transOffset=ax.transData,
                facecolors=colour,
                edgecolors="0.35",
                linewidths=0.4,
                alpha=alpha,
                zorder=1,
            )
        )


def packing(
    state: State | Packing,
    forces: Optional[np.ndarray] = None,
    mechanism: Optional[np.ndarray] = None,
    ax: Optional[Axes] = None,
) -> Axes:
    """The disks and walls, the forces as lines, a mechanism as arrows.

    A periodic cell is outlined with dashes; disks are where the state has them, and images that contacts reach are paler.

    Parameters
    ----------
    state : State or Packing
    forces : (N,) float, optional
        One per contact (``inspect(state).forces``); default: those of the state's file. Line width is in
        proportion to the force, red: compression, blue: traction. Disks without force are pale.
    mechanism : (N_f,) float, optional
        Velocities of the degrees of freedom (`isostat.mechanism`); the longest arrow has the mean radius. In a cell
        those of the disks themselves: images also move with the periods.
    """
    if state.positions.shape[1] != 2:
        raise BadInput("a packing of spheres: expected disks (isostat export writes ParaView files of spheres)")
    ax = _axes(ax)
    if forces is None and isinstance(state, State) and len(state.forces):
        forces = state.forces
    holding = np.ones(len(state), dtype=bool)
    if forces is not None:
        if not isinstance(state, State):
            raise BadInput("forces: expected a State, whose contacts carry them")
        holding = _draw_forces(state, forces, ax)
    whole = ~np.isin(np.arange(len(state)), [member for ring in state.arcs for member in ring])
    disks, places = np.flatnonzero(whole), state.positions[whole]
    _draw_arcs(state, holding, ax)
    _draw_disks(state, disks, places, holding, ax)
    if isinstance(state, State):
        images, there = _images(state)
        _draw_disks(state, images, there, holding, ax, alpha=0.4)
        disks, places = np.concatenate((disks, images)), np.concatenate((places, there))
    if mechanism is not None:
        velocity, _ = disk_velocities(state, mechanism)
        longest = np.hypot(*velocity.T).max() or 1.0
        arrows = velocity * (state.radii.mean() / longest)
        ax.quiver(
            *state.positions.T,
            *arrows.T,
            angles="xy",
            scale_units="xy",
            scale=1,
            width=0.004,
            zorder=3,
        )
    sizes = state.radii[disks][:, None]
    drawn = np.concatenate([places - sizes, places + sizes, *(_outline(state, ring) for ring in state.arcs)])
    _draw_walls(state, drawn.min(axis=0), drawn.max(axis=0), ax)
    ax.set_aspect("equal")
    ax.set_axis_off()
    return ax


def _draw_walls(state: State | Packing, low: np.ndarray, high: np.ndarray, ax: Axes) -> None:
    """Walls and the outline of a cell, and the limits of the picture; `low`, `high`: of what is drawn already."""
    places = {}
    for side, place in {"lower": np.zeros(2), "upper": np.asarray(state.length)}.items():
        for axis, kind in enumerate(state.walls[side]):
            if kind != "absent":
                places[side, axis] = place[axis], kind
                (low if side == "lower" else high)[axis] = place[axis]
    for (_, axis), (at, kind) in places.items():
        ends = np.array([low, high])
        ends[:, axis] = at
        ax.plot(*ends.T, color="0.1" if kind == "fixed" else "0.5", linewidth=1.5, zorder=4)
    corners = _shifts(state, np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)]))
    for edge in range(4):
        if state.periodic[(edge + 1) % 2]:  # edges 0 and 2 are along x: they repeat along y
            ax.plot(*corners[edge : edge + 2].T, color="0.2", linewidth=0.8, linestyle="--", zorder=4)
    if any(state.periodic):
        low, high = np.minimum(low, corners.min(axis=0)), np.maximum(high, corners.max(axis=0))
    margin = 0.02 * (high - low).max()
    ax.set_xlim(low[0] - margin, high[0] + margin)
    ax.set_ylim(low[1] - margin, high[1] + margin)


def comparison(compared, ax: Optional[Axes] = None) -> Axes:
    """The staircase of the exact run, and frames of another program at their loads, a mark for each status.

    Parameters
    ----------
    compared : Comparison
        From `isostat.compare`.
    """
    ax = _axes(ax)
    path, frames = compared.path, compared.frames
    d = compared.dimension
    eps, sigma, true_eps = f"eps{d}", f"sigma{d}", f"true_eps{d}"
    if len(path):
        ax.plot(np.repeat(path[eps], 2)[:-1], np.repeat(path[sigma], 2)[1:], label="exact run", linewidth=1.2)
    strain = np.where(np.isnan(frames[true_eps]), frames[eps], frames[true_eps])
    marks = {"same": "o", "early": "^", "late": "v", "other": "s", "soft": "x", "moving": "+"}
    for status in dict.fromkeys(frames["status"]):
        at = frames["status"] == status
        ax.plot(strain[at], frames[sigma][at], marks.get(status, "*"), label=status, linestyle="none")
    ax.set_xlabel(f"strain {eps}")
    ax.set_ylabel(sigma)
    ax.legend()
    return ax


def _curve(run: Records) -> tuple[np.ndarray, np.ndarray, dict[str, str]]:
    """Strain and ratio of every row, and what they are called; of spheres whose walls are loaded q/p."""
    rows, loaded = run.equilibria, run._first.loaded_axis
    if len(run._first.length) == 2:
        shear = loaded == 2
        return rows["eps2"], rows["ratio"], {
            "strain": "shear strain $\\gamma$" if shear else "axial strain $\\varepsilon_2$",
            "ratio": "stress ratio " + ("$\\tau/\\sigma_2$" if shear else "$\\sigma_2/\\sigma_1$"),
            "strain step": "$|\\Delta\\gamma|$" if shear else "$|\\Delta\\varepsilon_2|$",
            "ratio step": "$|\\Delta\\tau|/\\sigma_2$" if shear else "$|\\Delta\\sigma_2|/\\sigma_1$",
        }
    if loaded >= 3:
        tilt = ("xy", "xz", "yz")[loaded - 3]
        return rows["eps_" + tilt], rows["ratio"], {
            "strain": f"shear strain {tilt}",
            "ratio": f"stress ratio, shear {tilt}",
            "strain step": "$|\\Delta\\gamma|$",
            "ratio step": "$|\\Delta\\tau|/\\sigma$",
        }
    test = run.triaxial
    return test["axial"], test["q"] / test["p"], {
        "strain": "axial strain $\\ln(L_{3,0}/L_3)$",
        "ratio": "$q/p$",
        "strain step": "$|\\Delta\\varepsilon_3|$",
        "ratio step": "$|\\Delta(q/p)|$",
    }


def staircase(run: Records, ax: Optional[Axes] = None) -> Axes:
    """Stress ratio against strain, axial or of shear: one structure carries a growing load, then a rearrangement.

    Of spheres whose walls or periods are loaded q/p against the axial strain (`Records.triaxial`).

    Parameters
    ----------
    run : Records
        From `isostat.load`. Each segment of the programme has a line style of its own.
    """
    ax = _axes(ax)
    strains, ratios, names = _curve(run)
    rows = {int(number): k for k, number in enumerate(run.equilibria["number"])}
    styles = ("-", "--", "-.", ":")
    for segment in np.unique(run.equilibria["segment"]):
        strain, ratio = [], []
        for k in np.flatnonzero(run.equilibria["segment"] == segment):
            before = rows.get(int(run.equilibria["previous"][k]))
            if before is not None:
                # Up (down) at the strain of the equilibrium before, then along at constant stress.
                strain += [strains[before], strains[before], strains[k]]
                ratio += [ratios[before], ratios[k], ratios[k]]
        ax.plot(
            strain, ratio, styles[segment % len(styles)], label=f"segment {segment}", linewidth=1.2
        )
    ax.set_xlabel(names["strain"])
    ax.set_ylabel(names["ratio"])
    if len(ax.get_lines()) > 1:
        ax.legend(frameon=False)
    return ax


def increments(run: Records, quantity: str = "strain", ax: Optional[Axes] = None) -> Axes:
    """Distribution of the increments between equilibria: the share that is at least x, no bins.

    Parameters
    ----------
    run : Records
    quantity : "strain" or "stress"
        |eps_2' - eps_2| of each rearrangement; or |sigma_2' - sigma_2| / sigma_1 between the rearrangements of a
        segment (the first one of a segment has none).
    """
    ax = _axes(ax)
    values = np.sort(increment_values(run, quantity))
    ax.step(values, 1 - np.arange(len(values)) / max(len(values), 1), where="pre", linewidth=1.2)
    ax.set_xscale("log")
    ax.set_yscale("log")
    names = _curve(run)[2]
    ax.set_xlabel(f"{quantity} increment {names['strain step' if quantity == 'strain' else 'ratio step']}")
    ax.set_ylabel("share at least as large")
    return ax


def force_distribution(*forces: np.ndarray, ax: Optional[Axes] = None) -> Axes:
    """P(f / <f>) of the contacts that carry a force, in bins of 1/4: densities that integrate to 1.

    Parameters
    ----------
    *forces : arrays
        One for each packing (`isostat.inspect(state).forces`); each is divided by its own mean. Numbers that are 0 or
        below, of contacts without force, are left out.
    """
    ax = _axes(ax)
    carrying = [np.asarray(of, float)[np.asarray(of) > 0] for of in forces]
    scaled = np.concatenate([of / of.mean() for of in carrying if of.size] or [np.empty(0)])
    if not scaled.size:
        raise BadInput("no force is positive: expected the forces of a packing at least")
    edges = np.arange(0, np.floor(scaled.max() / 0.25) + 2) * 0.25
    ax.stairs(np.histogram(scaled, edges, density=True)[0], edges, linewidth=1.2)
    ax.set_yscale("log")
    ax.set_xlabel("$f / \\langle f \\rangle$")
    ax.set_ylabel("$P(f / \\langle f \\rangle)$")
    return ax


def increment_values(run: Records, quantity: str = "strain") -> np.ndarray:
    """The positive increments that `increments` draws.

    A stress that was reached inside a supported interval (``arcs`` = 0) is no rearrangement.
    """
    strain, ratio, _ = _curve(run)
    if quantity not in ("strain", "stress"):
        raise BadInput(f"quantity is {quantity!r}: expected 'strain' or 'stress'")
    column = strain if quantity == "strain" else ratio
    places = {int(number): k for k, number in enumerate(run.equilibria["number"])}
    values = []
    for k, row in enumerate(run.equilibria):
        place = places.get(int(row["previous"]))
        if place is None or row["arcs"] == 0:
            continue
        before = run.equilibria[place]
        same = before["segment"] == row["segment"] and before["previous"] >= 0
        if quantity == "strain" or (same and before["arcs"] > 0):
            values.append(abs(column[k] - column[place]))
    found = np.array(values)
    return found[found > 0]
