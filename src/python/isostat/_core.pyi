"""Types of the compiled part; `Final` is an attribute that is only read.

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
Walls = dict[str, tuple[str, str]]

version: str
_integer_columns: frozenset[str]

class Packing:
    def __init__(
        self,
        positions: Floats,
        radii: Sequence[float],
        length: Sequence[float],
        *,
        lower: Optional[Sequence[str]] = ...,
        upper: Optional[Sequence[str]] = ...,
        fixed: Sequence[bool] = ...,
    ) -> None: ...
    def __len__(self) -> int: ...
    positions: Final[Floats]
    length: Final[Floats]
    radii: Final[Floats]
    fixed: Final[Flags]
    bars: Final[list[tuple[int, int, float]]]
    arcs: Final[list[tuple[int, ...]]]
    walls: Final[Walls]
    periodic: Final[tuple[bool, bool]]
    tilt: Final[Optional[float]]
    solid_fraction: Final[float]
    dof_names: Final[list[str]]

class State:
    @staticmethod
    def read(path: Path) -> State: ...
    @staticmethod
    def parse(text: str, source: str = ...) -> State: ...
    @staticmethod
    def from_arrays(
        positions: Floats,
        radii: Floats,
        length: Sequence[float],
        contacts: Iterable[Sequence[object]],
        *,
        lower: Optional[Sequence[str]] = ...,
        upper: Optional[Sequence[str]] = ...,
        stress: Optional[Sequence[float]] = ...,
        reference_length: Optional[Sequence[float]] = ...,
        load: str = ...,
        infinitesimal: Optional[Floats] = ...,
        disk_force: Optional[Floats] = ...,
        fixed: Iterable[int] = ...,
        bars: Iterable[tuple[int, int, float]] = ...,
        arcs: Iterable[Iterable[int]] = ...,
    ) -> State: ...
    def text(self) -> str: ...
    def write(self, path: Path) -> None: ...
    def with_stress(self, stress: Sequence[float], shear: Optional[float] = ...) -> State: ...
    def with_loaded_stress(self, stress: float) -> State: ...
    def __len__(self) -> int: ...
    positions: Final[Floats]
    radii: Final[Floats]
    length: Final[Floats]
    fixed: Final[Flags]
    bars: Final[list[tuple[int, int, float]]]
    arcs: Final[list[tuple[int, ...]]]
    walls: Final[Walls]
    periodic: Final[tuple[bool, bool]]
    contacts: Final[Integers]
    images: Final[Integers]
    tilt: Final[Optional[float]]
    contact_names: Final[list[str]]
    dof_names: Final[list[str]]
    forces: Final[Floats]
    stress: Final[list[float]]
    reference_length: Final[list[float]]
    loaded_axis: Final[int]
    load: Final[str]
    infinitesimal: Final[Floats]
    disk_force: Final[Floats]
    external_force: Final[Floats]
    solid_fraction: Final[float]
    equilibrium: Final[int]
    provenance: Final[str]
    packing: Final[Packing]
    rattlers: Final[list[int]]
    def _matrix(self) -> tuple[tuple[Floats, Integers, Integers], Pair]: ...
    def _curvature(self) -> tuple[Integers, Integers, Integers, Floats]: ...
    def _contact_table(self) -> str: ...

class Counting:
    dofs: Final[int]
    contacts: Final[int]
    rank: Final[int]
    h: Final[int]
    k: Final[int]
    rank_exact: Final[Verdict]

class Certificate:
    verdict: Final[Verdict]
    refuted: Final[list[str]]
    undecided: Final[list[str]]
    state: Final[State]
    counting: Final[Optional[dict[str, int]]]
    vertex: Final[Optional[tuple[float, float]]]
    forces: Final[Optional[Floats]]
    structural_zeros: Final[Optional[list[int]]]
    infinitesimal_forces: Final[Optional[Floats]]
    smallest_gap: Final[Optional[tuple[float, Optional[Pair]]]]
    low: Final[Optional[tuple[tuple[float, float], Pair]]]
    high: Final[Optional[tuple[tuple[float, float], Pair]]]
    minimum: Final[Optional[tuple[float, float]]]
    stable: Final[bool]
    def text(self) -> str: ...
    def write(self, path: Path) -> None: ...

class Inspection:
    counting: Final[Counting]
    contacts: Final[Integers]
    forces: Final[Floats]
    force_intervals: Final[Floats]
    structural_zero: Final[Flags]
    rattlers: Final[Integers]
    rotational_rattlers: Final[Integers]
    verdict: Final[Verdict]
    stable: Final[Verdict]
    second_order: Final[tuple[float, float]]
    length_rates: Final[list[tuple[float, float]]]
    second_variation: Final[list[tuple[float, float]]]
    remark: Final[str]
    sigma2: Final[float]
    sigma2_low: Final[float]
    sigma2_high: Final[float]
    opens_low: Final[Optional[Pair]]
    opens_high: Final[Optional[Pair]]
    force_bound: Final[float]
    min_gap: Final[float]
    sigma_min_bound: Final[float]
    strain: Final[list[float]]
    potential: Final[float]
    decided_by: Final[str]

class Arc:
    step: Final[int]
    equilibrium: Final[int]
    arc: Final[int]
    kind: Final[str]
    opened: Final[Pair]
    closed: Final[Pair]
    opened_image: Final[Pair]
    closed_image: Final[Pair]
    power_turn: Final[bool]
    sigma2: Final[float]
    eps2: Final[float]
    force: Final[float]
    power: Final[float]
    work: Final[float]
    displacement: Final[float]
    margin: Final[float]
    decided_by: Final[str]

class Equilibrium:
    state: Final[State]
    number: Final[int]
    segment: Final[int]
    sigma1: Final[float]
    sigma2: Final[float]
    sigma2_low: Final[float]
    sigma2_high: Final[float]
    opens_low: Final[Optional[Pair]]
    opens_high: Final[Optional[Pair]]
    strain: Final[list[float]]
    length: Final[list[float]]
    potential: Final[float]
    arcs: Final[int]
    rank: Final[int]
    h: Final[int]
    k: Final[int]
    rattlers: Final[int]
    min_force: Final[float]
    min_gap: Final[float]
    margin: Final[float]
    verdict: Final[Verdict]

class _Run:
    def __init__(
        self, text: str, name: str, folder: Path, output: Path, start: Optional[State]
    ) -> None: ...
    def play(
        self,
        mode: str,
        on_arc: Optional[Callable[[Arc], object]],
        on_equilibrium: Optional[Callable[[Equilibrium], object]],
    ) -> None: ...
    def stop(self) -> None: ...
    status: Final[str]
    reason: Final[str]

class ClaimCheck:
    claim: Final[str]
    claimed: Final[bool]
    verdict: Final[Verdict]
    detail: Final[str]
    numbers: Final[dict[str, float]]

class Verification:
    verdict: Final[Verdict]
    checks: Final[list[ClaimCheck]]

class RunVerification:
    verdict: Final[Verdict]
    words: Final[str]
    finished: Final[bool]
    wrong: Final[str]
    undecided: Final[list[str]]
    arcs: Final[int]
    arcs_proved: Final[int]
    ways_proved: Final[int]
    equilibria: Final[int]
    equilibria_proved: Final[int]

class Number:
    def __init__(self, value: Rational) -> None: ...
    def __add__(self, other: Rational) -> Exact: ...
    def __radd__(self, other: Rational) -> Exact: ...
    def __sub__(self, other: Rational) -> Exact: ...
    def __rsub__(self, other: Rational) -> Exact: ...
    def __mul__(self, other: Rational) -> Exact: ...
    def __rmul__(self, other: Rational) -> Exact: ...
    def __truediv__(self, other: Rational) -> Exact: ...
    def __rtruediv__(self, other: Rational) -> Exact: ...
    def __neg__(self) -> Exact: ...
    def __abs__(self) -> Exact: ...
    def __lt__(self, other: Rational) -> bool: ...
    def __le__(self, other: Rational) -> bool: ...
    def __gt__(self, other: Rational) -> bool: ...
    def __ge__(self, other: Rational) -> bool: ...
    def __bool__(self) -> bool: ...
    def __float__(self) -> float: ...
    def enclosure(self) -> tuple[float, float]: ...

class ExactPacking:
    @staticmethod
    def read(path: Path) -> ExactPacking: ...
    @staticmethod
    def parse(text: str, source: str = ...) -> ExactPacking: ...
    @staticmethod
    def of_state(state: State) -> ExactPacking: ...
    def __len__(self) -> int: ...
    title: Final[str]
    centres: Final[list[tuple[Exact, Exact]]]
    radii: Final[list[Exact]]
    length: Final[tuple[Exact, Exact]]
    packing: Final[Packing]
    contacts: Final[Integers]
    def exact_columns(self) -> list[dict[int, Exact]]: ...
    def inspect(self) -> ExactInspection: ...

class ExactInspection:
    dofs: Final[int]
    strains: Final[dict[str, Counting]]
    jammed: Final[dict[str, Verdict]]
    contacts: Final[Integers]
    rank: Final[int]
    rank_exact: Final[Verdict]
    h: Final[int]
    k: Final[int]
    rigid_motions: Final[int]
    generic_rank: Final[int]
    special_position: Final[Verdict]
    verdict: Final[str]
    bases_exact: Final[Verdict]
    self_stresses: Final[list[list[Exact]]]
    mechanisms: Final[list[list[Exact]]]
    one_sign: Final[str]
    hold: Final[list[str]]
    support: Final[str]
    forces: Final[list[Exact]]
    forces_unique: Final[bool]
    without_force: Final[list[int]]
    second_order: Final[str]
    stable: Final[Verdict]
    def enclosed_bases(
        self, count: int = ...
    ) -> tuple[Verdict, list[tuple[Floats, float]], list[tuple[Floats, float]]]: ...

class JammedIfClosed:
    verdict: Final[Verdict]
    contacts: Final[int]
    within: Final[float]

class Jamming:
    verdicts: Final[dict[str, Verdict]]
    reasons: Final[dict[str, str]]
    if_closed: Final[dict[str, JammedIfClosed]]
    counts: Final[dict[str, Counting]]
    backbone: Final[dict[str, Counting]]
    grains: Final[int]

class Genericity:
    samples: Final[list[dict[str, object]]]
    proved: Final[int]
    ties: Final[int]
    undecided: Final[int]
    failed: Final[int]
    within: Final[int]
    networks: Final[int]

class _Ensemble:
    def __init__(self, text: str, scene: Path, output: Path, seed: int, samples: int, mode: str) -> None: ...
    def folder(self, number: int) -> os.PathLike[str]: ...
    def prepare(self, number: int) -> bool: ...
    def finished(self, number: int) -> bool: ...
    def note(self, number: int, stopped: bool, reason: str) -> None: ...
    def merge(self) -> list[tuple[int, str, str]]: ...

class PlateauCounts:
    dofs: Final[int]
    contacts: Final[int]
    rank: Final[int]
    h: Final[int]
    k: Final[int]
    isostatic: Final[Verdict]

class PlateauStep:
    threshold: Final[float]
    rattlers: Final[int]
    backbone: Final[PlateauCounts]
    all: Final[PlateauCounts]

class PlateauRange:
    first: Final[float]
    last: Final[float]
    open: Final[bool]
    contacts: Final[int]
    rattlers: Final[int]
    told: Final[bool]

class Plateau:
    steps: Final[list[PlateauStep]]
    ranges: Final[list[PlateauRange]]
    rounding: Final[float]
    widest: Final[PlateauRange | None]
    special: Final[list[PlateauRange]]
    no_self_stress_below: Final[float]
    deepest_overlap: Final[float]
    changes: Final[int]

@overload
def count(state: State) -> Counting: ...
@overload
def count(packing: Packing, contacts: Sequence[Pair]) -> Counting: ...
@overload
def certify(file: Path) -> Certificate: ...
@overload
def certify(state: State) -> Certificate: ...
def inspect(state: State) -> Inspection: ...
def jamming(state: State) -> Jamming: ...
def genericity(
    packing: Union[State, ExactPacking],
    *,
    size: float = ...,
    samples: int = ...,
    seed: int = ...,
    stress: float = ...,
    keep_equal: bool = ...,
    tilt: bool = ...,
) -> Genericity: ...
def _walked_to(folder: Path, number: int) -> State: ...
def _members(folder: Path) -> list[tuple[int, os.PathLike[str]]]: ...
def forces_at(state: State, sigma2: float) -> Floats: ...
def _verify_certificate(certificate: Certificate) -> Verification: ...
def _verify_file(path: Path) -> Verification: ...
def _verify_folder(
    path: Path, progress: Optional[Callable[[int, int], None]]
) -> RunVerification: ...
def sqrt(rational: Rational) -> Exact: ...
def prepare(
    disks: int,
    *,
    dimension: int = ...,
    seed: int = ...,
    diameters: tuple[float, float] = ...,
    jitter: float = ...,
    radii: Optional[Sequence[float]] = ...,
) -> State: ...
def find_vertex(packing: Packing, *, stress: Optional[Sequence[float]] = ..., seed: int = ...) -> State: ...
def read_packing(
    path: Path,
    *,
    walls: str = ...,
    box: Optional[Sequence[float]] = ...,
    radius: str = ...,
    diameter: str = ...,
    dimension: Optional[int] = ...,
    bodies: str = ...,
) -> Packing: ...
class Snap:
    outcome: Final[str]
    reason: Final[str]
    h: Final[int]
    k: Final[int]
    rattlers: Final[list[int]]
    distance: Final[float]
    walls: Final[float]
    rest: Final[float]
    stiffness: Final[float]
    state: Final[Optional[State]]

def snap(state: State, *, stiffness: float = ..., law: str = ...) -> Snap: ...
def _compare(
    series: Path, reference: Optional[State], bundle: int, local: bool, nearest_arc: bool, output: Optional[Path]
) -> str: ...
def plateau(packing: Packing, first: float, last: float, rows: int = ...) -> Plateau: ...
def backbone_at(packing: Packing, threshold: float) -> Integers: ...
def set_threads(count: int) -> None: ...
def available_cores() -> int: ...
