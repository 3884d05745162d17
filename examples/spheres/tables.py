"""Axial compression of spheres beside that of disks: staircase, volumetric strain, distributions of load and strain increments.

    python3 examples/spheres/tables.py [SIZES [SAMPLES]]     100,250,500 and 10 samples of each unless said

Each size is an ensemble (`isostat ensemble`) of packings with diameters uniform in [1, 2] in a box, isotropic at first; the stress of
the last axis is raised through 30 equilibria. Folder examples/output/spheres-and-disks; what is there is not made again. ISOSTAT says
which program. Tables: staircase.csv (every equilibrium: q/p, axial and volumetric strain), distributions.csv (quantiles), summary.md.
q is the loaded stress less the others, p the mean of all; a strain is positive in compression."""
import csv
import os
import pathlib
import statistics
import subprocess
import sys

isostat = os.environ.get("ISOSTAT", "build/release/isostat")
folder = pathlib.Path("examples/output/spheres-and-disks")
equilibria = 30
quantiles = (0.1, 0.25, 0.5, 0.75, 0.9, 0.99)
scene = """[packing]
{grains} = {n}
diameters = [1.0, 2.0]
seed = 1

[[programme]]
do = "up"
equilibria = {equilibria}
"""


def rows_of(path):
    lines = path.read_text().splitlines()
    return csv.DictReader([lines[0].lstrip("# "), *lines[1:]])


def ensemble(dimension, n, samples):
    """Its folder; samples that ended before their time are among its results."""
    grains = "disks" if dimension == 2 else "spheres"
    output = folder / f"{grains}-{n}"
    output.parent.mkdir(parents=True, exist_ok=True)
    file = folder / f"{grains}-{n}.toml"
    file.write_text(scene.format(grains=grains, n=n, equilibria=equilibria))
    more = ["--resume"] if (output / "ensemble.json").exists() else []
    status = subprocess.run([isostat, "ensemble", file, "--samples", str(samples), "-o", output, "--jobs", "1", *more]).returncode
    if status > 2:
        sys.exit(status)
    return output


def staircases(output, dimension):
    """{seed: [(q/p, axial strain, volumetric strain), ...]} at the limits that were reached."""
    out = {}
    for row in rows_of(output / "equilibria.csv"):
        ratio = float(row["ratio"])
        strains = [float(row[f"eps{a + 1}"]) for a in range(dimension)]
        q_p = (ratio - 1) * dimension / (ratio + dimension - 1)
        out.setdefault(int(row["seed"]), []).append((q_p, strains[-1], sum(strains)))
    return out


def increments(staircase, column):
    """Of the load between limits; of the axial strain over a rearrangement."""
    steps = [b[column] - a[column] for rows in staircase.values() for a, b in zip(rows[1:], rows[2:])]
    return [step for step in steps if step > 0]


def quantile(values, share):
    values = sorted(values)
    at = share * (len(values) - 1)
    low = int(at)
    return values[low] + (at - low) * (values[min(low + 1, len(values) - 1)] - values[low])


def main():
    sizes = [int(n) for n in (sys.argv[1] if len(sys.argv) > 1 else "100,250,500").split(",")]
    samples = int(sys.argv[2]) if len(sys.argv) > 2 else 10
    steps, table, distributions = [], [], []
    for n in sizes:
        for dimension in (3, 2):
            output = ensemble(dimension, n, samples)
            found = staircases(output, dimension)
            steps += [(dimension, n, seed, k, *row) for seed, rows in found.items() for k, row in enumerate(rows)]
            ends = [rows[-1] for rows in found.values() if len(rows) == equilibria + 1]
            load, strain = increments(found, 0), increments(found, 1)
            for name, values in (("q/p", load), ("axial strain", strain)):
                distributions.append((dimension, n, name, len(values), *(quantile(values, q) for q in quantiles)))
            means = [f"{statistics.median(column):.3g}" for column in zip(*ends)] if ends else ["-"] * 3
            table.append(("spheres" if dimension == 3 else "disks", n, f"{len(ends)} of {len(found)}", *means,
                          f"{statistics.mean(load):.2e}, {quantile(load, 0.5):.2e}", f"{quantile(strain, 0.5):.1e}",
                          f"{quantile(strain, 0.9) / quantile(strain, 0.5):.0f}"))
    write("staircase.csv", ("dimension", "n", "seed", "number", "q_p", "axial", "volumetric"), steps)
    write("distributions.csv", ("dimension", "n", "of", "count", *(f"quantile_{q}" for q in quantiles)), distributions)
    head = ("grains", "n", f"samples with {equilibria} equilibria", "q/p then", "axial strain", "volumetric strain",
            "load increment in q/p: mean, median", "strain increment: median", "its 9th decile over the median")
    text = "\n".join("| " + " | ".join(str(cell) for cell in row) + " |" for row in (head, ["---"] * len(head), *table))
    (folder / "summary.md").write_text(f"Medians over the samples.\n\n{text}\n")
    print(text)


def write(name, head, rows):
    with open(folder / name, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([head, *rows])


if __name__ == "__main__":
    main()
