# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""`thalweg distance`: how far a second scene is from a scene, the points between, and what is refused."""

import json
import math
import unittest

from cli_case import HALF_PLANE, CliCase

FORMULA = {"thalweg": 1, "dimension": 2, "shape": {"op": "expression", "text": "x*x + y*y - 1"}}


class Distance(CliCase):
    def setUp(self):
        super().setUp()
        # Discs of radius 2: apart by 1, in each other, nowhere.
        self.save("poses.npy", [5, 0, 0, 1, 0, 0, math.nan, 0, 0], (3, 3))
        self.ask = ("distance", "circle.json", "--with", "circle.json", "--poses", "poses.npy")

    def test_the_bracket_and_its_witnesses(self):
        self.succeed(*self.ask, "--tolerance", "1e-3", "-o", "out.npz")
        out = self.result("out.npz")
        self.assertEqual([0, 1, 255], out["status"].numbers)
        self.assertEqual([1, 1, 0], out["converged"].numbers)
        self.assertLessEqual(out["lower"].numbers[0], 1)
        self.assertGreaterEqual(out["distance"].numbers[0], 1)
        self.assertLess(out["distance"].numbers[0] - out["lower"].numbers[0], 1e-3)
        self.assertEqual([0, 0], [out[name].numbers[1] for name in ("distance", "lower")])
        for name, x in (("point_a", 2), ("point_b", 3), ("normal", 1)):
            self.assertEqual((3, 2), out[name].shape)
            self.assertAlmostEqual(x, out[name].rows()[0][0], delta=1e-3)
            self.assertTrue(math.isnan(out[name].rows()[2][0]))

    def test_the_report_counts(self):
        report = json.loads(self.succeed("--json", *self.ask, "-o", "out.npz").stdout)
        self.assertEqual({"separated": 1, "overlapping": 1, "touching": 0, "undecided": 0, "bad_row": 1}, report["status"])
        self.assertEqual(2, report["converged"])
        self.assertAlmostEqual(1e-2 * math.hypot(4, 4), report["tolerance"])

    def test_no_pose_is_no_row(self):
        self.save("poses.npy", [], (0, 3))
        self.succeed(*self.ask, "-o", "out.npz")
        self.assertEqual((0,), self.result("out.npz")["distance"].shape)

    def test_spheres_in_three_dimensions(self):
        self.save("poses.npy", [0, 0, 7, 1, 0, 0, 0], (1, 7))
        self.succeed("distance", "sphere.json", "--with", "sphere.json", "--poses", "poses.npy", "-o", "out.npz")
        out = self.result("out.npz")
        self.assertEqual([0], out["status"].numbers)
        self.assertAlmostEqual(1, out["normal"].numbers[2], delta=1e-2)

    def test_what_cannot_be_measured_is_refused(self):
        self.scene("plane.json", HALF_PLANE)
        self.scene("formula.json", FORMULA)
        self.save("poses.npy", [0, 0, 0], (1, 3))
        rest = ("--poses", "poses.npy", "-o", "out.npz")
        self.assertIn("unbounded", self.refuse("distance", "plane.json", "--with", "plane.json", *rest))
        self.assertIn("formula", self.refuse("distance", "formula.json", "--with", "circle.json", *rest))
        self.assertIn("/dimension", self.refuse("distance", "circle.json", "--with", "sphere.json", *rest))
        self.assertIn("--with", self.refuse("distance", "circle.json", *rest))
        self.assertIn("--tolerance", self.refuse(*self.ask, "--tolerance", "0", "-o", "out.npz"))
        self.save("poses.npy", [0, 0], (1, 2))
        self.assertIn("poses.npy", self.refuse(*self.ask, "-o", "out.npz"))


if __name__ == "__main__":
    unittest.main()
