"""One series of LAMMPS from an equilibrium of isostat, sigma2 = 1, 1 + step, ... 1 + step steps, and what `isostat compare` says of it.

In its folder: start.data (input of LAMMPS), series.toml (the manifest), the dumps, seconds (processor time of LAMMPS; a series
that has it is not made again), comparison. The environment says which programs: LMP, ISOSTAT."""
import json
import os
import pathlib
import shutil
import subprocess
import sys

here = pathlib.Path(__file__).parent
lammps = os.environ.get("LMP") or shutil.which("lmp") or shutil.which("lmp_serial")
isostat = os.environ.get("ISOSTAT", "build/release/isostat")


def timed(command, **options):
    """Runs a command: its result, and seconds of processor time."""
    before = os.times()
    result = subprocess.run([str(word) for word in command], env={**os.environ, "OMP_NUM_THREADS": "1"}, **options)
    after = os.times()
    return result, after.children_user + after.children_system - before.children_user - before.children_system


def write_input(state, folder, stiffness):
    """LAMMPS wants diameter and density of spheres. The walls are atoms of type 2. Returns variables of in.loading."""
    disks, (width, height) = state["disks"], state["length"]
    n = len(disks)
    rows = [f"{i + 1} 1 {2 * r!r} 1.0 {x!r} {y!r} 0" for i, (x, y, r) in enumerate(disks)]
    rows += [f"{n + 1} 2 1.0 {0.02 * n} {width!r} -2.0 0", f"{n + 2} 2 1.0 {0.02 * n} -2.0 {height!r} 0"]
    (folder / "start.data").write_text(
        f"disks and two walls\n\n{n + 2} atoms\n2 atom types\n\n-4 {2 * width!r} xlo xhi\n-4 {2 * height!r} ylo yhi\n-0.5 0.5 zlo zhi\n\n"
        "Atoms # sphere\n\n" + "\n".join(rows) + "\n")
    (folder / "series.toml").write_text(f"""format = "isostat-series 1"
title = "{n} disks, stiffness {stiffness}"
program = "LAMMPS"
[files]
disks = "disks.dump"
contacts = "contacts.dump"
frames = "frames.csv"
select = "type 1"
[columns]
contact_i = "c_ids[1]"
contact_j = "c_ids[2]"
contact_force = "c_forces"
wall_force = {{left = "f_left[2]", right = "f_right[2]", bottom = "f_bottom[3]", top = "f_top[3]"}}
[law]
kind = "linear"
stiffness = {float(stiffness)}
[load]
kind = "nominal"
sigma1 = 1.0
reference_length = [{width!r}, {height!r}]
""")
    return {"data": folder / "start.data", "n": n, "k": stiffness, "f1": repr(height), "f2": repr(width), "rest": 1e-6, "out": folder}


def series(start, folder, stiffness, drag, step, steps):
    """Makes the series unless it is there. Returns seconds of processor time of LAMMPS."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    variables = write_input(json.load(open(start)), folder, stiffness) | {"drag": drag, "step": step, "steps": steps}
    done = folder / "seconds"
    if not done.exists():
        for dump in folder.glob("*.dump"):
            dump.unlink() # in.loading appends
        words = [word for name, value in variables.items() for word in ("-var", name, value)]
        result, seconds = timed([lammps, "-in", here / "in.loading", "-log", "none", "-screen", folder / "screen", *words])
        if result.returncode != 0:
            sys.exit(f"LAMMPS failed: {folder / 'screen'}")
        done.write_text(f"{seconds:.2f}\n")
    return float(done.read_text())


def compare(start, folder):
    """The words of `isostat compare`; its tables are in DIR/comparison."""
    folder = pathlib.Path(folder)
    result = subprocess.run([isostat, "compare", str(folder / "series.toml"), "-o", str(folder / "comparison"), "--reference", str(start),
                             "--local", "--quiet"], stdout=subprocess.PIPE, text=True)
    if result.returncode > 2:
        sys.exit(result.returncode)
    return result.stdout
