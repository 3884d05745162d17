"""snap and compare: soft grains of other programs."""

import math

import numpy as np
from common import Folder, project

import isostat

series = project / "tests/data/series/series.toml"


def soft(stiffness, dimension=2):
    """An equilibrium whose grains overlap as those of that stiffness do, with its contacts that carry a force."""
    state = isostat.prepare(30 if dimension == 2 else 15, seed=3, dimension=dimension)
    forces = isostat.inspect(state).forces
    carry = forces > 1e-9
    contacts = state.contacts[carry]
    grains = sorted(set(contacts[:, 0]) | {j for j in contacts[:, 1] if j >= 0})
    place = {disk: k for k, disk in enumerate(grains)}
    listed = [(place[i], place[j] if j >= 0 else j) for i, j in contacts]

    def moved(positions, length):
        return isostat.State.from_arrays(
            positions, state.radii[grains], length, listed, stress=state.stress, reference_length=state.length
        )

    hard = moved(state.positions[grains], state.length)
    step = np.linalg.solve(isostat.contact_matrix(hard).T.toarray(), forces[carry] / stiffness)
    q = np.concatenate([hard.positions.ravel(), hard.length]) + step  # H^T gives approach
    return moved(q[:-dimension].reshape(-1, dimension), q[-dimension:])


class Compare(Folder):
    def test_soft_grains_snap_to_their_vertex(self):
        for stiffness in (1e5, 1e7):
            snap = isostat.snap(soft(stiffness), stiffness=stiffness)
            self.assertEqual((snap.outcome, snap.h, snap.k), ("vertex", 0, 0), snap.reason)
            self.assertLess(snap.distance, 100 / stiffness)
            self.assertGreater(snap.distance, 0.01 / stiffness)
            self.assertLess(snap.rest, 3000 / stiffness)  # the overlaps are those of one Newton step
            self.assertGreater(isostat.snap(soft(stiffness), stiffness=1.2 * stiffness).rest, 0.1)
            self.assertIs(isostat.certify(snap.state).verdict, isostat.Verdict.PROVED)
        self.assertTrue(math.isnan(isostat.snap(soft(1e5)).rest))  # no forces are said

    def test_soft_spheres_snap_to_their_vertex(self):
        grains = soft(1e6, dimension=3)
        snap = isostat.snap(grains, stiffness=1e6)
        self.assertEqual((snap.outcome, snap.h, snap.k), ("vertex", 0, 0), snap.reason)
        self.assertEqual(snap.state.positions.shape, grains.positions.shape)
        self.assertLess(snap.distance, 1e-3)
        self.assertLess(snap.rest, 1e-2)
        self.assertGreater(isostat.snap(grains, stiffness=1e6, law="hertz").rest, 0.1)
        self.assertIs(isostat.certify(snap.state).verdict, isostat.Verdict.PROVED)
        with self.assertRaisesRegex(isostat.BadInput, "linear"):
            isostat.snap(grains, stiffness=1.0, law="cubic")
        with self.assertRaisesRegex(isostat.BadInput, "stiffness is -1"):
            isostat.snap(grains, stiffness=-1.0)

    def test_a_series_is_compared_as_by_the_program(self):
        compared = isostat.compare(series, bundle=0, local=True, output=self.folder / "out")
        self.assertEqual(compared.status, 1)
        self.assertEqual(len(compared.frames), sum(compared.counts.values()))
        same = compared.frames["status"] == "same"
        self.assertEqual(same.sum(), compared.counts["same"])
        self.assertTrue((compared.frames["distance"][same] < 1e-3).all())
        self.assertIn(compared.departure["reason"], ("stiffness", "dynamics"))
        self.assertTrue((compared.path["sigma2_low"] < compared.path["sigma2_high"]).all())
        self.assertTrue((self.folder / "out" / "comparison.csv").is_file())
        self.assertEqual(len(compared.plot().get_lines()), 1 + len(set(compared.frames["status"])))

    def test_bad_input_names_the_file(self):
        with self.assertRaisesRegex(isostat.BadInput, "none.toml"):
            isostat.compare(self.folder / "none.toml")
