#!/usr/bin/python3
"""Sequential linear programming to the vertex: Isostat against scipy's HiGHS on the same start.

    apt-get install python3-scipy
    cmake --preset bench && cmake --build --preset bench --target bench_linear_programmes
    /usr/bin/python3 tests/bench/highs_chain.py build/bench/bench/bench_linear_programmes [--sizes 400 1936] [--seeds 1] [--runs 3]

Both start from the relaxed soft packing of `isostat prepare` and solve the same programmes (linearised gaps of all pairs within reach,
trust bounds, overlaps kept in the first one, eps g on every disk). HiGHS gets each as a sparse matrix, without a starting basis (linprog has no
way to give one), until a programme moves nothing more: step below 1e-8 mean radii, same contacts. Timed for HiGHS: the calls of linprog
only. Timed for Isostat: everything from the start to the proved vertex (candidates, programmes, Newton, proofs). Processor time of one
thread. The contacts must be the same; exit status 1 if not.
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
from scipy.spatial import cKDTree

TRUST = 0.27       # largest displacement of a disk along an axis, in mean radii; ten times that for a wall
WALL_TRUST = 10
TOLERANCE = 1e-9   # of HiGHS, primal and dual: that of Isostat's programmes
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
    return rows[:, 0] / unit, rows[:, 1:3] / unit, numbers[5 * n:] / unit, weight, eps


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


def chain(path, most=100):
    radius, x, length, weight, eps = read_start(path)
    n = len(radius)
    mean = radius.mean()
    trust = TRUST * mean
    bounds = np.full((2 * n + 2, 2), [-trust, trust])
    bounds[2 * n:] *= WALL_TRUST
    seconds, iterations, contacts, settled, repaired = 0.0, 0, None, 0.0, 0
    for programme in range(1, most + 1):
        names, gap, matrix = rows_of(radius, x, length, trust)
        cost = SCALE * np.concatenate([-eps * weight.ravel(), [length[1], length[0]]])
        lower = np.minimum(0, -gap) if programme == 1 else -gap
        before = time.process_time()
        answer = linprog(cost, A_ub=-matrix, b_ub=-lower, bounds=bounds, method="highs",
                         options={"primal_feasibility_tolerance": TOLERANCE, "dual_feasibility_tolerance": TOLERANCE})
        if answer.status != 0:  # HiGHS gives up at this tolerance now and then: its own defaults, interior points
            repaired += 1
            answer = linprog(cost, A_ub=-matrix, b_ub=-lower, bounds=bounds, method="highs-ipm")
        seconds += time.process_time() - before
        if answer.status != 0:
            return {"failed": f"programme {programme}: {answer.message}", "seconds": seconds}
        iterations += int(answer.nit)
        step = answer.x
        x = x + step[:2 * n].reshape(n, 2)
        length = length + step[2 * n:]
        now = sorted(names[k] for k in np.flatnonzero(answer.ineqlin.marginals < 0))
        if now != contacts:
            settled = seconds
        still = now == contacts and np.abs(step[:2 * n]).max() <= 1e-8 * mean
        contacts = now
        if still:
            break
    return {"seconds": seconds, "settled": settled, "programmes": programme, "iterations": iterations,
            "repaired": repaired, "contacts": contacts}


def spread(values):
    return f"{statistics.median(values):.3g} ({min(values):.3g}–{max(values):.3g})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="bench_linear_programmes")
    parser.add_argument("--sizes", type=int, nargs="+", default=[400, 1936])
    parser.add_argument("--seeds", type=int, nargs="+", default=[1])
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--json", help="file for the figures")
    arguments = parser.parse_args()
    results, wrong = [], 0
    for n in arguments.sizes:
        for seed in arguments.seeds:
            with tempfile.TemporaryDirectory() as folder:
                start = os.path.join(folder, "start.txt")
                subprocess.run([arguments.program, "start", str(n), str(seed), start], check=True)
                ours, theirs, ratios, settled = [], [], [], []
                for _ in range(arguments.runs):
                    own = json.loads(subprocess.run([arguments.program, "solve", start], check=True,
                                                    capture_output=True, text=True).stdout)
                    other = chain(start)
                    if "failed" in other:
                        sys.exit(f"HiGHS, n = {n}, seed {seed}: {other['failed']}")
                    ours += own["seconds"]
                    theirs.append(other["seconds"])
                    ratios.append(own["seconds"][0] / other["seconds"])
                    settled.append(own["seconds"][0] / other["settled"])
                same = sorted(own["contacts"]) == sorted(other["contacts"])
                wrong += not same
                results.append({"n": n, "seed": seed, "same_contacts": same, "isostat_seconds": ours,
                                "highs_seconds": theirs, "ratio": ratios, "ratio_until_contacts_settled": settled,
                                "isostat_programmes": own["programmes"], "isostat_pivots": own["pivots"],
                                "highs_programmes": other["programmes"], "highs_iterations": other["iterations"],
                                "highs_repaired": other["repaired"], "contacts": len(own["contacts"]),
                                "different": len(set(own["contacts"]) ^ set(other["contacts"]))})
                print(json.dumps(results[-1]), flush=True)
    print("\n| n | seed | Isostat, s | HiGHS chain, s | ratio | ratio until HiGHS's contacts settle | programmes | same contacts |")
    print("|---|---|---|---|---|---|---|---|")
    for r in results:
        print(f"| {r['n']} | {r['seed']} | {spread(r['isostat_seconds'])} | {spread(r['highs_seconds'])} | {spread(r['ratio'])} "
              f"| {spread(r['ratio_until_contacts_settled'])} | {r['isostat_programmes']} / {r['highs_programmes']} "
              f"| {'yes' if r['same_contacts'] else 'NO: %d differ' % r['different']} |")
    if arguments.json:
        with open(arguments.json, "w") as file:
            json.dump({"scipy": scipy.__version__, "results": results}, file, indent=1)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
