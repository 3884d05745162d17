#!/usr/bin/env python3
"""How good is the faster code? Samples of LAMMPS against the exact trajectory: error against run time.

    ensemble.py [--disks 100] [--samples 5] [--end 1.2] [--stiffness 1e4 1e5 1e6] [--step 0.05 0.01] [--drag 1] [--table] [--figure]

One series after another, sample by sample; what `isostat compare` says of each, a row of OUTPUT/ensemble.csv as it ends, and the table
at the end. Series that are there are not made again: a run that was stopped goes on. `--table`: only the table, of what is there.
`--figure`: OUTPUT/ensemble.svg, the frames of the first sample, a panel for each series."""
import argparse
import collections
import csv
import itertools
import math
import pathlib
import statistics
import sys

from figure import draw
from series import compare, isostat, lammps, series, timed

elsewhere = ("early", "late", "other")


def name_of(row):
    return f"k{row['stiffness']}-drag{row['drag']}-step{row['step']}-end{row['end']}"


def exact_seconds(start, folder, end):
    """Processor time of the exact run to the last load."""
    scene = folder / "exact.toml"
    scene.write_text(f'[packing]\nfile = "start.json"\n[[programme]]\ndo = "up"\nto = {end}\n[output]\npictures = false\n')
    result, seconds = timed([isostat, "run", scene, "-o", folder / "exact", "--force", "--quiet"])
    return seconds if result.returncode == 0 else math.nan


def row_of(key, folder, seconds, exact, words):
    frames = list(csv.DictReader(open(folder / "comparison" / "comparison.csv")))
    statuses = collections.Counter(frame["status"] for frame in frames)
    median = lambda name, of: statistics.median([float(f[name]) for f in of if f[name] not in ("", "nan")] or [math.nan])
    soft = [frame for frame in frames if frame["status"] == "soft"]
    departure = words.split("FIRST DEPARTURE: ")[1].split(": ")[1] if "FIRST DEPARTURE" in words else "none"
    return key | {"frames": len(frames), "same": statuses["same"], "elsewhere": sum(statuses[s] for s in elsewhere),
                  "soft": statuses["soft"], "moving": statuses["moving"],
                  "undecided": sum(statuses[s] for s in ("undecided", "refuted", "file")),
                  "local": sum(frame["local"] == "same" for frame in frames), "asked": sum(frame["local"] != "" for frame in frames),
                  "departure": departure, "force_error": median("stiffness", frames), "soft_error": median("downhill", soft),
                  "lammps_seconds": seconds, "exact_seconds": exact}


def table(rows):
    """One line per stiffness, drag and step, over the samples."""
    print("| kn / P | drag | step | samples, frames | same list | elsewhere | soft | in motion | undecided | next one right | first departure "
          "| force error | of soft ones | LAMMPS | exact run |\n" + "|---" * 15 + "|")
    groups = collections.defaultdict(list)
    for row in rows:
        groups[row["stiffness"], row["drag"], row["step"]].append(row)
    for (stiffness, drag, step), members in sorted(groups.items(), key=lambda item: [float(x) * sign for x, sign in zip(item[0], (1, -1, -1))]):
        total = lambda name: sum(float(row[name]) for row in members)
        share = lambda name: f"{total(name) / total('frames'):.0%}"
        known = lambda name: [float(row[name]) for row in members if str(row.get(name) or "nan") != "nan"]
        error = lambda name: f"{statistics.median(known(name)):.1e}" if known(name) else "-"
        reasons = collections.Counter(row["departure"] for row in members).most_common()
        print("| " + " | ".join([
            stiffness, drag, step, f"{len(members)}, {total('frames'):.0f}", share("same"), share("elsewhere"), share("soft"), share("moving"),
            share("undecided"), f"{total('local'):.0f} of {total('asked'):.0f}", ", ".join(f"{reason} {n}" for reason, n in reasons),
            error("force_error"), error("soft_error"), f"{total('lammps_seconds') / len(members):.3g} s",
            f"{total('exact_seconds') / len(members):.2g} s"]) + " |")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--disks", type=int, default=100)
    options.add_argument("--samples", type=int, default=5)
    options.add_argument("--end", type=float, default=1.2)
    options.add_argument("--stiffness", nargs="+", default=["1e4", "1e5", "1e6"])
    options.add_argument("--step", nargs="+", default=["0.05", "0.01"])
    options.add_argument("--drag", nargs="+", default=["1"])
    options.add_argument("--table", action="store_true")
    options.add_argument("--figure", action="store_true")
    asked = options.parse_args()
    if not lammps and not asked.table:
        print("LAMMPS is not there: sudo apt-get install lammps", file=sys.stderr)
        sys.exit(77)
    output = pathlib.Path("examples/output/lammps") / f"ensemble-{asked.disks}"
    output.mkdir(parents=True, exist_ok=True)
    results = output / "ensemble.csv"
    rows = list(csv.DictReader(open(results))) if results.exists() else []
    for seed in range(1, asked.samples + 1) if not asked.table else []:
        sample = output / f"seed{seed}"
        sample.mkdir(exist_ok=True)
        start = sample / "start.json"
        (sample / "scene.toml").write_text(f"[packing]\ndisks = {asked.disks}\nseed = {seed}\n")
        if not start.exists():
            timed([isostat, "prepare", sample / "scene.toml", "-o", start, "--quiet"])
        exact = exact_seconds(start, sample, asked.end)
        for stiffness, drag, step in itertools.product(asked.stiffness, asked.drag, asked.step):
            key = {"seed": str(seed), "stiffness": stiffness, "step": step, "drag": drag, "end": str(asked.end)}
            if any(all(row[name] == value for name, value in key.items()) for row in rows):
                continue
            folder = sample / name_of(key)
            seconds = series(start, folder, stiffness, drag, step, round((asked.end - 1) / float(step)))
            words = compare(start, folder)
            print(f"seed {seed}, stiffness {stiffness}, drag {drag}, step {step} ({seconds:.0f} s of LAMMPS)" + words.replace("\n", "\n  "),
                  flush=True)
            rows.append(row_of(key, folder, seconds, exact, words))
            with open(results, "w", newline="") as file:
                writer = csv.DictWriter(file, rows[-1].keys())
                writer.writeheader()
                writer.writerows(rows)
    rows = [row for row in rows if int(row["seed"]) <= asked.samples and row["end"] == str(asked.end) and
            all(row[name] in getattr(asked, name) for name in ("stiffness", "drag", "step"))]
    table(rows)
    if asked.figure:
        draw(output, [(f"k_n/P = {row['stiffness']}, drag {row['drag']}", output / "seed1" / name_of(row) / "comparison")
                      for row in rows if row["seed"] == "1"], len(asked.stiffness))


if __name__ == "__main__":
    main()
