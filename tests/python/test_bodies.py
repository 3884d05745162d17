"""Clumps: states with bars, proofs, runs, and what takes single grains only."""

import pickle

import numpy as np
from common import Folder, project

import isostat
import isostat.plot

data = project / "tests/data/clumps"


def lying(f1=12.0, f2=12.0):
    return isostat.State.from_arrays(
        [[1, 1], [2.5, 0.375]], [1, 0.375], [2.875, 2],
        [(0, "left"), (0, "bottom"), (1, "bottom"), (1, "right"), (0, "top")],
        stress=[f1, f2], reference_length=[1, 1], bars=[(0, 1, 1.625)],
    )


class Bodies(Folder):
    def test_arrays_make_a_clump_with_the_forces_of_the_closed_form(self):
        state = lying()
        self.assertEqual(state.bars, [(0, 1, 1.625)])
        self.assertEqual([tuple(c) for c in state.contacts][-1], (0, -11))
        self.assertEqual(state.contact_names[-1], "bar 0-1")
        found = isostat.inspect(state)
        self.assertEqual(found.verdict, isostat.Verdict.PROVED)
        np.testing.assert_allclose(found.forces, [12, 7, 5, 12, 12, 13], rtol=1e-11)
        self.assertEqual((found.counting.dofs, found.counting.contacts), (5, 5))
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(state)).contacts, state.contacts)

    def test_free_motions_are_told_and_certificates_verify(self):
        for name, k, turning in (("dimer_20_1", 2, 2), ("dimer2_20_2", 6, 3), ("trimer_20_3", 6, 0)):
            state = isostat.State.read(data / f"{name}.json")
            found = isostat.inspect(state)
            self.assertEqual(found.verdict, isostat.Verdict.PROVED)
            self.assertEqual(found.counting.k, k)
            self.assertEqual(len(found.rotational_rattlers), turning)
            certificate = isostat.certify(state)
            self.assertEqual(certificate.verdict, isostat.Verdict.PROVED)
            self.assertEqual(isostat.verify(certificate).verdict, isostat.Verdict.PROVED)

    def test_a_dimer_runs_through_its_loop(self):
        scene = {
            "programme": [{"do": "down", "equilibria": 1}, {"do": "up", "equilibria": 1}],
            "run": {"max_strain": 10.0},
        }
        run = isostat.Run(scene, self.folder / "run", start=lying())
        run.play()
        np.testing.assert_allclose(run.records.equilibria["sigma2"], [12, 5, 28.8], rtol=1e-12)

    def test_what_takes_single_grains_says_so(self):
        state = lying()
        for call in (
            lambda: isostat.snap(state), lambda: isostat.jamming(state), lambda: isostat.stiffness_matrix(state, 1.0),
            lambda: isostat.unjamming_motion(state), lambda: state.rattlers, lambda: pickle.dumps(state.packing),
        ):
            with self.assertRaisesRegex(isostat.BadInput, "clumps"):
                call()

    def test_perturbed_copies_of_a_dimer_are_isostatic(self):
        copies = isostat.genericity(lying(), samples=5, size=1e-3)
        self.assertEqual(copies.proved, 5)
        self.assertEqual({(s["turns"], s["rattlers"], len(s["carrying"])) for s in copies.samples}, {(0, 0, 5)})

    def test_a_table_with_a_column_of_bodies_is_one_of_clumps(self):
        table = self.folder / "grains.csv"
        table.write_text("x,y,r,mol\n1,1,1,3\n2.5,0.375,0.375,3\n")
        box = [0, 2.875, 0, 2]
        clump = isostat.read_packing(table, box=box, bodies="mol")
        self.assertEqual(isostat.plateau(isostat.read_packing(table, box=box), 0, 0.1).steps[0].all.dofs, 6)
        step = isostat.plateau(clump, 0, 0.1).steps[-1]
        self.assertEqual((step.all.dofs, step.all.contacts, step.backbone.h, step.backbone.k), (5, 5, 0, 0))
        self.assertEqual((step.rattlers, step.backbone.turns), (0, 0))
        self.assertEqual(step.backbone.isostatic, isostat.Verdict.PROVED)
        self.assertEqual(len(isostat.backbone_at(clump, 0.1)), 5)

    def test_a_minimum_along_mechanisms_is_one_claim_in_the_place_of_all(self):
        file = self.folder / "pendulum.json"
        file.write_text(
            """{"format": "isostat-state", "version": 2, "length": [10, 10], "fixed": [0], "bars": [[0, 1, 1]],
            "walls": {"lower": ["absent", "absent"], "upper": ["absent", "absent"]}, "disk_force": [[0, 0], [0, -3]],
            "load": {"stress": [0, 0], "reference_length": [10, 10]}, "contacts": [],
            "disks": [[2, 5, 0.25], [2, 4, 0.25]]}"""
        )
        made = isostat.certify(isostat.State.read(file))
        self.assertEqual((made.verdict, made.counting, made.stable), (isostat.Verdict.PROVED, None, False))
        self.assertIn("not isostatic", repr(made))
        away, curvature = made.minimum
        self.assertLess(away, 1e-12)
        self.assertTrue(1 < curvature < 3)
        held, form = made.form
        self.assertEqual((len(held), form.shape), (1, (1, 2)))
        self.assertTrue(3 - 1e-9 < form[0, 0] < 3 < form[0, 1] < 3 + 1e-9)
        self.assertEqual(isostat.verify(made).verdict, isostat.Verdict.PROVED)
        self.assertIsNone(isostat.certify(lying()).minimum)

    def test_an_oval_between_four_walls(self):
        state = isostat.State.from_arrays(
            [[7, 2], [4, -2], [1, 2], [4, 6]], [1, 6, 1, 6], [8, 4],
            [(2, "left"), (0, "right"), (3, "bottom"), (1, "top")], reference_length=[1, 1],
            bars=[(0, 1, 5), (0, 2, 6), (0, 3, 5), (1, 2, 5), (2, 3, 5)], arcs=[(0, 1, 2, 3)],
        )
        self.assertEqual(state.arcs, [(0, 1, 2, 3)])
        self.assertEqual(isostat.State.parse(state.text()).arcs, state.arcs)
        self.assertEqual(isostat.inspect(state).stable, isostat.Verdict.PROVED)
        rates = isostat.inspect(state).length_rates
        self.assertEqual(len(rates), 2)
        self.assertLess(abs(rates[1][0]), 1e-9)  # upright it does not yield
        ((value, bound),) = isostat.inspect(state).second_variation
        self.assertLessEqual(abs(value - 2), bound)  # per radian squared: nothing but the angle moves
        self.assertEqual(isostat.inspect(lying()).second_variation, [])
        made = isostat.certify(state)
        self.assertEqual(isostat.verify(made).verdict, isostat.Verdict.PROVED)
        with self.assertRaisesRegex(isostat.Error, "arcs"):
            isostat.Run({"programme": [{"do": "up", "equilibria": 1}]}, self.folder / "oval", start=state).play()
        axes = isostat.plot.packing(state)
        low, high = axes.dataLim.min, axes.dataLim.max
        self.assertLess(abs(high[0] - low[0] - 8), 1)  # the oval, not its circles
        self.assertLess(abs(high[1] - low[1] - 4), 1)

    def test_bars_are_drawn_as_no_contacts(self):
        axes = isostat.plot.packing(lying(), isostat.inspect(lying()).forces)
        self.assertTrue(axes.collections)
