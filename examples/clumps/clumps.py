"""Unions of disks in a box or a periodic cell, and convex bodies bounded by arcs in a box: gaps, their first and second derivatives, equilibria of rigid bodies, and what is counted of them.

A body has the coordinates (X, Y, angle); the lengths L_x, L_y of the box come last, and of a cell its tilt. A contact is (i, j, m_x, m_y),
of two members and the image of the second, i < j, or (i, -1 - w, 0, 0) with w the position in WALLS. Where G is the matrix of the gaps' derivatives, an equilibrium is a place where the gaps of
its contacts are 0 and G^T f = dW/dq, W the potential of the load on L_x and L_y. Everything is in double precision."""
import itertools
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.sparse import bmat, csr_matrix, diags
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

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
    cell: bool = False  # x, y repeat, and both periods and the tilt move

    def __post_init__(self) -> None:
        self.count = int(self.body[-1]) + 1
        self.middle, self.half = np.zeros(len(self.body)), np.full(len(self.body), np.inf)  # of the sectors of normals
        for ring in self.rings:
            ends = np.roll(ring, -1)
            joint = (self.place[ring] - self.place[ends]) * np.sign(self.radius[ends] - self.radius[ring])[:, None]
            end = np.unwrap(np.arctan2(joint[:, 1], joint[:, 0]))
            self.half[ring] = (end - np.roll(end, 1)) % (2 * np.pi) / 2
            self.middle[ring] = end - self.half[ring]
        self.members = np.split(np.arange(len(self.body)), np.flatnonzero(np.diff(self.body)) + 1)
        around = [members[:1] if self.half[members[0]] < np.inf else members for members in self.members]  # the caps of an oval
        self.size = np.array([(np.hypot(*self.place[m].T) + self.radius[m]).max() for m in around])  # the body is in a circle about its origin
        self.load = np.zeros(3 * self.count + 2 + self.cell)
        self.load[3 * self.count : 3 * self.count + 2] = 1

    def origins(self, q: Vector) -> Matrix:
        return q[: 3 * self.count].reshape(-1, 3)[:, :2]

    def lengths(self, q: Vector) -> Vector:
        return q[3 * self.count : 3 * self.count + 2]

    def shifts(self, q: Vector, images: Indices) -> Matrix:
        """By which images are moved."""
        tilt = np.array([q[-1], 0]) if self.cell else np.zeros(2)
        return images * self.lengths(q) + images[:, 1:] * tilt

    def arms(self, q: Vector) -> Matrix:
        """From the origin of a body to its members."""
        angle = q[2 : 3 * self.count : 3][self.body]
        cos, sin = np.cos(angle), np.sin(angle)
        x, y = self.place.T
        return np.stack([cos * x - sin * y, sin * x + cos * y], axis=1)

    def centres(self, q: Vector) -> Matrix:
        return self.origins(q)[self.body] + self.arms(q)

    def gaps(self, q: Vector, contacts: Indices) -> tuple[Vector, Matrix, Vector]:
        """Gaps, unit normals from the first to the second, and 1/distance of the centres (0 for walls)."""
        centre, (i, j) = self.centres(q), contacts[:, :2].T
        wall = j < 0
        other = np.maximum(j, 0)
        between = centre[other] - centre[i] + self.shifts(q, contacts[:, 2:])
        distance = np.where(wall, 1, np.hypot(between[:, 0], between[:, 1]))
        outward = OUTWARD[np.where(wall, -1 - j, 0)]
        normal = np.where(wall[:, None], outward, between / distance[:, None])
        reach = np.maximum(outward @ np.diag(self.lengths(q)), 0).sum(axis=1) - (outward * centre[i]).sum(axis=1)
        gap = np.where(wall, reach, distance - self.radius[other]) - self.radius[i]
        return gap, normal, np.where(wall, 0, 1 / distance)

    def near(self, q: Vector, reach: float) -> Indices:
        """All pairs of members of two bodies, and of a body and a wall, whose circles about the origins have gaps below `reach`."""
        origin, wide = self.origins(q), self.size + reach / 2
        found: list[list[tuple[int, ...]]] = []
        if self.cell:
            for m in itertools.product(range(-2, 3), repeat=2):
                between = origin - origin[:, None] + self.shifts(q, np.array([m]))
                for a, b in np.argwhere(np.hypot(*between.transpose(2, 0, 1)) < wide + wide[:, None]):
                    own = [(i, j) for i in self.members[a] for j in self.members[b] if i < j or i == j and m > (0, 0)]
                    found.append([(i, j, *m) for i, j in own if a < b or a == b and m != (0, 0)])
            return np.array(sorted(itertools.chain(*found)), dtype=np.int64).reshape(-1, 4)
        pairs = cKDTree(origin).query_pairs(2 * wide.max(), output_type="ndarray")
        first, second = np.sort(pairs[np.hypot(*(origin[pairs[:, 0]] - origin[pairs[:, 1]]).T) < wide[pairs].sum(axis=1)], axis=1).T
        found += [[(i, j, 0, 0) for i in self.members[a] for j in self.members[b]] for a, b in zip(first, second)]
        for w, gap in enumerate(np.concatenate([origin.T, self.lengths(q)[:, None] - origin.T])):
            found.append([(i, -1 - w, 0, 0) for b in np.flatnonzero(gap < self.size + reach) for i in self.members[b]])
        return np.array(sorted(itertools.chain(*found)), dtype=np.int64).reshape(-1, 4)

    def distances(self, q: Vector, pairs: Indices) -> Vector:
        """Gaps of pairs (`near`). Of two bodies bounded by arcs, or of one and a wall, that of the members whose normals are in their
        sectors, the largest one if there are several; all others are infinite."""
        gap, normal, _ = self.gaps(q, pairs)
        if not self.rings:
            return gap
        angle = q[2 : 3 * self.count : 3][self.body]

        def faces(member: Indices, n: Matrix) -> NDArray[np.bool_]:
            off = np.arctan2(n[:, 1], n[:, 0]) - angle[member] - self.middle[member]
            return abs((off + np.pi) % (2 * np.pi) - np.pi) <= self.half[member] + 1e-9

        i, j = pairs[:, :2].T
        facing = faces(i, normal) & ((j < 0) | faces(np.maximum(j, 0), -normal))
        whole = self.body + len(self.body)  # of a body bounded by arcs one member counts, of unions each
        alone = ~np.isin(np.arange(len(self.body)), np.concatenate(self.rings))
        side = np.where(alone, np.arange(len(self.body)), whole)
        key = np.where(j < 0, j, side[np.maximum(j, 0)]) + (2 * len(self.body) + 4) * side[i]
        order = np.lexsort((-gap, ~facing, key))
        first = order[np.unique(key[order], return_index=True)[1]]
        distance = np.full(len(gap), np.inf)
        distance[first] = np.where(facing[first], gap[first], np.inf)
        return distance

    def rows(self, q: Vector, contacts: Indices, direction: Matrix) -> csr_matrix:
        """The component of the relative velocity of each contact along its direction, as rows over the coordinates."""
        swing, lines = turned(self.arms(q)), np.arange(len(contacts))
        line, column, value = [], [], []
        for side, sign in ((0, -1), (1, 1)):
            member = contacts[:, side]
            there = member >= 0
            at, along = 3 * self.body[member[there]], sign * direction[there]
            line.append(np.tile(lines[there], 3))
            column.append(np.concatenate([at, at + 1, at + 2]))
            value.append(np.concatenate([along[:, 0], along[:, 1], (along * swing[member[there]]).sum(axis=1)]))
        upper = contacts[:, 1] <= -3
        line.append(lines[upper])
        column.append(3 * self.count - 3 - contacts[upper, 1])
        value.append(np.ones(int(upper.sum())))
        for k, axis, period in ((0, 0, 0), (1, 1, 1), (2, 0, 1))[: 3 * self.cell]:
            line.append(lines)
            column.append(np.full(len(lines), 3 * self.count + k))
            value.append(direction[:, axis] * contacts[:, 2 + period])
        return csr_matrix((np.concatenate(value), (np.concatenate(line), np.concatenate(column))), shape=(len(contacts), len(q)))

    def second(self, q: Vector, contacts: Indices, force: Vector) -> csr_matrix:
        """The second derivatives of sum force gap: the second variation of W is minus this form."""
        _, normal, curvature = self.gaps(q, contacts)
        along = self.rows(q, contacts, turned(normal))
        turning = np.zeros(len(q))
        for side, sign in ((0, 1), (1, -1)):
            there = contacts[:, side] >= 0
            member = contacts[there, side]
            lever = (normal[there] * self.arms(q)[member]).sum(axis=1)
            np.add.at(turning, 3 * self.body[member] + 2, sign * force[there] * lever)
        return along.T @ diags(force * curvature) @ along + diags(turning)

    def members_that_bear(self, contacts: Indices) -> list[set[int]]:
        """For each body its members in contacts."""
        bear: list[set[int]] = [set() for _ in range(self.count)]
        for member in contacts[:, :2][contacts[:, :2] >= 0]:
            bear[self.body[member]].add(int(member))
        return bear


def closed(clumps: Clumps, q: Vector, contacts: Indices, force: Vector, held: list[int] | None = None) -> tuple[Vector, Vector]:
    """Newton's method for G^T f = dW/dq, gap = 0. Motions that change nothing would make the system singular: bodies that bear no force, and
    the angles of bodies held through one member, stay as they are, and in a cell one body. So do coordinates `held`, whatever they bear."""
    bear = list(enumerate(clumps.members_that_bear(contacts)))
    loose = [3 * b + k for b, _ in [(b, members) for b, members in bear if members][: clumps.cell] for k in (0, 1)]
    loose += [k for b, members in bear for k in (3 * b, 3 * b + 1, 3 * b + 2) if not members or k % 3 == 2 and len(members) == 1]
    unknown = np.setdiff1d(np.arange(len(q) + len(force)), loose + (held or []))
    last = np.inf
    for _ in range(40):
        gap, normal, _ = clumps.gaps(q, contacts)
        rows = clumps.rows(q, contacts, normal)
        rest = np.concatenate([clumps.load - rows.T @ force, -gap])
        system = bmat([[clumps.second(q, contacts, force), rows.T], [rows, None]], format="csc")
        step = np.zeros(len(rest))
        try:
            step[unknown] = splu(system[unknown][:, unknown]).solve(rest[unknown])
        except RuntimeError:  # singular
            break
        if not abs(step[: len(q)]).max() < 1:
            break
        q, force = q + step[: len(q)], force + step[len(q) :]
        if last < 1e-11:
            return q, force
        last = abs(step).max()
    raise Failed("Newton's method did not close the contacts")


@dataclass
class Packing:
    """An equilibrium: the contacts that bear force, and the forces."""

    clumps: Clumps
    q: Vector
    force: Vector
    contacts: Indices

    def __post_init__(self) -> None:
        self.near = self.clumps.near(self.q, 1)
        known = set(map(tuple, self.contacts))
        self.others = np.array([tuple(pair) not in known for pair in self.near], dtype=bool)  # which of these are no contacts

    def least_other_gap(self) -> float:
        return float(self.clumps.distances(self.q, self.near)[self.others].min(initial=np.inf))

    def inside_sectors(self) -> bool:
        """Every contact is of the members that are nearest."""
        return int((abs(self.clumps.distances(self.q, self.near)[~self.others]) < LEAST_GAP).sum()) == len(self.contacts)

    def settle(self) -> None:
        """Bodies that bear no force move, and bodies held through one member turn about it, one by one, until they keep clear of others."""
        loose = [(b, next(iter(bear), None)) for b, bear in enumerate(self.clumps.members_that_bear(self.contacts)) if len(bear) < 2]
        members = self.near[:, :2]
        sides = np.where(members >= 0, self.clumps.body[np.maximum(members, 0)], -1)

        def moved(b: int, pivot: int | None, motion: Vector) -> Vector:
            q = self.q.copy()
            q[3 * b + 2] += motion[0]
            q[3 * b : 3 * b + 2] += motion[1:] if pivot is None else (self.clumps.arms(self.q) - self.clumps.arms(q))[pivot]
            return q

        for margin in (1e-2, 1e-3, 1e-4):
            for _, (b, pivot) in itertools.product(range(5), loose):
                all_of = (sides == b).any(axis=1)
                pairs, others = self.near[all_of], self.others[all_of]

                def penalty(motion: Vector) -> float:
                    gaps = self.clumps.distances(moved(b, pivot, motion), pairs)[others]
                    return float((np.minimum(gaps / margin - 1, 0) ** 2).sum())

                start = np.zeros(3 if pivot is None else 1)
                if penalty(start) > 0:
                    self.q = moved(b, pivot, minimize(penalty, start).x)
            if self.least_other_gap() > margin / 10:
                return


@dataclass
class Counts:
    """What is counted, by singular values; `expected` in files of format "bodies-1" has the same quantities."""

    dof: int  # 3 for each body that bears force, and 2; in a cell 3, less the translations of all
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
    bear = clumps.members_that_bear(packing.contacts)
    scale = np.ones(len(q))
    scale[2 : 3 * clumps.count : 3] = clumps.radius.mean()
    loaded = np.array([k for k in range(len(q)) if k >= 3 * clumps.count or bear[k // 3]])
    rows = clumps.rows(q, packing.contacts, clumps.gaps(q, packing.contacts)[1]).toarray()
    _, values, right = np.linalg.svd((rows / scale)[:, loaded])
    rank = int((values > 1e-9 * values[0]).sum())
    kernel = np.linalg.qr(right[rank:].T / scale[loaded, None])[0]
    dof = len(loaded)
    if clumps.cell:  # translations of all bodies are no mechanisms
        all_alike = [[k < 3 * clumps.count and k % 3 == a for k in loaded] for a in (0, 1)]
        kernel = kernel @ np.linalg.svd(np.array(all_alike, dtype=float) @ kernel)[2][2:].T
        dof -= 2
    form = -clumps.second(q, packing.contacts, packing.force).toarray()[np.ix_(loaded, loaded)]
    pairs = [(*clumps.body[[i, j]], *image) for i, j, *image in packing.contacts if j >= 0]
    doubled = len({pair for pair in pairs if pairs.count(pair) > 1})
    none, one = ([b for b, members in enumerate(bear) if len(members) == size] for size in (0, 1))
    return Counts(dof, len(packing.contacts), rank, none, one, doubled, np.linalg.eigvalsh(kernel.T @ form @ kernel))


def equilibrium(clumps: Clumps, q: Vector, contacts: Indices, force: Vector, held: list[int] | None = None) -> tuple[Packing, Counts]:
    """The equilibrium with these contacts next to q, but for what is `held`. Raises `Failed` unless forces are positive and nothing overlaps."""
    packing = Packing(clumps, *closed(clumps, q, contacts, force, held), contacts)
    if packing.force.min() < LEAST_FORCE:
        raise Failed(f"a contact bears the force {packing.force.min():.1e}")
    packing.settle()
    if not packing.inside_sectors():
        raise Failed("a contact is not inside the arcs of its members")
    if packing.least_other_gap() < LEAST_GAP:
        raise Failed(f"a pair that bears no force has the gap {packing.least_other_gap():.1e}")
    return packing, counted(packing)
