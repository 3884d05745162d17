"""Unions of disks, and convex bodies bounded by arcs, in a box: gaps, their first and second derivatives, equilibria of rigid bodies, and what is counted of them.

A body has the coordinates (X, Y, angle); the lengths L_x, L_y of the box are the last two. A contact is a pair (i, j) of members, i < j,
or (i, -1 - w) with w the position in WALLS. Where G is the matrix of the gaps' derivatives, an equilibrium is a place where the gaps of
its contacts are 0 and G^T f = dW/dq, W the potential of the load on L_x and L_y. Everything is in double precision."""
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
Indices = NDArray[np.int64]

WALLS = ("left", "bottom", "right", "top")
OUTWARD = np.array([[-1.0, 0.0], [0.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
LEAST_FORCE = 1e-6  # of the force on a wall: smaller ones are overlaps by rounding
LEAST_GAP = 1e-9  # of pairs that are no contacts


class Failed(Exception):
    """A packing, or a file, that cannot be used; the reason in words."""


def turned(vectors: Matrix) -> Matrix:
    """The vectors turned by a right angle."""
    return np.stack([-vectors[:, 1], vectors[:, 0]], axis=1)


@dataclass
class Clumps:
    """Bodies: member k is a disk of radius[k] at place[k] in the frame of body[k]. The members of a ring, counterclockwise, are the circles
    of arcs that bound a body; two neighbours touch from within, where the arcs meet."""

    body: Indices
    place: Matrix
    radius: Vector
    rings: list[list[int]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.count = int(self.body[-1]) + 1
        self.middle, self.half = np.zeros(len(self.body)), np.full(len(self.body), np.inf)  # of the sectors of normals
        for ring in self.rings:
            ends = np.roll(ring, -1)
            joint = (self.place[ring] - self.place[ends]) * np.sign(self.radius[ends] - self.radius[ring])[:, None]
            end = np.unwrap(np.arctan2(joint[:, 1], joint[:, 0]))
            self.half[ring] = (end - np.roll(end, 1)) % (2 * np.pi) / 2
            self.middle[ring] = end - self.half[ring]
        first, second = np.triu_indices(len(self.body), 1)
        others = self.body[first] != self.body[second]
        walls = [(i, -1 - w) for i in range(len(self.body)) for w in range(4)]
        self.candidates = np.concatenate([np.stack([first[others], second[others]], axis=1), np.array(walls)])
        self.load = np.zeros(3 * self.count + 2)
        self.load[-2:] = 1

    def arms(self, q: Vector) -> Matrix:
        """From the origin of a body to its members."""
        angle = q[2 : 3 * self.count : 3][self.body]
        cos, sin = np.cos(angle), np.sin(angle)
        x, y = self.place.T
        return np.stack([cos * x - sin * y, sin * x + cos * y], axis=1)

    def centres(self, q: Vector) -> Matrix:
        return q[: 3 * self.count].reshape(-1, 3)[self.body, :2] + self.arms(q)

    def gaps(self, q: Vector, contacts: Indices) -> tuple[Vector, Matrix, Vector]:
        """Gaps, unit normals from the first to the second, and 1/distance of the centres (0 for walls)."""
        centre, (i, j) = self.centres(q), contacts.T
        wall = j < 0
        other = np.maximum(j, 0)
        between = centre[other] - centre[i]
        distance = np.where(wall, 1, np.hypot(between[:, 0], between[:, 1]))
        outward = OUTWARD[np.where(wall, -1 - j, 0)]
        normal = np.where(wall[:, None], outward, between / distance[:, None])
        reach = np.maximum(outward @ np.diag(q[-2:]), 0).sum(axis=1) - (outward * centre[i]).sum(axis=1)
        gap = np.where(wall, reach, distance - self.radius[other]) - self.radius[i]
        return gap, normal, np.where(wall, 0, 1 / distance)

    def distances(self, q: Vector) -> Vector:
        """Gaps of the candidates. Of two bodies bounded by arcs, or of one and a wall, that of the members whose normals are in their
        sectors, the largest one if there are several; all others are infinite."""
        gap, normal, _ = self.gaps(q, self.candidates)
        if not self.rings:
            return gap
        angle = q[2 : 3 * self.count : 3][self.body]

        def faces(member: Indices, n: Matrix) -> NDArray[np.bool_]:
            off = np.arctan2(n[:, 1], n[:, 0]) - angle[member] - self.middle[member]
            return abs((off + np.pi) % (2 * np.pi) - np.pi) <= self.half[member] + 1e-9

        i, j = self.candidates.T
        facing = faces(i, normal) & ((j < 0) | faces(np.maximum(j, 0), -normal))
        key = np.where(j < 0, self.count + j + 4, self.body[np.maximum(j, 0)]) + (self.count + 4) * self.body[i]
        union = ~np.isin(np.arange(len(self.body)), np.concatenate(self.rings).astype(int))
        alone = union[i] & ((j < 0) | union[np.maximum(j, 0)])
        key = np.where(alone, -1 - np.arange(len(key)), key)
        order = np.lexsort((-gap, ~facing, key))
        first = order[np.unique(key[order], return_index=True)[1]]
        distance = np.full(len(gap), np.inf)
        distance[first] = np.where(facing[first], gap[first], np.inf)
        return distance

    def rows(self, q: Vector, contacts: Indices, direction: Matrix) -> Matrix:
        """The component of the relative velocity of each contact along its direction, as rows over the coordinates."""
        matrix, swing, lines = np.zeros((len(contacts), len(q))), turned(self.arms(q)), np.arange(len(contacts))
        for side, sign in ((0, -1), (1, 1)):
            member = contacts[:, side]
            there = member >= 0
            at, line, along = 3 * self.body[member[there]], lines[there], sign * direction[there]
            matrix[line, at] += along[:, 0]
            matrix[line, at + 1] += along[:, 1]
            matrix[line, at + 2] += (along * swing[member[there]]).sum(axis=1)
        upper = contacts[:, 1] <= -3
        matrix[lines[upper], 3 * self.count - 3 - contacts[upper, 1]] = 1
        return matrix

    def second(self, q: Vector, contacts: Indices, force: Vector) -> Matrix:
        """The second derivatives of sum force gap: the second variation of W is minus this form."""
        _, normal, curvature = self.gaps(q, contacts)
        along = self.rows(q, contacts, turned(normal))
        form = along.T @ ((force * curvature)[:, None] * along)
        for side, sign in ((0, 1), (1, -1)):
            there = contacts[:, side] >= 0
            member = contacts[there, side]
            lever = (normal[there] * self.arms(q)[member]).sum(axis=1)
            angle = 3 * self.body[member] + 2
            np.add.at(form, (angle, angle), sign * force[there] * lever)
        return form


def closed(clumps: Clumps, q: Vector, contacts: Indices, force: Vector) -> tuple[Vector, Vector]:
    """Newton's method for G^T f = dW/dq, gap = 0. Motions that change nothing (a body that bears no force, or is held through one
    member) make the system singular: the shortest step solves it."""
    size = len(q)
    for _ in range(40):
        gap, normal, _ = clumps.gaps(q, contacts)
        rows = clumps.rows(q, contacts, normal)
        rest = np.concatenate([clumps.load - rows.T @ force, -gap])
        system = np.block([[clumps.second(q, contacts, force), rows.T], [rows, np.zeros((len(contacts), len(contacts)))]])
        step = np.linalg.lstsq(system, rest, rcond=1e-10)[0]
        if not abs(step[:size]).max() < 1:
            break
        q, force = q + step[:size], force + step[size:]
        if abs(step).max() < 2e-14:
            return q, force
    raise Failed("Newton's method did not close the contacts")


@dataclass
class Packing:
    """An equilibrium: the contacts that bear force, and the forces."""

    clumps: Clumps
    q: Vector
    force: Vector
    contacts: Indices

    def members_that_bear(self) -> list[set[int]]:
        """For each body its members that bear force."""
        bear: list[set[int]] = [set() for _ in range(self.clumps.count)]
        for member in self.contacts[self.contacts >= 0]:
            bear[self.clumps.body[member]].add(int(member))
        return bear

    def others(self) -> NDArray[np.bool_]:
        """Which candidates are no contacts."""
        known = set(map(tuple, self.contacts))
        return np.array([tuple(pair) not in known for pair in self.clumps.candidates])

    def least_other_gap(self) -> float:
        return float(self.clumps.distances(self.q)[self.others()].min())

    def inside_sectors(self) -> bool:
        """Every contact is of the members that are nearest."""
        return int((abs(self.clumps.distances(self.q)[~self.others()]) < LEAST_GAP).sum()) == len(self.contacts)

    def settle(self) -> None:
        """Bodies that bear no force move, and bodies held through one member turn about it, until they keep clear of others."""
        loose = [(b, next(iter(bear), None)) for b, bear in enumerate(self.members_that_bear()) if len(bear) < 2]
        pairs = self.clumps.candidates
        sides = np.where(pairs >= 0, self.clumps.body[np.maximum(pairs, 0)], -1)
        near = self.others() & (self.clumps.gaps(self.q, pairs)[0] < 1) & np.isin(sides, [b for b, _ in loose]).any(axis=1)

        def moved(motion: Vector) -> Vector:
            q = self.q.copy()
            for (b, pivot), (x, y, turn) in zip(loose, motion.reshape(-1, 3)):
                q[3 * b + 2] += turn
                if pivot is None:
                    q[3 * b : 3 * b + 2] += (x, y)
                else:
                    q[3 * b : 3 * b + 2] += self.clumps.arms(self.q)[pivot] - self.clumps.arms(q)[pivot]
            return q

        for margin in (1e-2, 1e-3, 1e-4):
            if self.clumps.distances(self.q)[near].min(initial=1) > margin / 10:
                return
            start = np.zeros(3 * len(loose))
            found = minimize(lambda z: (np.minimum(self.clumps.distances(moved(z))[near] / margin - 1, 0) ** 2).sum(), start)
            self.q = moved(found.x)


@dataclass
class Counts:
    """What is counted, by singular values; `expected` in files of format "bodies-1" has the same quantities."""

    dof: int  # 3 for each body that bears force, and 2
    contacts: int
    rank: int
    rattlers: list[int]  # the bodies that bear no force
    rotational: list[int]  # the bodies whose contacts all pass through one member
    doubled: int  # pairs of bodies that touch more than once
    variation: Vector  # eigenvalues of the second variation on the mechanisms, orthonormal in (X, Y, angle)

    @property
    def hyperstaticity(self) -> int:
        return self.contacts - self.rank

    @property
    def hypostaticity(self) -> int:
        return self.dof - self.rank

    def named(self) -> dict[str, object]:
        """Under the names of format "bodies-1"."""
        return {
            "N_f_of_loaded_bodies": self.dof,
            "N": self.contacts,
            "rank": self.rank,
            "h": self.hyperstaticity,
            "k": self.hypostaticity,
            "rattlers": self.rattlers,
            "rotational_rattlers": self.rotational,
            "pairs_that_touch_more_than_once": self.doubled,
        }


def counted(packing: Packing) -> Counts:
    """The rank is that of the matrix in lengths of the mean radius of the members."""
    clumps, q = packing.clumps, packing.q
    bear = packing.members_that_bear()
    scale = np.ones(len(q))
    scale[2:-2:3] = clumps.radius.mean()
    loaded = np.array([k for k in range(len(q)) if k >= 3 * clumps.count or bear[k // 3]])
    rows = clumps.rows(q, packing.contacts, clumps.gaps(q, packing.contacts)[1])
    _, values, right = np.linalg.svd((rows / scale)[:, loaded])
    rank = int((values > 1e-9 * values[0]).sum())
    kernel = np.linalg.qr(right[rank:].T / scale[loaded, None])[0]
    form = -clumps.second(q, packing.contacts, packing.force)[np.ix_(loaded, loaded)]
    pairs = [tuple(pair) for pair in clumps.body[packing.contacts[packing.contacts[:, 1] >= 0]]]
    doubled = len({pair for pair in pairs if pairs.count(pair) > 1})
    none, one = ([b for b, members in enumerate(bear) if len(members) == size] for size in (0, 1))
    return Counts(len(loaded), len(packing.contacts), rank, none, one, doubled, np.linalg.eigvalsh(kernel.T @ form @ kernel))


def equilibrium(clumps: Clumps, q: Vector, contacts: Indices, force: Vector) -> tuple[Packing, Counts]:
    """The equilibrium with these contacts next to q. Raises `Failed` unless forces are positive and nothing overlaps."""
    packing = Packing(clumps, *closed(clumps, q, contacts, force), contacts)
    if packing.force.min() < LEAST_FORCE:
        raise Failed(f"a contact bears the force {packing.force.min():.1e}")
    packing.settle()
    if not packing.inside_sectors():
        raise Failed("a contact is not inside the arcs of its members")
    if packing.least_other_gap() < LEAST_GAP:
        raise Failed(f"a pair that bears no force has the gap {packing.least_other_gap():.1e}")
    return packing, counted(packing)
