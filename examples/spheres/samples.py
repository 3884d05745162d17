"""Packings of spheres prepared, compressed through twelve equilibria and verified: how many go all the way, why the others stop.

    python3 examples/spheres/samples.py [N...]     30 45 60 80 100 unless said: 207 runs, a quarter of an hour on one core

Diameters uniform in [1, 2], bidisperse 1 : 1.4 by number, equal with jitter 1e-3; a box, an orthorhombic and a triclinic cell; three to
six seeds of each. Folder examples/output/sphere-samples; what is in its samples.csv is not made again. ISOSTAT says which program."""
import collections
import csv
import itertools
import json
import os
import pathlib
import shutil
import subprocess
import sys

isostat = os.environ.get("ISOSTAT", "build/release/isostat")
folder = pathlib.Path("examples/output/sphere-samples")
laws = {"uniform": "", "bidisperse": 'law = "bidisperse"\n', "jitter": 'law = "equal"\njitter = 1e-3\n'}
kinds = {"box": "", "orthorhombic": '[cell]\nkind = "orthorhombic"\n', "triclinic": '[cell]\nkind = "triclinic"\n'}
seeds = {30: 6, 45: 6, 60: 5, 80: 3, 100: 3}
scene = """[packing]
spheres = {n}
seed = {seed}
{law}{kind}[output]
pictures = false
[run]
max_strain = 1e6
[[programme]]
do = "up"
equilibria = 12
"""
columns = ["sample", "ended", "equilibria", "proved", "arcs", "verify"]


def sample(name, text):
    """One row: how the run ended, what it proved, what `verify` says."""
    out = folder / name
    shutil.rmtree(out, ignore_errors=True)
    (folder / "scene.toml").write_text(text)
    subprocess.run([isostat, "run", folder / "scene.toml", "-o", out, "--quiet"], stderr=subprocess.DEVNULL)
    status = json.loads((out / "run.json").read_text())["status"]
    lines = (out / "equilibria.csv").read_text().splitlines()
    rows = list(csv.DictReader([lines[0].lstrip("# "), *lines[1:]]))
    answer = subprocess.run([isostat, "verify", out, "--json"], capture_output=True, text=True)
    reasons = {"completed": "completed", ": tie: ": "named tie", ": no limit: ": "supported without limit"}
    ended = next((words for mark, words in reasons.items() if mark in status), status)
    return [name, ended, len(rows), sum(int(r["proved"]) for r in rows), sum(int(r["arcs"]) for r in rows), json.loads(answer.stdout)["verdict"]]


def main():
    folder.mkdir(parents=True, exist_ok=True)
    table = folder / "samples.csv"
    done = list(csv.reader(table.read_text().splitlines()))[1:] if table.exists() else []
    known = {row[0] for row in done}
    for n in map(int, sys.argv[1:] or seeds):
        for seed, law, kind in itertools.product(range(1, seeds.get(n, 3) + 1), laws, kinds):
            name = f"{kind}-{law}-{n}-{seed}"
            if name not in known:
                done.append(sample(name, scene.format(n=n, seed=seed, law=laws[law], kind=kinds[kind])))
                print(", ".join(map(str, done[-1])), flush=True)
                with table.open("w", newline="") as file:
                    csv.writer(file).writerows([columns, *done])
    for column in ("ended", "verify"):
        print(dict(collections.Counter(row[columns.index(column)] for row in done)))
    print(*(f"{sum(int(row[k]) for row in done)} {columns[k]}" for k in (2, 3, 4)), sep=", ")


main()
