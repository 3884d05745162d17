"""What objects say of themselves, copies of them, ensembles, and that every failure is an isostat.Error."""

import copy
import pickle

import numpy as np
from common import Folder, project, scene, two_disks

import isostat


class Objects(Folder):
    def test_repr_says_what_each_object_is(self):
        state = two_disks()
        exact = isostat.ExactPacking.read(project / "examples/packings/square_lattice_3.toml")
        run = isostat.Run({"packing": {"disks": 10}, "programme": [{"do": "up", "equilibria": 1}]}, self.folder / "run")
        before = repr(run)
        steps = list(run.arcs())
        certificate = isostat.certify(state)
        proof = isostat.verify(certificate)
        plateau = isostat.plateau(isostat.prepare(10).packing, 1e-12, 1e-3)
        generic = isostat.genericity(exact, samples=2)
        things = {
            state: "2 disks, box 5.82843 x 4, 6 contacts, nominal stress (1, 1)",
            state.packing: "2 disks, box 5.82843 x 4",
            isostat.State.read(project / "examples/cells/tilted-100.json"): "tilt 0.295",
            isostat.State.read(project / "examples/spheres/box-30.json"): "30 spheres, box",
            isostat.inspect(state): "isostatic equilibrium: proved, stable: proved; h = 0, k = 0",
            isostat.count(state): "rank=6",
            certificate: "proved; of 2 disks, 0 claims absent",
            proof: "certificate: proved; counting, vertex",
            proof.checks[0]: "counting: proved",
            isostat.verify(run.path): "run: ends proved, way looked at; 2 of 2 equilibria",
            exact: "9 disks, box",
            exact.inspect(): "N_f = 20, N = 24, rank = 20, h = 4, k = 0",
            plateau: "ranges isostatic",
            plateau.steps[0]: "gap <= ",
            plateau.steps[0].backbone: "rank = ",
            plateau.ranges[0]: "gap from ",
            isostat.snap(state): "vertex, h = 0, k = 0",
            generic: "2 of 2 proved isostatic",
            isostat.jamming(isostat.State.read(project / "examples/cells/tilted-100.json")): "strict: proved",
            isostat.jamming(isostat.State.read(project / "tests/data/field/04_square7_fixed.json")).if_closed["collective"]: "proved if 14 contacts close",
            steps[0]: "number 0, 0 arcs, sigma2 = 1 in [",
            steps[1]: "step 1, limit: (",
            run: "completed, in ",
            run.records: "completed, 2 equilibria",
            run.records.states: "2 of ",
        }
        self.assertIn("not begun", before)
        for thing, words in things.items():
            self.assertIn(words, repr(thing))
            self.assertNotIn(" object at 0x", repr(thing))
        shown = {type(thing) for thing in things} | {isostat.Number, isostat.Comparison, isostat.Ensemble}
        classes = {kind for kind in vars(isostat).values() if isinstance(kind, type) and not issubclass(kind, (isostat.Error, isostat.Verdict))}
        self.assertEqual(classes - shown, set())  # no class is forgotten here

    def test_copies_have_the_same_bits(self):
        for state in (two_disks(), isostat.State.read(project / "examples/cells/tilted-100.json"), isostat.State.read(project / "examples/spheres/cell-30.json")):
            for other in (pickle.loads(pickle.dumps(state)), copy.deepcopy(state)):
                self.assertEqual(other.text(), state.text())
            packing = pickle.loads(pickle.dumps(state.packing))
            np.testing.assert_array_equal(packing.positions, state.positions)
            np.testing.assert_array_equal(packing.length, state.length)
            self.assertEqual((packing.walls, packing.tilt, packing.periodic, packing.dof_names), (state.walls, state.tilt, state.periodic, state.dof_names))
        number = isostat.Number("1 + 1/3*sqrt(2)")
        self.assertEqual(pickle.loads(pickle.dumps(number)), number)
        for exact in (isostat.ExactPacking.read(project / "examples/packings/cell_square_tilted.toml"), isostat.ExactPacking.of_state(two_disks())):
            other = pickle.loads(pickle.dumps(exact))
            self.assertEqual((other.centres, other.radii, str(other.inspect())), (exact.centres, exact.radii, str(exact.inspect())))

    def test_cells_from_arrays_are_those_of_their_files(self):
        for name in ("cells/tilted-100", "spheres/cell-30"):
            state = isostat.State.read(project / f"examples/{name}.json")
            spheres = state.positions.shape[1] == 3
            contacts = [(j, i, tuple(-m)) if i % 2 and j >= 0 else (i, j, tuple(m)) for (i, j), m in zip(state.contacts.tolist(), state.images)]
            pin = ({str(i) for i in range(len(state))} - {dof.rsplit(" ", 1)[1] for dof in state.dof_names}).pop()
            other = isostat.State.from_arrays(
                state.positions, state.radii, state.length, contacts, periodic=state.periodic, tilt=state.tilt,
                moves=["x", "y", "z", "xy", "xz", "yz"] if spheres else ["x", "y", "xy"], stress=state.stress,
                reference_length=state.reference_length, infinitesimal=state.infinitesimal, pin=int(pin),
            )
            np.testing.assert_array_equal(other.contacts, state.contacts)
            np.testing.assert_array_equal(other.images, state.images)
            self.assertEqual((other.tilt, other.dof_names), (state.tilt, state.dof_names))
            self.assertIs(isostat.inspect(other).verdict, isostat.Verdict.PROVED)
        with self.assertRaisesRegex(isostat.BadInput, "belong to a cell"):
            isostat.State.from_arrays([[1, 1]], [1], [2, 2], [], moves=["x"])

    def test_every_failure_is_an_error_of_isostat(self):
        state, run = two_disks(), isostat.load(self.run_scene())
        for fails in (
            lambda: run.at(1e9), lambda: run.states[99], lambda: run.state(99), lambda: isostat.mechanism(state, (0, 7)),
            lambda: isostat.mechanism(state, (0, "lid")), lambda: isostat.mechanism(state, 3), lambda: isostat.contact_pair((0, "lid")),
            lambda: isostat.State.from_arrays([1, 2], [1], [2, 2], []), lambda: isostat.State.from_arrays([[1, 1]], [1], [2, 2], [(0, "lid")]),
            lambda: isostat.Run(self.folder / "none.toml"), lambda: isostat.load(self.folder), lambda: isostat.Ensemble(self.folder),
            lambda: isostat.compare(self.folder / "none.toml"), lambda: isostat.plot.increments(run, "stresses"), lambda: isostat.Number("pi"),
            lambda: isostat.verify(self.folder / "none.json"), lambda: isostat.certify(self.folder / "none.json"), lambda: isostat.prepare(0),
            lambda: isostat.disk_velocities(isostat.State.read(project / "examples/spheres/box-30.json"), np.zeros(93)),
        ):
            with self.assertRaises(isostat.Error) as caught:
                fails()
            self.assertIn(" ", str(caught.exception))
        with self.assertRaises(isostat.NotIsostatic):
            isostat.mechanism(isostat.State.from_arrays([[1, 1]], [1], [2, 2], [(0, "left")]), (0, "left"))
        with self.assertRaises(KeyError):
            run.states[99]
        with self.assertRaises(AttributeError):
            isostat.no_such_name

    def test_every_load_of_the_path_has_its_state_stored_or_not(self):
        every = isostat.load(self.run_scene())
        few = isostat.load(self.run_few())
        self.assertLess(len(few.states), len(every.states))
        for row in every.equilibria:
            load = 0.5 * (max(row["sigma2_low"], 0.5) + min(row["sigma2_high"], 3))
            (state, forces), (other, others) = every.at(load), few.at(load)
            np.testing.assert_array_equal(state.contacts, other.contacts)
            np.testing.assert_allclose(state.positions, other.positions, atol=1e-12)
            self.assertTrue((forces[:, 0] <= others[:, 1]).all() and (others[:, 0] <= forces[:, 1]).all())
            self.assertEqual(other.stress[1], load)
        last = few.at(1.0, segment=1)[0] if (few.equilibria["segment"] == 1).any() else None
        self.assertIsNotNone(last)
        for gap in np.linspace(few.equilibria["sigma2"][:4].min(), few.equilibria["sigma2"][:4].max(), 7):
            few.at(float(gap))  # no hole between two structures

    def run_few(self):
        folder = self.folder / "few"
        isostat.Run(self.folder / "scene.toml", folder).play()
        for file in (folder / "states").glob("eq_*.json"):
            if file.name != "eq_000000.json":
                file.unlink()
        return folder

    def test_an_ensemble_is_the_one_of_the_program(self):
        sections = {"packing": {"disks": 12}, "programme": [{"do": "up", "equilibria": 2}], "output": {"pictures": False}}
        seen = []
        many = isostat.ensemble(sections, self.folder / "many", samples=2, seed=5, progress=lambda *at: seen.append(at))
        self.assertEqual((list(many.members), seen[-1], many.samples["status"].tolist()), ([5, 6], (2, 2), [0, 0]))
        self.assertEqual(sorted(set(many.equilibria["seed"])), [5, 6])
        self.assertEqual(len(many.increments), sum(len(run.equilibria) - 1 for run in many.members.values()))
        alone = isostat.Run({**sections, "packing": {"disks": 12, "seed": 6}}, self.folder / "alone")
        alone.play()
        self.assertEqual([tuple(r)[:8] for r in alone.records.equilibria], [tuple(r)[:8] for r in many.members[6].equilibria])
        again = isostat.ensemble(sections, self.folder / "many", samples=3, seed=5, resume=True)
        self.assertEqual((len(again.members), again.samples["status"].tolist()), (3, [0, 0, 1]))  # 7 fails at its load
        with self.assertRaises(isostat.Error):
            isostat.ensemble(sections, self.folder / "many", samples=3)

    def test_what_stops_an_ensemble_leaves_one_that_goes_on(self):
        sections = {"packing": {"disks": 12}, "programme": [{"do": "up", "equilibria": 2}], "output": {"pictures": False}}
        folder = self.folder / "stopped"

        def stop(done, samples):
            raise ZeroDivisionError(done)

        with self.assertRaises(ZeroDivisionError):
            isostat.ensemble(sections, folder, samples=3, jobs=1, progress=stop)
        self.assertEqual(isostat.Ensemble(folder).samples["status"][0], 0)
        self.assertGreater(isostat.Ensemble(folder).samples["status"][1:].min(), 2)  # not finished
        again = isostat.ensemble(sections, folder, samples=3, resume=True)
        self.assertLess(again.samples["status"].max(), 3)
