"""The folder of a run as arrays. It may be going on, finished or killed."""

from __future__ import annotations

import csv
import functools
import io
import json
import os
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ._core import State, _contact_spelt, _event_numbers, _integer_columns, _walked_to, forces_at
from ._words import BadInput, NotStored, Verdict


def _complete_lines(path: Path) -> list[str]:
    """Lines that were written to their end: a run that goes on may be in the middle of one."""
    try:
        text = path.read_text()
    except FileNotFoundError:
        return []
    return text.split("\n")[:-1]


def _integer(word: str) -> int:
    if str(int(word)) != word:
        raise ValueError(f"{word!r}: expected an integer")
    return int(word)


_casts: dict[str, Callable[[str], float]] = {"i": _integer, "f": float}


def _once(pairs: list[tuple[str, object]]) -> dict:
    names = [name for name, _ in pairs]
    if twice := {name for name in names if names.count(name) > 1}:
        raise ValueError(f"the field {twice.pop()!r} comes twice in one object: expected once")
    return dict(pairs)


def _parsed(text: str, where: str) -> dict:
    """JSON as the library reads it: no name comes twice in one object."""
    try:
        return json.loads(text, object_pairs_hook=_once)
    except ValueError as error:
        raise BadInput(f"{where}: {error}") from None


def contact_of_name(name: str, dimension: int = 2) -> tuple[int, ...]:
    """(i, j, m_x, m_y) of ``"3-7"``, ``"3-8(1,0)"``, ``"3-left"``, ``"held x of grain 3"``; of spheres m_z too.

    Walls are j = -1 to -4 (-6), held coordinates -9; the second disk is moved by m_x and m_y periods.
    """
    if contact := _contact_spelt(name, dimension):
        return tuple(contact)
    raise BadInput(
        f"events.jsonl: contact '{name}': expected two disks i < j, as 3-7 or 3-8(1,0), a disk and a wall, or a held coordinate"
    )


def read_table(path: Path, integers: frozenset[str] = _integer_columns) -> np.ndarray:
    """A CSV file of numbers with a row of names, without a line that was cut, as a structured array."""
    lines = _complete_lines(path)
    names = lines[0].lstrip("# ").split(",") if lines else []
    rows = csv.reader(io.StringIO("\n".join(lines[1:])))
    try:
        kinds = np.dtype(
            [(name, int if name in integers else float) for name in names]
        )  # refuses a name that comes twice
        casts = [_casts[kinds[name].kind] for name in names]
        return np.array(
            [tuple(cast(x) for cast, x in zip(casts, row, strict=True)) for row in rows],
            dtype=kinds,
        )
    except ValueError as error:
        raise BadInput(f"{path}: {error}") from None


class States:
    """Stored states by the number of their equilibrium, read when they are asked for.

    ``len(states)``, ``for number in states``, ``states[number]``, ``number in states``.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def __repr__(self) -> str:
        return f"<isostat.States: {len(self)} of {self._folder}>"

    def numbers(self) -> list[int]:
        """Numbers of the equilibria whose states were stored, increasing."""
        names = (re.fullmatch(r"eq_(\d{6,})\.json", path.name) for path in self._folder.glob("eq_*"))
        return sorted(int(name[1]) for name in names if name)

    def __len__(self) -> int:
        return len(self.numbers())

    def __iter__(self):
        return iter(self.numbers())

    def __contains__(self, number: object) -> bool:
        return isinstance(number, (int, np.integer)) and self._path(int(number)).exists()

    def __getitem__(self, number: int) -> State:
        if number not in self:
            raise NotStored(f"equilibrium {number} was not stored: there are {self.numbers()}")
        return State.read(self._path(int(number)))

    @property
    def last(self) -> State:
        """The last equilibrium of a run that has ended."""
        return State.read(self._folder / "last.json")

    def _path(self, number: int) -> Path:
        return self._folder / f"eq_{number:06}.json"


class Records:
    """The records of a run. Each file is read when it is first asked for; `reload` forgets what was read.

    Attributes
    ----------
    path : Path
    states : States
        Stored states, by number.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        if not (self.path / "run.json").is_file():
            raise BadInput(f"{self.path}: holds no run: expected a folder with run.json")
        self.states = States(self.path / "states")

    def __repr__(self) -> str:
        return (
            f"isostat.load({str(self.path)!r})  # {self.status}, {len(self.equilibria)} equilibria"
        )

    def reload(self) -> None:
        """Reads the files again when they are next asked for: of a run that goes on."""
        for name in ("header", "equilibria", "event_records", "events", "_stored", "_first"):
            self.__dict__.pop(name, None)

    @functools.cached_property
    def header(self) -> dict:
        """run.json: program, command, scene, settings, status."""
        return _parsed((self.path / "run.json").read_text(), str(self.path / "run.json"))

    @property
    def status(self) -> str:
        """``"running"`` (also after a kill), ``"completed"``, ``"failed: ..."``, ``"undecided: ..."``,
        ``"interrupted: ..."``.
        """
        return self.header["status"]

    @functools.cached_property
    def equilibria(self) -> np.ndarray:
        """(m,) structured array, one row per equilibrium, fields as the columns of equilibria.csv.

        Stresses in your unit, strains positive in compression; contacts are two fields ``_i``, ``_j``.
        """
        return read_table(self.path / "equilibria.csv")

    @functools.cached_property
    def event_records(self) -> list[dict]:
        """events.jsonl as it stands: one dictionary per arc."""
        file = self.path / "events.jsonl"
        return [_parsed(line, str(file)) for line in _complete_lines(file)]

    @functools.cached_property
    def events(self) -> np.ndarray:
        """(arcs,) structured array of events.jsonl; what is not known is NaN.

        ``opened``, ``closed``: (2,) int, walls -1 to -4 (-6), held coordinates -9; ``opened_image``, ``closed_image``:
        (2,) int, of spheres (3,), periods of the cell by which the second disk is moved, 0 in a box. ``decided_by``:
        word. ``sigma2``, ``eps2``, ``eps2_bound``: of spheres by axis, ``sigma3`` and so on; on a path
        of stresses ``t``, ``eps3``.
        """
        dimension = self._first.positions.shape[1] if self.event_records else 2
        numbers = _event_numbers("".join(_complete_lines(self.path / "equilibria.csv")[:1]))
        kinds = np.dtype(
            [("step", int), ("equilibrium", int), ("arc", int), ("kind", "U8")]
            + [("opened", int, 2), ("closed", int, 2), ("opened_image", int, dimension), ("closed_image", int, dimension)]
            + [("power_turn", bool), ("steps", int)]
            + [("decided_by", "U13")]
            + [(name, float) for name in numbers]
        )
        events = np.empty(len(self.event_records), dtype=kinds)
        for row, record in zip(events, self.event_records):
            for name in ("step", "equilibrium", "arc", "kind", "power_turn", "steps", "decided_by"):
                row[name] = record[name]
            for name in ("opened", "closed"):
                contact = contact_of_name(record[name], dimension)
                row[name], row[name + "_image"] = contact[:2], contact[2:]
            for name in numbers:
                value = record.get(name)
                row[name] = np.nan if value is None else value
        return events

    @property
    def _stress(self) -> str:
        """The column of the loaded stress, behind number, previous and segment."""
        return (self.equilibria.dtype.names or [""] * 3 + ["sigma2"])[3]

    @functools.cached_property
    def _stored(self) -> list[State]:
        return [self.states[number] for number in self.states]

    @functools.cached_property
    def _first(self) -> State:
        return self.states[0] if 0 in self.states else State.read(self.path / "start.json")

    @property
    def radii(self) -> np.ndarray:
        """(n,) radii; unit of length: that of the scene."""
        return self._first.radii

    @property
    def positions(self) -> np.ndarray:
        """(s, n, 2) centres in the s stored states (``states.numbers()``)."""
        return np.stack([state.positions for state in self._stored])

    @property
    def cell(self) -> np.ndarray:
        """(m, 2) lengths (Lx, Ly) of the box at every equilibrium, of spheres (m, 3)."""
        if self._first.positions.shape[1] == 3:
            return np.column_stack([self.equilibria[name] for name in ("L1", "L2", "L3")])
        # L1 is along the axis that is not loaded.
        columns = {0: ("L2", "L1"), 1: ("L1", "L2"), 2: ("L3", "L1")}[self._first.loaded_axis]  # 2: the tilt
        return np.column_stack([self.equilibria[name] for name in columns])

    @property
    def triaxial(self) -> np.ndarray:
        """(m,) structured array of a run of spheres, z axial: ``number``, ``axial`` and ``volumetric`` (logarithmic
        strains since the lengths of reference, positive in compression), ``p`` (mean stress), ``q`` (axial stress less
        the mean of the others).
        """
        first, rows = self._first, self.equilibria
        if len(first.length) != 3 or first.loaded_axis >= 3:
            raise BadInput(f"{self.path}: no triaxial test: expected spheres whose walls or periods are loaded")
        strain = np.log(np.asarray(first.reference_length) / self.cell)
        stress = np.tile(first.stress, (len(rows), 1))
        stress[:, first.loaded_axis] = rows[self._stress]
        on_path = self._stress == "t"
        test = np.empty(len(rows), [("number", int)] + [(n, float) for n in ("axial", "volumetric", "p", "q")])
        test["number"], test["axial"], test["volumetric"] = rows["number"], strain[:, 2], strain.sum(axis=1)
        test["p"] = rows["p"] if on_path else stress.mean(axis=1)
        test["q"] = rows["q"] if on_path else stress[:, 2] - stress[:, :2].mean(axis=1)
        return test

    @property
    def contacts(self) -> list[np.ndarray]:
        """Contacts (N, 2) of each stored state; walls -1 to -4, held coordinates -9."""
        return [state.contacts for state in self._stored]

    @property
    def forces(self) -> list[np.ndarray]:
        """Forces (N,) in the contacts of each stored state; stress x length, positive in compression."""
        return [state.forces for state in self._stored]

    def state(self, number: int) -> State:
        """The state of an equilibrium, stored or not: what was not stored is found by following the records from the
        start, in double precision. Raises BadInput where they cannot be followed.
        """
        return self.states[number] if number in self.states else _walked_to(self.path, int(number))

    def at(self, sigma2: float, *, segment: int | None = None) -> tuple[State, np.ndarray]:
        """The first equilibrium (of one `segment` of the programme, from 0) whose supported interval holds `sigma2`,
        under that stress (where the tilt is loaded: that shear stress; on a path of stresses: that t), and the intervals
        (N, 2) of its forces there, proved (`forces_at`). Any load of the path has one, whether its state was stored or
        not (`state`). Raises BadInput for a load that no equilibrium holds.
        """
        rows = self.equilibria
        if segment is not None:
            rows = rows[rows["segment"] == segment]
        low, high = rows[self._stress + "_low"], rows[self._stress + "_high"]
        holding = rows["number"][(low <= sigma2) & (sigma2 <= high)]
        if len(holding) == 0:
            reached = f"from {np.nanmin(low):.17g} to {np.nanmax(high):.17g}" if len(rows) else "none"
            raise BadInput(f"{self._stress} is {sigma2}: expected a load that an equilibrium of this run holds: {reached}")
        state = self.state(int(holding[0]))
        return state.with_loaded_stress(float(sigma2)), forces_at(state, sigma2)

    def certified(self) -> dict[int, Verdict]:
        """What the certificate of each equilibrium says, where one was made (level ``states``)."""
        rows = self.equilibria[self.equilibria["certified"] >= 0]
        return {
            int(r["number"]): Verdict.PROVED if r["certified"] else Verdict.UNDECIDED for r in rows
        }


def load(path: str | os.PathLike[str]) -> Records:
    """The records of a run, read lazily: a folder that ``isostat run`` or `Run` writes.

    Works while the run goes on and after a kill: a record that is not complete is left out.

    Parameters
    ----------
    path : folder

    Raises
    ------
    BadInput
        The folder holds no run.
    """
    return Records(path)
