"""States: arrays, files, contact matrix, counting."""

import gc

import numpy as np
from common import Folder, project, two_disks

import isostat


class States(Folder):
    def test_arrays_come_back_bit_for_bit_and_through_a_file(self):
        state = two_disks()
        state.write(self.folder / "state.json")
        for other in (state, isostat.State.read(self.folder / "state.json")):
            np.testing.assert_array_equal(other.positions, [[1, 1], [1 + 2 * np.sqrt(2), 2]])
            np.testing.assert_array_equal(other.radii, [1, 2])
            np.testing.assert_array_equal(other.length, [3 + 2 * np.sqrt(2), 4])
            np.testing.assert_array_equal(other.contacts, [(0, 1), (0, -1), (0, -2), (1, -2), (1, -3), (1, -4)])
            self.assertEqual(other.stress, [1, 1])
            self.assertEqual(other.walls, {"lower": ("fixed",) * 2, "upper": ("movable",) * 2})

    def test_arrays_look_into_the_state_and_keep_it_alive(self):
        state = isostat.State.read(project / "tests/data/vertex1936.txt")
        positions, radii = state.positions, state.radii
        self.assertEqual(positions.shape, (1936, 2))
        self.assertFalse(positions.flags.owndata)
        self.assertEqual(positions.ctypes.data, state.positions.ctypes.data)
        with self.assertRaises(ValueError):
            positions[0, 0] = 0
        before = positions.copy(), radii.copy()
        del state
        gc.collect()
        np.ones(10**6)
        np.testing.assert_array_equal(positions, before[0])
        np.testing.assert_array_equal(radii, before[1])

    def test_bad_input_is_an_exception_with_an_id_and_the_field(self):
        with self.assertRaisesRegex(isostat.BadInput, "disks") as caught:
            isostat.State.from_arrays([[1, 1]], [-1], [2, 2], [])
        self.assertEqual(caught.exception.id, "bad_input")
        self.assertIsInstance(caught.exception, ValueError)
        with self.assertRaisesRegex(isostat.BadInput, "no.json"):
            isostat.State.read(self.folder / "no.json")
        with self.assertRaisesRegex(isostat.CannotWrite, "nowhere"):
            two_disks().write(self.folder / "nowhere" / "state.json")

    def test_numbers_are_finite_and_integers_are_integers(self):
        state = two_disks()
        for wrong in (np.nan, np.inf, -np.inf):
            for ask in (lambda: isostat.forces_at(state, wrong), lambda: state.with_stress([1, wrong]),
                        lambda: isostat.snap(state, stiffness=wrong)):
                with self.assertRaisesRegex(isostat.BadInput, "State|finite"):
                    ask()
        for first, last, rows in ((1, 0, 0), (0, 1, -1)):
            with self.assertRaisesRegex(isostat.BadInput, "first <= last"):
                isostat.plateau(state.packing, first, last, rows)
        with self.assertRaisesRegex(isostat.BadInput, "count is 0"):
            isostat.set_threads(0)
        arrays = state.positions, state.radii, state.length
        with self.assertRaises(isostat.BadInput):
            isostat.State.from_arrays(*arrays, [(0.5, 1)])
        turned = isostat.State.from_arrays(*arrays, [(1, 0), (1, -3)])
        self.assertEqual(turned.contacts.tolist(), [[0, 1], [1, -3]])

    def test_matrix_balances_the_load_and_has_the_rank_that_is_counted(self):
        state = two_disks()
        matrix = isostat.contact_matrix(state)
        self.assertEqual(matrix.shape, (6, 6))
        forces = isostat.inspect(state).forces
        np.testing.assert_allclose(matrix @ forces, state.external_force, atol=1e-14)
        counting = isostat.count(state)
        self.assertEqual((counting.dofs, counting.contacts, counting.rank), (6, 6, 6))
        self.assertEqual((counting.h, counting.k), (0, 0))
        self.assertIs(counting.rank_exact, isostat.Verdict.PROVED)
        fewer = isostat.count(state.packing, [(0, 1), (0, -1), (0, -2)])
        self.assertEqual((fewer.rank, fewer.h, fewer.k), (3, 0, 3))
        for pair in ((0, 2), (2, -1), (0, -5), (0, 900_000_000), (-1, -1), (0, 0), (6, -9), (0, -11), (0, -12)):
            with self.assertRaisesRegex(isostat.BadInput, "of two of 2 grains", msg=pair):
                isostat.count(state.packing, [pair])

    def test_mechanism_opens_one_contact_and_keeps_the_others(self):
        state = two_disks()
        velocity = isostat.mechanism(state, (1, "bottom"))
        rates = -isostat.contact_matrix(state).T @ velocity
        np.testing.assert_allclose(rates, [0, 0, 0, 1, 0, 0], atol=1e-14)
        disks, walls = isostat.disk_velocities(state, velocity)
        # Rolling about disk 0: up with 1, to the left with the ratio of the sides of the triangle.
        np.testing.assert_allclose(disks, [[0, 0], [-1 / (2 * np.sqrt(2)), 1]], atol=1e-14)
        np.testing.assert_allclose(walls, disks[1], atol=1e-14)
        with self.assertRaises(ValueError):
            isostat.mechanism(state, (0, "top"))
