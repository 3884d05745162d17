"""Series of soft grains against the exact trajectory."""

from __future__ import annotations

import json
import os
from typing import Any, Mapping, Sequence

import numpy as np

from ._core import State, _compare

_objects = np.dtype(object)


def _array(rows: Sequence[Mapping[str, Any]]) -> np.ndarray:
    """A structured array; a number that was not found is nan."""
    if not rows:
        return np.empty(0)
    kinds = []
    for name in rows[0]:
        values = [row[name] for row in rows]
        text = any(isinstance(value, str) for value in values)
        whole = all(isinstance(value, int) for value in values)
        kinds.append((name, _objects if text else np.dtype(int if whole else float)))
    missing = [None if kind is _objects else np.nan for _, kind in kinds]
    plain = [tuple(m if v is None else v for v, m in zip(row.values(), missing)) for row in rows]
    return np.array(plain, dtype=kinds)


class Comparison:
    """What `compare` says of a series.

    Attributes
    ----------
    frames, path : structured arrays
        Columns of comparison.csv and of path.csv (src/io/README.md): frames; equilibria of the exact run.
    nodes, members : structured arrays
        The bundle of exact runs.
    departure : dict or None
        The first frame that leaves the exact run: ``from``, ``to``, ``reason``, ``words``, ``opened``, ``closed``.
    dimension : int
        3: spheres, whose loaded stress is sigma3.
    status : int
        0: every frame at rest is the exact equilibrium of its load; 1: one departs; 2: one is undecided, or none is at rest.
    """

    def __init__(self, content: Mapping[str, Any]) -> None:
        self.frames = _array(content["frames"])
        self.path = _array(content["path"])
        self.nodes = _array(content["bundle"]["nodes"])
        self.members = _array(content["bundle"]["members"])
        self.departure = content["departure"]
        self.dimension = content.get("dimension", 2)
        self.status = content["status"]
        self.counts = content["counts"]

    def __repr__(self) -> str:
        counts = ", ".join(f"{count} {what}" for what, count in self.counts.items() if count)
        return f"<isostat.Comparison: {len(self.frames)} frames: {counts}>"

    def plot(self, ax=None):
        """The staircase of the exact run with the frames at their loads. Returns matplotlib axes."""
        from .plot import comparison

        return comparison(self, ax)


def compare(
    series: str | os.PathLike[str],
    *,
    reference: State | None = None,
    bundle: int = 16,
    local: bool = False,
    nearest_arc: bool = False,
    output: str | os.PathLike[str] | None = None,
) -> Comparison:
    """Frames of another program against the exact trajectory, as ``isostat compare``.

    Parameters
    ----------
    series : path of the manifest (src/io/README.md)
    reference : State, optional
        Start of the exact run; default: the vertex of the first frame that has one.
    bundle : int
        Exact runs from the start; 0: none.
    local : bool
        Besides, the exact run from every frame to the next one.
    nearest_arc : bool
        Besides, the arc of the exact run that each frame in motion is on.
    output : path, optional
        Folder for tables and figure.

    Raises BadInput with file and row; Ctrl-C ends it after what is going on.
    """
    return Comparison(json.loads(_compare(series, reference, bundle, local, nearest_arc, output)))
