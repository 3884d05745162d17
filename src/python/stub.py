"""Writes the stub of the compiled module beside it, from the signatures that the bindings give it:  stub.py FOLDER"""

import re
import sys
from inspect import signature
from pathlib import Path
from types import FunctionType

HEAD = '''"""Types of the compiled part; `Final` is an attribute that is only read.

Meanings, shapes and units: the docstrings (``help(isostat.State)``).
"""

import os
from fractions import Fraction
from typing import Callable, Final, Iterable, Optional, Sequence, Union, overload

import numpy as np
from numpy.typing import NDArray

from ._words import Verdict

Path = Union[str, os.PathLike[str]]
Pair = tuple[int, int]
Floats = NDArray[np.float64]
Integers = NDArray[np.int32]
Flags = NDArray[np.uint8]
Exact = Union[Fraction, "Number"]
Rational = Union[int, float, str, Fraction, "Number"]
'''
ARRAYS = {"float64": "Floats", "int32": "Integers", "uint8": "Flags"}
# What the typing of Python has for every class, or what only copies and printing use.
UNTYPED = {"__module__", "__doc__", "__eq__", "__hash__", "__str__", "__repr__", "__reduce__", "__getstate__", "__setstate__"}


def typed(name, argument=False):
    """The type that pybind11 names, as Python writes it; arguments may be any sequence, and names of files text."""
    name = re.sub(r"\bisostat\.(_core\.)?", "", name)
    name = re.sub(r"numpy\.ndarray\[numpy\.(\w+)\]", lambda array: ARRAYS[array[1]], name)
    name = re.sub(r"os\.PathLike\b(?!\[)", "Path" if argument else "os.PathLike[str]", name)
    name = re.sub(r"\bList\b", "Sequence" if argument else "list", name)
    return name.replace("Tuple[", "tuple[").replace("Dict[", "dict[")


def split(arguments):
    """The arguments between commas that no bracket encloses."""
    depth, part = 0, ""
    for letter in arguments:
        depth += (letter in "[(") - (letter in "])")
        if letter == "," and depth == 0:
            yield part.strip()
            part = ""
        else:
            part += letter
    if part:
        yield part.strip()


def argument(text):
    """NAME: TYPE = DEFAULT; an object itself has no type."""
    name, _, rest = text.partition(": ")
    given, default, _ = rest.partition(" = ")
    return name if name == "self" or not rest else f"{name}: {typed(given, True)}" + (" = ..." if default else "")


def functions(name, made, method=False):
    """The lines of a function, one for each signature, of which there are several where it is overloaded."""
    found = re.findall(rf"^(?:\d+\. )?{name}\((.*)\) -> (.+)$", made.__doc__, re.MULTILINE)
    for arguments, result in found:
        parts = [argument(part) for part in split(arguments)]
        parts[:method] = ["self"] * method
        yield from ["@overload"] * (len(found) > 1)
        yield f"def {name}({', '.join(parts)}) -> {typed(result)}: ..."


def attributes(kind):
    for name, made in vars(kind).items():
        if isinstance(made, property):
            yield f"{name}: Final[{typed(made.fget.__doc__.split(' -> ')[1].strip())}]"
        elif isinstance(made, staticmethod):
            yield "@staticmethod"
            python = isinstance(made.__func__, FunctionType)  # what the package adds
            yield from [f"def {name}{signature(made.__func__)}: ..."] if python else functions(name, made.__func__)
        elif name not in UNTYPED and not isinstance(made, FunctionType):
            yield from functions(name, made, True)


def stub(core):
    yield HEAD
    for name, made in vars(core).items():
        if isinstance(made, type):
            yield from [f"class {name}:", *("    " + line for line in attributes(made)), ""]
        elif callable(made):
            yield from functions(name, made)
    yield from ["version: str", "_integer_columns: frozenset[str]", "_walls: dict[int, str]"]


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    sys.path.insert(0, str(folder.parent))
    (folder / "_core.pyi").unlink(missing_ok=True)  # a build of before has a link to a source there
    try:
        from isostat import _core
    except ModuleNotFoundError as missing:
        if missing.name != "numpy":  # needed where the module is used, not where it is built
            raise
        print(f"The module has no types beside it: {missing}")
        sys.exit()
    (folder / "_core.pyi").write_text("\n".join(stub(_core)) + "\n")
