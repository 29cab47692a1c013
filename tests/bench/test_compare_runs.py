# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""bench/compare_runs tells a regression from noise."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "bench" / "compare_runs"


class Compare(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_of(self, name: str, **counters: float) -> Path:
        path = self.folder / f"{name}.json"
        case = {"run_name": "evaluate/small/value", **counters}
        path.write_text(json.dumps({"context": {}, "benchmarks": [case]}), encoding="utf-8")
        return path

    def compare(self, old: Path, new: Path, *options: str) -> subprocess.CompletedProcess:
        command = [sys.executable, SCRIPT, old, new, *options]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def verdict(self, old: dict, new: dict, *options: str) -> tuple[int, str]:
        done = self.compare(self.run_of("old", **old), self.run_of("new", **new), *options)
        return done.returncode, done.stdout.split()[0]

    def test_a_loss_within_the_tolerance_is_the_same(self):
        self.assertEqual((0, "same"), self.verdict({"vs_native": 0.8}, {"vs_native": 0.75}))
        self.assertEqual((1, "WORSE"), self.verdict({"vs_native": 0.8}, {"vs_native": 0.75}, "--tolerance", "0.05"))

    def test_a_loss_beyond_it_fails_in_the_direction_of_the_ratio(self):
        self.assertEqual((1, "WORSE"), self.verdict({"vs_native": 0.8}, {"vs_native": 0.6}))
        self.assertEqual((0, "better"), self.verdict({"vs_native": 0.6}, {"vs_native": 0.8}))
        self.assertEqual((1, "WORSE"), self.verdict({"vs_value": 2.0}, {"vs_value": 2.4}))
        self.assertEqual((0, "better"), self.verdict({"vs_value": 2.4}, {"vs_value": 2.0}))

    def test_a_loss_within_the_spreads_of_both_runs_is_noise(self):
        noisy = {"vs_thesis": 1400, "vs_thesis_spread": 0.08}
        self.assertEqual((0, "same"), self.verdict(noisy, {"vs_thesis": 1000, "vs_thesis_spread": 0.06}))
        self.assertEqual((1, "WORSE"), self.verdict(noisy, {"vs_thesis": 700, "vs_thesis_spread": 0.06}))

    def test_a_case_or_ratio_that_is_gone_fails(self):
        old = self.run_of("old", vs_native=0.8)
        self.assertEqual((1, "WORSE"), self.verdict({"vs_native": 0.8}, {"vs_value": 2}))
        empty = self.folder / "empty.json"
        empty.write_text('{"benchmarks": []}', encoding="utf-8")
        self.assertEqual(1, self.compare(old, empty).returncode)

    def test_folders_of_record_are_taken_and_other_files_refused(self):
        (self.folder / "run").mkdir()
        self.run_of("run/bench", vs_native=0.8)
        self.assertEqual(0, self.compare(self.folder / "run", self.folder / "run").returncode)
        done = self.compare(self.folder / "run", self.folder / "none.json")
        self.assertEqual(1, done.returncode)
        self.assertIn("expected a result of thalweg_bench", done.stderr)
        self.assertEqual(1, self.compare(self.run_of("bare"), self.run_of("bare")).returncode)


if __name__ == "__main__":
    unittest.main()
