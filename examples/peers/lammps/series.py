#!/usr/bin/env python3
"""From a state of isostat to the input of LAMMPS, and the manifest of the series that LAMMPS writes.

    series.py STATE.json DIR STIFFNESS      writes DIR/start.data, DIR/series.toml; prints n and the wall forces"""
import json
import pathlib
import sys

state, folder, stiffness = json.load(open(sys.argv[1])), pathlib.Path(sys.argv[2]), sys.argv[3]
disks, (width, height) = state["disks"], state["length"]
n = len(disks)
folder.mkdir(parents=True, exist_ok=True)

# Density 1 / (4/3 R^3 pi) would be a mass of 1; LAMMPS wants diameter and density of spheres. The walls are atoms of type 2.
rows = [f"{i + 1} 1 {2 * r!r} 1.0 {x!r} {y!r} 0" for i, (r, x, y) in enumerate(disks)]
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
print(n, repr(height), repr(width))
