#!/usr/bin/env python3
"""Makes the reference set anew: packings, certificates, sequences (see README.md):  python3 examples/reference/make.py [PROGRAM]

`isostat` prepares, runs, certifies and verifies; what is written has 30 digits, of a Newton iteration and of linear systems in 60. Every
number must lie in the interval that the certificate proves, or nothing is written."""
import csv
import decimal
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from decimal import Decimal

here = pathlib.Path(__file__).resolve().parent
examples = here.parent
program = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else here.parent.parent / "build/release/isostat").resolve()
decimal.getcontext().prec = 60
lower, upper = ("left", "bottom", "back"), ("right", "top", "front")


def scene(grains=0, seed=1, *, start=None, more="", programme=(), file=None):
    """A scene whose first equilibrium, or whose whole path, is a case."""
    packing = f'file = "{file}"' if file else f"{start or 'disks'} = {grains}\nseed = {seed}"
    steps = "".join(f"[[programme]]\n{step}\n" for step in programme) or '[[programme]]\ndo = "up"\nequilibria = 1\n'
    return f"[packing]\n{packing}\n{more}\n{steps}[output]\npictures = false\nstates_every = 1\n"


def loading(count):
    return [f'do = "up"\nequilibria = {count}']


def nearly_tied(folder):
    state = json.loads((examples / "ties/two-forces.json").read_text())
    state["disk_force"][1][1] += 2.0**-30
    (folder / "state.json").write_text(json.dumps(state))
    return folder / "state.json"


tilted, rectangle = '[cell]\nkind = "tilted"', '[cell]\nkind = "rectangular"'
# name: (what it is, scene or file of a state, whether the path is part of it)
cases = {
    **{f"box-{n}-{seed}": (f"{n} disks in a box, diameters uniform in [1, 2], seed {seed}", scene(n, seed), False)
       for n, seed in ((10, 1), (10, 2), (20, 1), (20, 2), (30, 1), (30, 2), (50, 1), (100, 1))},
    **{f"path-{n}-{seed}": (f"{n} disks in a box, sigma2 raised over {count} equilibria, seed {seed}",
                            scene(n, seed, programme=loading(count)), True)
       for n, seed, count in ((20, 3, 5), (30, 3, 5), (50, 2, 5))},
    "wide-20": ("20 disks, diameters in [1, 8]", scene(20, 1, more="diameters = [1.0, 8.0]"), False),
    "wide-30": ("30 disks, diameters in [1, 20]: small ones among large ones", scene(30, 2, more="diameters = [1.0, 20.0]"), False),
    "equal-20": ("20 disks whose diameters differ by 1e-6: nearly a lattice in places, so nearly degenerate",
                 scene(20, 1, more="diameters = [1.0, 1.000001]"), False),
    "equal-30": ("30 disks whose diameters differ by 1e-4", scene(30, 1, more="diameters = [1.0, 1.0001]"), False),
    "tilted-12": ("12 disks in a cell whose periods and tilt move", scene(12, 1, more=tilted), False),
    "tilted-20": ("20 disks in such a cell", scene(20, 2, more=tilted), False),
    "tilted-30-path": ("30 disks in such a cell, sigma2 raised over 4 equilibria", scene(30, 1, more=tilted, programme=loading(4)), True),
    "rectangle-12": ("12 disks in a periodic rectangle", scene(12, 1, more=rectangle), False),
    "rectangle-30": ("30 disks in a periodic rectangle", scene(30, 2, more=rectangle), False),
    "rectangle-20-path": ("20 disks in a periodic rectangle, sigma2 raised over 4 equilibria",
                          scene(20, 1, more=rectangle, programme=loading(4)), True),
    "tie-forces": ("three disks: two forces vanish at one load", examples / "ties/two-forces.json", False),
    "near-tie": ("the same with one weight larger by 2^-30: one force vanishes a little before the other", nearly_tied, False),
    "turn": ("four disks before a power turn", examples / "turns/four-disks.json", False),
    "sphere-tetrahedron": ("four spheres, closed form: the load is supported from 2/5 to 2", examples / "spheres/tetrahedron.json", False),
    "sphere-box-30": ("30 spheres in a box", examples / "spheres/box-30.json", False),
    "sphere-cell-30": ("30 spheres in a triclinic cell", examples / "spheres/cell-30.json", False),
    "sphere-box-12": ("12 spheres in a box", scene(12, 1, start="spheres"), False),
    "sphere-box-20-path": ("20 spheres in a box, sigma3 raised over 4 equilibria",
                           scene(20, 1, start="spheres", programme=loading(4)), True),
    "sphere-cell-16": ("16 spheres in an orthorhombic cell", scene(16, 1, start="spheres", more='[cell]\nkind = "orthorhombic"'), False),
}


def run(*arguments, statuses=(0,)):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode not in statuses:
        sys.exit(f"isostat {' '.join(map(str, arguments))}: status {done.returncode}: {done.stderr}")
    return done.stdout


def exact(value):
    """The number that a file says: a double, as it is stored."""
    return Decimal(float.fromhex(value)) if isinstance(value, str) and "0x" in value else Decimal(float(value))


class Geometry:
    """Gaps, their gradients and the load of a state, in decimal numbers."""

    def __init__(self, state):
        self.state, self.axes = state, state.get("dimension", 2)
        first = state["version"] == 1
        rows = [[exact(value) for value in row] for row in state["disks"]]
        self.radius = [row[0] if first else row[-1] for row in rows]
        self.n = len(rows)
        self.q = [value for row in rows for value in (row[1:] if first else row[:-1])]
        self.q += [exact(value) for value in state["length"]]
        self.cell = state.get("cell") or {}
        repeats = [axis == "periodic" for axis in self.cell.get("axes", ["walls"] * self.axes)]
        self.repeats = repeats
        self.tilts = [(0, 1)] if self.axes == 2 else [(0, 1), (0, 2), (1, 2)]
        tilt = self.cell.get("tilt", [0] * len(self.tilts))
        self.q += [exact(value) for value in tilt] if any(repeats) else []
        walls = state.get("walls", {})
        self.upper = walls.get("upper", ["movable"] * self.axes)
        moves = self.cell.get("moves", [])
        if "scale" in moves:
            sys.exit("an isotropic cell: not here")
        fixed, pin = set(state.get("fixed", [])), self.cell.get("pin", 0)
        self.dofs = [self.axes * i + a for i in range(self.n) for a in range(self.axes)
                     if i not in fixed and not (repeats[a] and i == pin)]
        self.dofs += [self.length_at(a) for a in range(self.axes)
                      if ("xyz"[a] in moves if repeats[a] else self.upper[a] == "movable")]
        self.dofs += [self.tilt_at(k) for k, (a, b) in enumerate(self.tilts) if "xyz"[a] + "xyz"[b] in moves]
        self.place = {coordinate: row for row, coordinate in enumerate(self.dofs)}
        self.contacts = [tuple(contact) for contact in state["contacts"]]

    def length_at(self, axis):
        return self.axes * self.n + axis

    def tilt_at(self, tilt):
        return self.length_at(self.axes) + tilt

    def lattice(self, a, b):
        return self.q[self.length_at(a)] if a == b else self.q[self.tilt_at(self.tilts.index((a, b)))]

    def gap(self, contact):
        """The gap of a contact and its gradient by coordinate."""
        i, j, *image = contact
        if isinstance(j, str):
            axis = (lower if j in lower else upper).index(j)
            k = self.axes * i + axis
            if j in lower:
                return self.q[k] - self.radius[i], {k: Decimal(1)}
            return self.q[self.length_at(axis)] - self.q[k] - self.radius[i], {k: Decimal(-1), self.length_at(axis): Decimal(1)}
        m = image[0] if image else [0] * self.axes
        r = [self.q[self.axes * j + a] - self.q[self.axes * i + a] + sum(m[b] * self.lattice(a, b) for b in range(a, self.axes) if m[b])
             for a in range(self.axes)]
        distance = sum(x * x for x in r).sqrt()
        gradient = {}

        def add(coordinate, value):
            gradient[coordinate] = gradient.get(coordinate, Decimal(0)) + value

        for a in range(self.axes):
            unit = r[a] / distance
            add(self.axes * j + a, unit)
            add(self.axes * i + a, -unit)
            for b in range(a, self.axes):
                if m[b]:
                    add(self.length_at(a) if a == b else self.tilt_at(self.tilts.index((a, b))), m[b] * unit)
        return distance - self.radius[i] - self.radius[j], gradient

    def rows(self):
        """Gaps, and the matrix whose row is the gradient of a contact."""
        gaps, matrix = [], []
        for contact in self.contacts:
            gap, gradient = self.gap(contact)
            row = [Decimal(0)] * len(self.dofs)
            for coordinate, value in gradient.items():
                if coordinate in self.place:
                    row[self.place[coordinate]] += value
            gaps.append(gap)
            matrix.append(row)
        return gaps, matrix

    def loads(self):
        """External force on the degrees of freedom at loaded stress 0, and its derivative. Nominal stresses."""
        load = self.state.get("load", {})
        if load.get("kind", "nominal") != "nominal" or "path" in load:
            sys.exit("expected nominal stresses on single axes")
        stress = [exact(value) for value in load.get("stress", [1] * self.axes)]
        reference = [exact(value) for value in load.get("reference_length", self.state["length"])]
        shear = [exact(value) for value in load.get("shear", [0] * len(self.tilts))]
        loaded = load.get("loaded_axis", self.axes - 1)
        fixed, unit = [Decimal(0)] * len(self.q), [Decimal(0)] * len(self.q)
        force = [exact(value) for row in self.state.get("disk_force", []) for value in row]
        fixed[:len(force)] = force

        def area(left_out):
            product = Decimal(1)
            for axis in range(self.axes):
                product *= 1 if axis == left_out else reference[axis]
            return product

        for place in range(self.axes + len(self.tilts)):
            tilt = place - self.axes
            coordinate = self.length_at(place) if tilt < 0 else self.tilt_at(tilt)
            if coordinate in self.place:
                pressed = area(place if tilt < 0 else self.tilts[tilt][1])
                if place == loaded:
                    unit[coordinate] -= pressed
                else:
                    fixed[coordinate] -= pressed * (stress[place] if tilt < 0 else shear[tilt])
        self.stress = stress[loaded] if loaded < self.axes else shear[loaded - self.axes]
        return [fixed[k] for k in self.dofs], [unit[k] for k in self.dofs]


def solved(matrix, sides):
    """Solutions for each right-hand side; Gauss with the largest pivot of a column."""
    rows = [list(row) + [side[k] for side in sides] for k, row in enumerate(matrix)]
    size = len(rows)
    for column in range(size):
        pivot = max(range(column, size), key=lambda k: abs(rows[k][column]))
        rows[column], rows[pivot] = rows[pivot], rows[column]
        top = rows[column]
        inverse = 1 / top[column]
        filled = [k for k in range(column, len(top)) if top[k]]
        for row in rows[column + 1:]:
            if row[column]:
                factor = row[column] * inverse
                for k in filled:
                    row[k] -= factor * top[k]
    out = []
    for side in range(len(sides)):
        x = [Decimal(0)] * size
        for k in reversed(range(size)):
            x[k] = (rows[k][size + side] - sum(rows[k][c] * x[c] for c in range(k + 1, size) if rows[k][c])) / rows[k][k]
        out.append(x)
    return out


def vertex(state):
    """The geometry at the true vertex, and the forces f0 + sigma f1 there."""
    at = Geometry(state)
    if len(at.contacts) != len(at.dofs):
        sys.exit(f"N = {len(at.contacts)}, N_f = {len(at.dofs)}: expected an isostatic state")
    for _ in range(8):
        gaps, matrix = at.rows()
        (step,) = solved(matrix, [[-gap for gap in gaps]])
        for coordinate, move in zip(at.dofs, step):
            at.q[coordinate] += move
        if max(map(abs, step)) < Decimal("1e-45"):
            break
    else:
        sys.exit("Newton's iteration does not end")
    _, matrix = at.rows()
    fixed, unit = at.loads()
    # F + sum f dh = 0: a force pushes its gap open.
    transposed = [list(column) for column in zip(*matrix)]
    f0, f1 = solved(transposed, [[-x for x in fixed], [-x for x in unit]])
    small = Decimal("1e-40") * max(map(abs, f0 + f1))
    return at, [Decimal(0) if abs(x) < small else x for x in f0], [Decimal(0) if abs(x) < small else x for x in f1]


def short(value):
    """30 digits, plainly written."""
    text = format(decimal.Context(prec=30).create_decimal(value).normalize(), "f")
    return text if "e" not in text.lower() and len(text) < 48 else str(decimal.Context(prec=30).create_decimal(value))


def name_of(contact):
    i, j, *image = contact
    return f"{i}-{j}" + (f"({','.join(map(str, image[0]))})" if image and any(image[0]) else "")


def interval(at, f0, f1):
    """Ends of the range of the loaded stress, and the contacts that open there: several where their forces vanish at one load."""
    ends = {-1: [], 1: []}
    for contact, a, b in zip(at.contacts, f0, f1):
        if b:
            ends[1 if b < 0 else -1].append((-a / b, name_of(contact)))
    low = max((end for end, _ in ends[-1]), default=None)
    high = min((end for end, _ in ends[1]), default=None)
    same = Decimal("1e-38")
    opens = [sorted(name for end, name in ends[side] if known is not None and abs(end - known) <= same * abs(known or 1))
             for side, known in ((-1, low), (1, high))]
    return low, high, opens


def check(at, forces, low, high, certificate, name):
    """Every number is where the certificate proves it to be."""
    claims = certificate["claims"]
    inside = lambda value, ends: exact(ends[0]) <= value <= exact(ends[1])
    stored = Geometry(certificate["state"])
    radius = exact(claims["vertex"]["radius"])
    assert all(abs(a - b) <= radius for a, b in zip(at.q, stored.q)), name
    for force, ends in zip(forces, claims["forces"]["finite"]):
        assert inside(force, ends), (name, force, ends)
    for key, value in (("low", low), ("high", high)) if claims["load_interval"] else ():
        end = claims["load_interval"][key]
        if value is None:
            assert end.get("unbounded"), (name, key)
        else:
            assert inside(value, end["stress"]), (name, key, value, end)


def case_of(name, what, state, certificate):
    at, f0, f1 = vertex(state)
    forces = [a + at.stress * b for a, b in zip(f0, f1)]
    low, high, opens = interval(at, f0, f1)
    check(at, forces, low, high, certificate, name)
    d = at.axes
    case = {
        "name": name, "what": what, "dimension": d, "grains": at.n, "N_f": len(at.dofs), "N": len(at.contacts), "h": 0, "k": 0,
        "radii": [short(r) for r in at.radius],
        "positions": [[short(x) for x in at.q[d * i:d * i + d]] for i in range(at.n)],
        "length": [short(at.q[at.length_at(a)]) for a in range(d)],
        "walls": state.get("walls", {"lower": ["fixed"] * d, "upper": ["movable"] * d}),
        "fixed": state.get("fixed", []),
        "cell": {**at.cell, "tilt": [short(at.q[at.tilt_at(k)]) for k in range(len(at.tilts))]} if at.cell else None,
        "load_kind": "nominal",
        "stress": [short(exact(x)) for x in state.get("load", {}).get("stress", [1] * d)],
        "reference_length": [short(exact(x)) for x in state.get("load", {}).get("reference_length", state["length"])],
        "disk_force": [[short(exact(x)) for x in row] for row in state.get("disk_force", [])],
        "loaded_axis": state.get("load", {}).get("loaded_axis", d - 1), "load": short(at.stress),
        "forces": {name_of(contact): short(force) for contact, force in zip(at.contacts, forces)},
        "rattlers": [i for i in range(at.n) if not any(force and i in contact[:2] for contact, force in zip(at.contacts, forces))],
        "interval": [None if end is None else short(end) for end in (low, high)], "opens": opens,
        "not_certified": certificate["claims"].get("undecided", []),
    }
    return case, at, forces


def write_csv(path, rows):
    with open(path, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)


def contact_rows(at, forces):
    image = ["mx", "my", "mz"][:at.axes]
    yield ["i", "j", *image, "force"]
    for (i, j, *m), force in zip(at.contacts, forces):
        yield [i, j, *(m[0] if m else [0] * at.axes), short(force)]


def make(name, scratch, out):
    what, source, path = cases[name]
    folder = scratch / name
    folder.mkdir()
    if not isinstance(source, str):
        states = [source(folder) if callable(source) else source]
    else:
        (folder / "scene.toml").write_text(source)
        run("run", folder / "scene.toml", "-o", folder / "out", "--quiet", statuses=(0, 1, 2))
        states = sorted((folder / "out/states").glob("eq_*.json"))[: None if path else 1]
    steps = [["structure", "load", "opens", "gained", "lost"]]
    before = set()
    for number, path_of_state in enumerate(states):
        state = json.loads(path_of_state.read_text())
        state.pop("provenance", None)  # it names folders of this computer
        file = folder / f"{name}.json"
        file.write_text(json.dumps(state))
        certificate_file = folder / f"{number}.cert.json"
        tie = (0, 2) if name.startswith("tie") else (0,)  # which force vanishes first is not decided there: it is neither
        run("certify", file, "-o", certificate_file, statuses=tie)
        run("verify", certificate_file, statuses=tie)
        certificate = json.loads(certificate_file.read_text())
        case, at, forces = case_of(name, what, certificate["state"], certificate)
        if number == 0:
            first = case
            write_csv(out / "packings" / f"{name}.csv", contact_rows(at, forces))
            shutil.copy(certificate_file, out / "certificates" / f"{name}.cert.json")
        carrying = {contact for contact, force in case["forces"].items() if Decimal(force)}
        gained, lost = carrying - before, before - carrying
        steps.append([number, case["interval"][1], " or ".join(case["opens"][1]), *(" ".join(sorted(x)) if number else "" for x in (gained, lost))])
        before = carrying
    if path:
        first["sequence"] = f"sequences/{name}.csv"
        write_csv(out / "sequences" / f"{name}.csv", steps)
    text = re.sub(r"\[[^][{}]*\]", lambda row: re.sub(r"\s*\n\s*", " ", row[0]), json.dumps(first, indent=1))  # a row a line
    (out / "packings" / f"{name}.json").write_text(text + "\n")
    return [name, what, first["dimension"], first["grains"], first["N_f"], len(first["rattlers"]), len(steps) - 1 if path else 0]


def main():
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        for kind in ("packings", "certificates", "sequences"):
            (out / kind).mkdir(parents=True)
        rows = [["name", "what", "dimension", "grains", "N_f", "rattlers", "structures"]]
        for name in cases:
            rows.append(make(name, pathlib.Path(folder), out))
            print(*rows[-1])
        write_csv(out / "cases.csv", rows)
        for kind in ("packings", "certificates", "sequences"):
            shutil.rmtree(here / kind, ignore_errors=True)
            shutil.copytree(out / kind, here / kind)
        shutil.copy(out / "cases.csv", here)
    size = sum(path.stat().st_size for path in here.rglob("*") if path.is_file())
    print(f"{len(cases)} cases, {size / 1e6:.2f} MB")
    if size > 3e6:
        sys.exit("more than 3 MB")


if __name__ == "__main__":
    main()
