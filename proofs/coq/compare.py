#!/usr/bin/env python3
"""Lays what Coq printed (verdict.v) beside the certificate of the program:  python3 compare.py CERT.json VERDICT.log DATA.v [FIRST LINE]

The first line of the log says what was proved; an extracted program says other words than Coq, and prints the same values.
Every number of the file is a double, hence an exact fraction; those that Coq printed are integers times powers of two.
Packing, contacts and loads have to be equal; claims of the file have to follow from what was proved. Exit status 1 and
the first difference otherwise."""
import json
import math
import re
import sys
from fractions import Fraction

CLOSED = "Closed under the global context" # what Print Assumptions says of a theorem without axioms
EXTRACTED = "the extracted check is true"
WALLS = {"left": "Lower {} 0", "bottom": "Lower {} 1", "back": "Lower {} 2", "right": "Upper {} 0", "top": "Upper {} 1", "front": "Upper {} 2"}
AXES = "xyz"


def differ(what):
    sys.exit(f"compare.py: {what}")


def same(what, proved, claimed):
    if isinstance(proved, list) and isinstance(claimed, list) and len(proved) == len(claimed):
        for k, pair in enumerate(zip(proved, claimed)):
            same(f"{what}, number {k}", *pair)
    elif proved != claimed:
        differ(f"{what}: Coq printed {proved}, the certificate has {claimed}")


def printed(log, first):
    """The values after the first line, in the order of verdict.v."""
    head, *values = re.split(r"^     = ", log, flags=re.M)
    same("first line", head.strip(), first)
    result = []
    for value in values:
        text, kind = re.fullmatch(r"(.*?)\n     : (.*?)\n?", value, flags=re.S).groups()
        items = re.sub(r"%Z|[\[\]()]|::", " ", text).split(";") if "[::" in text else [text.replace("%Z", "")]
        items = [" ".join(item.split()) for item in items if item.strip()]
        if "contact" not in kind:
            items = [item == "true" if "bool" in kind else int(item.strip("()")) for item in items]
        result.append(items if kind.startswith("seq") else items[0])
    return result


def name(contact):
    i, j, *image = contact
    periods = image[0] if image else []
    return WALLS[j].format(i) if isinstance(j, str) else " ".join(map(str, ["Image", i, j, *periods, *[0] * (3 - len(periods))]))


def main(certificate_path, log_path, data_path, first=CLOSED):
    with open(data_path, encoding="utf-8") as data:
        for sentence in re.sub(r"\(\*.*?\*\)", " ", data.read(), flags=re.S).split("."):
            if sentence.strip() and not re.match(r"\s+(From (Coq|mathcomp|Isostat) Require Import|Definition|Open Scope) ", f"\n{sentence}"):
                differ(f"{data_path} has more than definitions: {sentence.strip()[:60]}")
    with open(certificate_path, encoding="utf-8") as file:
        certificate = json.load(file)
    with open(log_path, encoding="utf-8") as file:
        values = printed(file.read(), first)
    ((unit, fine, force, small, unit_stress), d, n, contacts, walls, periodic, stored, radii, zoom, distance, ball, load, low, high, zeros, load_small,
     low_small, high_small, gap, rate, loaded, *ends) = values
    state, claims = certificate["state"], certificate["claims"]
    same("formats", [certificate["format"], certificate["version"], state["version"]], ["isostat-certificate", 1, 2])
    known = {"format", "version", "dimension", "equilibrium", "provenance", "load", "walls", "cell", "length", "disks", "fixed",
             "disk_force", "infinitesimal", "contacts", "forces"}
    if set(state) - known:
        differ(f"the state has what Coq was not told of: {sorted(set(state) - known)}")
    same("dimension", d, state["dimension"])
    lengths = [Fraction(x) for x in state["length"]]
    tilts = [(a, b) for b in range(d) for a in range(b)]
    places = [AXES[a] for a in range(d)] + [AXES[a] + AXES[b] for a, b in tilts]
    two = Fraction(2)

    def scaled(numbers, exponent):
        return [x * two**exponent for x in numbers]

    same("number of disks", n, len(state["disks"]))
    cell = state.get("cell", {"axes": ["walls"] * d, "moves": [], "tilt": [0] * len(tilts), "pin": None})
    if set(cell) != {"axes", "moves", "tilt", "pin"} or set(cell["moves"]) - set(places) or set(cell["axes"]) - {"periodic", "walls"}:
        differ(f"this cell is not what Coq was told of: {cell}")
    repeats = [kind == "periodic" for kind in cell["axes"]]
    same("periodic axes", periodic, repeats)
    same("coordinates", scaled(stored, unit), [Fraction(x) for grain in state["disks"] for x in grain[:d]] + lengths + [Fraction(x) for x in cell["tilt"]])
    for (a, b), tilt, moves in zip(tilts, cell["tilt"], places[d:]):
        if not (repeats[a] and repeats[b]) and (tilt != 0 or moves in cell["moves"]):
            differ(f"a tilt {moves} beside walls")
    same("radii", scaled(radii, unit), [Fraction(grain[d]) for grain in state["disks"]])
    lower, upper = state["walls"]["lower"], state["walls"]["upper"]
    if set(state["walls"]) != {"lower", "upper"} or set(lower) - {"fixed", "absent"} or set(upper) - {"fixed", "absent", "movable"}:
        differ(f"these walls are not what Coq was told of: {state['walls']}")
    same("walls", walls, [kind != "absent" for kind in lower + upper])
    if any(repeats[a] and {lower[a], upper[a]} != {"absent"} for a in range(d)) or any(repeats) and state.get("fixed"):
        differ("a cell with a wall on a periodic axis, or with fixed disks")
    movable = [upper[a] == "movable" if a < d and not repeats[a] else place in cell["moves"] for a, place in enumerate(places)]
    held = [d * i + a for i in range(n) for a in range(d) if i in state.get("fixed", []) or (repeats[a] and i == cell["pin"])]
    held += [d * n + a for a in range(len(places)) if not movable[a]]
    same("contacts and what is held", contacts, [name(c) for c in state["contacts"]] + [f"Held {k}" for k in held])
    same("units", zoom * two**fine, two**unit)
    counting, moving = claims["counting"], d * n + len(places) - len(held)
    same("counting", [moving, moving, moving, 0, 0],
         [counting[k] for k in ("dof_count", "contact_count", "rank", "hyperstaticity", "hypostaticity")])
    if distance * two**fine > Fraction(claims["vertex"]["radius"]):
        differ("the radius that is claimed is smaller than what Coq proved")
    if ball * two**unit < Fraction(claims["vertex"]["unique_radius"]):
        differ("uniqueness is claimed further than Coq proved it")

    loads = state["load"]
    same("kind of load", loads["kind"], "nominal")
    if set(loads) - {"kind", "stress", "loaded_axis", "reference_length", "shear", "reference_tilt"}:
        differ(f"the load has what Coq was not told of: {sorted(loads)}")
    disk_force = [Fraction(x) for grain in state.get("disk_force", []) for x in grain] or [Fraction(0)] * (d * n)
    infinitesimal = [Fraction(x) for grain in state["infinitesimal"] for x in grain]
    for a in range(d):
        if repeats[a] and (sum(disk_force[a::d]) != 0 or sum(infinitesimal[a::d]) != 0):
            differ(f"loads on the disks do not cancel along periodic axis {a}")
    reference = [Fraction(x) for x in loads["reference_length"]]
    presses_on = [math.prod(reference[:b] + reference[b + 1:]) for b in [*range(d), *(b for _, b in tilts)]] # lengths of the other axes
    stress = [Fraction(x) for x in loads["stress"] + loads.get("shear", [0] * len(tilts))]
    same("load", scaled(load, force), disk_force + [-stress[a] * presses_on[a] if movable[a] else Fraction(0) for a in range(len(places))])
    same("infinitesimal load", scaled(load_small, small), infinitesimal + [Fraction(0)] * len(places))
    claim = claims["forces"]
    same("structural zeros", [l for l, zero in enumerate(zeros) if zero], claim["structural_zeros"])

    def intervals(proved_low, proved_high, exponent, where, claimed, what="force {}"):
        same(f"number of intervals, {what.format('l')}", len(claimed), len(where))
        for l, (lower, upper) in zip(where, claimed):
            if not Fraction(lower) <= proved_low[l] * two**exponent or not proved_high[l] * two**exponent <= Fraction(upper):
                differ(f"{what.format(l)}: the interval that is claimed is smaller than what Coq proved")

    carrying = [l for l, zero in enumerate(zeros[:len(state["contacts"])]) if not zero]
    same("number of forces", len(zeros), len(claim["finite"]) + len(held))
    intervals(low, high, force, carrying, [claim["finite"][l] for l in carrying])
    intervals(low_small, high_small, small, claim["structural_zeros"], claim["infinitesimal"])
    for l in claim["structural_zeros"]:
        lower, upper = claim["finite"][l]
        if not lower <= 0 <= upper:
            differ(f"force {l} is 0, and the interval that is claimed does not hold it")
    axis = loads["loaded_axis"]
    same("loaded stress", loaded * two**unit_stress, stress[axis])
    same("load per unit of stress", scaled(rate, force - unit_stress),
         [Fraction(0)] * (d * n) + [-presses_on[a] if a == axis and movable[a] else Fraction(0) for a in range(len(places))])
    interval = claims["load_interval"]
    for end, claimed, (opens, between) in (("low", interval["low"], ends[:2]), ("high", interval["high"], ends[2:])):
        same(f"{end} end of the load: what opens", [contacts[l] for l in opens], [] if claimed["unbounded"] else [name(claimed["opens"])])
        if not claimed["unbounded"]:
            intervals([min(between)], [max(between)], unit_stress, [0], [claimed["stress"]], f"{end} end of the load")
    same("claim of stability", claims["stable"], True)
    if gap * two**fine < Fraction(claims["gaps"]["smallest"]):
        differ("a larger gap is claimed than Coq proved")
    print(f"{n} {'disk' if d == 2 else 'sphere'}{'s' if n > 1 else ''}: Coq's packing is that of the certificate; counting, vertex, forces, smallest gap, load interval and stability follow")


if __name__ == "__main__":
    main(*sys.argv[1:])
