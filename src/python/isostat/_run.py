"""Runs: a scene carried out, an equilibrium or an arc at a time."""

from __future__ import annotations

import os
import queue
import shutil
import tempfile
import threading
import weakref
from pathlib import Path
from typing import Any, Callable, Iterator, Mapping, cast

import numpy as np

from ._core import Arc, Equilibrium, State, _Run
from ._records import Records
from ._words import BadInput

_end = object()


def _value(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    return repr(value.item() if isinstance(value, np.generic) else value)


def scene_text(scene: Mapping[str, Any]) -> str:
    """The scene file of a dictionary: ``{"packing": {...}, "programme": [{...}, ...], "run": {...}}``."""
    lines = []
    for name, content in scene.items():
        tables = [content] if isinstance(content, Mapping) else content
        brackets = "[{}]" if isinstance(content, Mapping) else "[[{}]]"
        for table in tables:
            lines.append(brackets.format(name))
            lines += [f"{key} = {_value(value)}" for key, value in table.items()]
    return "\n".join(lines) + "\n"


def scene_of(scene: str | os.PathLike[str] | Mapping[str, Any], start: State | None) -> tuple[str, str, Path]:
    """Text, name and folder of a scene file, or of its sections."""
    if not isinstance(scene, Mapping):
        try:
            return Path(scene).read_text(), Path(scene).name, Path(scene).parent
        except (OSError, UnicodeDecodeError) as error:
            raise BadInput(f"{scene}: cannot be read: {error}") from None
    sections = dict(scene) if start is None else {"packing": {"file": "start"}, **scene}
    folder = Path.cwd()
    for key in ("file", "radii_file"):  # a scene names files of its folder alone
        if start is None and key in sections.get("packing", {}):
            named = Path(sections["packing"][key]).resolve()
            folder = named.parent
            sections["packing"] = {**sections["packing"], key: named.name}
    return scene_text(sections), "scene", folder


class Run:
    """A run: a packing, and a programme of loads, carried out into a folder.

    Parameters
    ----------
    scene : path, or dict
        A scene file, or its sections as a dictionary, with the keys of src/scene/README.md:
        ``{"packing": {"disks": 100}, "programme": [{"do": "up", "equilibria": 5}]}``.
    output : path, optional
        The folder. Without it a temporary one, which vanishes with this object.
    start : State, optional
        Where to start from, in place of a section ``packing``.
    resume, force : bool
        Go on with the run that the folder holds; delete it first.

    Nothing is computed before `play` or a loop. A loop that is left, `stop` and Ctrl-C end the run after
    the arc that is going on, with valid files; the next `play` or loop goes on from the last equilibrium
    and gives the records of a run that was never stopped. At its end a run that failed raises the Failure.

    Examples
    --------
    >>> run = Run({"packing": {"disks": 30}, "programme": [{"do": "up", "equilibria": 3}]})
    >>> [equilibrium.h for equilibrium in run]
    [0, 0, 0, 0]
    """

    def __init__(
        self,
        scene: str | os.PathLike[str] | Mapping[str, Any],
        output: str | os.PathLike[str] | None = None,
        *,
        start: State | None = None,
        resume: bool = False,
        force: bool = False,
    ) -> None:
        self.path = Path(tempfile.mkdtemp() if output is None else output)
        if output is None:
            weakref.finalize(self, shutil.rmtree, self.path, ignore_errors=True)
        text, name, folder = scene_of(scene, start)
        self._run = _Run(text, name, folder, self.path, start)
        self._mode = "resume" if resume else "force" if force else "fresh"

    def __repr__(self) -> str:
        return f"<isostat.Run: {self.status or 'not begun'}, in {self.path}>"

    @property
    def status(self) -> str:
        """``""`` before it began, ``"completed"``, ``"failed"``, ``"undecided"``, ``"interrupted"``."""
        return self._run.status

    @property
    def reason(self) -> str:
        """Why it ended, where it did not complete."""
        return self._run.reason

    @property
    def records(self) -> Records:
        """What was recorded so far, as `load` gives it."""
        return Records(self.path)

    @property
    def state(self) -> State:
        """The last equilibrium; the run has stopped or ended."""
        return self.records.states.last

    def at(self, sigma2: float, *, segment: int | None = None) -> tuple[State, np.ndarray]:
        """As `Records.at`: the equilibrium under a load of the path, and the proved intervals of its forces."""
        return self.records.at(sigma2, segment=segment)

    def play(
        self,
        on_equilibrium: Callable[[Equilibrium], object] | None = None,
        on_arc: Callable[[Arc], object] | None = None,
    ) -> None:
        """Carries out the programme, or what is left of it.

        Parameters
        ----------
        on_equilibrium, on_arc : callables, optional
            Called with each Equilibrium and each Arc, after it was recorded. What they raise stops the run.
        """
        if self.status == "completed":
            return
        mode, self._mode = self._mode, "resume"
        self._run.play(mode, on_arc, on_equilibrium)

    def stop(self) -> None:
        """Ends `play` after the arc that is going on: for a callback or another thread."""
        self._run.stop()

    def __iter__(self) -> Iterator[Equilibrium]:
        """The equilibria, one at a time: nothing is computed while the loop has one."""
        return cast(Iterator[Equilibrium], self._steps("on_equilibrium"))

    def arcs(self) -> Iterator[Arc | Equilibrium]:
        """The arcs and the equilibria in their order, one at a time."""
        return self._steps("on_equilibrium", "on_arc")

    def _steps(self, *kinds: str) -> Iterator[Arc | Equilibrium]:
        # The run has a thread of its own, which waits while the loop has a record.
        records: queue.SimpleQueue = queue.SimpleQueue()
        go_on = threading.Semaphore(0)
        left = threading.Event()
        raised: list[BaseException] = []

        def hand_over(record: Arc | Equilibrium) -> None:
            if not left.is_set():
                records.put(record)
                go_on.acquire()

        def work() -> None:
            try:
                self.play(**{kind: hand_over for kind in kinds})
            except BaseException as error:
                raised.append(error)
            records.put(_end)

        thread = threading.Thread(target=work, daemon=True)
        thread.start()
        try:
            while (record := records.get()) is not _end:
                yield record
                go_on.release()
        finally:
            left.set()
            self.stop()
            go_on.release()
            thread.join()
        if raised:
            raise raised[0]
