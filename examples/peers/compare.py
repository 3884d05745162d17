#!/usr/bin/env python3
"""Compares isostat with independent exact codes on small inputs: see README.md in this folder.

    python3 examples/peers/compare.py [path of isostat]
"""

import json
import re
import shutil
import subprocess
import sys
import tempfile
import time
from fractions import Fraction
from pathlib import Path

HERE = Path(__file__).resolve().parent
WALLS = {"left": (0, -1), "bottom": (1, -1), "right": (0, 1), "top": (1, 1)}


def run(*command, ok=(0,)):
    start = time.monotonic()
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode not in ok:
        sys.exit(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stderr}{done.stdout[-2000:]}")
    return done.stdout, time.monotonic() - start


def number(value):
    """A number of a state file, exactly: a double, or a hexadecimal float in a string."""
    return Fraction(float.fromhex(value) if isinstance(value, str) else value)


def columns(state):
    """Contact matrix without rounding: entries x_j - x_i, so that an unknown is force / distance of the centres."""
    disks = [[number(v) for v in row] for row in state["disks"]]
    first = 1 if state["version"] == 1 else 0  # of the coordinates in a row
    n = len(disks)
    out = []
    for i, other in state["contacts"]:
        column = {}
        if isinstance(other, str):
            axis, side = WALLS[other]
            column[2 * i + axis] = Fraction(side)
            if side > 0:
                column[2 * n + axis] = Fraction(-1)
        else:
            for axis in range(2):
                d = disks[other][first + axis] - disks[i][first + axis]
                column[2 * i + axis], column[2 * other + axis] = d, -d
        out.append({row: v for row, v in column.items() if v != 0})
    return 2 * n + 2, out


def programme(state, rows, matrix, sense):
    """The end of the load interval: largest or smallest sigma_2 with forces >= 0 in balance, sigma_1 as stored."""
    load = state["load"]
    sigma1 = number(load["stress"][0])
    lengths = [number(v) for v in load["reference_length"]]
    n = (rows - 2) // 2
    row_terms = [[] for _ in range(rows)]
    for l, column in enumerate(matrix):
        for row, value in column.items():
            row_terms[row].append((value, f"f{l}"))
    right = [Fraction(0)] * rows
    right[2 * n] = -sigma1 * lengths[1]
    row_terms[2 * n + 1].append((lengths[0], "s"))  # + sigma_2 Lx on the left-hand side
    return row_terms, right, sense


def lp_text(problem, rational):
    terms, right, sense = problem
    show = (lambda v: str(v)) if rational else (lambda v: repr(float(v)))

    def sum_of(row):
        return " ".join(f"{'+' if v > 0 else '-'} {show(abs(v))} {name}" for v, name in row)

    lines = ["Maximize" if sense > 0 else "Minimize", " obj: s", "Subject To"]
    lines += [f" r{k}: {sum_of(row)} = {show(right[k])}" for k, row in enumerate(terms) if row]
    return "\n".join(lines + ["End", ""])


def qsopt(problem, folder):
    path = folder / "problem.lp"
    path.write_text(lp_text(problem, True))
    sol = folder / "problem.sol"
    out, seconds = run("esolver", "-L", "-O", sol, path, ok=range(256))
    text = sol.read_text() if sol.exists() else out
    if "UNBOUNDED" in text or "UNBOUNDED" in out:
        return "unbounded", seconds
    found = re.search(r"Value\s*=\s*(-?[0-9]+(?:/[0-9]+)?)", text)
    return (Fraction(found.group(1)) if found else None), seconds


def glpk(problem, folder):
    path = folder / "problem.lp"
    path.write_text(lp_text(problem, False))
    out, seconds = run("glpsol", "--exact", "--lp", path, "-o", folder / "glpk.sol", ok=range(256))
    if "UNBOUNDED" in out:
        return "unbounded", seconds
    text = (folder / "glpk.sol").read_text() if (folder / "glpk.sol").exists() else ""
    found = re.search(r"Objective:\s+obj\s*=\s*(\S+)", text)
    return (Fraction(float(found.group(1))) if found else None), seconds


def compare_intervals(isostat, folder):
    print("load interval: isostat inspect against exact linear programmes\n")
    print(f"{'input':>14} {'end':>4} {'isostat':>22} {'QSopt_ex (exact, rounded)':>26} {'difference':>11} "
          f"{'seconds':>8} {'glpsol --exact':>15} {'seconds':>8}")
    wrong = 0
    inputs = []
    for disks in (2, 4, 8, 16, 32):
        scene = folder / f"{disks}.toml"
        scene.write_text(f"[packing]\ndisks = {disks}\nseed = 1\n[[programme]]\ndo = \"up\"\nequilibria = 1\n")
        state = folder / f"{disks}.json"
        run(isostat, "prepare", scene, "-o", state, "--quiet")
        inputs.append((f"prepared {disks}", state))
    state = folder / "vertex100.json"
    run(isostat, "import", HERE.parent.parent / "tests" / "data" / "vertex100.txt", "-o", state)
    inputs.append(("vertex100", state))
    for name, path in inputs:
        answer, seconds = run(isostat, "inspect", path, "--json", ok=(0, 1, 2))
        answer = json.loads(answer)
        state = json.loads(path.read_text())
        rows, matrix = columns(state)
        for sense, end in ((-1, "low"), (1, "high")):
            problem = programme(state, rows, matrix, sense)
            mine = answer["supported_interval"][0 if sense < 0 else 1]
            exact, exact_seconds = qsopt(problem, folder) if shutil.which("esolver") else (None, 0)
            other, other_seconds = glpk(problem, folder) if shutil.which("glpsol") else (None, 0)
            if mine is None or exact == "unbounded":
                same = mine is None and exact in ("unbounded", None)
                difference = "both none" if same else "DIFFERENT"
            elif exact is None:
                difference, same = "no answer", not shutil.which("esolver")
            else:
                error = abs(Fraction(mine) - exact) / max(abs(exact), Fraction(1))
                same = error < Fraction(1, 10**11)
                difference = f"{float(error):.1e}" + ("" if same else " DIFFERENT")
            wrong += not same
            show = lambda v: v if isinstance(v, str) else ("none" if v is None else f"{float(v):.15g}")
            print(f"{name:>14} {end:>4} {show(mine):>22} {show(exact):>26} {difference:>11} {exact_seconds:8.2f} "
                  f"{show(other):>15} {other_seconds:8.2f}")
    return wrong


def compare_ranks(isostat, folder):
    try:
        import sympy
    except ImportError:
        print("\nrank: skipped, sympy is not installed")
        return 0
    print("\nrank: isostat inspect against sympy, rational or symbolic\n")
    print(f"{'input':>28} {'N_f':>4} {'N':>4} {'isostat':>8} {'sympy':>6} {'seconds':>8} {'sympy s':>8}")
    wrong = 0

    def row(name, rows, count, mine, seconds, matrix):
        nonlocal wrong
        start = time.monotonic()
        theirs = matrix.rank(simplify=True) if matrix.has(sympy.sqrt(3)) else matrix.rank()
        took = time.monotonic() - start
        wrong += mine != theirs
        print(f"{name:>28} {rows:>4} {count:>4} {mine:>8} {theirs:>6} {seconds:8.2f} {took:8.2f}"
              + ("" if mine == theirs else "  DIFFERENT"))

    for disks in (2, 4, 8):
        path = folder / f"{disks}.json"
        answer, seconds = run(isostat, "inspect", path, "--json", ok=(0, 1, 2))
        rows, matrix = columns(json.loads(path.read_text()))
        dense = sympy.zeros(rows, len(matrix))
        for l, column in enumerate(matrix):
            for k, value in column.items():
                dense[k, l] = sympy.Rational(value.numerator, value.denominator)
        row(f"prepared {disks}", rows, len(matrix), json.loads(answer)["rank"], seconds, dense)
    for name in ("two_disks", "three_disks", "square_lattice_2", "square_lattice_3", "triangular_patch_2x3"):
        path = HERE.parent / "packings" / f"{name}.toml"
        answer, seconds = run(isostat, "inspect", path, "--json")
        answer = json.loads(answer)
        disks = crafted_disks(path, sympy)
        n = len(disks)
        dense = sympy.zeros(2 * n + 2, len(answer["contacts"]))
        for l, contact in enumerate(answer["contacts"]):
            i, other = contact.split("-")
            i = int(i)
            if other in WALLS:
                axis, side = WALLS[other]
                dense[2 * i + axis, l] = side
                if side > 0:
                    dense[2 * n + axis, l] = -1
            else:
                j = int(other)
                for axis in range(2):
                    d = sympy.expand(disks[j][axis] - disks[i][axis])
                    dense[2 * i + axis, l], dense[2 * j + axis, l] = d, -d
        row(name, 2 * n + 2, len(answer["contacts"]), answer["rank"], seconds, dense)
    return wrong


def crafted_disks(path, sympy):
    """x, y, r of `disks = [[..], ..]`; enough for the files used here."""
    text = re.sub(r"#.*", "", path.read_text())
    body = re.search(r"^disks\s*=\s*(\[.*?\]\s*,?\s*\])", text, re.S | re.M).group(1)
    rows = re.findall(r"\[([^\[\]]+)\]", body)
    return [[sympy.sympify(v.strip().strip('"'), rational=True) for v in row.split(",")] for row in rows]


def main():
    isostat = Path(sys.argv[1] if len(sys.argv) > 1 else HERE.parent.parent / "build" / "release" / "isostat")
    if not isostat.exists():
        sys.exit(f"{isostat}: not there: build it, or give its path")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        wrong = compare_intervals(isostat, folder) + compare_ranks(isostat, folder)
    print(f"\n{'all agree' if wrong == 0 else f'{wrong} differences'}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
