"""Many samples of one scene on all cores, and their tables."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, Callable, Mapping

import numpy as np

from ._core import _Ensemble, _integer_columns, _members, available_cores
from ._records import Records, read_table
from ._run import scene_of

_sample = """import sys, isostat
isostat.set_threads(1)
run = isostat.Run(sys.argv[1], sys.argv[2], resume=sys.argv[3] == "resume", force=sys.argv[3] == "force")
try:
    run.play()
except isostat.Failure:
    pass  # the folder says it
except KeyboardInterrupt:
    sys.exit(130)
"""


class Ensemble:
    """The folder of an ensemble, of `ensemble` or ``isostat ensemble``; tables are read when they are asked for.

    Attributes
    ----------
    path : Path
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        _members(self.path)

    def __repr__(self) -> str:
        return f"<isostat.Ensemble: {len(self.samples)} samples in {self.path}>"

    @property
    def members(self) -> dict[int, Records]:
        """The runs that were begun, by seed."""
        return {seed: Records(folder) for seed, folder in _members(self.path)}

    @property
    def samples(self) -> np.ndarray:
        """Columns of samples.csv; ``status`` 0: completed, 1: failed, 2: undecided, others: not finished."""
        return read_table(self.path / "samples.csv", frozenset(["seed", "status", "equilibria", "proved", "arcs"]))

    @property
    def equilibria(self) -> np.ndarray:
        """Columns of equilibria.csv of all samples, behind ``seed``."""
        return read_table(self.path / "equilibria.csv", _integer_columns | {"seed"})

    @property
    def increments(self) -> np.ndarray:
        """Columns of increments.csv, one row per rearrangement; nan where there is no increment."""
        return read_table(self.path / "increments.csv", frozenset(["seed", "segment", "number", "direction", "arcs"]))


def ensemble(
    scene: str | os.PathLike[str] | Mapping[str, Any],
    output: str | os.PathLike[str],
    *,
    samples: int,
    seed: int = 1,
    jobs: int | None = None,
    resume: bool = False,
    force: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> Ensemble:
    """Samples of one scene, each a run of its own in a process of its own, and one table: ``isostat ensemble``.

    Parameters
    ----------
    scene : path, or dict, as for `Run`
    output : path of the folder
    samples, seed : how many, from which seed on
    jobs : samples at a time; default: one per core
    resume, force : go on with the samples that the folder holds; delete them first
    progress : callable (done, samples), optional
        Called when a sample has ended. What it raises stops all, as Ctrl-C does; `resume` goes on.

    Returns
    -------
    Ensemble
        Also where samples failed at their load: a result, which `Ensemble.samples` tells.
    """
    text, name, folder = scene_of(scene, None)
    mode = "resume" if resume else "force" if force else "fresh"
    made = _Ensemble(text, folder / name, output, seed, samples, mode)
    left = [number for number in range(samples) if not made.finished(number)]
    running: dict[int, subprocess.Popen] = {}

    def start(number: int) -> None:
        how = "resume" if made.prepare(number) else "fresh"
        here = Path(made.folder(number))
        command = [sys.executable, "-c", _sample, str(here / "scene.toml"), str(here), how]
        paths = os.pathsep.join([str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
        with open(here / "log.txt", "ab") as log:
            running[number] = subprocess.Popen(
                command, stdout=log, stderr=log, env={**os.environ, "PYTHONPATH": paths}, start_new_session=True
            )

    try:
        while left or running:
            while left and len(running) < (jobs or available_cores()):
                start(left.pop(0))
            time.sleep(0.02)
            for number in [number for number, process in running.items() if process.poll() is not None]:
                status = running.pop(number).returncode
                if not made.finished(number):
                    made.note(number, status in (130, -signal.SIGINT), f"ended with status {status}: see log.txt")
                if progress is not None:
                    progress(samples - len(left) - len(running), samples)
    finally:
        for process in running.values():
            process.send_signal(signal.SIGINT)
        for process in running.values():
            process.wait()
        made.merge()
        del made
    return Ensemble(output)
