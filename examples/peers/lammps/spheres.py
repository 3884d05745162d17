"""Soft spheres of LAMMPS, jammed in a periodic cube, and the packing of rigid spheres that they stand for, proved.

    python3 examples/peers/lammps/spheres.py [SPHERES [PRESSURE]]     1000 spheres, pressure 1e-6 of the stiffness unless said

Diameters are uniform in [1, 2]; a folder in examples/output/lammps gets the dumps, the state and its certificate. Where the soft
spheres close more contacts than rigid ones can (h > 0), `--exchange` leads downhill. Without LAMMPS nothing is done (status 77)."""
import math
import pathlib
import random
import subprocess
import sys

from series import here, isostat, lammps, timed


def write_input(path, count, seed):
    """Spheres anywhere in a cube of solid fraction 0.68, all of the same mass: the slowest motion sets the time of the search."""
    draw = random.Random(seed)
    diameters = [1 + draw.random() for _ in range(count)]
    side = (sum(math.pi / 6 * d**3 for d in diameters) / 0.68) ** (1 / 3)
    rows = [f"{i + 1} 1 {d!r} {6 / math.pi / d**3!r} " + " ".join(repr(side * draw.random()) for _ in range(3)) for i, d in enumerate(diameters)]
    bounds = "\n".join(f"0 {side!r} {axis}lo {axis}hi" for axis in "xyz")
    path.write_text(f"spheres\n\n{count} atoms\n1 atom types\n\n{bounds}\n\nAtoms # sphere\n\n" + "\n".join(rows) + "\n")


def made(folder, count, pressure, seed=1):
    """Runs LAMMPS in the folder; seconds of processor time."""
    folder.mkdir(parents=True, exist_ok=True)
    write_input(folder / "start.data", count, seed)
    words = ["-var", "data", folder / "start.data", "-var", "pressure", pressure, "-var", "out", folder]
    result, seconds = timed([lammps, "-in", here / "in.spheres", "-log", "none", "-screen", folder / "screen", *words])
    if result.returncode != 0 or not (folder / "pressure").exists():
        sys.exit(f"LAMMPS failed: {folder / 'screen'}")
    return seconds


def main():
    if not lammps:
        print("LAMMPS is not there: sudo apt-get install lammps", file=sys.stderr)
        sys.exit(77)
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    pressure = sys.argv[2] if len(sys.argv) > 2 else "1e-6"
    folder = pathlib.Path(f"examples/output/lammps/spheres-{count}-{pressure}")
    print(f"LAMMPS: {made(folder, count, pressure):.1f} s", flush=True)
    stress = ",".join([(folder / "pressure").read_text().strip()] * 3)
    state, proof = folder / "state.json", folder / "certificate.json"
    columns = "c_ids[1],c_ids[2],c_forces"
    for command in (["snap", folder / "spheres.dump", "--contacts", folder / "contacts.dump", "--contact-columns", columns, "--cell",
                     "isotropic", "--stress", stress, "--exchange", "-o", state],
                    ["certify", state, "-o", proof], ["verify", proof, "--input", state]):
        result, seconds = timed([isostat, *command], stdout=subprocess.PIPE, text=True)
        print(f"{result.stdout}isostat {command[0]}: {seconds:.1f} s", flush=True)
        if result.returncode != 0:
            sys.exit(result.returncode)


if __name__ == "__main__":
    main()
