"""States from arrays, and what follows from their contact matrix."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Sequence
from operator import index
from typing import Any

import numpy as np

from ._core import ExactPacking, Packing, State, _walls
from ._words import BadInput, NotIsostatic


def contact_pair(contact: Sequence[Any]) -> tuple[int, int]:
    """(i, j) with the codes of walls, from ``(0, 1)``, ``(0, "left")`` or ``(0, -1)``."""
    try:
        i, j = contact
        codes = {name: code for code, name in _walls.items()}
        return index(i), codes[j] if isinstance(j, str) else index(j)
    except (KeyError, TypeError, ValueError):
        raise BadInput(
            f"contact {contact!r}: expected two integers, or an integer and one of {', '.join(_walls.values())}"
        ) from None


def _json_contact(contact: Sequence[Any]) -> list[object]:
    i, j = contact_pair(contact[:2])
    if j < 0:
        return [i, _walls.get(j, j)]
    image = [index(periods) for periods in contact[2]] if len(contact) > 2 else []
    if not any(image):
        return [min(i, j), max(i, j)]
    turned = i > j or (i == j and next((m for m in image if m), 1) < 0)  # the same contact, seen from the other grain
    return [j, i, [-m for m in image]] if turned else [i, j, image]


def _three(values: object) -> list[float]:
    return [float(value) for value in np.broadcast_to(np.asarray(values, dtype=float), 3)]


def from_arrays(
    positions: np.ndarray,
    radii: np.ndarray,
    length: Sequence[float],
    contacts: Iterable[Sequence[object]],
    *,
    lower: Sequence[str] | None = None,
    upper: Sequence[str] | None = None,
    stress: Sequence[float] | None = None,
    reference_length: Sequence[float] | None = None,
    load: str = "nominal",
    infinitesimal: np.ndarray | None = None,
    disk_force: np.ndarray | None = None,
    fixed: Iterable[int] = (),
    bars: Iterable[tuple[int, int, float]] = (),
    arcs: Iterable[Iterable[int]] = (),
    periodic: Sequence[bool] | None = None,
    moves: Sequence[str] = (),
    tilt: float | Sequence[float] = 0.0,
    pin: int = 0,
    shear: float | Sequence[float] | None = None,
) -> State:
    """A state from arrays. Every number is kept bit for bit.

    Parameters
    ----------
    positions : (n, 2) float, of spheres (n, 3)
        Centres. Unit of length: yours.
    radii : (n,) float
    length : (d,) float
        Positions of the right, the top (and the front) wall; the lower walls are at 0.
    contacts : rows (i, j)
        Two grains, or a grain and ``"left"``, ``"bottom"``, ``"right"``, ``"top"`` (or -1 to -4), of spheres
        ``"back"``, ``"front"`` (-5, -6). They are part of the state: never found from a threshold. In a cell rows may
        be (i, j, (m_x, m_y)): the second grain is moved by so many periods.
    lower, upper : for each axis "fixed" (default of `lower`), "absent", and for `upper` "movable" (default)
    stress : (d,) float
        On the right, the top (and the front) wall; positive in compression; default: ones.
    reference_length : (d,) float, optional
        Lengths at which nominal stress and strain are defined; default: `length`, where no wall is absent.
    load : "nominal" or "true"
    infinitesimal : (n, d) float, optional
        Infinitesimal loads, on which rattlers rest.
    disk_force : (n, d) float, optional
        External forces on disks; stress x length.
    fixed : numbers of disks that cannot move
    bars : rows (i, j, length), optional
        Clumps: the centres of two members of one body stay at this distance; ``inspect``, ``certify`` and `Run` take them.
    arcs : members of bodies bounded by arcs, counterclockwise, optional
        Neighbours have a bar of exactly the difference of their radii; ``inspect`` and ``certify`` take such bodies.
    periodic : (d,) flags, optional
        Axes that repeat, with `length` as their periods: a cell.
    moves : of a cell, which of ``"x"``, ``"y"``, ``"xy"`` (of spheres ``"z"``, ``"xz"``, ``"yz"`` too) are degrees of
        freedom, or ``["scale"]``; none: a fixed cell
    tilt, shear : of a cell, x of the second period and the shear stress on it; of spheres three, xy, xz, yz
    pin : of a cell, the grain that stays where it is

    Raises
    ------
    BadInput
        The field, the value and what was expected. Gaps and overlaps are not looked at.
    """
    positions = np.asarray(positions, dtype=float)
    radii = np.asarray(radii, dtype=float)
    axes = positions.shape[-1] if positions.ndim == 2 else 0
    if axes not in (2, 3) or len(positions) != len(radii):
        raise BadInput(f"positions has shape {positions.shape}: expected ({len(radii)}, 2), of spheres ({len(radii)}, 3)")
    repeats = list(periodic) if periodic is not None else [False] * axes
    lower = lower or ["absent" if again else "fixed" for again in repeats]
    upper = upper or ["absent" if again else "movable" for again in repeats]
    stress = [1.0] * axes if stress is None else stress
    content: dict[str, Any] = {
        "format": "isostat-state",
        "version": 2,
        "dimension": axes,
        "disks": np.column_stack((positions, radii)).tolist(),
        "length": [float(value) for value in length],
        "walls": {"lower": list(lower), "upper": list(upper)},
        "load": {"kind": load, "stress": [float(value) for value in stress]},
        "contacts": [_json_contact(contact) for contact in contacts],
    }
    if reference_length is not None:
        content["load"]["reference_length"] = [float(value) for value in reference_length]
    for name, value in (("infinitesimal", infinitesimal), ("disk_force", disk_force)):
        if value is not None:
            content[name] = np.asarray(value, dtype=float).tolist()
    if held := [index(disk) for disk in fixed]:
        content["fixed"] = held
    if rows := [[index(i), index(j), float(length_of_bar)] for i, j, length_of_bar in bars]:
        content["bars"] = rows
    if rings := [[index(member) for member in ring] for ring in arcs]:
        content["arcs"] = rings
    if any(repeats):
        content["cell"] = {
            "axes": ["periodic" if again else "walls" for again in repeats],
            "moves": list(moves),
            "tilt": np.atleast_1d(np.asarray(tilt, dtype=float)).tolist() if axes == 2 else _three(tilt),
            "pin": index(pin),
        }
        if shear is not None:
            content["load"]["shear"] = np.atleast_1d(np.asarray(shear, dtype=float)).tolist() if axes == 2 else _three(shear)
    elif moves or np.any(tilt) or shear is not None:
        raise BadInput("moves, tilt and shear belong to a cell: expected `periodic` too")
    return State.parse(json.dumps(content), "State.from_arrays")


def contact_matrix(state: State | ExactPacking):
    """The contact matrix H, rounded to doubles: ``H @ forces == external_force``.

    Parameters
    ----------
    state : State or ExactPacking

    Returns
    -------
    scipy.sparse.csc_matrix, shape (N_f, N)
        Row d is degree of freedom d (`dof_names`), column l contact l; unit normals. ``H.T @ v`` are the
        rates at which contacts close when the degrees of freedom move with v. Each entry has a relative
        error of some 1e-16; the rank of this matrix proves nothing (see `count` and `ExactPacking`).
    """
    from scipy.sparse import csc_matrix

    if isinstance(state, State):
        parts, shape = state._matrix()
        return csc_matrix(parts, shape=shape, copy=False)
    columns = state.exact_columns()
    rows = [row for column in columns for row in column]
    values = [float(value) for column in columns for value in column.values()]
    starts = np.cumsum([0] + [len(column) for column in columns])
    dofs = len(state.packing.dof_names)
    return csc_matrix((values, rows, starts), shape=(dofs, len(columns)))


def mechanism(state: State, contact: Sequence[object]) -> np.ndarray:
    """The motion that opens one contact of an isostatic state and keeps the others closed.

    In double precision, for pictures and experiments: nothing is proved of it.

    Parameters
    ----------
    state : State
        With N = N_f contacts and a regular contact matrix.
    contact : (i, j) or (i, j, (m_x, m_y))
        One of its contacts; where a disk touches several images of another one, with the image.

    Returns
    -------
    (N_f,) float
        Velocities of the degrees of freedom; the gap of `contact` grows with rate 1.

    Raises
    ------
    BadInput
        The state has no such contact, or several.
    NotIsostatic
        N != N_f.
    """
    from scipy.sparse.linalg import spsolve

    wanted = contact_pair(contact[:2] if isinstance(contact, Sequence) else contact)
    same = (state.contacts == wanted).all(axis=1)
    for image in contact[2:]:
        same &= (state.images == image).all(axis=1)
    places = np.flatnonzero(same)
    if len(places) != 1:
        raise BadInput(
            f"{tuple(contact)} is {len(places)} contacts of this state: expected one, (i, j) or (i, j, (m_x, m_y))"
        )
    matrix = contact_matrix(state)
    if matrix.shape[0] != matrix.shape[1]:
        raise NotIsostatic(f"N_f = {matrix.shape[0]}, N = {matrix.shape[1]}: expected as many contacts")
    rates = np.zeros(matrix.shape[1])
    rates[places[0]] = -1.0
    return spsolve(matrix.T.tocsc(), rates)


def contact_table(state: State) -> np.ndarray:
    """The contacts of a state with their points, normals, gaps and proved forces: ``isostat inspect --contacts``.

    Returns
    -------
    structured array, one row per contact in the order of the state, held coordinates left out
        ``contact``, its name; ``i``, ``j``, walls -1 to -4 (-6); ``mx``, ``my``, the image of j; ``x``, ``y``, a point on
        the surface of i; ``nx``, ``ny``, the unit normal from i to j; ``gap``, of the stored coordinates; ``force``,
        ``force_low``, ``force_high``, the middle and the proved ends, nan where they are not known;
        ``force_infinitesimal``, nan where none is claimed. Of spheres ``mz``, ``z``, ``nz`` too. Lengths in your unit,
        forces in stress x length, of spheres stress x length squared.
    """
    head, *rows = csv.reader(io.StringIO(state._contact_table()))
    codes = {name: code for code, name in _walls.items()}
    kinds = [(name, "U32" if name == "contact" else int if name in ("i", "j", "mx", "my", "mz") else float) for name in head]

    def value(name: str, word: str) -> object:
        if name == "j":
            return codes[word] if word in codes else int(word)
        return word if name == "contact" else float(word or "nan")

    return np.array([tuple(value(name, word) for name, word in zip(head, row)) for row in rows], dtype=kinds)


def stiffness_matrix(state: State, stiffness: float | np.ndarray, *, forces: np.ndarray | None = None):
    """The stiffness matrix of linear springs in the contacts, in double precision: nothing is proved of it.

    Parameters
    ----------
    state : State
    stiffness : float, or (N,)
        Force / overlap of the contacts (stress units for disks, stress x length for spheres).
    forces : (N,) float, optional
        Forces that the contacts bear, of ``inspect(state).forces`` for instance: their part, minus the force times the
        second derivative of the gap, is added. Without them: unstressed springs.

    Returns
    -------
    scipy.sparse.csc_matrix, (N_f, N_f), symmetric
        K = H diag(stiffness) H^T - sum f d2h, in the order of `dof_names`, under dead loads.

    Raises
    ------
    BadInput
        Lengths that do not fit; an isotropic cell.
    """
    from scipy.sparse import csc_matrix, diags

    matrix = contact_matrix(state)
    size, count = matrix.shape
    contact, row, column, value = state._curvature()
    springs = np.asarray(stiffness, dtype=float)
    if springs.shape not in ((), (count,)) or not (np.isfinite(springs).all() and (springs > 0).all()):
        raise BadInput(f"stiffness: expected a positive number, or {count} of them")
    total = matrix @ diags(np.broadcast_to(springs, count)) @ matrix.T
    if forces is not None:
        pressed = np.asarray(forces, dtype=float)
        if pressed.shape != (count,) or not np.isfinite(pressed).all():
            raise BadInput(f"forces has shape {pressed.shape}: expected one finite number for each of {count} contacts")
        total = total - csc_matrix((pressed[contact] * value, (row, column)), shape=(size, size))
    return csc_matrix(total)


def modes(
    state: State, stiffness: float | np.ndarray, count: int | None = None, *, forces: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Eigenvalues, ascending, and eigenvectors, columns, of `stiffness_matrix`: the softest `count`, or all.

    Squares of frequencies where every degree of freedom has mass 1. Dense: seconds for 2000 degrees of freedom.
    """
    from scipy.linalg import eigh

    matrix = stiffness_matrix(state, stiffness, forces=forces).toarray()
    last = len(matrix) if count is None else min(index(count), len(matrix))
    if last < 1:
        raise BadInput(f"count is {count}: expected at least 1")
    return eigh(matrix, subset_by_index=(0, last - 1))


def unjamming_motion(state: State) -> np.ndarray | None:
    """A motion at first order under which no gap shrinks and the load does no negative work, by a linear programme.

    Rattlers by coordination do not move. It has the largest sum of the rates at which gaps open, and velocities of at
    most 1; where no gap opens at first order, but a mechanism keeps all closed, it is one of those. In double
    precision: nothing is proved of it. Whether a state is jammed is proved by `inspect` and `jamming`.

    Returns
    -------
    (N_f,) float, or None
        Velocities of the degrees of freedom; None: there is none.
    """
    from scipy.optimize import linprog

    words = [name.rsplit(" ", 1) for name in state.dof_names]  # "x of disk", "3"
    loose = {str(rattler) for rattler in state.rattlers}
    moving = np.array([" of " not in what or which not in loose for what, which in words], dtype=bool)
    matrix = contact_matrix(state)
    among = np.asarray(abs(matrix[~moving]).sum(axis=0) == 0).ravel()  # contacts that no rattler has
    closing = matrix[:, np.flatnonzero(among)].T
    rates = np.asarray(closing.sum(axis=0)).ravel()
    limits = [(-1, 1) if free else (0, 0) for free in moving]
    load = state.external_force
    scale = np.abs(load).max() if load.size and np.abs(load).max() > 0 else 1.0
    rows = np.vstack([closing.toarray(), -load / scale])
    small = 1e-7  # what the solver allows itself

    def best(cost: np.ndarray) -> np.ndarray:
        answer = linprog(cost, A_ub=rows, b_ub=np.zeros(len(rows)), bounds=limits, method="highs")
        return answer.x if answer.status == 0 else np.zeros(len(moving))

    for cost in (rates, -load / scale):  # gaps that open, or work that is done
        motion = best(cost)
        if cost @ motion < -small:
            return motion
    held = np.flatnonzero(moving)
    _, sizes, directions = np.linalg.svd(closing.toarray()[:, held], full_matrices=True)
    if len(held) == 0 or (len(sizes) == len(held) and sizes[-1] > small * sizes[0]):
        return None
    motion = np.zeros(len(moving))
    motion[held] = directions[-1] / np.abs(directions[-1]).max()
    return motion if load @ motion >= -small * scale else -motion


def disk_velocities(
    state: State | Packing, velocities: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Velocities of degrees of freedom as those of disks (n, 2), and those of the lengths (2,), of a cell with its tilt (3,).

    A length is that of the box, where its upper wall moves, or a period of the cell.
    """
    if state.positions.shape[1] != 2:
        raise BadInput("velocities of spheres: expected a state of disks")
    lengths = {"right wall": 0, "period along x": 0, "top wall": 1, "period along y": 1, "tilt xy": 2}
    disks, sizes = np.zeros((len(state), 2)), np.zeros(2 if state.tilt is None else 3)
    for name, value in zip(state.dof_names, velocities):
        if " of disk " in name:
            axis, _, number = name.partition(" of disk ")
            disks[int(number), "xy".index(axis)] = value
        else:
            sizes[lengths[name]] = value
    return disks, sizes
