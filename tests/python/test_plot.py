"""Pictures: what is drawn is what the state has."""

import unittest

import numpy as np
from common import project, two_disks
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.quiver import Quiver

import isostat
import isostat.plot


def collected(ax, kind):
    return [part for part in ax.collections if isinstance(part, kind)]


def lines_of(ax):
    return np.concatenate([np.reshape(part.get_segments(), (-1, 2, 2)) for part in collected(ax, LineCollection)])


class Pictures(unittest.TestCase):
    cells = ("cells/tilt_16.json", "cells/rect_16.json", "cells/channel_16.json")

    def states(self):
        for name in (*self.cells, "vertex100.txt"):
            yield name, isostat.State.read(project / "tests/data" / name)

    def test_every_line_of_a_contact_joins_grains_that_touch(self):
        for name, state in self.states():
            forces = isostat.inspect(state).forces
            ax = isostat.plot.packing(state, forces)
            pairs = state.contacts[:, 1] >= 0
            through = state.images.any(axis=1)
            self.assertEqual(through.any(), name in self.cells)
            lines = lines_of(ax)
            self.assertEqual(len(lines), len(pairs) + through.sum())
            touching = state.radii[state.contacts[:, 0]] + np.where(pairs, state.radii[state.contacts[:, 1]], 0)
            expected = np.sort(np.concatenate((touching, touching[through])))
            np.testing.assert_allclose(np.sort(np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1)), expected, rtol=1e-9)
            # Both ends of a pair are centres of disks that are drawn, the images among them.
            drawn = np.concatenate([part.get_offsets() for part in collected(ax, EllipseCollection)])
            self.assertEqual(len(drawn) > len(state), name in self.cells)
            distance = np.linalg.norm(lines[:, :, None] - drawn, axis=3).min(axis=2)
            self.assertLess(distance[:, 0].max(), 1e-12)
            self.assertEqual((distance[:, 1] > 1e-12).sum(), (~pairs).sum())

    def test_a_cell_is_outlined_where_it_repeats(self):
        for name, sides in zip((*self.cells, "vertex100.txt"), (4, 4, 2, 0)):
            state = isostat.State.read(project / "tests/data" / name)
            for shown in (state, state.packing):
                dashed = [line for line in isostat.plot.packing(shown).get_lines() if line.get_linestyle() == "--"]
                self.assertEqual(len(dashed), sides, name)

    def test_a_mechanism_is_drawn_in_boxes_and_in_cells(self):
        for name, state in self.states():
            contact, image = state.contacts[5], state.images[5]
            velocity = isostat.mechanism(state, (*contact, image))
            disks, sizes = isostat.disk_velocities(state, velocity)
            moved = dict(zip(state.dof_names, velocity))
            self.assertEqual(disks[3, 1], moved["y of disk 3"])
            self.assertEqual(sizes[1], moved.get("top wall", moved.get("period along y", 0)))
            self.assertEqual(sizes[2:].tolist(), [moved.get("tilt xy", 0)] if name in self.cells else [])
            (arrows,) = collected(isostat.plot.packing(state, mechanism=velocity), Quiver)
            np.testing.assert_allclose(arrows.U * disks[3, 1], arrows.V[3] * disks[:, 0], atol=1e-12)

    def test_a_pair_that_touches_through_several_images_is_asked_for_by_its_image(self):
        state = isostat.State.read(project / "tests/data/cells/tilt_16.json")
        with self.assertRaisesRegex(ValueError, "0 contacts"):
            isostat.mechanism(state, (*state.contacts[0], (7, 7)))

    def test_pairs_without_images_are_no_contacts_of_a_cell(self):
        state = isostat.State.read(project / "tests/data/cells/rect_16.json")
        self.assertEqual(isostat.count(state).contacts, len(state.contacts))
        with self.assertRaisesRegex(isostat.BadInput, "name images"):
            isostat.count(state.packing, state.contacts.tolist())

    def test_two_disks_have_six_lines(self):
        self.assertEqual(len(lines_of(isostat.plot.packing(two_disks(), np.ones(6)))), 6)

    def test_forces_of_packings_are_pooled_over_their_own_means(self):
        # Over the means 2 and 20: 0.5, 1, 1.5 and 0.5, 1.5; without force: 0.
        (steps,) = isostat.plot.force_distribution([1, 2, 0, 3], [10, 30, 0]).patches
        data = steps.get_data()
        np.testing.assert_array_equal(data.edges, np.arange(8) / 4)
        np.testing.assert_allclose(data.values, [0, 0, 1.6, 0, 0.8, 0, 1.6], rtol=1e-15)
        with self.assertRaises(isostat.Error):
            isostat.plot.force_distribution([0, 0])
