"""Exact numbers and crafted packings."""

import unittest
from fractions import Fraction

import numpy as np
from common import project, two_disks

import isostat
from isostat import Verdict


class Numbers(unittest.TestCase):
    def test_roots_are_kept_and_rational_results_are_fractions(self):
        root = isostat.sqrt(2)
        self.assertIsInstance(root, isostat.Number)
        self.assertEqual(root * root, 2)
        self.assertIsInstance(root * root, Fraction)
        self.assertEqual((1 + root) * (root - 1), 1)
        self.assertEqual(Fraction(1, 3) + root - root, Fraction(1, 3))
        self.assertTrue(Fraction(1414213562373095, 10**15) < root < 1.4142135623730951)
        self.assertFalse(root == 1.4142135623730951)
        self.assertEqual(isostat.Number(0.1), Fraction(0.1))
        self.assertEqual(isostat.sqrt(Fraction(4, 9)), Fraction(2, 3))
        with self.assertRaises(ZeroDivisionError):
            root / 0
        with self.assertRaises(isostat.BadInput):
            isostat.Number("1 + pi")

    def test_numbers_of_thousands_of_digits(self):
        large = isostat.Number(2.0**-1000) * isostat.sqrt(2)
        power = large
        for _ in range(4):
            power = power * power
        self.assertEqual(power, Fraction(2**8, 2**16000))


class Crafted(unittest.TestCase):
    def lattice(self, m, **options):
        """m x m equal disks in a box; Fractions, so that nothing is rounded."""
        step = Fraction(2, 3)
        disks = [(step / 2 + step * i, step / 2 + step * j, step / 2) for j in range(m) for i in range(m)]
        return isostat.exact_packing(disks, length=(m * step, m * step), **options)

    def test_cells_have_counts_for_every_strain(self):
        folder = project / "examples/packings"
        seen = isostat.ExactPacking.read(str(folder / "cell_hexagonal_saddle.toml")).inspect()
        counts = {name: (c.h, c.k) for name, c in seen.strains.items()}
        self.assertEqual(counts["fixed cell"], (3, 1))
        self.assertEqual(counts["isotropic"], (2, 1))
        self.assertIs(seen.jammed["collectively"], Verdict.REFUTED)
        largest = isostat.ExactPacking.read(str(folder / "cell_hexagonal_largest.toml")).inspect()
        self.assertIs(largest.jammed["strictly"], Verdict.PROVED)
        self.assertEqual(self.lattice(2).inspect().strains, {})
        self.assertEqual(self.lattice(2).inspect().jammed, {})

    def test_rank_and_self_stresses_of_a_square_lattice(self):
        packing = self.lattice(3)
        seen = packing.inspect()
        self.assertEqual((seen.dofs, len(seen.contacts), seen.rank, seen.h, seen.k), (20, 24, 20, 4, 0))
        self.assertIs(seen.rank_exact, Verdict.PROVED)
        self.assertEqual(len(seen.self_stresses), 4)
        columns = packing.exact_columns()
        for stress in seen.self_stresses:
            self.assertTrue(all(isinstance(force, Fraction) for force in stress))
            balance = [Fraction(0)] * seen.dofs
            for column, force in zip(columns, stress):
                for row, value in column.items():
                    balance[row] += value * force
            self.assertEqual(balance, [0] * seen.dofs)
        matrix = isostat.contact_matrix(packing).toarray()
        self.assertEqual(np.linalg.matrix_rank(matrix), 20)

    def test_forces_and_centres_are_exact(self):
        packing = isostat.exact_packing(
            [(1, 1, 1), ("1 + 2*sqrt(2)", 2, 2)], length=("3 + 2*sqrt(2)", 4), wall_force=(1, Fraction(1, 2))
        )
        self.assertEqual(packing.centres[1][0], 1 + 2 * isostat.sqrt(2))
        seen = packing.inspect()
        self.assertEqual(seen.support, "positive")
        forces = dict(zip(map(tuple, seen.contacts.tolist()), seen.forces))
        self.assertEqual(forces[1, -3], 1)
        self.assertEqual(forces[1, -4], Fraction(1, 2))
        self.assertEqual(forces[0, 1], isostat.Number("3/4*sqrt(2)"))

    def test_mechanisms_are_exact_motions(self):
        packing = isostat.ExactPacking.read(project / "examples/packings/two_disks_rolling.toml")
        seen = packing.inspect()
        self.assertEqual(len(seen.mechanisms), seen.k)
        self.assertGreater(seen.k, 0)
        for motion in seen.mechanisms:
            for column in packing.exact_columns():
                self.assertEqual(sum(value * motion[row] for row, value in column.items()), 0)

    def test_overlap_is_an_exception(self):
        overlapping = isostat.exact_packing([(0, 0, 1), (Fraction(199, 100), 0, 1)])
        with self.assertRaises(isostat.Overlap):
            overlapping.inspect()

    def test_a_state_in_exact_numbers(self):
        seen = isostat.ExactPacking.of_state(two_disks()).inspect()
        self.assertEqual((seen.rank, seen.h, seen.k), (6, 0, 0))

    def test_enclosed_bases_agree_with_exact_ones(self):
        seen = self.lattice(3).inspect()
        verdict, stresses, motions = seen.enclosed_bases(4)
        self.assertIs(verdict, Verdict.PROVED)
        self.assertEqual((len(stresses), len(motions)), (4, 0))
        exact = np.array([[float(force) for force in stress] for stress in seen.self_stresses])
        for value, radius in stresses:
            self.assertLess(radius, 1e-12)
            # In the span of the exact ones: the residual of least squares vanishes to rounding.
            _, residual, _, _ = np.linalg.lstsq(exact.T, value, rcond=None)
            self.assertLess(residual.max(), 1e-20)
