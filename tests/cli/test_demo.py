# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""`thalweg demo`: a small run checks itself, and writes its result and its picture."""

import json
import unittest

from cli_case import CliCase


class Demo(CliCase):
    def setUp(self):
        super().setUp()
        if b"\n  demo " not in self.run_program("--help").stdout:
            self.skipTest("a build without the oracle or the baselines has no demo")

    def test_a_small_run_is_right_and_writes_its_files(self):
        done = self.succeed("demo", "--count", "3000", "--out", "results", "--json")
        report = json.loads(done.stdout)
        self.assertEqual((3000, 3000, 0), (report["triangles"], report["checked_rows"], report["wrong_verdicts"]))
        self.assertEqual(3000, sum(report["status"].values()))
        self.assertGreater(report["speed_up"], 1)
        self.assertEqual({"demo.npz", "demo.png"}, {path.name for path in (self.folder / "results").iterdir()})
        self.assertEqual((3000,), self.result("results/demo.npz")["status"].shape)

    def test_the_seed_decides_the_triangles(self):
        statuses = []
        for seed in ("1", "1", "2"):
            self.succeed("demo", "--count", "500", "--seed", seed, "--quiet")
            statuses.append((self.folder / "demo.npz").read_bytes())
        self.assertEqual(statuses[0], statuses[1])
        self.assertNotEqual(statuses[0], statuses[2])

    def test_the_table_names_the_speed_up_and_the_wrong_verdicts(self):
        table = self.succeed("demo", "--count", "500").stdout.decode()
        for words in ("triangles per second", "evaluations per triangle", "speed-up", "threads", "wrong verdicts"):
            self.assertIn(words, table)


if __name__ == "__main__":
    unittest.main()
