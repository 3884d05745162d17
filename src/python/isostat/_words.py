"""Verdicts and exceptions."""

from __future__ import annotations

import enum
import re


class Verdict(enum.Enum):
    """Answer of a check. It does not convert to bool: compare with the member that is meant.

    ``PROVED``: the statement holds. ``REFUTED``: its negation holds. ``UNDECIDED``: neither was
    shown with the arithmetic that was allowed; it says nothing about which one is true.
    """

    PROVED = "proved"
    REFUTED = "refuted"
    UNDECIDED = "undecided"

    def __bool__(self) -> bool:
        raise TypeError("a Verdict has three values: compare it, as in `x is Verdict.PROVED`")

    def __str__(self) -> str:
        return self.value


class Error(Exception):
    """Everything that this package raises of its own.

    Attributes
    ----------
    id : str
        The library's word for the reason, that of the class: ``"bad_input"``, ``"tie"``, ...
    """

    id = "error"

    def __init_subclass__(cls) -> None:
        if cls.__module__ == __name__: # a user's class keeps the id of its base
            word = re.sub("(?<=[a-z])(?=[A-Z])", "_", cls.__name__.removesuffix("Error")).lower()
            cls.id = vars(cls).get("id", word)


class UsageError(Error):
    """Something was asked for that cannot be: a folder holds a run already."""


class BadInput(Error, ValueError):
    """Bad input; the message names file, line or field, the value, and what was expected."""


class NotStored(BadInput, KeyError):
    """The state of an equilibrium is not in the folder of its run."""

    id = BadInput.id
    __str__ = BadInput.__str__


class InternalError(Error, RuntimeError):
    """A defect of the program or of this computer. Says nothing of the input."""


class CannotWrite(Error, OSError):
    """A file cannot be written."""


class Failure(Error):
    """An outcome of the mechanics or of the arithmetic, with the numbers that were measured."""


class NotIsostatic(Failure):
    """N != N_f, or the rank is smaller."""


class Overlap(Failure):
    """Two grains overlap."""


class Tie(Failure):
    """Two candidates could not be ordered: several contacts at once."""


class Undecided(Failure):
    """A sign could not be decided with the arithmetic that was allowed."""


class NoLimit(Failure):
    """The load can grow for ever: nothing opens."""


class Flows(Failure):
    """A dead shear force moves the tilt of a cell without end."""


class Unbounded(Failure):
    """A motion finds no new contact, or a linear programme is unbounded."""


class NotConverged(Failure):
    """An iteration stopped short."""


class CapReached(Failure):
    """A cap on arcs or strain: the sample fails at this load."""


class Contradiction(Failure):
    """What was proved in one way is refuted in another: a defect of the program."""


class Interrupted(Failure):
    """Stopped on request."""


_errors = {64: UsageError, 65: BadInput, 70: InternalError, 74: CannotWrite}
_failures = {kind.id: kind for kind in Failure.__subclasses__()}


def error_of(exit_status: int) -> type[Error]:
    """The exception of an exit status of the program."""
    return _errors[exit_status]


def failure_of(word: str) -> type[Failure]:
    """The exception of the library's word for a failure."""
    return _failures[word.replace("-", "_").replace(" ", "_")]
