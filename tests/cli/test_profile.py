# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""`thalweg profile`: what it measures is plausible on a field whose gradient is known, and all of it is reported."""

import json
import shutil
import unittest

from cli_case import THESIS, CliCase

FLAT = ["autodiff", "central", "forward", "simplex", "dichotomy", "dichotomy:verbatim", "closest_point"]
SOLID = [name for name in FLAT if not name.startswith("dichotomy")]
SIZE = ("--points", "400", "--triangles", "60")


class Profile(CliCase):
    def profile(self, scene: str, *arguments: str) -> dict:
        return json.loads(self.succeed("profile", scene, *SIZE, "--json", *arguments).stdout)

    def test_every_strategy_is_measured_in_the_plane_and_in_space(self):
        for scene, expected in (("circle.json", FLAT), ("sphere.json", SOLID)):
            report = self.profile(scene)
            self.assertEqual(expected, [row["strategy"] for row in report["strategies"]])
            for row in report["strategies"]:
                with self.subTest(scene=scene, strategy=row["strategy"]):
                    self.assertEqual(400, row["all"]["points"])
                    self.assertEqual(400, row["away_from_kinks"]["points"] + row["near_kinks"]["points"])
                    self.assertEqual(400, sum(band["points"] for band in row["by_distance"]))
                    self.assertEqual(0, row["all"]["nan"])
                    self.assertLess(row["away_from_kinks"]["median"], 0.05)
                    self.assertGreater(row["nanoseconds"], 0)

    def test_the_best_strategy_of_an_exact_field_is_the_closed_form(self):
        rows = {row["strategy"]: row for row in self.profile("circle.json")["strategies"]}
        self.assertLess(rows["autodiff"]["away_from_kinks"]["p99"], 1e-4)
        self.assertEqual((1, 12), (rows["autodiff"]["evaluations"], rows["dichotomy"]["evaluations"]))
        self.assertGreater(rows["dichotomy"]["away_from_kinks"]["median"], 100 * rows["autodiff"]["away_from_kinks"]["median"])

    def test_the_offset_is_swept_over_eight_decades(self):
        sweeps = self.profile("circle.json")["sweeps"]
        self.assertEqual(FLAT[1:-1], [sweep["strategy"] for sweep in sweeps])
        for sweep in sweeps:
            offsets = [point["offset_in_diagonals"] for point in sweep["offsets"]]
            self.assertAlmostEqual(1e-8, min(offsets))
            self.assertAlmostEqual(1, max(offsets))
            errors = [point["away_from_kinks"]["median"] or 1 for point in sweep["offsets"]]
            # Rounding at the one end, the curve of the field at the other.
            self.assertLess(min(errors), errors[0])
            if sweep["strategy"] != "dichotomy":
                self.assertLess(min(errors), errors[-1] + 1e-9)

    def test_descents_are_held_against_the_proven_minimum(self):
        descents = self.profile("circle.json")["descents"]
        methods = {row["method"] for row in descents}
        self.assertEqual({"accelerated", "thesis", "thesis_fixed", "thesis_scaled", "projected", "frank_wolfe",
                          "frank_wolfe_search", "distance_step"}, methods)
        self.assertEqual(len(methods) * len(FLAT), len(descents))
        for row in descents:
            self.assertLessEqual(row["misses"], row["hits"])
            self.assertGreater(row["hits"], 0)
            self.assertGreaterEqual(row["evaluations"], row["iterations"])
        thesis = next(r for r in descents if r["method"] == "thesis" and r["strategy"] == "dichotomy:verbatim")
        self.assertAlmostEqual(64, thesis["iterations"])
        self.assertGreater(thesis["evaluations"], 831.9)

    def test_the_table_names_every_strategy(self):
        text = self.succeed("profile", "circle.json", *SIZE).stdout.decode()
        for strategy in FLAT:
            self.assertIn(strategy, text)

    @unittest.skipUnless(shutil.which("gnuplot"), "needs gnuplot")
    def test_plots_are_pictures_in_a_folder(self):
        self.scene("thesis.json", THESIS)
        plots = self.profile("thesis.json", "--plots", "plots")["plots"]
        self.assertGreaterEqual(len(plots), 8)
        for plot in plots:
            self.assertEqual(b"\x89PNG", (self.folder / plot).read_bytes()[:4])

    def test_a_scene_without_end_is_refused(self):
        self.scene("plane.json", {"thalweg": 1, "dimension": 2, "shape": {"op": "half_plane", "normal": [0, 1], "offset": 0}})
        self.assertIn(": /shape: expected a shape of finite extent", self.refuse("profile", "plane.json"))
        self.refuse("profile", "circle.json", "--points", "0")
        self.refuse("profile", "circle.json", "--gradient-offset", "-1")


if __name__ == "__main__":
    unittest.main()
