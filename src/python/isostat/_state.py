"""States from arrays, and what follows from their contact matrix."""

from __future__ import annotations

import json
from operator import index
from typing import Any, Iterable, Sequence

import numpy as np

from ._core import ExactPacking, Inspection, Packing, State, count

_walls = {-1: "left", -2: "bottom", -3: "right", -4: "top", -5: "back", -6: "front"}


def contact_pair(contact: Sequence[Any]) -> tuple[int, int]:
    """(i, j) with the codes of walls, from ``(0, 1)``, ``(0, "left")`` or ``(0, -1)``."""
    i, j = contact
    codes = {name: code for code, name in _walls.items()}
    return index(i), codes[j] if isinstance(j, str) else index(j)


def _json_contact(contact: Sequence[Any]) -> list[object]:
    i, j = index(contact[0]), contact[1]
    if isinstance(j, str):
        return [i, j]
    return [min(i, index(j)), max(i, index(j))] if index(j) >= 0 else [i, _walls.get(index(j), index(j))]


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
        ``"back"``, ``"front"`` (-5, -6). They are part of the state: never found from a threshold.
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

    Returns
    -------
    State

    Raises
    ------
    BadInput
        The field, the value and what was expected. Gaps and overlaps are not looked at.
    """
    positions = np.asarray(positions, dtype=float)
    radii = np.asarray(radii, dtype=float)
    axes = positions.shape[-1] if positions.ndim == 2 else 0
    if axes not in (2, 3) or len(positions) != len(radii):
        raise ValueError(f"positions has shape {positions.shape}: expected ({len(radii)}, 2), of spheres ({len(radii)}, 3)")
    lower, upper = lower or ["fixed"] * axes, upper or ["movable"] * axes
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
    """
    from scipy.sparse.linalg import spsolve

    wanted = contact_pair(contact[:2])
    same = (state.contacts == wanted).all(axis=1)
    for image in contact[2:]:
        same &= (state.images == image).all(axis=1)
    places = np.flatnonzero(same)
    if len(places) != 1:
        raise ValueError(
            f"{tuple(contact)} is {len(places)} contacts of this state: expected one, (i, j) or (i, j, (m_x, m_y))"
        )
    matrix = contact_matrix(state)
    if matrix.shape[0] != matrix.shape[1]:
        raise ValueError(
            f"N_f = {matrix.shape[0]}, N = {matrix.shape[1]}: expected as many contacts"
        )
    rates = np.zeros(matrix.shape[1])
    rates[places[0]] = -1.0
    return spsolve(matrix.T.tocsc(), rates)


def disk_velocities(
    state: State | Packing, velocities: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Velocities of degrees of freedom as those of disks (n, 2), and those of the lengths (2,), of a cell with its tilt (3,).

    A length is that of the box, where its upper wall moves, or a period of the cell.
    """
    lengths = {"right wall": 0, "period along x": 0, "top wall": 1, "period along y": 1, "tilt xy": 2}
    disks, sizes = np.zeros((len(state), 2)), np.zeros(2 if state.tilt is None else 3)
    for name, value in zip(state.dof_names, velocities):
        if " of disk " in name:
            axis, _, number = name.partition(" of disk ")
            disks[int(number), "xy".index(axis)] = value
        else:
            sizes[lengths[name]] = value
    return disks, sizes
