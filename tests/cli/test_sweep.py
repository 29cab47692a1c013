# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""`thalweg sweep`: when moving triangles and circles first meet a scene, and what is refused."""

import json
import math
import unittest

from cli_case import CliCase

FORMULA = {"thalweg": 1, "dimension": 2, "shape": {"op": "expression", "text": "x*x + y*y - 1"}}


class Sweep(CliCase):
    def setUp(self):
        super().setUp()
        # Toward a disc of radius 2: its corner (7, 0) arrives at half of the way, or it passes by, or is nowhere.
        corner, aside = [7, 0, 9, 1, 9, -1], [7, 5, 9, 6, 9, 4]
        self.save("from.npy", corner + aside + [math.nan] * 6, (3, 3, 2))
        self.save("to.npy", [x - 10 * (i % 2 == 0) for i, x in enumerate(corner + aside)] + [0] * 6, (3, 3, 2))
        self.save("motions.npy", [10, 0, 0, 10, 0, 0, 1, 0, 0], (3, 3))
        self.ask = ("sweep", "circle.json", "--triangles", "from.npy")

    def check(self, out):
        self.assertEqual([1, 0, 255], out["status"].numbers)
        self.assertEqual([1, 1, 0], out["converged"].numbers)
        self.assertLessEqual(out["toi_lower"].numbers[0], 0.5)
        self.assertGreaterEqual(out["toi_upper"].numbers[0], 0.5)
        self.assertLess(out["toi_upper"].numbers[0] - out["toi_lower"].numbers[0], 1.001e-3)
        self.assertEqual([1, 1], [out[name].numbers[1] for name in ("toi_lower", "toi_upper")])
        self.assertAlmostEqual(1, out["normal"].rows()[0][0], delta=1e-2)
        for name in ("toi_lower", "toi_upper", "value"):
            self.assertTrue(math.isnan(out[name].numbers[2]))
        self.assertTrue(math.isnan(out["point"].rows()[1][0]))

    def test_triangles_to_their_ends(self):
        self.succeed(*self.ask, "--triangles-end", "to.npy", "-o", "out.npz")
        out = self.result("out.npz")
        self.check(out)
        self.assertAlmostEqual(2, out["point"].rows()[0][0], delta=2e-2)
        self.assertAlmostEqual(1, out["barycentric"].rows()[0][0], delta=2e-2)

    def test_a_scene_that_moves(self):
        self.succeed(*self.ask, "--motions", "motions.npy", "-o", "out.npz")
        out = self.result("out.npz")
        self.check(out)
        # Told where the triangle is, which did not move.
        self.assertAlmostEqual(7, out["point"].rows()[0][0], delta=2e-2)

    def test_spheres_against_a_moving_scene(self):
        self.save("circles.npy", [5, 0, 0, 1], (1, 4))
        self.save("motions.npy", [4, 0, 0, 1, 0, 0, 0], (1, 7))
        self.succeed("sweep", "sphere.json", "--circles", "circles.npy", "--motions", "motions.npy", "--tolerance", "1e-4",
                     "-o", "out.npz")
        out = self.result("out.npz")
        self.assertNotIn("barycentric", out)
        self.assertEqual([1], out["status"].numbers)
        self.assertLess(abs(out["toi_upper"].numbers[0] - 0.5), 2e-4)

    def test_the_report_counts(self):
        report = json.loads(self.succeed("--json", *self.ask, "--motions", "motions.npy", "-o", "out.npz").stdout)
        self.assertEqual({"separated": 1, "overlapping": 1, "touching": 0, "undecided": 0, "bad_row": 1}, report["status"])
        self.assertEqual((3, 2, 1e-3), (report["rows"], report["converged"], report["tolerance"]))

    def test_no_query_is_no_row(self):
        self.save("from.npy", [], (0, 3, 2))
        self.succeed(*self.ask, "--triangles-end", "from.npy", "-o", "out.npz")
        self.assertEqual((0,), self.result("out.npz")["toi_upper"].shape)

    def test_what_cannot_be_swept_is_refused(self):
        self.scene("formula.json", FORMULA)
        self.save("circles.npy", [5, 0, 1], (1, 3))
        rest = ("-o", "out.npz")
        self.assertIn("--motions", self.refuse(*self.ask, *rest))
        self.assertIn("both", self.refuse(*self.ask, "--motions", "motions.npy", "--triangles-end", "to.npy", *rest))
        self.assertIn("--circles", self.refuse("sweep", "circle.json", "--motions", "motions.npy", *rest))
        self.assertIn("--triangles-end", self.refuse("sweep", "circle.json", "--circles", "circles.npy", "--triangles-end",
                                                     "to.npy", *rest))
        self.assertIn("3 rows", self.refuse(*self.ask, "--motions", "circles.npy", *rest))
        self.assertIn("(N,3,2)", self.refuse(*self.ask, "--triangles-end", "motions.npy", *rest).replace(" ", ""))
        self.assertIn("formula", self.refuse("sweep", "formula.json", "--triangles", "from.npy", "--motions", "motions.npy",
                                             *rest))
        self.assertIn("--tolerance", self.refuse(*self.ask, "--motions", "motions.npy", "--tolerance", "2", *rest))
        self.assertIn("--with", self.refuse(*self.ask, "--motions", "motions.npy", "--with", "circle.json", *rest))


if __name__ == "__main__":
    unittest.main()
