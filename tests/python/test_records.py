"""isostat.load: a run as arrays, finished, killed or going on."""

import json
import shutil
from pathlib import Path

import numpy as np
from common import Folder, project

import isostat
import isostat.plot


class Records(Folder):
    def test_arrays_of_a_finished_run(self):
        out = self.run_scene()
        run = isostat.load(out)
        self.assertEqual(run.status, "completed")
        table = np.genfromtxt(out / "equilibria.csv", delimiter=",", names=True)
        self.assertEqual(run.equilibria.dtype.names, table.dtype.names)
        for name in table.dtype.names:
            np.testing.assert_array_equal(run.equilibria[name], table[name])
        self.assertEqual(list(run.states), list(range(6)))
        self.assertEqual(run.positions.shape, (6, 30, 2))
        self.assertEqual(run.radii.shape, (30,))
        self.assertEqual([forces.shape for forces in run.forces], [(62,)] * 6)
        self.assertEqual([contacts.shape for contacts in run.contacts], [(62, 2)] * 6)
        for number in run.states:
            np.testing.assert_allclose(run.cell[number], run.states[number].length, rtol=1e-12)
            self.assertEqual(run.states[number].equilibrium, number)
        np.testing.assert_array_equal(run.states.last.positions, run.states[5].positions)
        with self.assertRaises(KeyError):
            run.states[6]

    def test_forces_at_any_load_of_a_run(self):
        run = isostat.load(self.run_scene())
        row = run.equilibria[1]
        middle = 0.5 * (max(row["sigma2_low"], run.equilibria[0]["sigma2_high"]) + row["sigma2_high"])
        state, forces = run.at(middle)
        self.assertEqual(state.equilibrium, 1)
        self.assertEqual(state.stress[1], middle)
        seen = isostat.inspect(state)
        self.assertEqual(forces.shape, (62, 2))
        self.assertTrue(np.all(forces[:, 0] <= seen.forces[:62]) and np.all(seen.forces[:62] <= forces[:, 1]))
        # Beyond the interval of that structure a force is negative.
        beyond = isostat.forces_at(state, row["sigma2_high"] * 1.01)
        self.assertLess(beyond[:, 1].min(), 0)
        with self.assertRaisesRegex(isostat.BadInput, "expected a load that an equilibrium"):
            run.at(1e9)

    def sheared(self, equilibria=2):
        """A run of a cell whose tilt is loaded."""
        shutil.copy(project / "examples/cells/tilted-100.json", self.folder)
        scene = f"""
[packing]
file = "tilted-100.json"
[load]
loaded = "tilt"
[[programme]]
do = "up"
equilibria = {equilibria}
[output]
states_every = 1
"""
        return isostat.load(self.run_scene(scene))

    def test_forces_at_any_shear_of_a_run_in_a_cell(self):
        run = self.sheared()
        row = run.equilibria[1]
        shear = 0.5 * (row["sigma2"] + row["sigma2_high"])
        state, forces = run.at(shear)
        self.assertEqual(state.loaded_axis, 2)
        self.assertEqual(state.images.shape, state.contacts.shape)
        self.assertTrue(np.any(state.images != 0))
        self.assertEqual(state.tilt, json.loads(state.text())["cell"]["tilt"][0])
        seen = isostat.inspect(state)
        self.assertTrue(np.all(forces[:, 0] <= seen.forces) and np.all(seen.forces <= forces[:, 1]))

    def test_events_of_a_cell_have_the_images_of_their_contacts(self):
        run = self.sheared(8)
        lines = [json.loads(line) for line in (run.path / "events.jsonl").read_text().splitlines()]
        self.assertGreater(len(lines), 1)
        self.assertTrue(any("(" in line["opened"] + line["closed"] for line in lines))
        for event, line in zip(run.events, lines):
            for name in ("opened", "closed"):
                (i, j), (mx, my) = event[name], event[name + "_image"]
                self.assertEqual(f"{i}-{j}" + (f"({mx},{my})" if mx or my else ""), line[name])
        again = isostat.Run(run.path.parent / "scene.toml", self.folder / "again")
        self.assertEqual([(arc.opened_image, arc.closed_image) for arc in again.arcs() if isinstance(arc, isostat.Arc)],
                         [(tuple(e["opened_image"]), tuple(e["closed_image"])) for e in run.events])
        end = run.states[1]  # what closed last is a contact there
        last = run.events[run.events["equilibrium"] == 1][-1]
        same = (end.contacts == last["closed"]) & (end.images == last["closed_image"])
        self.assertEqual(same.all(axis=1).sum(), 1)

    def test_the_axes_of_a_sheared_run_are_those_of_its_load(self):
        run = self.sheared()
        self.assertIn("shear", isostat.plot.staircase(run).get_xlabel())
        self.assertIn("\\tau", isostat.plot.increments(run, "stress").get_xlabel())

    def test_events_are_those_of_the_file(self):
        run = isostat.load(self.run_scene())
        lines = [json.loads(line) for line in (run.path / "events.jsonl").read_text().splitlines()]
        self.assertEqual(len(run.events), len(lines))
        walls = {-1: "left", -2: "bottom", -3: "right", -4: "top"}
        for event, line in zip(run.events, lines):
            self.assertEqual(event["kind"], line["kind"])
            self.assertEqual(event["eps2"], line["eps2"])
            for name in ("opened", "closed"):
                i, j = event[name]
                if j != -9:
                    self.assertEqual(f"{i}-{walls.get(j, j)}", line[name])
        arcs = run.equilibria["arcs"]
        self.assertEqual(arcs.sum(), len(run.events))

    def test_events_of_a_run_with_a_held_coordinate(self):
        scene = Path(__file__).parents[2] / "examples" / "turns" / "power-turn.toml"
        run = isostat.Run(scene, self.folder / "turn")
        run.play()
        events = run.records.events
        self.assertEqual(events["power_turn"].tolist(), [True, False, False])
        self.assertEqual(events["closed"][0].tolist(), [2, -9])  # x of disk 1
        self.assertEqual(events["opened"][2].tolist(), [2, -9])  # let go again
        self.assertFalse(np.isnan(events["held_at"][0]))

    def test_files_are_read_when_they_are_asked_for(self):
        run = isostat.load(self.run_scene())
        (run.path / "events.jsonl").write_text("not json\n")
        self.assertEqual(len(run.equilibria), 6)
        with self.assertRaises(ValueError):
            run.events

    def test_a_record_in_the_middle_of_being_written_is_left_out(self):
        run = isostat.load(self.run_scene())
        whole = len(run.equilibria), len(run.events)
        for name in ("equilibria.csv", "events.jsonl"):
            path = run.path / name
            text = path.read_text()
            path.write_text(text[: len(text) - 7])
        (run.path / "states" / "eq_000003.json").unlink()
        run.reload()
        self.assertEqual((len(run.equilibria), len(run.events)), (whole[0] - 1, whole[1] - 1))
        self.assertNotIn(3, run.states)
        self.assertEqual(len(run.positions), 5)

    def test_a_run_that_has_just_begun(self):
        out = self.folder / "begun"
        (out / "states").mkdir(parents=True)
        (out / "run.json").write_text('{"status": "running"}')
        (out / "equilibria.csv").write_text("# number,pre")
        run = isostat.load(out)
        self.assertEqual((run.status, len(run.equilibria), len(run.events)), ("running", 0, 0))

    def test_a_folder_without_a_run_is_bad_input(self):
        with self.assertRaisesRegex(isostat.BadInput, "run.json"):
            isostat.load(self.folder)

    def test_names_of_contacts(self):
        from isostat._records import contact_of_name

        known = {
            "3-7": (3, 7, 0, 0), "3-8(1,0)": (3, 8, 1, 0), "3-12(-1,-2)": (3, 12, -1, -2), "3-3(1,0)": (3, 3, 1, 0),
            "3-left": (3, -1, 0, 0), "3-top": (3, -4, 0, 0), "held x of grain 3": (6, -9, 0, 0),
            "held y of grain 10": (21, -9, 0, 0),
        }
        for name, contact in known.items():
            self.assertEqual(contact_of_name(name), contact)
        for name in ("3-nowhere", "7-3", "03-7", "+3-7", "held x of grain 03", "3-3", "3-7(1)", "3-7(1,0,0)", "3-left(1,0)", "3-7 ", "٣-7"):
            with self.assertRaises(isostat.BadInput, msg=name):
                contact_of_name(name)

    def test_columns_and_fields_come_once_and_integers_are_integers(self):
        out = self.folder / "out"
        out.mkdir()
        (out / "run.json").write_text('{"status": "a", "status": "b"}')
        with self.assertRaisesRegex(isostat.BadInput, "status.*twice"):
            isostat.load(out).status
        (out / "run.json").write_text('{"status": "completed"}')
        for table in ("number,eps2,eps2\n0,1,1", "number,eps2\n4.9,1", "number,eps2\n+4,1", "number,eps2\n1"):
            (out / "equilibria.csv").write_text(f"# {table}\n")
            with self.assertRaisesRegex(isostat.BadInput, "equilibria.csv"):
                isostat.load(out).equilibria
        (out / "equilibria.csv").write_text("# number,touching,min_gap_j,eps2\n4,2,-1,1\n")
        row = isostat.load(out).equilibria
        self.assertEqual([row[name].dtype.kind for name in row.dtype.names], list("iiif"))
        self.assertEqual(row["touching"].tolist(), [2])
