# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""`thalweg stress`: every sweep has its numbers, the plots are there, and a machine without gnuplot is told so."""

import json
import os
import unittest

from cli_case import HALF_PLANE, THESIS, CliCase

QUICK = ("--count", "300", "--rounds", "1")
SWEEPS = ["batch", "tile", "threads", "simd", "scene", "method", "gradient"]


class Stress(CliCase):
    def report(self, *arguments: str) -> dict:
        return json.loads(self.succeed("stress", *arguments, *QUICK, "--json").stdout)

    def labels(self, report: dict, sweep: str) -> list[str]:
        return [p["label"] for s in report["sweeps"] if s["name"] == sweep for p in s["points"]]

    def test_every_sweep_has_rates(self):
        self.scene("thesis.json", THESIS)
        report = self.report("thesis.json", "--threads", "3")
        self.assertEqual(SWEEPS, [sweep["name"] for sweep in report["sweeps"]])
        for sweep in report["sweeps"]:
            for point in sweep["points"]:
                self.assertGreater(point["queries_per_second"], 0, point)
        self.assertEqual(["1", "2", "3"], self.labels(report, "threads"))
        self.assertEqual(["2", "8", "32", "128", "512"], self.labels(report, "scene"))
        self.assertIn("dichotomy:verbatim", self.labels(report, "gradient"))
        thesis = next(p for s in report["sweeps"] for p in s["points"] if p["label"] == "thesis")
        self.assertAlmostEqual(832.5, thesis["evaluations_per_query"], delta=1.6)

    def test_the_roofline_knows_the_native_code_of_a_scene_by_its_field(self):
        self.scene("thesis.json", THESIS)
        has_demo = b"\n  demo " in self.run_program("--help").stdout
        roofline = self.report("thesis.json")["roofline"]
        self.assertEqual("native" if has_demo else "kernel", roofline["limit"])
        self.assertEqual("kernel", self.report("circle.json")["roofline"]["limit"])
        self.assertGreater(roofline["copy_bytes_per_second"], 0)

    def test_what_a_scene_does_not_admit_is_left_out(self):
        self.scene("half.json", HALF_PLANE)
        self.assertNotIn("scene", [sweep["name"] for sweep in self.report("half.json")["sweeps"]])
        self.assertNotIn("thesis", self.labels(self.report("sphere.json"), "method"))

    def test_plots_are_drawn_with_their_numbers_and_scripts(self):
        report = self.report("circle.json", "--plots", "plots")
        names = {"stress-" + sweep for sweep in [*SWEEPS, "roofline"]}
        self.assertEqual({f"plots/{name}.png" for name in names}, set(report["plots"]))
        written = {path.name for path in (self.folder / "plots").iterdir()}
        self.assertEqual({f"{name}.{ending}" for name in names for ending in ("png", "dat", "gp")}, written)
        for name in names:
            self.assertEqual(b"\x89PNG", (self.folder / "plots" / f"{name}.png").read_bytes()[:4])

    def test_plots_without_gnuplot_are_refused_before_any_work(self):
        environment = {**os.environ, "PATH": str(self.folder)}
        done = self.run_program("stress", "circle.json", "--plots", "plots", env=environment)
        self.assertEqual(1, done.returncode)
        self.assertEqual(b"thalweg: command line: --plots: expected gnuplot on the PATH, found none\n", done.stderr)
        self.assertFalse((self.folder / "plots").exists())

    def test_half_a_picture_is_a_failure_and_does_not_stay(self):
        """gnuplot says nothing when the disk is full."""
        gnuplot = self.folder / "gnuplot"
        gnuplot.write_text("#!/bin/sh\nprintf '\\211PNG' > .stress-batch.png\n", encoding="utf-8")
        gnuplot.chmod(0o755)
        environment = {**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"}
        done = self.run_program("stress", "circle.json", *QUICK, "--plots", "plots", env=environment)
        self.assertEqual(2, done.returncode)
        self.assertIn(b"expected a picture, found a picture that is not whole", done.stderr)
        self.assertFalse([path.name for path in (self.folder / "plots").iterdir() if path.suffix == ".png"])

    def test_counts_are_checked(self):
        self.assertIn("--count", self.refuse("stress", "circle.json", "--count", "0"))
        self.assertIn("--rounds", self.refuse("stress", "circle.json", "--rounds", "x"))


if __name__ == "__main__":
    unittest.main()
