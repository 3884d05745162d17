#!/usr/bin/env python3
"""A periodic cell of disks, K times along both axes: a large packing without a preparation, for `scale.py`.

    python3 tests/bench/repeat.py STATE K OUT

In a rectangular cell N = N_f again, and the list is regular unless a mode of the lattice of copies is a mechanism. All copies bear the same
forces: those of one contact tie at the end of the supported interval, which stays undecided."""
import json
import sys


def repeated(state, k):
    n, (width, height) = len(state["disks"]), state["length"]
    whole = {name: state[name] for name in ("format", "version", "dimension", "equilibrium", "walls", "cell")}
    whole["provenance"] = {}
    whole["load"] = state["load"] | {"reference_length": [k * x for x in state["load"]["reference_length"]]}
    whole["length"] = [k * width, k * height]
    copies = [(a, b) for b in range(k) for a in range(k)]
    whole["disks"] = [[x + a * width, y + b * height, r] for a, b in copies for x, y, r in state["disks"]]
    whole["infinitesimal"] = state["infinitesimal"] * k**2
    whole["contacts"] = []
    for a, b in copies:
        for i, j, *image in state["contacts"]:
            to_x, to_y = (a + image[0][0], b + image[0][1]) if image else (a, b)
            i, j, m = (a + k * b) * n + i, (to_x % k + k * (to_y % k)) * n + j, [to_x // k, to_y // k]
            if i > j or (i == j and m < [0, 0]):
                i, j, m = j, i, [-x for x in m]
            whole["contacts"].append([i, j, m] if m != [0, 0] else [i, j])
    return whole


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        packing = json.load(file)
    with open(sys.argv[3], "w", encoding="utf-8") as file:
        json.dump(repeated(packing, int(sys.argv[2])), file)
