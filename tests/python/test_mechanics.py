"""Contact tables, stiffness, motions, jamming, genericity: against closed forms and differences."""

import unittest
from fractions import Fraction

import numpy as np
from common import Folder, project, two_disks

import isostat
from isostat import Verdict


def energy(state, q, lattice_dofs, stiffness):
    """Of linear springs in the contacts, as a function of the degrees of freedom."""
    d = state.positions.shape[1]
    positions, length = state.positions.copy(), state.length.copy()
    tilt = np.array(0.0 if state.tilt is None else state.tilt, dtype=float)
    for name, value in zip(state.dof_names, q):
        if " of " in name:
            positions[int(name.rsplit(" ", 1)[1]), "xyz".index(name[0])] = value
        elif name.startswith("tilt"):
            tilt = np.array(value)
        else:
            length[lattice_dofs[name]] = value
    lattice = np.diag(length)
    if d == 2:
        lattice[0, 1] = tilt
    total = 0.0
    for (i, j), image in zip(state.contacts, state.images):
        if j >= 0:
            gap = np.linalg.norm(positions[j] - positions[i] + lattice @ image) - state.radii[i] - state.radii[j]
        else:
            axis = {-1: 0, -2: 1, -3: 0, -4: 1}[j]
            gap = (positions[i, axis] if j >= -2 else length[axis] - positions[i, axis]) - state.radii[i]
        total += 0.5 * stiffness * gap**2
    return total


lengths = {"right wall": 0, "top wall": 1, "period along x": 0, "period along y": 1}


def coordinates(state):
    values = []
    for name in state.dof_names:
        if " of " in name:
            values.append(state.positions[int(name.rsplit(" ", 1)[1]), "xyz".index(name[0])])
        else:
            values.append(state.tilt if name.startswith("tilt") else state.length[lengths[name]])
    return np.array(values)


def hessian(state, stiffness):
    q, step = coordinates(state), 1e-4
    size = len(q)
    out = np.zeros((size, size))
    for a in range(size):
        for b in range(size):
            for s, t in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
                moved = q.copy()
                moved[a] += s * step
                moved[b] += t * step
                out[a, b] += s * t * energy(state, moved, lengths, stiffness) / (4 * step**2)
    return out


class Mechanics(Folder):
    def pressed(self, state, by=0.01):
        """The same with larger grains: every contact overlaps. Overlaps by contact."""
        radii = state.radii + by
        cell = dict(periodic=state.periodic, moves=["x", "y", "xy"], tilt=state.tilt) if any(state.periodic) else {}
        contacts = [(i, j, tuple(m)) if j >= 0 and m.any() else (i, j) for (i, j), m in zip(state.contacts.tolist(), state.images)]
        soft = isostat.State.from_arrays(state.positions, radii, state.length, contacts, **cell)
        gaps = isostat.contact_table(soft)["gap"]
        return soft, -gaps

    def test_stiffness_is_the_second_derivative_of_the_energy_in_boxes_and_cells(self):
        wide = two_disks()  # in a box that is longer, so that larger disks still have their room
        states = [isostat.State.from_arrays(wide.positions, wide.radii, wide.length + [0, 0.1], wide.contacts.tolist())]
        run = self.run_scene('[packing]\ndisks = 8\nseed = 1\n[cell]\nkind = "tilted"\n[[programme]]\ndo = "up"\nequilibria = 1\n[output]\npictures = false\n')
        states.append(isostat.load(run).states[0])
        self.assertTrue(states[1].images.any())
        for state in states:
            soft, overlap = self.pressed(state)
            matrix = isostat.stiffness_matrix(soft, 3.0, forces=3.0 * overlap).toarray()
            np.testing.assert_allclose(matrix, matrix.T, atol=1e-12)
            np.testing.assert_allclose(matrix, hessian(soft, 3.0), atol=2e-5)
            without = isostat.stiffness_matrix(soft, 3.0).toarray()
            self.assertGreater(np.abs(matrix - without).max(), 1e-3)

    def test_modes_of_one_disk_between_four_walls(self):
        state = isostat.State.from_arrays(
            [[1, 1]], [1], [2, 2], [(0, "left"), (0, "right"), (0, "bottom"), (0, "top")], upper=["fixed", "fixed"]
        )
        values, vectors = isostat.modes(state, 5.0)
        np.testing.assert_allclose(values, [10, 10])
        np.testing.assert_allclose(vectors.T @ vectors, np.eye(2), atol=1e-15)
        self.assertEqual(len(isostat.modes(state, 5.0, 1)[0]), 1)
        for wrong in (lambda: isostat.modes(state, 5.0, 0), lambda: isostat.modes(state, -1.0), lambda: isostat.stiffness_matrix(state, [1.0]),
                      lambda: isostat.stiffness_matrix(state, 1.0, forces=[1.0, np.nan, 0, 0])):
            with self.assertRaisesRegex(isostat.BadInput, "expected"):
                wrong()

    def test_stiffness_of_spheres_has_the_rank_of_the_contact_matrix(self):
        state = isostat.State.read(project / "examples/spheres/cell-30.json")
        values, _ = isostat.modes(state, 1.0)
        self.assertEqual(len(values), 93)
        self.assertGreater(values[0], 1e-6)
        forces = isostat.inspect(state).forces
        softer, _ = isostat.modes(state, 1.0, forces=1e-3 * forces)
        self.assertLess(softer.sum(), values.sum())  # minus the trace of the part of the forces

    def test_the_contact_table_has_points_normals_and_proved_forces(self):
        table = isostat.contact_table(two_disks())
        root = 2 * np.sqrt(2)
        np.testing.assert_array_equal(np.column_stack((table["i"], table["j"])), two_disks().contacts)
        np.testing.assert_allclose(table["x"], [1 + root / 3, 0, 1, 1 + root, 3 + root, 1 + root], rtol=1e-15)
        np.testing.assert_allclose(table["ny"], [1 / 3, 0, -1, -1, 0, 1], rtol=1e-15)
        # The walls bear 1 each (reference lengths 1), the pair 1/cos of its slope, the bottoms the rest.
        forces = [3 / root, 1, 1 / root, 1 - 1 / root, 1, 1]
        np.testing.assert_allclose(table["force"], forces, rtol=1e-14)
        self.assertTrue((table["force_low"] <= forces).all() and (forces <= table["force_high"]).all())
        spheres = isostat.contact_table(isostat.State.read(project / "examples/spheres/tetrahedron.json"))
        self.assertIn("nz", spheres.dtype.names)
        self.assertEqual(spheres["j"].min(), -6)

    def test_a_motion_that_unjams_opens_gaps_and_a_jammed_state_has_none(self):
        self.assertIsNone(isostat.unjamming_motion(two_disks()))
        beyond = two_disks(stress=(1.0, 0.25))  # disk 1 leaves the bottom: below 1/(2 sqrt 2) the pair lifts it
        forces = isostat.forces_at(beyond, 0.25)
        self.assertLess(forces[3, 1], 0)
        motion = isostat.unjamming_motion(beyond)
        rates = -isostat.contact_matrix(beyond).T @ motion
        self.assertGreater(rates[3], 0.1)
        self.assertGreaterEqual(rates.min(), -1e-9)
        self.assertGreaterEqual(motion @ beyond.external_force, -1e-9)
        rolling = isostat.State.from_arrays([[1, 1]], [1], [4, 4], [(0, "bottom")], upper=["fixed", "fixed"])
        self.assertEqual(rolling.rattlers, [0])
        self.assertIsNone(isostat.unjamming_motion(rolling))  # of what is no rattler

    def test_jamming_of_cells_and_boxes(self):
        seen = isostat.jamming(isostat.State.read(project / "examples/cells/tilted-100.json"))
        self.assertEqual(set(seen.verdicts), {"local", "collective", "strict"})
        self.assertIs(seen.verdicts["strict"], Verdict.PROVED)
        self.assertEqual(seen.counts["full strain"].h, 0)
        self.assertEqual(seen.grains, 94)
        box = isostat.jamming(two_disks())
        self.assertEqual((box.verdicts, box.grains, box.counts["box"].dofs), ({"collective": Verdict.PROVED}, 2, 4))  # walls stay
        self.assertEqual(box.if_closed, {})
        square = isostat.jamming(isostat.State.read(project / "tests/data/field/04_square7_fixed.json"))
        self.assertIs(square.verdicts["collective"], Verdict.UNDECIDED)  # of doubles, by themselves
        closed = square.if_closed["collective"]
        self.assertEqual((closed.verdict, closed.contacts), (Verdict.PROVED, 14))
        self.assertTrue(1e-5 < closed.within < 2e-4)
        with self.assertRaisesRegex(isostat.BadInput, "expected a cell"):
            isostat.jamming(two_disks(fixed=[0]))

    def test_genericity_as_the_program(self):
        lattice = isostat.ExactPacking.read(project / "examples/packings/square_lattice_3.toml")
        answer = isostat.genericity(lattice, size=1e-6, samples=6, seed=2)
        self.assertEqual((answer.proved, answer.ties, answer.undecided, answer.failed), (6, 0, 0, 0))
        self.assertEqual([sample["seed"] for sample in answer.samples], list(range(2, 8)))
        self.assertGreater(answer.samples[0]["min_force"], 0)
        self.assertIsNone(answer.samples[0]["failure"])
        again = isostat.genericity(isostat.State.from_arrays(*self.plain(lattice)), size=1e-6, samples=6, seed=2)
        self.assertEqual([s["min_force"] for s in again.samples], [s["min_force"] for s in answer.samples])
        with self.assertRaises(isostat.BadInput):
            isostat.genericity(lattice, size=np.nan)

    def plain(self, exact):
        return exact.packing.positions, exact.packing.radii, exact.packing.length, exact.contacts.tolist()


class ExactCells(unittest.TestCase):
    def test_a_cell_and_spheres_in_exact_numbers_are_those_of_their_files(self):
        half, root = Fraction(1, 2), isostat.sqrt(3)
        made = isostat.exact_packing(
            [(0, 0, half), (1, 0, half), (half, root / 2, half), (1 + half, root / 2, half)],
            period=(2, root), tilt=0, moves=["x", "y", "xy"],
        ).inspect()
        self.assertEqual((made.dofs, len(made.contacts), made.rank), (9, 12, 9))
        self.assertEqual(made.strains["fixed cell"].dofs, 6)
        cubic = isostat.exact_packing([(0, 0, 0, 1)], period=(2, 2, 2), moves=["x", "y", "z"]).inspect()
        self.assertEqual((cubic.dofs, len(cubic.contacts), cubic.rank), (3, 3, 3))
        box = isostat.exact_packing([(1, 1, 1, 1)], length=(2, 2, 2), wall_force=(1, 1, 1)).inspect()
        self.assertEqual((box.dofs, box.rank, box.support), (6, 6, "positive"))
        for wrong in (lambda: isostat.exact_packing([(0, 0)]), lambda: isostat.exact_packing([(0, 0, 1)], moves=["x"])):
            with self.assertRaises(isostat.BadInput):
                wrong()
