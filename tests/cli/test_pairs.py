# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""`thalweg collide --with`: a second scene at many poses, contacts as flat columns, paths, and what is refused."""

import json
import math
import unittest

from cli_case import CIRCLE, HALF_PLANE, CliCase

# Two discs, and a bar through both.
DISCS = {
    "thalweg": 1,
    "dimension": 2,
    "shape": {
        "op": "union",
        "of": [
            {"op": "translate", "by": [-2, 0], "of": {"op": "circle", "radius": 1}},
            {"op": "translate", "by": [2, 0], "of": {"op": "circle", "radius": 1}},
        ],
    },
}
BAR = {"thalweg": 1, "dimension": 2, "shape": {"op": "box", "half_size": [2.5, 0.3]}}
POSES = [0.1, 0, 0, 0, 5, 0, math.nan, 0, 0, 0, 0, math.pi / 2]


class Pairs(CliCase):
    def setUp(self):
        super().setUp()
        self.scene("discs.json", DISCS)
        self.scene("bar.json", BAR)
        self.save("poses.npy", POSES, (4, 3))

    def collide(self, *arguments: str) -> dict:
        self.succeed("collide", "discs.json", "--with", "bar.json", "--poses", "poses.npy", *arguments, "-o", "out.npz")
        return self.result("out.npz")

    def test_a_verdict_has_the_columns_of_collide_and_no_contacts(self):
        out = self.collide()
        self.assertEqual([1, 0, 255, 0], out["status"].numbers)
        self.assertEqual((4, 2), out["point"].shape)
        self.assertNotIn("contact_offset", out)
        self.assertTrue(math.isnan(out["value"].numbers[2]))
        self.assertGreater(out["lower"].numbers[1], 0)

    def test_every_overlap_is_one_contact(self):
        for arguments in (["--goal", "deepest"], ["--contacts", "4"]):
            with self.subTest(arguments=arguments):
                out = self.collide(*arguments)
                self.assertEqual([0, 2, 2, 2, 2], out["contact_offset"].numbers)
                self.assertEqual([2, 0, 0, 0], out["contact_found"].numbers)
                self.assertEqual((2, 2), out["contact_point"].shape)
                self.assertEqual([-1, 1], sorted(math.copysign(1, x) for x, _ in out["contact_point"].rows()))
                for depth, value, lower in zip(
                    out["contact_depth"].numbers, out["contact_value"].numbers, out["contact_lower"].numbers, strict=True
                ):
                    self.assertEqual(depth, -value)
                    self.assertAlmostEqual(0.3, depth, delta=1e-3)
                    self.assertLessEqual(lower, value)

    def test_nothing_is_cut_in_silence(self):
        out = self.collide("--contacts", "1")
        self.assertEqual([2, 0, 0, 0], out["contact_found"].numbers)
        self.assertEqual([0, 1, 1, 1, 1], out["contact_offset"].numbers)

    def test_every_gradient_strategy_gives_normals_and_is_counted(self):
        closed = self.collide("--contacts", "4")
        for strategy in ("central", "forward", "simplex", "dichotomy", "closest_point"):
            with self.subTest(strategy=strategy):
                out = self.collide("--contacts", "4", "--gradient", strategy, "--gradient-offset", "1e-3")
                self.assertEqual(closed["contact_point"].numbers, out["contact_point"].numbers)
                self.assertEqual(closed["contact_normal"].shape, out["contact_normal"].shape)
                for normal in out["contact_normal"].rows():
                    self.assertAlmostEqual(1, math.hypot(*normal), delta=1e-5)
                more = [a - b for a, b in zip(out["evaluations"].numbers, closed["evaluations"].numbers, strict=True)]
                self.assertGreater(more[0], more[1])  # two contacts and the row's own point
                self.assertEqual(0, more[2])

    def test_a_single_start_misses_an_overlap(self):
        out = self.collide("--method", "thesis", "--starts", "1", "--contacts", "4")
        self.assertEqual(1, out["contact_found"].numbers[0])

    def test_paths_are_kept_and_drawn(self):
        out = self.collide("--method", "thesis", "--starts", "3", "--iterations", "20", "--paths")
        self.assertEqual((4, 3, 22, 2), out["path"].shape)
        self.succeed("render", "discs.json", "-o", "plain.png", "--size", "120", "80", "--bounds", "-4", "-2", "4", "2")
        self.succeed(
            "render", "discs.json", "-o", "paths.png", "--overlay", "out.npz", "--size", "120", "80",
            "--bounds", "-4", "-2", "4", "2",
        )  # fmt: skip
        self.assertNotEqual((self.folder / "plain.png").read_bytes(), (self.folder / "paths.png").read_bytes())

    def test_no_pose_is_no_row(self):
        self.save("poses.npy", [], (0, 3))
        out = self.collide("--goal", "deepest")
        self.assertEqual((0,), out["status"].shape)
        self.assertEqual([0], out["contact_offset"].numbers)

    def test_the_report_counts(self):
        done = self.succeed(
            "--json", "collide", "discs.json", "--with", "bar.json", "--poses", "poses.npy", "--goal", "deepest",
            "-o", "out.npz",
        )  # fmt: skip
        report = json.loads(done.stdout)
        self.assertEqual({"separated": 2, "overlapping": 1, "touching": 0, "undecided": 0, "bad_row": 1}, report["status"])
        self.assertEqual(2, report["contacts"])
        size = math.hypot(5, 0.6)
        self.assertAlmostEqual(1e-4 * size, report["tolerance"])
        self.assertAlmostEqual(size / 32, report["region"])

    def test_spheres_in_three_dimensions(self):
        self.save("poses.npy", [3, 0, 0, 1, 0, 0, 0], (1, 7))
        self.succeed("collide", "sphere.json", "--with", "sphere.json", "--poses", "poses.npy", "--goal", "deepest",
                     "-o", "out.npz")  # fmt: skip
        out = self.result("out.npz")
        self.assertEqual([1], out["contact_found"].numbers)
        self.assertAlmostEqual(0.5, out["contact_depth"].numbers[0], delta=1e-3)
        self.assertAlmostEqual(1, out["contact_normal"].numbers[0], delta=1e-2)


class Refusals(CliCase):
    def setUp(self):
        super().setUp()
        self.scene("plane.json", HALF_PLANE)
        self.save("poses.npy", [0, 0, 0], (1, 3))

    def refused(self, *arguments: str, scene: str = "circle.json") -> str:
        return self.refuse("collide", scene, *arguments, "-o", "out.npz")

    def test_with_and_poses_belong_together(self):
        self.assertIn("--with", self.refused("--poses", "poses.npy"))
        self.assertIn("--poses", self.refused("--with", "circle.json"))

    def test_one_kind_of_query_at_a_time(self):
        self.assertIn(
            "more than one",
            self.refused("--with", "circle.json", "--poses", "poses.npy", "--circles", "poses.npy"),
        )

    def test_dimensions_must_agree(self):
        self.assertIn("/dimension", self.refused("--with", "sphere.json", "--poses", "poses.npy"))

    def test_two_unbounded_shapes(self):
        line = self.refused("--with", "plane.json", "--poses", "poses.npy", scene="plane.json")
        self.assertIn("two unbounded shapes", line)

    def test_the_shape_of_poses(self):
        self.save("poses.npy", [0, 0, 0, 1], (1, 4))
        self.assertIn("poses.npy: shape", self.refused("--with", "circle.json", "--poses", "poses.npy"))

    def test_methods_of_other_queries(self):
        for method in ("projected", "published"):
            with self.subTest(method=method):
                self.assertIn(
                    "midsurface", self.refused("--with", "circle.json", "--poses", "poses.npy", "--method", method)
                )
        self.assertIn("--method", self.refused("--circles", "poses.npy", "--method", "midsurface"))

    def test_paths_need_a_descent(self):
        self.assertIn("--paths", self.refused("--with", "circle.json", "--poses", "poses.npy", "--paths"))

    def test_options_of_other_queries(self):
        self.assertIn("--one-sided", self.refused("--with", "circle.json", "--poses", "poses.npy", "--one-sided"))
        self.save("circles.npy", [0, 0, 1], (1, 3))
        self.assertIn("--region", self.refused("--circles", "circles.npy", "--region", "0.1"))
        self.assertIn("--contacts", self.refused("--circles", "circles.npy", "--contacts", "2"))

    def test_a_scene_that_is_not_there(self):
        self.assertIn("absent.json", self.refused("--with", "absent.json", "--poses", "poses.npy"))
        self.scene("broken.json", {**CIRCLE, "shape": {"op": "circle"}})
        self.assertIn("broken.json", self.refused("--with", "broken.json", "--poses", "poses.npy"))


if __name__ == "__main__":
    unittest.main()
