#!/usr/bin/python3
"""Sequential linear programming to the vertex: Isostat against scipy's HiGHS on the same start.

    apt-get install python3-scipy
    cmake --preset bench && cmake --build --preset bench --target bench_linear_programmes
    /usr/bin/python3 tests/bench/highs_chain.py build/bench/bench/bench_linear_programmes [--sizes 400 1936]
        [--seeds 1] [--runs 3] [--methods highs-ds highs-ipm] [--limit 120] [--json FILE]

Both start from the relaxed soft packing of `isostat prepare` and solve the same programmes (linearised gaps of all
pairs within reach, trust bounds, overlaps kept in the first one, eps g on every disk). HiGHS gets each as a sparse
matrix, with its own settings (tolerances of 1e-7; a basis is found by crossover), without a starting basis (linprog
has no way to give one), until a programme ends with the N_f contacts of the one before. Newton then puts all their
gaps to zero, and the end must be that of Isostat: same contacts, coordinates within 1e-9 mean radii. Exit status 1 if
not.

Timed for HiGHS: the calls of linprog only. Timed for Isostat: everything from the start to the proved vertex
(candidates, programmes, Newton, proofs). Processor time of one thread. A chain that needs more than --limit seconds is
given up, and not tried again for this start. The unit is the fastest method that ended.

Why not tighter tolerances: with 1e-9, that of Isostat's programmes, HiGHS gives up on some programmes at n = 1936; and
with 1e-7 the last steps stay near 1e-7 mean radii, so that steps are no criterion for the end.
"""
import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import numpy as np
import scipy
from scipy.optimize import linprog
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

TRUST = 0.27       # largest displacement of a disk along an axis, in mean radii; ten times that for a wall
WALL_TRUST = 10
SAME = 1e-9        # mean radii: two ends are one vertex
SCALE = 256        # of the objective, as in Isostat's programmes


def read_start(path):
    with open(path) as file:
        words = file.read().split()
    n, eps = int(words[0]), float.fromhex(words[2])
    numbers = np.array([float.fromhex(w) for w in words[3:]])
    rows = numbers[:5 * n].reshape(n, 5)
    # Internal unit of length: the power of two that puts the mean radius into [1/2, 1).
    _, exponent = math.frexp(rows[:, 0].mean())
    unit = 2.0 ** exponent
    weight = rows[:, 3:] / unit ** 2     # g ~ R^2
    return unit, rows[:, 0] / unit, rows[:, 1:3] / unit, numbers[5 * n:] / unit, weight, eps


def rows_of(radius, x, length, trust):
    """Candidates: names, gaps, gradients as a sparse matrix over (x, y of each disk, Lx, Ly)."""
    n = len(radius)
    reach = 2 * math.sqrt(2) * trust * (1 + 1e-9)
    pairs = cKDTree(x).query_pairs(2 * radius.max() + reach, output_type="ndarray")
    d = x[pairs[:, 1]] - x[pairs[:, 0]]
    distance = np.hypot(d[:, 0], d[:, 1])
    gap = distance - radius[pairs].sum(axis=1)
    near = gap < reach
    pairs, d, distance, gap = pairs[near], d[near], distance[near], gap[near]
    unit = d / distance[:, None]
    names = [f"{i}-{j}" for i, j in pairs]
    row = np.repeat(np.arange(len(pairs)), 4)
    column = np.stack([2 * pairs[:, 0], 2 * pairs[:, 0] + 1, 2 * pairs[:, 1], 2 * pairs[:, 1] + 1], axis=1).ravel()
    value = np.concatenate([-unit, unit], axis=1).ravel()
    gaps, rows, columns, values = [gap], [row], [column], [value]
    count = len(pairs)
    wall_reach = (WALL_TRUST + 1) * trust * (1 + 1e-9)
    for a, (lower, upper) in enumerate((("left", "right"), ("bottom", "top"))):
        h = x[:, a] - radius
        i = np.flatnonzero(h < reach)
        names += [f"{k}-{lower}" for k in i]
        gaps.append(h[i])
        rows.append(count + np.arange(len(i)))
        columns.append(2 * i + a)
        values.append(np.ones(len(i)))
        count += len(i)
        h = length[a] - x[:, a] - radius
        i = np.flatnonzero(h < wall_reach)
        names += [f"{k}-{upper}" for k in i]
        gaps.append(h[i])
        own = count + np.arange(len(i))
        rows.append(np.concatenate([own, own]))
        columns.append(np.concatenate([2 * i + a, np.full(len(i), 2 * n + a)]))
        values.append(np.concatenate([-np.ones(len(i)), np.ones(len(i))]))
        count += len(i)
    matrix = csr_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))),
                        shape=(count, 2 * n + 2))
    return names, np.concatenate(gaps), matrix


def gaps_of(names, radius, x, length):
    """Gaps and their gradients for named contacts."""
    n = len(radius)
    gap, row, column, value = np.empty(len(names)), [], [], []
    for k, name in enumerate(names):
        first, second = name.split("-")
        i = int(first)
        if second.isdigit():
            j = int(second)
            d = x[j] - x[i]
            distance = math.hypot(*d)
            gap[k] = distance - radius[i] - radius[j]
            entries = [(2 * k_ + a, sign * d[a] / distance) for k_, sign in ((i, -1), (j, 1)) for a in (0, 1)]
        else:
            a = 0 if second in ("left", "right") else 1
            if second in ("left", "bottom"):
                gap[k], entries = x[i, a] - radius[i], [(2 * i + a, 1.0)]
            else:
                gap[k], entries = length[a] - x[i, a] - radius[i], [(2 * i + a, -1.0), (2 * n + a, 1.0)]
        for c, v in entries:
            row.append(k)
            column.append(c)
            value.append(v)
    return gap, csr_matrix((value, (row, column)), shape=(len(names), 2 * n + 2)).tocsc()


def polished(names, radius, x, length):
    """All gaps zero by Newton; None where that fails."""
    n = len(radius)
    for _ in range(10):
        gap, jacobian = gaps_of(names, radius, x, length)
        if np.abs(gap).max() < 1e-13 * length.max():
            return x, length
        step = splu(jacobian).solve(-gap)
        x, length = x + step[:2 * n].reshape(n, 2), length + step[2 * n:]
    return None


def chain(path, method, limit, most=200):
    """Programmes until the contacts repeat. "failed" says why there is no end."""
    unit, radius, x, length, weight, eps = read_start(path)
    n = len(radius)
    trust = TRUST * radius.mean()
    bounds = np.full((2 * n + 2, 2), [-trust, trust])
    bounds[2 * n:] *= WALL_TRUST
    seconds, iterations, contacts = 0.0, 0, None
    for programme in range(1, most + 1):
        names, gap, matrix = rows_of(radius, x, length, trust)
        cost = SCALE * np.concatenate([-eps * weight.ravel(), [length[1], length[0]]])
        lower = np.minimum(0, -gap) if programme == 1 else -gap
        before = time.process_time()
        answer = linprog(cost, A_ub=-matrix, b_ub=-lower, bounds=bounds, method=method,
                         options={"time_limit": 3 * limit})  # wall clock, here
        seconds += time.process_time() - before
        if answer.x is None or answer.status != 0:
            return {"failed": f"programme {programme}: {answer.message}", "seconds": seconds, "programmes": programme}
        if seconds > limit:
            return {"failed": f"programme {programme}", "seconds": seconds, "programmes": programme}
        iterations += int(answer.nit)
        x = x + answer.x[:2 * n].reshape(n, 2)
        length = length + answer.x[2 * n:]
        now = sorted(names[k] for k in np.flatnonzero(answer.ineqlin.marginals < 0))
        if now == contacts and len(now) == 2 * n + 2:
            break
        contacts = now
    end = polished(contacts, radius, x, length)
    if end is None:
        return {"failed": "Newton does not converge", "seconds": seconds, "programmes": programme}
    return {"seconds": seconds, "programmes": programme, "iterations": iterations, "contacts": contacts, "unit": unit,
            "radius": radius, "x": end[0], "length": end[1]}


def distance(own, other):
    """Largest difference of a coordinate between the two ends, in mean radii; infinite when the contacts differ."""
    if sorted(own["contacts"]) != sorted(other["contacts"]):
        return math.inf
    there = np.concatenate([other["x"].ravel(), other["length"]]) * other["unit"]
    return np.abs(np.array(own["coordinates"]) - there).max() / (other["radius"].mean() * other["unit"])


def sample(values):
    return {"median": statistics.median(values), "low": min(values), "high": max(values), "values": values}


def spread(s):
    return "–" if s is None else f"{s['median']:.3g} ({s['low']:.3g}-{s['high']:.3g})"


def shown(value):
    if isinstance(value, bool):
        return "yes" if value else "NO"
    return spread(value) if value is None or isinstance(value, dict) else str(value)


COLUMNS = [("n", "n", ""), ("seed", "seed", ""), ("isostat", "Isostat, s", "s"), ("method", "fastest HiGHS", ""),
           ("highs", "HiGHS chain, s", "s"), ("ratio", "Isostat / HiGHS", "HiGHS"), ("programmes", "programmes", ""),
           ("iterations", "pivots / iterations", ""), ("same", "same vertex", ""), ("others", "other methods", "")]


def compare(program, n, seed, methods, runs, limit):
    with tempfile.TemporaryDirectory() as folder:
        start = os.path.join(folder, "start.txt")
        subprocess.run([program, "start", str(n), str(seed), start], check=True)
        ours, theirs, given_up, same = [], {}, {}, True
        for _ in range(runs):
            solved = subprocess.run([program, "solve", start], check=True, capture_output=True, text=True)
            own = json.loads(solved.stdout)
            ours += own["seconds"]
            for method in methods:
                if method in given_up:
                    continue
                other = chain(start, method, limit)
                if "failed" in other:
                    why = other["failed"].split(".")[0]
                    given_up[method] = f"{method}: given up after {other['seconds']:.0f} s in {why}"
                    theirs.pop(method, None)
                    continue
                same = bool(same and distance(own, other) < SAME)
                theirs.setdefault(method, []).append(other)
    row = dict.fromkeys((key for key, _, _ in COLUMNS))
    row.update(n=n, seed=seed, isostat=sample(ours), same=False, others="; ".join(given_up.values()))
    if theirs:
        seconds = {method: [c["seconds"] for c in chains] for method, chains in theirs.items()}
        best = min(seconds, key=lambda m: statistics.median(seconds[m]))
        chains = theirs[best]
        slower = [f"{m}: {spread(sample(s))} s" for m, s in seconds.items() if m != best]
        row.update(method=best, highs=sample(seconds[best]), ratio=sample([o / t for o, t in zip(ours, seconds[best])]),
                   programmes=f"{own['programmes']} / {chains[-1]['programmes']}",
                   iterations=f"{own['pivots']} / {chains[-1]['iterations']}", same=same,
                   others="; ".join(slower + list(given_up.values())))
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="bench_linear_programmes")
    parser.add_argument("--sizes", type=int, nargs="+", default=[100, 400, 1936])
    parser.add_argument("--seeds", type=int, nargs="+", default=[1])
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--methods", nargs="+", default=["highs-ds", "highs-ipm"])
    parser.add_argument("--limit", type=float, default=120, help="processor seconds of one chain")
    parser.add_argument("--json", help="file for the table")
    arguments = parser.parse_args()
    rows = []
    for n in arguments.sizes:
        for seed in arguments.seeds:
            rows.append(compare(arguments.program, n, seed, arguments.methods, arguments.runs, arguments.limit))
            print(f"n = {n}, seed {seed}: {spread(rows[-1]['ratio'])}", file=sys.stderr, flush=True)
    caption = (f"Sequential linear programming from one start to one vertex, scipy {scipy.__version__}, "
               f"median (range) of {arguments.runs}:")
    print(f"\n{caption}\n\n| " + " | ".join(heading for _, heading, _ in COLUMNS) + " |\n|" + "---|" * len(COLUMNS))
    for row in rows:
        print("| " + " | ".join(shown(row[key]) for key, _, _ in COLUMNS) + " |")
    good = all(row["same"] for row in rows)
    if arguments.json:
        with open(arguments.json, "w") as file:
            json.dump({"program": "highs_chain.py", "arguments": sys.argv[1:], "scipy": scipy.__version__,
                       "processors": os.cpu_count(), "clock": "CPU time of one thread", "holds": good,
                       "tables": [{"name": "linear_programmes", "caption": caption,
                                   "columns": [{"key": k, "heading": h, "unit": u} for k, h, u in COLUMNS],
                                   "rows": rows}]}, file, indent=1)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
