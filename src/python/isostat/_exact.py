"""Exact numbers between Python and the library, and packings made of them."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Iterable, Sequence

from ._core import ExactPacking, Number

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
    return "[" + ", ".join(_quoted(value) for value in values) + "]"


def _words(values: Sequence[str]) -> str:
    return "[" + ", ".join(f'"{value}"' for value in values) + "]"


def exact_packing(
    disks: Iterable[Sequence[object]],
    *,
    length: Sequence[object] | None = None,
    lower: Sequence[str] = ("fixed", "fixed"),
    upper: Sequence[str] = ("movable", "movable"),
    fixed: Iterable[int] = (),
    wall_force: Sequence[object] | None = None,
    disk_force: Iterable[Sequence[object]] = (),
) -> ExactPacking:
    """A packing in exact numbers.

    Parameters
    ----------
    disks : rows (x, y, radius)
        Numbers: ``int``, ``fractions.Fraction``, ``isostat.Number``, text such as ``"1/2*sqrt(3)"``,
        or ``float``, which is the dyadic number that it stores. Unit: yours.
    length : (Lx, Ly), optional
        Positions of the right and the top wall; without it there are no walls.
    lower, upper : pairs of "fixed", "absent", and for `upper` "movable"
        Left and bottom wall; right and top wall.
    fixed : numbers of disks
        Disks that cannot move.
    wall_force : (Fx, Fy), optional
        Inward forces on the right and the top wall.
    disk_force : rows (disk, Fx, Fy)
        External forces on disks.

    Returns
    -------
    ExactPacking

    Raises
    ------
    BadInput
        A value that makes no sense, named.
    """
    held = set(fixed)
    lines = ['format = "isostat-packing 1"']
    for number, (x, y, radius) in enumerate(disks):
        lines += ["[[disk]]", f"x = {_quoted(x)}", f"y = {_quoted(y)}", f"r = {_quoted(radius)}"]
        if number in held:
            lines.append("fixed = true")
    if length is not None:
        lines += ["[box]", f"length = {_row(length)}"]
        lines += [f"lower = {_words(lower)}", f"upper = {_words(upper)}"]
    forces = [f"[{disk}, {_quoted(fx)}, {_quoted(fy)}]" for disk, fx, fy in disk_force]
    if wall_force is not None or forces:
        lines.append("[load]")
        if wall_force is not None:
            lines.append(f"wall = {_row(wall_force)}")
        if forces:
            lines.append(f"disk = [{', '.join(forces)}]")
    return ExactPacking.parse("\n".join(lines) + "\n", "exact_packing")
