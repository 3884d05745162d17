#!/usr/bin/env python3
"""A series of frames of soft grains made from the equilibria of a run, to measure what `isostat compare` costs.

    soft_series.py RUN DIR STIFFNESS      RUN with states_every = 1; writes DIR/series.toml and its files

Each stored equilibrium becomes one frame, in the middle of its interval: Newton's method moves the grains until every contact that carries
a force f has the gap -f / STIFFNESS. Needs the Python module. Not frames of a soft trajectory: those come from LAMMPS (examples/peers/lammps)."""
import pathlib
import sys

import isostat
import numpy as np
from scipy.sparse.linalg import splu


def gaps(state, q, contacts):
    n = len(state.radii)
    x, y = q[: 2 * n : 2], q[1 : 2 * n : 2]
    i, j = contacts[:, 0], contacts[:, 1]
    out = np.hypot(x[i] - x[j], y[i] - y[j]) - state.radii[i] - state.radii[j]
    for wall, value in {-1: x, -2: y, -3: q[2 * n] - x, -4: q[2 * n + 1] - y}.items():
        at = j == wall
        out[at] = (value - state.radii)[i[at]]
    return out


def soften(state, stress, stiffness):
    """Coordinates and forces; rattlers (contacts without force) stay 1e-7 away."""
    loaded = state.with_stress(stress)
    forces = isostat.inspect(loaded).forces
    contacts = np.asarray(state.contacts)
    slopes = splu(isostat.contact_matrix(state).T.tocsc())
    q = np.concatenate([np.asarray(state.positions).ravel(), state.length])
    wanted = np.where(forces > 0, -forces / stiffness, 1e-7)
    for _ in range(4):
        q += slopes.solve(gaps(state, q, contacts) - wanted)
    overlap = -gaps(state, q, contacts)
    return q, contacts, np.where(overlap > 0, stiffness * overlap, 0)


def main():
    run, folder, stiffness = isostat.load(sys.argv[1]), pathlib.Path(sys.argv[2]), float(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    reference = run.states[0].reference_length
    with (folder / "disks.dump").open("w") as disks, (folder / "contacts.dump").open("w") as pairs, \
            (folder / "frames.csv").open("w") as table:
        table.write("timestep,left,bottom,right,top,sigma2\n")
        for k in run.states:
            row = run.equilibria[k]
            sigma = float((row["sigma2"] + row["sigma2_high"]) / 2)
            state = run.states[k]
            q, contacts, forces = soften(state, [1.0, sigma], stiffness)
            n = len(state.radii)
            table.write(f"{k},0,0,{q[2 * n]!r},{q[2 * n + 1]!r},{sigma!r}\n")
            header = f"ITEM: TIMESTEP\n{k}\nITEM: NUMBER OF {{}}\n{{}}\nITEM: BOX BOUNDS ff ff pp\n-1 {q[2 * n] + 1}\n-1 {q[2 * n + 1] + 1}\n-1 1\n"
            walls = np.zeros((n, 4))
            for (i, j), f in zip(contacts, forces):
                if j < 0:
                    walls[i, -1 - j] = f if j > -3 else -f
            disks.write(header.format("ATOMS", n) + "ITEM: ATOMS id radius x y left bottom right top\n")
            for i in range(n):
                numbers = [state.radii[i], q[2 * i], q[2 * i + 1], *walls[i]]
                disks.write(f"{i} " + " ".join(repr(float(v)) for v in numbers) + "\n")
            listed = [(i, j, f) for (i, j), f in zip(contacts, forces) if j >= 0 and f > 0]
            pairs.write(header.format("ENTRIES", len(listed)) + "ITEM: ENTRIES i j force\n")
            pairs.writelines(f"{i} {j} {float(f)!r}\n" for i, j, f in listed)
    (folder / "series.toml").write_text(f"""format = "isostat-series 1"
title = "{n} disks from a run"
[files]
disks = "disks.dump"
contacts = "contacts.dump"
frames = "frames.csv"
[columns]
contact_i = "i"
contact_j = "j"
contact_force = "force"
wall_force = {{left = "left", bottom = "bottom", right = "right", top = "top"}}
[law]
kind = "linear"
stiffness = {stiffness!r}
[load]
kind = "nominal"
sigma1 = 1.0
reference_length = [{float(reference[0])!r}, {float(reference[1])!r}]
""")


if __name__ == "__main__":
    main()
