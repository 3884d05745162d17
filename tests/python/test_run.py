"""Runs step by step: from a callback, from a loop, stopped and gone on with."""

import signal
import subprocess

import numpy as np
from common import Folder, scene, two_disks

import isostat
from isostat import Verdict

sections = {
    "packing": {"disks": 30, "seed": 3},
    "programme": [{"do": "up", "equilibria": 3}, {"do": "down", "equilibria": 2}],
    "output": {"pictures": False, "states_every": 1},
}


class Runs(Folder):
    def same_records(self, one, other):
        """The records of two runs, bit for bit, times apart."""
        events = [(folder / "events.jsonl").read_text() for folder in (one, other)]
        self.assertEqual(*events)
        rows = [(folder / "equilibria.csv").read_text().splitlines() for folder in (one, other)]
        self.assertEqual(*[[row.rpartition(",")[0] for row in table] for table in rows])

    def test_a_loop_gives_the_records_of_the_program(self):
        program = self.run_scene()
        run = isostat.Run(self.folder / "scene.toml", self.folder / "loop")
        seen = [(e.number, e.h, e.verdict, len(e.state.forces)) for e in run]
        self.assertEqual(seen, [(k, 0, Verdict.PROVED, 62) for k in range(6)])
        self.assertEqual(run.status, "completed")
        self.same_records(program, self.folder / "loop")
        self.assertIs(isostat.verify(run.path).verdict, Verdict.PROVED)

    def test_callbacks_get_arcs_and_equilibria_in_their_order(self):
        program = self.run_scene()
        arcs, equilibria = [], []
        run = isostat.Run(sections, self.folder / "called")
        run.play(on_equilibrium=equilibria.append, on_arc=arcs.append)
        self.same_records(program, run.path)
        events = isostat.load(program).events
        self.assertEqual([arc.opened for arc in arcs], [tuple(e) for e in events["opened"].tolist()])
        self.assertEqual([arc.work for arc in arcs], events["work"].tolist())
        self.assertEqual([e.number for e in equilibria], list(range(6)))
        both = list(isostat.Run(sections).arcs())
        self.assertEqual(len(both), len(arcs) + len(equilibria))

    def test_nothing_is_computed_while_the_loop_has_an_equilibrium(self):
        run = isostat.Run(sections, self.folder / "slow")
        for equilibrium in run:
            if equilibrium.number == 1:
                before = (run.path / "events.jsonl").read_text()
                subprocess.run(["sleep", "1"], check=True)
                self.assertEqual((run.path / "events.jsonl").read_text(), before)
                break
        self.assertEqual(run.status, "interrupted")

    def test_a_loop_that_was_left_goes_on_with_the_same_bits(self):
        whole = isostat.Run(sections, self.folder / "whole")
        whole.play()
        for step in ("equilibrium", "arc"):
            run = isostat.Run(sections, self.folder / step)
            rounds = 0
            while run.status != "completed":
                rounds += 1
                records = iter(run) if step == "equilibrium" else run.arcs()
                for count, _ in enumerate(records):
                    if count == 2 * rounds:
                        break
                records.close()
            self.assertGreater(rounds, 1)
            self.same_records(whole.path, run.path)
        again = isostat.Run(sections, self.folder / "arc", resume=True)
        again.play()
        self.assertEqual(again.status, "completed")
        self.same_records(whole.path, again.path)

    def test_what_a_callback_raises_stops_the_run_with_valid_files(self):
        def refuse(equilibrium):
            if equilibrium.number == 2:
                raise LookupError("enough")

        run = isostat.Run(sections, self.folder / "refused")
        with self.assertRaisesRegex(LookupError, "enough"):
            run.play(on_equilibrium=refuse)
        self.assertEqual(run.status, "interrupted")
        self.assertEqual(run.records.equilibria["number"].tolist(), [0, 1, 2])
        run.play()
        whole = isostat.Run(sections, self.folder / "whole")
        whole.play()
        self.same_records(whole.path, run.path)

    def test_a_run_from_a_state_of_arrays_has_the_closed_form(self):
        start = two_disks(infinitesimal=[[-0.6, -0.8], [-2.4, -3.2]])
        up = {"programme": [{"do": "down", "equilibria": 1}], "run": {"max_strain": 10}}
        run = isostat.Run(up, start=start)
        first, second = run
        self.assertEqual(first.opens_low, (1, -2))
        self.assertAlmostEqual(second.sigma2, 1 / (2 * np.sqrt(2)), places=12)
        np.testing.assert_array_equal(run.state.positions, second.state.positions)
        (arc,) = [a for a in run.records.events if a["opened"].tolist() == [1, -2]]
        self.assertEqual(arc["closed"].tolist(), [1, -1])

    def test_a_failure_is_raised_at_the_end_with_its_id(self):
        start = two_disks()
        run = isostat.Run({"programme": [{"do": "up", "equilibria": 1}]}, start=start)
        with self.assertRaises(isostat.NoLimit) as caught:
            for equilibrium in run:
                self.assertEqual(equilibrium.number, 0)
        self.assertEqual(caught.exception.id, "no_limit")
        self.assertEqual(run.status, "failed")

    def test_a_shear_that_flows_is_a_failure_of_its_own(self):
        start = isostat.State.from_arrays(
            [[0.25, 0.5]], [1.0], [2, np.sqrt(3)], [(0, 0, (1, 0)), (0, 0, (0, 1)), (0, 0, (1, -1))],
            periodic=(True, True), moves=("x", "y", "xy"), tilt=1.0, shear=0.5,
        )
        with self.assertRaises(isostat.Flows) as caught:
            isostat.Run({"programme": [{"do": "down", "to": 0.1}]}, start=start).play()
        self.assertEqual(caught.exception.id, "flows")

    def test_bad_scenes_and_taken_folders(self):
        with self.assertRaisesRegex(isostat.BadInput, "no_such_key"):
            isostat.Run({"packing": {"disks": 10, "no_such_key": 1}, "programme": []})
        with self.assertRaisesRegex(isostat.BadInput, "programme"):
            isostat.Run({"packing": {"disks": 10}})
        isostat.Run(sections, self.folder / "taken").play()
        with self.assertRaises(isostat.UsageError):
            isostat.Run(sections, self.folder / "taken").play()

    def test_ctrl_c_ends_a_run_and_a_loop(self):
        for body in ("run.play(on_arc=tell)", "for e in run.arcs(): tell(e)"):
            code = f"""
import isostat
scene = dict(packing=dict(disks=100), programme=[dict(do="up", equilibria=3000)], output=dict(pictures=False))
run = isostat.Run(scene, "long", force=True)
def tell(record):
    print("record", flush=True)
try:
    {body}
except KeyboardInterrupt:
    print(run.status, len(run.records.equilibria))
"""
            process = self.script(code, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            process.stdout.readline()
            process.send_signal(signal.SIGINT)
            out, errors = process.communicate(timeout=600)
            self.assertEqual(process.returncode, 0, errors)
            self.assertRegex(out.splitlines()[-1], "^interrupted [0-9]+$")
