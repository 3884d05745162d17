"""inspect, certify, verify; verdicts; what Ctrl-C does."""

import math
import re
import resource
import signal
import subprocess
import sys
import time
import unittest

import numpy as np
from common import Folder, program, project, two_disks

import isostat
from isostat import Verdict


def processor_time():
    """Of the processes that have ended, in seconds: other work on the machine does not change it."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Verdicts(unittest.TestCase):
    def test_no_verdict_is_true_or_false(self):
        for verdict in Verdict:
            with self.assertRaises(TypeError):
                bool(verdict)
            with self.assertRaises(TypeError):
                assert verdict


class Proofs(Folder):
    def test_inspection_has_the_closed_forms(self):
        seen = isostat.inspect(two_disks())
        self.assertIs(seen.verdict, Verdict.PROVED)
        self.assertIs(seen.stable, Verdict.PROVED)
        self.assertAlmostEqual(seen.sigma2_low, 1 / (2 * math.sqrt(2)), places=12)
        self.assertEqual(seen.opens_low, (1, -2))
        self.assertEqual(seen.sigma2_high, math.inf)
        self.assertIsNone(seen.opens_high)
        low, high = seen.force_intervals.T
        self.assertTrue(((low <= seen.forces) & (seen.forces <= high)).all())

    def test_forces_of_many_copies_are_left_unordered_without_more_digits(self):
        (self.folder / "cell.toml").write_text(
            '[packing]\ndisks = 20\nseed = 1\n[cell]\nkind = "rectangular"\n[[programme]]\ndo = "up"\nequilibria = 1\n'
        )
        prepare = [program, "prepare", "cell.toml", "-o", "one.json"]
        subprocess.run(prepare, cwd=self.folder, check=True, stdout=subprocess.DEVNULL)
        for k, digits in ((2, (1e-99, 1e-60)), (8, (1e-30, 1e-10))):  # 3 and 63 copies tie at either end
            repeat = [sys.executable, project / "tests/bench/repeat.py", "one.json", str(k), "all.json"]
            subprocess.run(repeat, cwd=self.folder, check=True)
            certify = [program, "certify", "all.json", "-o", f"{k}.cert.json"]
            answer = subprocess.run(certify, cwd=self.folder, stdout=subprocess.PIPE, text=True, check=False)
            self.assertEqual(answer.returncode, 2)
            self.assertIn("stable         strict local minimum", answer.stdout)
            known = float(re.search(r"load interval: .*? proved to ([^;]*);", answer.stdout)[1])
            self.assertTrue(digits[0] < known < digits[1], f"{k}: {known}")

    def test_a_state_that_is_not_in_equilibrium_is_refuted(self):
        seen = isostat.inspect(two_disks(stress=(1.0, 0.1)))
        self.assertIs(seen.verdict, Verdict.REFUTED)
        self.assertIn("1-bottom", seen.remark)

    def test_a_state_that_is_not_isostatic_is_an_exception_with_its_id(self):
        contacts = [(0, "left"), (0, "bottom"), (0, "right"), (0, "top")]
        state = isostat.State.from_arrays([[1, 1]], [1], [2, 2], contacts, upper=("fixed", "movable"))
        with self.assertRaises(isostat.NotIsostatic) as caught:
            isostat.inspect(state)
        self.assertEqual(caught.exception.id, "not_isostatic")

    def test_a_certificate_is_verified_and_a_changed_one_refuted(self):
        certificate = isostat.certify(two_disks())
        self.assertIs(certificate.verdict, Verdict.PROVED)
        self.assertEqual(certificate.counting["rank"], 6)
        self.assertTrue((certificate.forces[:, 0] > 0).all())
        (low, high), opens = certificate.low
        self.assertTrue(low <= 1 / (2 * math.sqrt(2)) <= high)
        self.assertEqual(opens, (1, -2))
        self.assertIsNone(certificate.high)
        checked = isostat.verify(certificate)
        self.assertIs(checked.verdict, Verdict.PROVED)
        self.assertGreaterEqual({check.claim for check in checked.checks if check.claimed}, {"forces", "stable"})
        path = self.folder / "two.cert.json"
        certificate.write(path)
        self.assertIs(isostat.verify(path).verdict, Verdict.PROVED)
        path.write_text(path.read_text().replace('"rank":6', '"rank":5'))
        with self.assertRaisesRegex(isostat.BadInput, "digest"):
            isostat.verify(path)

    def test_a_large_state_from_a_file(self):
        certificate = isostat.certify(project / "tests/data/vertex400.txt")
        self.assertIs(certificate.verdict, Verdict.PROVED)
        self.assertEqual(certificate.forces.shape[1], 2)

    def test_a_run_is_verified_and_a_changed_record_refuted(self):
        out = self.run_scene()
        steps = []
        run = isostat.verify(out, progress=lambda done, total: steps.append((done, total)))
        self.assertIs(run.verdict, Verdict.PROVED, run.undecided)
        self.assertEqual(run.equilibria_proved, run.equilibria)
        self.assertEqual(steps[-1][0], steps[-1][1])
        records = out / "events.jsonl"
        records.write_text(records.read_text().replace('"kind":"limit"', '"kind":"tension"', 1))
        self.assertIs(isostat.verify(out).verdict, Verdict.REFUTED)

    def test_what_the_progress_raises_ends_a_verification(self):
        out = self.run_scene()

        def stop(done, total):
            raise StopIteration(f"{done} of {total}")

        with self.assertRaisesRegex(StopIteration, "1 of"):
            isostat.verify(out, progress=stop)

    def interrupted(self, words, call):
        """What Ctrl-C makes of a call, 0.3 s after it began: standard error, and the processor time that it took."""
        code = f"import isostat, time\n{words}\nprint(time.process_time(), flush=True)\n{call}"
        before = processor_time()
        process = self.script(code, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        begun = float(process.stdout.readline())
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=600)
        return process.returncode, errors, processor_time() - before - begun

    def test_ctrl_c_ends_a_preparation(self):
        status, errors, _ = self.interrupted("", "isostat.prepare(20000)")
        self.assertIn("KeyboardInterrupt", errors)
        self.assertNotEqual(status, 0)

    def test_ctrl_c_ends_what_has_no_steps(self):
        # Disks on a grid, each on its left and its lower neighbour: N = N_f = 80 002 takes many seconds of processor time.
        grid = """
import numpy as np
n = 200
i, j = np.divmod(np.arange(n * n), n)
contacts = [(int(k - n), int(k)) if i[k] else (int(k), "left") for k in range(n * n)]
contacts += [(int(k - 1), int(k)) if j[k] else (int(k), "bottom") for k in range(n * n)]
contacts += [(n * n - 1, "right"), (n * n - 1, "top")]
state = isostat.State.from_arrays(np.stack([i, j], 1) + 0.5, np.full(n * n, 0.5), [n, n], contacts,
                                  stress=(1, 1), reference_length=[n, n])
"""
        for call in ("inspect", "certify"):
            status, errors, seconds = self.interrupted(grid, f"isostat.{call}(state)")
            self.assertIn("KeyboardInterrupt", errors)
            self.assertNotEqual(status, 0)
            self.assertLess(seconds, 5)
