#!/usr/bin/env python3
"""Jammed packings of clumps (unions of disks), in a box or a periodic cell, and of ovals (four arcs) in a box under equal stresses, as state files of Isostat, in double precision.

    prepare.py trimer --seed 3 -o trimer.json           a packing of 20 trimers
    prepare.py dimer --cell -o cell.json                a packing of dimers in a cell, both periods and the tilt of which move
    prepare.py oval --aspect 1.4 -n 16 -o oval.json     a packing of 16 ovals
    prepare.py trimer --seed 3 --saddle -o saddle.json  an equilibrium of trimers that is a saddle of the potential
    prepare.py dimer --seed 7 --held 0.75 -o held.json  what rests under this force on the top wall while rotational rattlers cannot turn
    prepare.py --from FILE -o state.json                a packing in a file of format "bodies-1"
    prepare.py --table 10                               what ten packings of each kind count; no files

The penalty energy L_x + L_y + (stiffness / 2) sum overlap^2 is minimised for growing stiffness; the overlaps that are left say which
contacts bear force, and Newton's method closes these. Nothing is proved here: that is what `isostat inspect` is for."""
import argparse
import dataclasses
import itertools
import json
import math
import os
import sys
import time
from decimal import Context, Decimal
from typing import Any, Iterator

import numpy as np
from scipy.sparse import csc_matrix, identity
from scipy.sparse.linalg import splu

from clumps import LEAST_FORCE, LEAST_GAP, WALLS, Clumps, Counts, Failed, Matrix, Packing, Vector, closed, counted, equilibrium

KINDS = {"dimer": 2, "dimer2": 2, "trimer": 3, "oval": 4, "mixed": 0}
RING = [0, 1, 2, 3]  # right cap, upper flank, left cap, lower flank
GRID = 2.0**-44  # radii are multiples of this: their differences are not rounded
STIFFNESSES = [10.0**e for e in range(1, 6)]
ATTEMPTS = 30  # packings tried for one seed
SADDLE = -1e-6  # a second variation below this value is negative beyond doubt


def rings(count: int) -> list[list[int]]:
    return [[4 * b + k for k in RING] for b in range(count)]


def oval(cap: float, flank: float, half: float) -> tuple[list[list[float]], list[float]]:
    """Caps at (+-half, 0), and flanks whose circles they touch from within."""
    cap, flank = round(cap / GRID) * GRID, round(flank / GRID) * GRID
    off = math.sqrt((flank - cap) ** 2 - half**2)
    return [[half, 0], [0, -off], [-half, 0], [0, off]], [cap, flank, cap, flank]


def ovals(count: int, aspect: float, rng: np.random.Generator) -> Clumps:
    """Half widths from 1 to 1.5; the caps are a tenth sharper than those of an ellipse."""
    place, radius = [], []
    for _ in range(count):
        width = rng.uniform(1, 1.5)
        cap = 0.9 * width / aspect
        half = aspect * width - cap
        four, radii = oval(cap, (half**2 + width**2 - cap**2) / (2 * (width - cap)), half)
        place += four
        radius += radii
    return Clumps(np.repeat(np.arange(count), 4), np.array(place), np.array(radius), rings(count))


def bodies(kind: str, count: int, aspect: float, rng: np.random.Generator) -> Clumps:
    """Members that overlap or just touch; sizes, distances and, for "dimer2", ratios of radii vary from body to body."""
    if kind == "oval":
        return ovals(count, aspect, rng)
    if kind == "mixed":
        round_ones, others = ovals(count - count // 2, aspect, rng), bodies("dimer2", count // 2, aspect, rng)
        body = np.concatenate([round_ones.body, round_ones.count + others.body])
        return Clumps(body, np.concatenate([round_ones.place, others.place]), np.concatenate([round_ones.radius, others.radius]), round_ones.rings)
    place: list[list[float]] = []
    radius: list[float] = []
    for _ in range(count):
        large, spread = rng.uniform(1, 1.5), rng.uniform(0.5, 1)
        small = large * (rng.uniform(0.5, 0.9) if kind == "dimer2" else 1)
        half = spread * (large + small) / 2
        if kind == "trimer":
            place += [[-half, -half / math.sqrt(3)], [half, -half / math.sqrt(3)], [0, 2 * half / math.sqrt(3)]]
            radius += [large, large, large]
        else:
            place += [[-half, 0], [half, 0]]
            radius += [large, small]
    return Clumps(np.repeat(np.arange(count), KINDS[kind]), np.array(place), np.array(radius))


def scattered(clumps: Clumps, rng: np.random.Generator) -> Vector:
    """Places on a wide grid in random order, turned at random."""
    cell = 2 * (np.hypot(*clumps.place.T) + clumps.radius).max()
    wide = math.ceil(math.sqrt(clumps.count))
    slot = rng.permutation(wide * wide)[: clumps.count]
    q = np.zeros(len(clumps.load))
    clumps.origins(q)[:] = (np.column_stack([slot % wide, slot // wide]) + 0.5) * cell
    q[2 : 3 * clumps.count : 3] = rng.uniform(0, 2 * np.pi, clumps.count)
    clumps.lengths(q)[:] = wide * cell
    return q


def descent(form: csc_matrix, gradient: Vector) -> Vector | None:
    """- form^-1 gradient; nothing unless the form is positive definite: its pivots on the diagonal are positive."""
    try:
        factors = splu(form, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True})
    except RuntimeError:  # singular
        return None
    regular = (factors.perm_r == factors.perm_c).all() and (factors.U.diagonal() > 0).all()
    return -factors.solve(gradient) if regular else None


def softly(clumps: Clumps, q: Vector, stiffness: float, held: list[int] | None = None) -> Vector:
    """A minimum of the penalty energy, by Newton's method with a damping that keeps the form positive definite. Coordinates `held` stay."""
    damping, move = 1.0, np.setdiff1d(np.arange(len(q)), held or [])
    listed, pairs = q, clumps.near(q, 1)

    def energy(at: Vector) -> tuple[float, Vector]:
        nonlocal listed, pairs
        shift = at - listed
        far = max(np.hypot(*clumps.origins(shift).T).max(), abs(shift[3 * clumps.count :]).max())
        if far > (0.2 if clumps.cell else 0.5):  # pairs that are not listed may touch
            listed, pairs = at, clumps.near(at, 1)
        gap = clumps.distances(at, pairs)
        return float(clumps.load @ at + stiffness / 2 * (np.minimum(gap, 0) ** 2).sum()), gap

    value, gap = energy(q)
    for _ in range(max(2000, 100 * clumps.count)):
        touching = pairs[gap < 0]
        force = -stiffness * gap[gap < 0]
        rows = clumps.rows(q, touching, clumps.gaps(q, touching)[1])
        gradient = (clumps.load - rows.T @ force)[move]
        if abs(gradient).max() < 1e-8:
            return q
        form = (stiffness * rows.T @ rows - clumps.second(q, touching, force)).tocsc()[move][:, move]
        while damping < 1e12:
            found = descent(form + damping * identity(len(move), format="csc"), gradient)
            if found is not None and abs(found).max() < 0.5:
                step = np.zeros(len(q))
                step[move] = found
                after, gap = energy(q + step)
                if after <= value + 1e-14 * abs(value):
                    break
            damping *= 4
        else:
            break
        q, value, damping = q + step, after, max(damping / 5, 1e-10)
    raise Failed("the penalty energy has no minimum that was found")


def borne(clumps: Clumps, q: Vector, held: list[int] | None = None) -> tuple[Packing, Counts]:
    """The equilibrium next to a minimum of the penalty energy, but for what is `held`."""
    pairs = clumps.near(q, 1)
    force = -STIFFNESSES[-1] * clumps.distances(q, pairs)
    bears = force > LEAST_FORCE
    return equilibrium(clumps, q, pairs[bears], force[bears], held)


def jammed(kind: str, count: int, rng: np.random.Generator, aspect: float, cell: bool) -> tuple[Packing, Counts]:
    """The equilibrium next to a minimum of the penalty energy."""
    clumps = dataclasses.replace(bodies(kind, count, aspect, rng), cell=cell)
    q = scattered(clumps, rng)
    for stiffness in STIFFNESSES:
        q = softly(clumps, q, stiffness)
    return borne(clumps, q)


def saddles(packing: Packing) -> Iterator[tuple[Packing, Counts]]:
    """Equilibria next to this one with one contact less. While that contact opens and all others stay closed, W rises until its force
    would be 0: there W has a maximum along this motion."""
    for drop in np.argsort(packing.force):
        keep = np.arange(len(packing.contacts)) != drop
        try:
            found, counts = equilibrium(packing.clumps, packing.q, packing.contacts[keep], packing.force[keep])
        except Failed:
            continue
        if counts.variation.min(initial=0) < SADDLE:
            yield found, counts


def held_angles(packing: Packing, ratio: float) -> tuple[Packing, Counts]:
    """What rests under the force `ratio` on the top wall while the rotational rattlers keep their angles: where one of these bodies touches
    something with another member it bears a torque, and the place is no equilibrium."""
    clumps, q = packing.clumps, packing.q
    clumps.load[-1] = ratio
    held = [3 * body + 2 for body in counted(packing).rotational]
    for stiffness in STIFFNESSES[1:]:
        q = softly(clumps, q, stiffness, held)
    found, counts = borne(clumps, q, held)
    normal = clumps.gaps(found.q, found.contacts)[1]
    torque = abs((clumps.rows(found.q, found.contacts, normal).T @ found.force)[held]).max(initial=0)
    if torque < LEAST_FORCE:
        raise Failed("no body whose angle is held bears a torque: an equilibrium")
    return found, counts


def prepared(kind: str, count: int, seed: int, saddle: bool, aspect: float = 1.4, held: float | None = None, cell: bool = False) -> tuple[Packing, Counts, int]:
    """The first attempt that succeeds, and its number; says why others did not."""
    for attempt in range(1, ATTEMPTS + 1):
        try:
            packing, counts = jammed(kind, count, np.random.default_rng([seed, attempt]), aspect, cell)
            if saddle:
                return *next(saddles(packing)), attempt
            if held is not None and counts.rotational:
                return *held_angles(packing, held), attempt
            if held is not None:
                raise Failed("no body is held through one member")
            if counts.variation.min(initial=0) > SADDLE:
                return packing, counts, attempt
            reason = f"a saddle, W'' = {counts.variation[0]:.2g}"
        except Failed as failed:
            reason = str(failed)
        except StopIteration:
            reason = "no saddle with one contact less"
        print(f"{kind}, seed {seed}, attempt {attempt} is left: {reason}", file=sys.stderr)
    raise Failed(f"{kind}, seed {seed}: none of {ATTEMPTS} attempts succeeded")


def contact(number: dict[tuple[int, int], int], what: str, b: int, k: int, c: int, d: Any) -> tuple[int, int, int, int]:
    """["pair", body, member, body, member] or ["wall", body, member, axis, side] as a contact."""
    if what == "wall":
        return number[b, k], -1 - range(2)[c] - 2 * ("lower", "upper").index(d), 0, 0
    if what != "pair" or not b < c:
        raise ValueError(f"contact {[what, b, k, c, d]}")
    return number[b, k], number[c, d], 0, 0


def bodies_of(content: dict[str, Any]) -> Packing:
    """The packing of a file of format "bodies-1"."""
    members = [np.array(rows, dtype=float).reshape(-1, 3) for rows in content["members"]]
    if content["sectors"] is not None:
        return ovals_of(content, members)
    for b, rows in enumerate(members):
        if not (len(rows) == 2 or len(rows) == 3 and abs(np.linalg.det(np.column_stack([rows[:, :2], np.ones(3)]))) > 1e-9):
            raise ValueError(f"body {b}: expected two members, or three that are not collinear")
    every = np.concatenate(members)
    return placed(content, Clumps(np.repeat(np.arange(len(members)), list(map(len, members))), every[:, :2], every[:, 2]), members)


def ovals_of(content: dict[str, Any], members: list[Matrix]) -> Packing:
    """Of ovals: radii are rounded to the grid, and the contacts closed again."""
    place, radius, sorted_members = [], [], []
    for b, rows in enumerate(members):
        if not len(rows) == len(content["sectors"][b]) == 4:
            raise ValueError(f"body {b}: expected an oval of four arcs")
        around = np.argsort([math.atan2(float(y), float(x)) % (2 * math.pi) for x, y, _ in content["sectors"][b]])
        right, up, left, _ = (rows[k] for k in around)
        four, radii = oval(right[2], up[2], right[0])
        if abs(rows[around] - np.column_stack([four, radii])).max() > 1e-12 or abs(right[0] + left[0]) > 1e-12:
            raise ValueError(f"body {b}: expected an oval of four arcs")
        place += four
        radius += radii
        sorted_members.append(around)
    clumps = Clumps(np.repeat(np.arange(len(members)), 4), np.array(place), np.array(radius), rings(len(members)))
    packing = placed(content, clumps, members, sorted_members)
    packing.q, packing.force = closed(clumps, packing.q, packing.contacts, packing.force)
    return packing


def placed(content: dict[str, Any], clumps: Clumps, members: list[Matrix], order: Any = None) -> Packing:
    """`order`: which member of the file comes first, second ... in a body; nothing: as in the file."""
    every = np.column_stack([clumps.place, clumps.radius])
    clumps.load[-2:] = np.array(content["loads"], dtype=float)
    places = np.array(content["bodies"], dtype=float).reshape(3 * clumps.count)
    q = np.concatenate([places, np.array(content["lengths"], dtype=float).reshape(2)])
    places_of = (order[b] if order else range(len(rows)) for b, rows in enumerate(members))
    number = {place: i for i, place in enumerate((b, int(k)) for b, of in enumerate(places_of) for k in of)}
    contacts = np.array([contact(number, *row) for row in content["contacts"]])
    force = np.array(content["forces"], dtype=float).reshape(len(contacts))
    if not (all(np.isfinite(numbers).all() for numbers in (q, every, force, clumps.load)) and (clumps.radius > 0).all()):
        raise ValueError("expected finite numbers and positive radii")
    return Packing(clumps, q, force, contacts)


def converted(path: str) -> tuple[Packing, Counts]:
    """The packing of a file; says where its counts are those that the file expects."""
    try:
        with open(path, encoding="utf-8") as file:
            content = json.load(file)
        if content["format"] != "bodies-1":
            raise ValueError(f"its format is {content['format']!r}")
        packing, expected = bodies_of(content), dict(content["expected"])
    except (LookupError, TypeError, ValueError, RecursionError) as error:
        raise Failed(f'{path}: not a file of format "bodies-1": {error!r}') from None
    if abs(packing.clumps.gaps(packing.q, packing.contacts)[0]).max() > 1e-12 or packing.least_other_gap() < LEAST_GAP:
        raise Failed(f"{path}: a contact is open, or another pair overlaps")
    counts = counted(packing)
    for name, value in counts.named().items():
        same = "as the file says" if expected.get(name) == value else f"but the file says {expected.get(name)!r}"
        print(f"{name} = {value}, {same}", file=sys.stderr)
    return packing, counts


def bars(clumps: Clumps) -> list[list[Any]]:
    """The pairs of members of one body, with their distance in its frame, rounded once: 2 K - 3 pairs for K = 2, 3 members. Of an oval
    its neighbours, with the difference of their radii, and the caps."""
    exact = Context(prec=60)

    def apart(i: int, j: int) -> float:
        x, y = (exact.subtract(Decimal(float(a)), Decimal(float(b))) for a, b in zip(clumps.place[i], clumps.place[j]))
        return float(exact.sqrt(exact.add(exact.multiply(x, x), exact.multiply(y, y))))

    pairs = (zip(r, r[1:] + r[:1]) for r in clumps.rings)
    sides = [[min(i, j), max(i, j), abs(clumps.radius[i] - clumps.radius[j])] for i, j in itertools.chain(*pairs)]
    across = [(r[0], r[2]) for r in clumps.rings]
    across += [pair for m in clumps.members if len(m) < 4 for pair in itertools.combinations(m.tolist(), 2)]
    return sorted(sides + [[i, j, apart(i, j)] for i, j in across])


def state(packing: Packing, origin: dict[str, Any]) -> str:
    """The text of a state file, a row a line. The bars are no contacts: the reader adds them."""
    clumps = packing.clumps
    load = f"dead forces on the {'periods' if clumps.cell else 'right and the top wall'}: W = L_x + L_y, so the stresses refer to a box of lengths 1"
    head: dict[str, Any] = {"format": "isostat-state", "version": 2}
    head["provenance"] = {"program": "examples/clumps/prepare.py", **origin, "load": load}
    head["load"] = {"kind": "nominal", "stress": clumps.lengths(clumps.load).tolist(), "reference_length": [1, 1]}
    head["length"] = clumps.lengths(packing.q).tolist()
    if clumps.cell:
        head["cell"] = {"axes": ["periodic", "periodic"], "moves": ["x", "y", "xy"], "tilt": [packing.q[-1]], "pin": 0}
    rows: dict[str, list[Any]] = {"disks": np.column_stack([clumps.centres(packing.q), clumps.radius]).tolist(), "bars": bars(clumps)}
    if clumps.rings:
        rows["arcs"] = clumps.rings
    rows["contacts"] = [[int(i), int(j) if j >= 0 else WALLS[-1 - j], *([m.tolist()] if m.any() else [])] for i, j, m in ((c[0], c[1], c[2:]) for c in packing.contacts)]
    parts = [f'  "{key}": {json.dumps(value, allow_nan=False)}' for key, value in head.items()]
    parts += [f'  "{key}": [\n    ' + ",\n    ".join(map(json.dumps, value)) + "\n  ]" for key, value in rows.items()]
    return "{\n" + ",\n".join(parts) + "\n}\n"


COLUMNS = "| kind | seed | N_f | N | h | k | rotational rattlers | doubled pairs | least W'' | least force | least other gap | seconds |"


def line(kind: str, seed: Any, packing: Packing, counts: Counts, seconds: float) -> str:
    least = f"{counts.variation[0]:.1e}" if len(counts.variation) else "-"
    cells = [kind, seed, counts.dof, counts.contacts, counts.hyperstaticity, counts.hypostaticity, len(counts.rotational)]
    cells += [counts.doubled, least, f"{packing.force.min():.1e}", f"{packing.least_other_gap():.1e}", f"{seconds:.1f}"]
    return f"| {' | '.join(map(str, cells))} |"


def table(kinds: list[str], count: int, aspect: float, seeds: int, saddle: bool, cell: bool) -> None:
    print(COLUMNS)
    print("|---" * COLUMNS.count(" | ") + "|---|")
    for kind in kinds:
        for seed in range(1, seeds + 1):
            start = time.process_time()
            try:
                packing, counts, _ = prepared(kind, count, seed, saddle, aspect, cell=cell)
            except Failed as failed:
                print(failed, file=sys.stderr)
                continue
            print(line(kind, seed, packing, counts, time.process_time() - start), flush=True)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", nargs="?", choices=list(KINDS), help="dimer: equal members; dimer2: unequal ones; trimer: an equilateral triangle; oval: four arcs; mixed: ovals and dimer2")
    parser.add_argument("-n", type=int, default=20, help="bodies (20)")
    parser.add_argument("--aspect", type=float, default=1.4, help="length over width of the ovals (1.4)")
    parser.add_argument("--cell", action="store_true", help="a periodic cell in the place of the box, of unions only")
    parser.add_argument("--seed", type=int, default=1, help="of the random numbers (1)")
    parser.add_argument("--saddle", action="store_true", help="an equilibrium with a contact less, where W has no minimum")
    parser.add_argument("--held", type=float, metavar="F", help="what rests under the force F on the top wall while rotational rattlers keep their angles")
    parser.add_argument("--from", dest="source", metavar="FILE", help='a packing of format "bodies-1"')
    parser.add_argument("--table", type=int, metavar="N", help="count in seeds 1 to N, of all kinds unless one is given")
    parser.add_argument("-o", dest="output", metavar="FILE", help="where the state goes; a file that is there stays (standard output)")
    given = parser.parse_args()
    if sum([given.table is not None, given.source is not None, given.kind is not None and given.table is None]) != 1:
        parser.error("expected a kind, --from FILE or --table N")
    if given.cell and (given.kind in ("oval", "mixed") or given.source is not None):
        parser.error("expected unions of disks for --cell")
    if given.n < 1 or given.seed < 0 or not 1.01 <= given.aspect <= 5:
        parser.error("expected at least one body, a seed that is not negative, and an aspect from 1.01 to 5")
    return given


def main() -> None:
    given = arguments()
    if given.table is not None:
        kinds = [given.kind] if given.kind else [kind for kind, members in KINDS.items() if 0 < members < 4 or not given.cell]
        table(kinds, given.n, given.aspect, given.table, given.saddle, given.cell)
        return
    if given.source is not None:
        packing, counts = converted(given.source)
        origin = {"file": os.path.basename(given.source)}
    else:
        packing, counts, attempt = prepared(given.kind, given.n, given.seed, given.saddle, given.aspect, given.held, given.cell)
        origin = {"kind": given.kind, "bodies": given.n, "seed": given.seed, "attempt": attempt, "saddle": given.saddle, "held": given.held}
        print(COLUMNS, line(given.kind, given.seed, packing, counts, time.process_time()), sep="\n", file=sys.stderr)
    text = state(packing, origin)
    if given.output is None:
        print(text, end="")
    else:
        try:
            with open(given.output, "x", encoding="utf-8") as file:
                file.write(text)
        except FileExistsError:
            raise Failed(f"{given.output} is there already and stays as it is") from None


if __name__ == "__main__":
    try:
        main()
    except (Failed, OSError) as failed:
        sys.exit(f"prepare.py: {failed}")
