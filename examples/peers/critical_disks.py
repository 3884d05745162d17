#!/usr/bin/env python3
"""Critical configurations of hard disks on the hexagonal torus (O. Ericok and others, public repository
burakericok/hard_disk_crits) against the counts of proofs/cells.md:

    python3 examples/peers/critical_disks.py FOLDER       # that holds 2disk.csv ... 12disk.csv

Each is polished with its stress: gaps of the listed contacts 0 at one radius, forces balanced, their sum 1, one Newton
iteration for all. Its index, the number of motions along which the radius grows, is compared with
k - 2 rattlers - 2 (components - 1), k the mechanisms of the fixed cell. Ranks are those of doubles, not proved.
Needs numpy and scipy.
"""

import csv
import itertools
import sys
from pathlib import Path

import numpy as np
from scipy.optimize import nnls

CELL = np.array([[1, 0.5], [0, np.sqrt(0.75)]])
IMAGES = [CELL @ np.array(m) for m in itertools.product(range(-2, 3), repeat=2)]
ROUNDING = 1e-13
REACH = 1e-4  # of the published radius
RANK = (1e-11, 1e-7, 1e-4)  # singular values: zero below the first; the second divides; none between first and third


def separations(x, contacts):
    return np.array([x[j] - x[i] + image for i, j, image in contacts])


def listed_contacts(row, x):
    """As many nearest images of each pair as the file says touch."""
    contacts = []
    for number, (i, j) in enumerate(itertools.combinations(range(len(x)), 2)):
        count = int(float(row[f"contact_graph_{number + 1}"]))
        nearest = sorted(IMAGES, key=lambda image, i=i, j=j: np.linalg.norm(x[j] - x[i] + image))
        contacts += [(i, j, image) for image in nearest[:count]]
    return contacts


def matrix(normals, contacts, disks):
    h = np.zeros((2 * disks, len(contacts)))
    for column, (i, j, _) in enumerate(contacts):
        h[2 * j : 2 * j + 2, column] = normals[column]
        h[2 * i : 2 * i + 2, column] = -normals[column]
    return h


def stiffness(normals, lengths, force, contacts, disks):
    """Derivative of h f with respect to the positions."""
    k = np.zeros((2 * disks, 2 * disks))
    for column, (i, j, _) in enumerate(contacts):
        n = normals[column]
        block = (np.eye(2) - np.outer(n, n)) * force[column] / lengths[column]
        for a, b in itertools.product((i, j), repeat=2):
            k[2 * a : 2 * a + 2, 2 * b : 2 * b + 2] += block if a == b else -block
    return k


def polish(x, radius, contacts):
    """Positions, radius and contact matrix; nothing when Newton's iteration does not end."""
    disks, count = len(x), len(contacts)
    force = None
    for _ in range(60):
        r = separations(x, contacts)
        lengths = np.linalg.norm(r, axis=1)
        normals = r / lengths[:, None]
        h = matrix(normals, contacts, disks)
        if force is None:
            balance = np.vstack([10 * h, np.ones(count)])
            force = nnls(balance, np.concatenate([np.zeros(2 * disks), [1]]))[0]
        residual = np.concatenate([lengths - 2 * radius, h @ force, [force.sum() - 1]])
        if np.abs(residual).max() < ROUNDING:
            return x, radius, h
        jacobian = np.zeros((len(residual), 2 * disks + 1 + count))
        jacobian[:count, : 2 * disks] = h.T
        jacobian[:count, 2 * disks] = -2
        jacobian[count:-1, : 2 * disks] = stiffness(normals, lengths, force, contacts, disks)
        jacobian[count:-1, 2 * disks + 1 :] = h
        jacobian[-1, 2 * disks + 1 :] = 1
        step = np.linalg.lstsq(jacobian, -residual, rcond=1e-11)[0]
        step *= min(1, 0.02 / np.abs(step[: 2 * disks]).max())
        x = x + step[: 2 * disks].reshape(-1, 2)
        radius += step[2 * disks]
        force = force + step[2 * disks + 1 :]
    return None


def overlap(x, radius):
    pairs = itertools.combinations(range(len(x)), 2)
    return max(2 * radius - np.linalg.norm(x[j] - x[i] + image) for i, j in pairs for image in IMAGES)


def counted_index(h, contacts, disks):
    """Nothing when the rank is not clear."""
    values = np.linalg.svd(h, compute_uv=False)
    if np.any((values > RANK[0]) & (values < RANK[2])):
        return None
    mechanisms = 2 * disks - 2 - int((values > RANK[1]).sum())
    group = list(range(disks))
    for i, j, _ in contacts:
        group = [group[j] if g == group[i] else g for g in group]
    touched = {disk for i, j, _ in contacts for disk in (i, j)}
    components = len({group[disk] for disk in touched})
    return mechanisms - 2 * (disks - len(touched)) - 2 * (components - 1)


def main(folder):
    wrong = 0
    print("disks  configurations  polished  index as counted")
    for disks in range(2, 13):
        with (folder / f"{disks}disk.csv").open() as file:
            rows = list(csv.DictReader(file))
        polished = right = 0
        for row in rows:
            x = np.array([float(row[f"coords_{k + 1}"]) for k in range(2 * disks)]).reshape(-1, 2)
            contacts = listed_contacts(row, x)
            done = polish(x, float(row["radius"]), contacts)
            if done is None or abs(done[1] - float(row["radius"])) > REACH or overlap(*done[:2]) > 1e-9:
                continue
            index = counted_index(done[2], contacts, disks)
            polished += index is not None
            right += index == int(row["index"])
        wrong += polished - right
        print(f"{disks:5}  {len(rows):14}  {polished:8}  {right:16}", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
