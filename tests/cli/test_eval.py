# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""`thalweg eval`: the field of a circle is known, so its values and gradients are too."""

import json
import math
import unittest

import arrays
from cli_case import CIRCLE, HALF_PLANE, CliCase

POINTS = [(0.5, 0.0), (3.0, 4.0), (0.0, -2.0), (-1.0, 1.0)]
EXPECTED = [math.hypot(x, y) - 2 for x, y in POINTS]


class Eval(CliCase):
    def setUp(self):
        super().setUp()
        self.save("points.npy", [number for point in POINTS for number in point], (4, 2))
        self.command = ("eval", "circle.json", "--points", "points.npy")

    def assert_values(self, value: arrays.Array) -> None:
        self.assertEqual(("<f4", (4,)), (value.descr, value.shape))
        for found, expected in zip(value.numbers, EXPECTED, strict=True):
            self.assertAlmostEqual(expected, found, delta=1e-5)

    def test_values_are_float32_in_the_order_of_the_points(self):
        self.succeed(*self.command, "-o", "out.npz")
        result = self.result("out.npz")
        self.assertEqual(["value"], list(result))
        self.assert_values(result["value"])

    def test_a_gradient_is_a_second_column(self):
        self.succeed(*self.command, "--gradient", "autodiff", "-o", "out.npz")
        result = self.result("out.npz")
        self.assertEqual(["value", "gradient", "evaluations", "ambiguous"], list(result))
        self.assertEqual(("<f4", (4, 2)), (result["gradient"].descr, result["gradient"].shape))
        for (x, y), (gx, gy) in zip(POINTS, result["gradient"].rows(), strict=True):
            self.assertAlmostEqual(x / math.hypot(x, y), gx, delta=1e-5)
            self.assertAlmostEqual(y / math.hypot(x, y), gy, delta=1e-5)

    def test_every_strategy_gives_the_gradient_and_counts_what_it_took(self):
        expected = {
            "autodiff": 1, "central": 5, "forward": 3, "simplex": 4,
            "dichotomy": 12, "dichotomy:verbatim": 12, "closest_point": 1,
        }  # fmt: skip
        for strategy, evaluations in expected.items():
            with self.subTest(strategy=strategy):
                done = self.succeed(*self.command, "--gradient", strategy, "--json", "-o", "out.npz")
                result = self.result("out.npz")
                for (x, y), (gx, gy) in zip(POINTS, result["gradient"].rows(), strict=True):
                    if strategy == "dichotomy:verbatim" and math.hypot(x, y) == 2:
                        continue  # at the surface |f| grows on both sides, and the published code looks at |f|
                    self.assertAlmostEqual(x / math.hypot(x, y), gx, delta=1e-2)
                    self.assertAlmostEqual(y / math.hypot(x, y), gy, delta=1e-2)
                self.assertEqual([evaluations] * 4, list(result["evaluations"].numbers))
                self.assertEqual(4 * evaluations, json.loads(done.stdout)["evaluations"])

    def test_the_closest_point_is_a_witness(self):
        self.succeed(*self.command, "--gradient", "closest_point", "-o", "out.npz")
        for x, y in self.result("out.npz")["witness"].rows():
            self.assertAlmostEqual(2, math.hypot(x, y), delta=1e-5)

    def test_kinks_are_told_and_shown_from_both_sides(self):
        pair = {"op": "union", "of": [{"op": "translate", "by": [x, 0], "of": {"op": "circle", "radius": 1}} for x in (-2, 2)]}
        self.scene("pair.json", {"thalweg": 1, "dimension": 2, "shape": pair})
        self.save("ties.npy", [0, 0, 2, 0, 0.5, 3, math.nan, 0], (4, 2))
        ties = ("eval", "pair.json", "--points", "ties.npy", "--gradient", "autodiff", "-o", "out.npz")
        self.succeed(*ties)
        self.assertNotIn("one_sided", self.result("out.npz"))
        self.succeed(*ties, "--one-sided")
        result = self.result("out.npz")
        self.assertEqual([1, 1, 0, 0], list(result["ambiguous"].numbers))
        self.assertEqual(("<f4", (4, 2, 2)), (result["one_sided"].descr, result["one_sided"].shape))
        sides = result["one_sided"].numbers
        for found, expected in zip(sides[:4], (1, 0, -1, 0), strict=True):
            self.assertAlmostEqual(expected, found, delta=1e-3)
        self.assertEqual(sides[8:10], sides[10:12])
        self.assertTrue(math.isnan(sides[12]))

    def test_the_offset_is_absolute_or_relative_to_the_field_or_to_the_scene(self):
        central = (*self.command, "--gradient", "central", "-o", "out.npz", "--gradient-offset")
        seen = {}
        # f(0, -2) = 0 and f(3, 4) = 3; the diagonal of the circle's bounds is 4 sqrt(2).
        for offset in ("0.5", "f:0.5", "scene:0.5", "scene:0.5,0.5", "0.01,f:0.5"):
            done = self.succeed(*central, offset, "--json")
            seen[offset] = self.result("out.npz")["gradient"].numbers
            self.assertTrue(json.loads(done.stdout)["gradient_offset"])
        self.assertEqual(0, math.hypot(*seen["f:0.5"][4:6]), "no offset at the surface, no difference")
        self.assertNotEqual(seen["0.5"], seen["scene:0.5"])
        self.assertEqual(seen["scene:0.5"], seen["scene:0.5,0.5"])
        self.assertEqual(seen["f:0.5"][2:4], seen["0.01,f:0.5"][2:4])

    def test_an_offset_that_cannot_be_is_refused(self):
        self.scene("plane.json", HALF_PLANE)
        for offset in ("0", "-1", "x", "f:", "1,", "scene:nan", "g:1"):
            with self.subTest(offset=offset):
                line = self.refuse(*self.command, "--gradient", "central", "--gradient-offset", offset, "-o", "out.npz")
                self.assertIn(": --gradient-offset: ", line)
        plane = ("eval", "plane.json", "--points", "points.npy", "--gradient", "central", "-o", "out.npz")
        self.assertIn(": --gradient-offset: ", self.refuse(*plane, "--gradient-offset", "scene:1e-3"))
        self.refuse(*self.command, "--gradient-offset", "1", "-o", "out.npz")

    def test_a_dichotomy_of_space_is_refused(self):
        self.save("points3.npy", [1, 2, 3], (1, 3))
        for strategy in ("dichotomy", "dichotomy:verbatim"):
            line = self.refuse("eval", "sphere.json", "--points", "points3.npy", "--gradient", strategy, "-o", "out.npz")
            self.assertIn(": --gradient: expected a strategy for 3D", line)

    def test_an_unknown_strategy_is_refused(self):
        self.assertIn(": --gradient: ", self.refuse(*self.command, "--gradient", "guess", "-o", "out.npz"))

    def test_one_array_may_be_npy(self):
        self.succeed(*self.command, "-o", "out.npy")
        self.assert_values(arrays.parse_npy((self.folder / "out.npy").read_bytes()))

    def test_float64_and_csv_points_give_the_same_bytes(self):
        self.succeed(*self.command, "-o", "out.npz")
        self.save("double.npy", [number for point in POINTS for number in point], (4, 2), "<f8")
        (self.folder / "points.csv").write_text("x,y\n" + "".join(f"{x},{y}\n" for x, y in POINTS), encoding="utf-8")
        expected = (self.folder / "out.npz").read_bytes()
        for points in ("double.npy", "points.csv"):
            self.succeed("eval", "circle.json", "--points", points, "-o", "again.npz")
            self.assertEqual(expected, (self.folder / "again.npz").read_bytes(), points)

    def test_stdin_and_stdout_carry_arrays_and_the_summary_goes_to_stderr(self):
        points = (self.folder / "points.npy").read_bytes()
        done = self.succeed("eval", "circle.json", "--points", "-", "-o", "-", stdin=points)
        self.assert_values(arrays.parse_npz(done.stdout)["value"])
        self.assertIn(b"points", done.stderr)
        done = self.succeed("eval", "circle.json", "--points", "-", "-o", "-", "--quiet", stdin=b"0.5,0\n3,4\n0,-2\n-1,1\n")
        self.assert_values(arrays.parse_npz(done.stdout)["value"])
        self.assertEqual(b"", done.stderr)

    def test_the_scene_may_come_from_stdin(self):
        self.succeed("eval", "-", "--points", "points.npy", "-o", "out.npz", stdin=json.dumps(CIRCLE).encode())
        self.assert_values(self.result("out.npz")["value"])

    def test_no_points_give_no_values(self):
        self.save("none.npy", [], (0, 2))
        self.succeed("eval", "circle.json", "--points", "none.npy", "--gradient", "central", "-o", "out.npz")
        result = self.result("out.npz")
        self.assertEqual((0,), result["value"].shape)
        self.assertEqual((0, 2), result["gradient"].shape)

    def test_a_bad_row_is_nan_and_counted_and_the_others_are_answered(self):
        self.save("bad.npy", [math.nan, 0, 3, 4, 0, math.inf, 2e15, 0], (4, 2))
        done = self.succeed("eval", "circle.json", "--points", "bad.npy", "-o", "out.npz", "--json")
        value = self.result("out.npz")["value"].numbers
        self.assertEqual([True, False, True, True], [math.isnan(number) for number in value])
        self.assertAlmostEqual(3, value[1], delta=1e-5)
        report = json.loads(done.stdout)
        self.assertEqual((4, 3), (report["rows"], report["bad_rows"]))

    def test_threads_do_not_change_the_bytes(self):
        numbers = [math.sin(i) * 5 for i in range(20000)]
        self.save("many.npy", numbers, (10000, 2))
        results = set()
        for threads in ("1", "2", "0"):
            self.succeed("eval", "circle.json", "--points", "many.npy", "--threads", threads, "-o", "out.npz")
            results.add((self.folder / "out.npz").read_bytes())
        self.assertEqual(1, len(results))


if __name__ == "__main__":
    unittest.main()
