"""examples/clumps: its packings are equilibria, judged from the state files alone: gaps of the disks that are written, derivatives of
them by differences in motions that keep every bar."""

import collections
import contextlib
import io
import itertools
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

folder = pathlib.Path(__file__).parents[2] / "examples/clumps"
sys.path.insert(0, str(folder))

import prepare  # noqa: E402


class Written:
    """A state file: disks, the bodies that its bars make of them, contacts."""

    def __init__(self, text):
        state = json.loads(text)
        self.disks, self.length, self.bars = np.array(state["disks"]), np.array(state["length"]), state["bars"]
        self.contacts = [(*row[:2], *map(tuple, row[2:])) for row in state["contacts"]]
        self.cell = "cell" in state
        if self.cell:
            self.length = np.append(self.length, state["cell"]["tilt"])
        self.body = np.arange(len(self.disks))
        for i, j, _ in self.bars:
            self.body[self.body == self.body[j]] = self.body[i]
        self.bodies = sorted(set(self.body))

    def gap(self, disks, length, contact):
        (x, y, r), other, image = disks[contact[0]], contact[1], np.array(contact[2:])
        if isinstance(other, str):
            return {"left": x, "bottom": y, "right": length[0] - x, "top": length[1] - y}[other] - r
        at = disks[other, :2] + (image[0] @ [[length[0], 0], [length[-1], length[1]]] if len(image) else 0)
        return math.dist((x, y), at) - r - disks[other, 2]

    def gaps(self, motion):
        """Of the contacts after a motion: two translations and an angle for each body, then L_x, L_y and the tilt of a cell."""
        disks = self.disks.copy()
        for b, (x, y, turn) in zip(self.bodies, motion[: -len(self.length)].reshape(-1, 3)):
            centre = self.disks[self.body == b, :2].mean(axis=0)
            by = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
            disks[self.body == b, :2] = (self.disks[self.body == b, :2] - centre) @ by + centre + (x, y)
        return np.array([self.gap(disks, self.length + motion[-len(self.length) :], contact) for contact in self.contacts])

    def derivatives(self):
        step = 1e-5
        return np.array([(self.gaps(step * unit) - self.gaps(-step * unit)) / (2 * step) for unit in np.eye(3 * len(self.bodies) + len(self.length))]).T

    def balanced(self, test):
        """Its derivatives, by which positive forces of the contacts balance equal loads on both lengths."""
        rows, unit = self.derivatives(), np.eye(3 * len(self.bodies) + len(self.length))
        load = unit[3 * len(self.bodies)] + unit[3 * len(self.bodies) + 1]
        force = np.linalg.lstsq(rows.T, load, rcond=None)[0]
        test.assertLess(abs(rows.T @ force - load).max(), 1e-8)
        test.assertGreater(force.min(), 1e-6)
        return rows

    def bearing(self):
        """Of each body that a contact holds: the disks that it holds."""
        bear = collections.defaultdict(set)
        for disk in (i for contact in self.contacts for i in contact[:2] if not isinstance(i, str)):
            bear[self.body[disk]].add(disk)
        return bear

    def others(self):
        pairs = ((i, j) for i, j in itertools.combinations(range(len(self.disks)), 2) if self.body[i] != self.body[j])
        if self.cell:
            images = [m for m in itertools.product(range(-3, 4), repeat=2) if m != (0, 0)]
            through = ((i, j, m) for i, j in itertools.combinations_with_replacement(range(len(self.disks)), 2) for m in images)
            return [self.gap(self.disks, self.length, c) for c in itertools.chain(pairs, through) if c not in set(self.contacts)]
        walls = itertools.product(range(len(self.disks)), ("left", "bottom", "right", "top"))
        return [self.gap(self.disks, self.length, c) for c in itertools.chain(pairs, walls) if c not in set(self.contacts)]


def prepared(*arguments):
    command = [sys.executable, "-B", str(folder / "prepare.py"), *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


class Clumps(unittest.TestCase):
    def test_packings_are_isostatic_up_to_rotational_rattlers(self):
        for kind, members in {"dimer": 2, "dimer2": 2, "trimer": 3}.items():
            text = prepared(kind, "-n", "12", "--seed", "7").stdout
            self.assertEqual(json.loads(text)["provenance"]["attempt"], 1)
            state = Written(text)
            self.assertEqual(len(state.disks), 12 * members)
            self.assertEqual(len(state.bars), 12 * (2 * members - 3))
            for i, j, distance in state.bars:
                self.assertLess(abs(math.dist(state.disks[i, :2], state.disks[j, :2]) - distance), 2e-14)
            self.assertLess(abs(state.gaps(np.zeros(38))).max(), 1e-14)
            self.assertGreater(min(state.others()), 1e-4)
            rank = int((np.linalg.svd(state.balanced(self))[1] > 1e-7).sum())
            bear = state.bearing()
            self.assertEqual(len(state.contacts), rank)
            self.assertEqual(3 * len(bear) + 2 - rank, sum(len(disks) == 1 for disks in bear.values()))

    def test_packings_in_cells_are_isostatic_up_to_rotational_rattlers(self):
        for kind in ("dimer", "trimer"):
            state = Written(prepared(kind, "--cell", "-n", "10", "--seed", "5").stdout)
            self.assertTrue(any(len(contact) == 3 for contact in state.contacts))
            self.assertLess(abs(state.gaps(np.zeros(33))).max(), 2e-14)
            self.assertGreater(min(state.others()), 1e-5)
            self.assertEqual(len(state.contacts), int((np.linalg.svd(state.balanced(self))[1] > 1e-7).sum()))
            bear = state.bearing()
            turning = sum(len(disks) == 1 for disks in bear.values())
            self.assertEqual(3 * len(bear) - 2 + 3 - len(state.contacts), turning)  # translations of all are none
        self.assertIn("expected unions of disks", prepared("oval", "--cell").stderr)

    def test_a_saddle_falls_along_its_mechanism(self):
        with contextlib.redirect_stderr(io.StringIO()):
            packing, counts, _ = prepare.prepared("trimer", 8, 2, True)
        state = Written(prepare.state(packing, {}))
        rows = state.derivatives()
        values, right = np.linalg.svd(rows)[1:]
        self.assertEqual((counts.hypostaticity, counts.rotational, counts.rattlers), (1, [], []))
        self.assertEqual(sum(values > 1e-7), len(state.contacts))
        mechanism, back = right[len(state.contacts)], np.linalg.pinv(rows)

        def potential(way):
            motion = way * mechanism
            for _ in range(20):
                motion = motion - back @ state.gaps(motion)
            return motion[-2:].sum()

        second = (potential(1e-3) - 2 * potential(0) + potential(-1e-3)) / 1e-6
        self.assertLess(counts.variation[0], -1e-3)
        self.assertLess(abs(second / counts.variation[0] - 1), 1e-3)

    def test_ovals_are_hypostatic_and_rest_in_a_minimum_along_every_mechanism(self):
        content = json.loads(prepared("oval", "-n", "8", "--seed", "3").stdout)
        state = Written(json.dumps(content))
        self.assertEqual(len(content["arcs"]), 8)
        for i, j, distance in state.bars:
            self.assertLess(abs(math.dist(state.disks[i, :2], state.disks[j, :2]) - distance), 2e-14)
            if (i % 4, j % 4) != (0, 2):  # neighbours touch from within
                self.assertEqual(distance, abs(state.disks[i, 2] - state.disks[j, 2]))
        self.assertLess(abs(state.gaps(np.zeros(26))).max(), 2e-14)
        rows = state.balanced(self)
        values, right = np.linalg.svd(rows)[1:]
        self.assertEqual(sum(values > 1e-7), len(state.contacts))
        loaded = [k for k, body in enumerate(state.bodies) if body in state.bearing()]
        mechanisms = [v for v in right[len(state.contacts) :] if any(abs(v[3 * k : 3 * k + 3]).max() > 1e-6 for k in loaded)]
        self.assertGreaterEqual(len(mechanisms), 2)
        back = np.linalg.pinv(rows)

        def potential(motion):
            for _ in range(20):
                motion = motion - back @ state.gaps(motion)
            return motion[-2:].sum()

        for mechanism in mechanisms:
            second = (potential(1e-3 * mechanism) - 2 * potential(0 * mechanism) + potential(-1e-3 * mechanism)) / 1e-6
            self.assertGreater(second, 1e-4)

    def test_files_are_converted_or_refused_in_words(self):
        one = [["-1", "0", "1"], ["0.8", "0", "0.5"]]
        walls = [["wall", 0, 0, 0, "lower"], ["wall", 0, 1, 0, "upper"], ["wall", 0, 0, 1, "lower"], ["wall", 0, 0, 1, "upper"]]
        content = {"format": "bodies-1", "members": [one], "sectors": None, "bodies": [["2", "1", "0"]], "lengths": ["3.3", "2"],
                   "loads": ["1", "1"], "contacts": walls, "forces": ["1"] * 4, "expected": {"N": 4, "h": 1}}
        altered = {"TypeError": {"sectors": [1]}, "an oval": {"sectors": [[["1", "0", "0.5"], ["-1", "0", "0.5"]]]}, "finite": {"lengths": ["nan", "2"]}, "a contact is open": {"lengths": ["4.4", "2"]},
                   "collinear": {"members": [[*one, ["3", "0", "1"]]]}, "KeyError": {"contacts": [["pair", 0, 0, 1, 0]]}}
        with tempfile.TemporaryDirectory() as where:
            path, out = pathlib.Path(where, "bodies.json"), pathlib.Path(where, "state.json")
            path.write_text(json.dumps(content))
            answer = prepared("--from", str(path), "-o", str(out))
            self.assertEqual(answer.returncode, 0)
            self.assertIn("N = 4, as the file says\n", answer.stderr)
            self.assertIn("h = 0, but the file says 1\n", answer.stderr)
            state = json.loads(out.read_text())
            self.assertEqual(state["bars"], [[0, 1, 1.8]])
            self.assertEqual(state["disks"], [[1, 1, 1], [2.8, 1, 0.5]])
            self.assertEqual(state["contacts"], [[0, "left"], [1, "right"], [0, "bottom"], [0, "top"]])
            self.assertIn("stays as it is", prepared("--from", str(path), "-o", str(out)).stderr)
            for word, change in altered.items():
                path.write_text(json.dumps({**content, **change}))
                answer = prepared("--from", str(path))
                self.assertEqual((answer.returncode, answer.stdout), (1, ""))
                self.assertIn(word, answer.stderr)
