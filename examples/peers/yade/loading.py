"""A series of YADE from an equilibrium of isostat, written as `isostat compare` reads it.

    yade -n -x loading.py STATE.json DIR STIFFNESS DAMPING STEP STEPS      sigma2 = 1, 1 + STEP, ... 1 + STEP STEPS

Disks are spheres that stay in the plane, without friction; every contact has the same stiffness. The right and the top wall have a mass and
bear constant forces. At each load the run goes on until the forces left are 1e-6 of a mean force, or for 400 000 steps."""
import json
import math
import pathlib
import sys

from yade import (Bo1_Sphere_Aabb, Bo1_Wall_Aabb, ForceResetter, FrictMat, Ig2_Sphere_Sphere_ScGeom, Ig2_Wall_Sphere_ScGeom,
                  InsertionSortCollider, InteractionLoop, Ip2_FrictMat_FrictMat_FrictPhys, Law2_ScGeom_FrictPhys_CundallStrack, MatchMaker,
                  NewtonIntegrator, O, PyRunner, utils)

state = json.loads(pathlib.Path(sys.argv[1]).read_text())
folder = pathlib.Path(sys.argv[2])
stiffness, damping, step, steps = float(sys.argv[3]), float(sys.argv[4]), float(sys.argv[5]), int(sys.argv[6])
folder.mkdir(parents=True, exist_ok=True)
disks, (width, height) = state["disks"], state["length"]
n = len(disks)
rest, longest = 1e-6, 400_000

material = O.materials.append(FrictMat(young=1, poisson=0.3, frictionAngle=0, density=1))
for x, y, r in disks if state["version"] > 1 else [(x, y, r) for r, x, y in disks]:
    body = O.bodies[O.bodies.append(utils.sphere((x, y, 0), r, material=material))]
    body.state.blockedDOFs = "zXYZ"
mass = max(body.state.mass for body in O.bodies)
names = ("left", "bottom", "right", "top")
places = {"left": (0, 0), "bottom": (0, 1), "right": (width, 0), "top": (height, 1)}
walls = {name: O.bodies.append(utils.wall(at, axis, material=material)) for name, (at, axis) in places.items()}
load = {"right": height, "top": width}


def push():
    """The movable walls: forces of the grains against the load, with drag."""
    for axis, name in enumerate(("right", "top")):
        velocity = O.bodies[walls[name]].state.vel
        velocity[axis] = (1 - damping / 60) * (velocity[axis] + O.dt * (O.forces.f(walls[name])[axis] - load[name]) / (20 * mass))
        O.bodies[walls[name]].state.vel = velocity


O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=0.05),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
                    [Ip2_FrictMat_FrictMat_FrictPhys(kn=MatchMaker(algo="val", val=stiffness), ks=MatchMaker(algo="val", val=stiffness))],
                    [Law2_ScGeom_FrictPhys_CundallStrack()]),
    NewtonIntegrator(damping=damping),
    PyRunner(command="push()", iterPeriod=1),
]
O.dt = 0.2 * math.sqrt(min(body.state.mass for body in O.bodies if body.id < n) / stiffness)


def contacts():
    return [(i.id1, i.id2, i.phys.normalForce.norm()) for i in O.interactions if i.isReal and i.geom.penetrationDepth > 0]


def left_over():
    """The largest force left on a disk or a movable wall, in mean forces."""
    listed = contacts()
    mean = sum(force for _, _, force in listed) / max(1, len(listed))
    left = [O.forces.f(i).norm() for i in range(n)]
    left += [abs(O.forces.f(walls[name])[axis] - load[name]) for axis, name in enumerate(("right", "top"))]
    return max(left) / mean if mean > 0 else math.inf


def write(frame, sigma2):
    on_walls = {name: {} for name in names}
    rows = []
    for i, j, force in contacts():
        wall = next((name for name in names if walls[name] in (i, j)), None)
        if wall:
            on_walls[wall][min(i, j)] = force if wall in ("left", "bottom") else -force
        else:
            rows.append(f"{i + 1} {j + 1} {force!r}")
    header = f"ITEM: TIMESTEP\n{frame}\nITEM: NUMBER OF {{}}\n{{}}\nITEM: BOX BOUNDS ff ff pp\n0 {2 * width}\n0 {2 * height}\n-1 1\n"
    with open(folder / "disks.dump", "a") as file:
        file.write(header.format("ATOMS", n) + "ITEM: ATOMS id radius x y " + " ".join(names) + "\n")
        for i in range(n):
            x, y, _ = O.bodies[i].state.pos
            file.write(f"{i + 1} {O.bodies[i].shape.radius!r} {x!r} {y!r} " + " ".join(repr(on_walls[w].get(i, 0.0)) for w in names) + "\n")
    with open(folder / "contacts.dump", "a") as file:
        file.write(header.format("ENTRIES", len(rows)) + "ITEM: ENTRIES i j force\n" + "".join(row + "\n" for row in rows))
    with open(folder / "frames.csv", "a") as file:
        at = [O.bodies[walls[name]].state.pos[places[name][1]] for name in names]
        file.write(f"{frame},{sigma2!r}," + ",".join(map(repr, at)) + "\n")


for name in ("disks.dump", "contacts.dump"):
    (folder / name).write_text("")
(folder / "frames.csv").write_text("timestep,sigma2," + ",".join(names) + "\n")
(folder / "series.toml").write_text(f"""format = "isostat-series 1"
title = "{n} disks, stiffness {stiffness:g}"
program = "YADE"
[files]
disks = "disks.dump"
contacts = "contacts.dump"
frames = "frames.csv"
[columns]
contact_i = "i"
contact_j = "j"
contact_force = "force"
wall_force = {{left = "left", right = "right", bottom = "bottom", top = "top"}}
[law]
kind = "linear"
stiffness = {stiffness}
[load]
kind = "nominal"
sigma1 = 1.0
reference_length = [{width!r}, {height!r}]
""")
for k in range(steps + 1):
    sigma2 = 1 + k * step
    load["top"] = sigma2 * width
    begin = O.iter
    O.run(2000, True)
    while left_over() > rest and O.iter - begin < longest:
        O.run(2000, True)
    print(f"sigma2 = {sigma2:g}: {O.iter - begin} steps, forces left {left_over():.1e}", flush=True)
    write(k, sigma2)
