"""States of spheres: three columns, proofs, and what takes disks only."""

import numpy as np
from common import Folder, project

import isostat
import isostat.plot

cell = project / "examples/spheres/cell-30.json"


class Spheres(Folder):
    def test_arrays_have_a_column_for_each_axis(self):
        state = isostat.State.read(cell)
        self.assertEqual(state.positions.shape, (30, 3))
        self.assertEqual(state.length.shape, (3,))
        self.assertEqual(state.images.shape, (93, 3))
        self.assertEqual(state.infinitesimal.shape, (30, 3))
        self.assertEqual(len(state.tilt), 3)
        self.assertEqual(state.periodic, (True,) * 3)
        self.assertEqual(len(state.stress), 3)
        self.assertAlmostEqual(state.solid_fraction, 0.6480034322378443, places=12)
        again = isostat.State.parse(state.text())
        np.testing.assert_array_equal(again.positions, state.positions)
        np.testing.assert_array_equal(again.images, state.images)

    def test_walls_in_front_and_behind_have_numbers_of_their_own(self):
        state = isostat.State.read(project / "examples/spheres/tetrahedron.json")
        self.assertEqual(len(state.walls["upper"]), 3)
        self.assertIn((0, -5), [tuple(c) for c in state.contacts])
        self.assertIn((2, -6), [tuple(c) for c in state.contacts])
        self.assertIn("2-front", state.contact_names)
        self.assertEqual(repr(isostat.count(state.packing, state.contacts.tolist())), repr(isostat.count(state)))
        # H f = F with the forces of the closed form: stress 1 on faces of 5 x 5.
        forces = 25 * 0.25 * np.array([3, 3, 3, 2, 2, 1, 2, 1, 2, 1, 2, 2, 3, 3, 3])
        self.assertLess(np.abs(isostat.contact_matrix(state) @ forces - state.external_force).max(), 1e-15)

    def test_a_state_is_inspected_certified_and_verified(self):
        state = isostat.State.read(cell)
        seen = isostat.inspect(state)
        self.assertEqual(seen.counting.rank, 93)
        proof = isostat.certify(state)
        self.assertIs(proof.verdict, isostat.Verdict.PROVED)
        self.assertIs(isostat.verify(proof).verdict, isostat.Verdict.PROVED)

    def test_spheres_are_prepared_and_found_again(self):
        state = isostat.prepare(12, dimension=3)
        self.assertEqual(len(state.contacts), 39)
        self.assertIs(isostat.certify(state).verdict, isostat.Verdict.PROVED)
        again = isostat.find_vertex(state.packing, stress=(2, 2, 2))
        self.assertEqual(list(again.stress), [2, 2, 2])
        for wrong in ((1, 1), (1, 2, 1)):
            with self.assertRaisesRegex(isostat.BadInput, "three numbers"):
                isostat.find_vertex(state.packing, stress=wrong)

    def test_packings_are_made_of_arrays_and_read_from_files(self):
        state = isostat.prepare(12, dimension=3)
        packing = isostat.Packing(state.positions, list(state.radii), list(state.length))
        self.assertEqual(packing.positions.shape, (12, 3))
        self.assertEqual(packing.walls["upper"], ("movable",) * 3)
        np.testing.assert_array_equal(isostat.find_vertex(packing).contacts, state.contacts)
        for wrong in ({"length": [1, 2]}, {"lower": ["fixed"] * 2}, {"positions": np.zeros((12, 4))}):
            with self.assertRaises(isostat.BadInput):
                isostat.Packing(**({"positions": state.positions, "radii": list(state.radii), "length": list(state.length)} | wrong))
        box = [0, 13.995847242391138, 0, 15.063850881057951, 0, 13.924292277825588]
        read = isostat.read_packing(project / "tests/data/spheres/box_uniform_100_1.txt", box=box)
        self.assertEqual(read.positions.shape, (100, 3))

    def test_triaxial_tests_have_p_q_and_two_strains(self):
        for loaded, rates in (("z", (0, 0, 1)), ("constant_mean", (-1, -1, 2))):
            with self.subTest(loaded):
                out = self.run_scene(f"""
[packing]
spheres = 12
seed = 2
[load]
loaded = "{loaded}"
[[programme]]
do = "up"
equilibria = 2
""", "--force")
                run = isostat.load(out)
                test = run.triaxial
                self.assertEqual(len(test), 3)
                np.testing.assert_allclose((test["p"][0], test["q"][0]), (1, 0), atol=1e-15)
                rise = test["q"] / 3  # of t on the path, of a third of sigma3 alone
                np.testing.assert_allclose(test["p"], 1 + rise * sum(rates), rtol=1e-12)
                self.assertGreater(test["q"][2], 0)
                last = run.states[2]
                strain = np.log(np.array(last.reference_length) / np.array(last.length))
                np.testing.assert_allclose((test["axial"][2], test["volumetric"][2]), (strain[2], strain.sum()), rtol=1e-9)
                isostat.plot.staircase(run)
                isostat.plot.increments(run)

    def test_what_takes_disks_only_says_so(self):
        state = isostat.State.read(cell)
        with self.assertRaisesRegex(isostat.BadInput, "spheres"):
            isostat.plot.packing(state)
        self.assertEqual(isostat.ExactPacking.of_state(state).inspect().h, 0)
