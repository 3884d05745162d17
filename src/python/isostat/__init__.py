"""Quasi-static mechanics of rigid frictionless disks and spheres, with proofs.

Arrays are numpy arrays; those of `State` and `Packing` look into the library's memory and are read-only.
Contacts are pairs of integers (i, j): two disks, or a disk and a wall (-1 left, -2 bottom, -3 right,
-4 top), or a held coordinate i (-9). Lengths and stresses are in your units, forces in stress x length;
stress, force and strain are positive in compression.
"""

from __future__ import annotations

import importlib
import os

from . import _core, _repr
from ._core import (
    Arc,
    Certificate,
    ClaimCheck,
    Counting,
    Equilibrium,
    ExactInspection,
    ExactPacking,
    Genericity,
    Inspection,
    JammedIfClosed,
    Jamming,
    Number,
    Packing,
    Plateau,
    RunVerification,
    Snap,
    State,
    Verification,
    available_cores,
    backbone_at,
    certify,
    count,
    find_vertex,
    forces_at,
    genericity,
    inspect,
    jamming,
    plateau,
    prepare,
    read_packing,
    set_threads,
    snap,
    sqrt,
)
from ._compare import Comparison, compare
from ._ensemble import Ensemble, ensemble
from ._exact import exact_packing
from ._records import Records, States, load
from ._run import Run
from ._state import (
    contact_matrix,
    contact_pair,
    contact_table,
    disk_velocities,
    from_arrays,
    mechanism,
    modes,
    stiffness_matrix,
    unjamming_motion,
)
from ._words import (
    BadInput,
    CannotWrite,
    CapReached,
    Contradiction,
    Error,
    Failure,
    Flows,
    InternalError,
    Interrupted,
    NoLimit,
    NotConverged,
    NotIsostatic,
    NotStored,
    Overlap,
    Tie,
    Unbounded,
    Undecided,
    UsageError,
    Verdict,
)

__version__ = _core.version

State.from_arrays = staticmethod(from_arrays)  # type: ignore[method-assign,assignment]


def __getattr__(name: str):
    """`isostat.plot`, which needs matplotlib, is imported when it is first asked for."""
    if name == "plot":
        return importlib.import_module("isostat.plot")
    raise AttributeError(f"module 'isostat' has no attribute {name!r}")


def verify(what, progress=None):
    """Proves again, with separate code, what a certificate or the records of a run say.

    Parameters
    ----------
    what : Certificate, or path of a certificate file or of the folder of a run
    progress : callable (done, total), optional
        For the folder of a run: called after each arc and each equilibrium. What it raises ends the
        verification. Ctrl-C does too; the verification of one certificate is not interrupted.

    Returns
    -------
    Verification or RunVerification
        Their `verdict` is a `Verdict`.
    """
    if isinstance(what, Certificate):
        return _core._verify_certificate(what)
    if os.path.isdir(what):
        return _core._verify_folder(what, progress)
    return _core._verify_file(what)
