# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""bench/record_run keeps the medians of repetitions, and how far apart these were."""

import unittest
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "bench" / "record_run"


def loaded_script():
    loader = SourceFileLoader("record_run", str(SCRIPT))
    module = module_from_spec(spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


def repetition(index: int, ratio: float, spread: float = 0.01) -> dict:
    return {
        "run_name": "pairs",
        "run_type": "iteration",
        "repetition_index": index,
        "vs_native": ratio,
        "vs_native_spread": spread,
    }


class Medians(unittest.TestCase):
    def setUp(self):
        self.medians = loaded_script().medians

    def test_one_disturbed_repetition_does_not_move_a_ratio(self):
        (case,) = self.medians([repetition(i, ratio) for i, ratio in enumerate((0.9, 0.2, 0.9, 0.9, 0.9))])
        self.assertEqual((0.9, 0.01), (case["vs_native"], case["vs_native_spread"]))
        self.assertNotIn("repetition_index", case)

    def test_repetitions_that_differ_widen_the_spread(self):
        (case,) = self.medians([repetition(i, ratio) for i, ratio in enumerate((0.6, 0.8, 1.0, 1.2, 1.4))])
        self.assertEqual(1.0, case["vs_native"])
        self.assertAlmostEqual(0.2, case["vs_native_spread"])

    def test_a_single_repetition_is_kept_as_it_is(self):
        (case,) = self.medians([repetition(0, 0.9, spread=0.03)])
        self.assertEqual((0.9, 0.03), (case["vs_native"], case["vs_native_spread"]))

    def test_aggregates_of_the_bench_are_left_out(self):
        mean = {**repetition(0, 5.0), "run_type": "aggregate"}
        self.assertEqual([0.9], [case["vs_native"] for case in self.medians([mean, repetition(0, 0.9)])])


if __name__ == "__main__":
    unittest.main()
