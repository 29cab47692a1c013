# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""`thalweg collide`: every column with its type and shape, verdicts that are plain to see, and bad rows."""

import json
import math
import os
import random
import subprocess
import unittest

import arrays
from cli_case import THESIS, CliCase

CHECKER = os.environ["THALWEG_CHECK_PROOF"]
SEPARATED, OVERLAPPING, TOUCHING, UNDECIDED, BAD_ROW = 0, 1, 2, 3, 255

COLUMNS = {
    "status": ("|u1", ()),
    "value": ("<f4", ()),
    "lower": ("<f4", ()),
    "converged": ("|u1", ()),
    "point": ("<f4", ("d",)),
    "normal": ("<f4", ("d",)),
    "barycentric": ("<f4", (3,)),
    "claimed": ("|u1", ()),
    "starts": ("<u4", ()),
    "iterations": ("<u4", ()),
    "evaluations": ("<u4", ()),
    "ambiguous": ("|u1", ()),
    "stop": ("|u1", ()),
}
STOP_GOAL, STOP_BUDGET, STOP_ITERATIONS, STOP_SMALL_STEP = 1, 2, 3, 4

LOCAL_METHODS = (
    "accelerated",
    "thesis",
    "thesis_fixed",
    "thesis_scaled",
    "projected",
    "frank_wolfe",
    "frank_wolfe_search",
    "golden_section",
    "distance_step",
)

# Against the circle of radius 2 about the origin.
TRIANGLES = [
    (5, 5, 6, 5, 5, 6),  # far away
    (-1, -1, 1, -1, 0, 1),  # wholly inside
    (1, 0, 4, -1, 4, 1),  # one corner inside
    (-9, -9, 9, -9, 0, 20),  # swallows the circle
    (0, 0, 0, 0, 0, 0),  # a point
    (2.5, -4, 2.5, 4, 2.5, 0),  # a segment that passes by
]
VERDICTS = [SEPARATED, OVERLAPPING, OVERLAPPING, OVERLAPPING, OVERLAPPING, SEPARATED]


class CollideCase(CliCase):
    def collide(self, *arguments: str, scene: str = "circle.json") -> dict[str, arrays.Array]:
        self.succeed("collide", scene, *arguments, "-o", "out.npz")
        return self.result("out.npz")

    def save_triangles(self, triangles: list, dimension: int = 2) -> None:
        numbers = [number for triangle in triangles for number in triangle]
        self.save("triangles.npy", numbers, (len(triangles), 3, dimension))

    def assert_columns(self, result: dict[str, arrays.Array], count: int, dimension: int, triangles: bool) -> None:
        expected = {
            name: (descr, (count, *(dimension if length == "d" else length for length in inner)))
            for name, (descr, inner) in COLUMNS.items()
            if triangles or name != "barycentric"
        }
        self.assertEqual(expected, {name: (array.descr, array.shape) for name, array in result.items()})


STRATEGIES = ("autodiff", "central", "forward", "simplex", "dichotomy", "dichotomy:verbatim", "closest_point")


class Strategies(CollideCase):
    """`--gradient` with each method: the steps of a descent, and the normals of all."""

    COST = dict(zip(STRATEGIES, (1, 5, 3, 4, 12, 12, 1), strict=True))  # with |f| for the offset

    def assert_normals_point_out_of_the_circle(self, result: dict[str, arrays.Array]) -> None:
        for (x, y), (nx, ny) in zip(result["point"].rows(), result["normal"].rows(), strict=True):
            self.assertAlmostEqual(x / math.hypot(x, y), nx, delta=2e-2)
            self.assertAlmostEqual(y / math.hypot(x, y), ny, delta=2e-2)

    def test_give_the_normals_of_proven_verdicts_and_are_counted(self):
        self.save_triangles([(1, 0, 4, -1, 4, 1), (2.5, -4, 2.5, 4, 3, 0), (0.3, 0.4, 1, 2, 2, 2)])
        plain = self.collide("--triangles", "triangles.npy")
        for strategy in STRATEGIES:
            with self.subTest(strategy=strategy):
                result = self.collide("--triangles", "triangles.npy", "--gradient", strategy)
                self.assert_normals_point_out_of_the_circle(result)
                self.assertEqual(plain["status"].numbers, result["status"].numbers)
                more = 0 if strategy == "autodiff" else self.COST[strategy]
                self.assertEqual([n + more for n in plain["evaluations"].numbers], list(result["evaluations"].numbers))

    def test_step_every_descent_and_are_counted(self):
        self.save_triangles([(1, 0, 4, -1, 4, 1), (3, 0, 4, -1, 4, 1)])
        for method in ("thesis", "projected"):
            for strategy in STRATEGIES:
                with self.subTest(method=method, strategy=strategy):
                    triangles = ("--triangles", "triangles.npy", "--method", method, "--gradient", strategy)
                    result = self.collide(*triangles, "--iterations", "7", "--starts", "2")
                    self.assertEqual([1, 0], list(result["claimed"].numbers))
                    self.assert_normals_point_out_of_the_circle(result)
                    # The thesis' step has an evaluation of its own.
                    step = self.COST[strategy] + (1 if method == "thesis" else 0)
                    normal = 0 if strategy == "autodiff" else self.COST[strategy]
                    for found, iterations in zip(
                        result["evaluations"].numbers, result["iterations"].numbers, strict=True
                    ):
                        self.assertEqual(iterations * step + normal, found)

    def test_find_the_deepest_point_of_a_disc_as_published(self):
        self.save("circles.npy", [3, 0, 1.5, 0, -5, 1], (2, 3))
        for strategy in STRATEGIES:
            with self.subTest(strategy=strategy):
                result = self.collide("--circles", "circles.npy", "--method", "published", "--gradient", strategy)
                self.assertEqual([1, 0], list(result["claimed"].numbers))
                self.assertAlmostEqual(1.5, result["point"].numbers[0], delta=1e-2)
                self.assert_normals_point_out_of_the_circle(result)
                normal = 0 if strategy == "autodiff" else self.COST[strategy]
                cost = self.COST[strategy] + 1 + normal
                self.assertEqual([cost] * 2, list(result["evaluations"].numbers))

    def test_kinks_are_told_and_shown_from_both_sides(self):
        corner = {"op": "intersection", "of": [{"op": "half_plane", "normal": n, "offset": 0} for n in ([1, 0], [0, 1])]}
        self.scene("corner.json", {"thalweg": 1, "dimension": 2, "shape": corner})
        # One ends in the corner, one on the side of it.
        self.save_triangles([(0, 0, 1, 1, 2, 1), (0, -3, 1, -3, 1, -4)])
        result = self.collide("--triangles", "triangles.npy", "--goal", "deepest", "--one-sided", scene="corner.json")
        self.assertEqual([1, 0], list(result["ambiguous"].numbers))
        self.assertEqual(("<f4", (2, 2, 2)), (result["one_sided"].descr, result["one_sided"].shape))
        tied, plain = result["one_sided"].rows()
        self.assertEqual({(1, 0), (0, 1)}, {tuple(map(round, tied[:2])), tuple(map(round, tied[2:]))})
        self.assertEqual((1, 0, 1, 0), plain)

    def test_are_refused_where_they_do_not_exist(self):
        self.save_triangles([(0, 0, 0, 1, 0, 0, 0, 1, 0)], dimension=3)
        self.save("spheres.npy", [0, 0, 0, 1], (1, 4))
        for queries in (("--triangles", "triangles.npy"), ("--circles", "spheres.npy")):
            for strategy in ("dichotomy", "dichotomy:verbatim"):
                line = self.refuse("collide", "sphere.json", *queries, "--gradient", strategy, "-o", "out.npz")
                self.assertIn(": --gradient: ", line)


class Triangles(CollideCase):
    def setUp(self):
        super().setUp()
        self.save_triangles(TRIANGLES)

    def test_verdicts_and_columns_of_the_plane(self):
        result = self.collide("--triangles", "triangles.npy")
        self.assert_columns(result, len(TRIANGLES), 2, triangles=True)
        self.assertEqual(VERDICTS, result["status"].numbers)

    def test_bounds_points_and_normals_fit_together(self):
        result = self.collide("--triangles", "triangles.npy", "--goal", "deepest")
        for row, triangle in enumerate(TRIANGLES):
            with self.subTest(row=row):
                x, y = result["point"].rows()[row]
                value, lower = result["value"].numbers[row], result["lower"].numbers[row]
                self.assertLessEqual(lower, value + 1e-5)
                self.assertAlmostEqual(math.hypot(x, y) - 2, value, delta=1e-4)
                self.assertAlmostEqual(1, math.hypot(*result["normal"].rows()[row]), delta=1e-5)
                weights = result["barycentric"].rows()[row]
                self.assertAlmostEqual(1, sum(weights), delta=1e-5)
                self.assertAlmostEqual(x, sum(w * triangle[2 * i] for i, w in enumerate(weights)), delta=1e-4)
                self.assertAlmostEqual(y, sum(w * triangle[2 * i + 1] for i, w in enumerate(weights)), delta=1e-4)

    def test_the_deepest_point_is_found(self):
        self.save_triangles([(1, -1, 1, 1, 5, 0), (3, -1, 3, 1, 5, 0)])
        result = self.collide("--triangles", "triangles.npy", "--goal", "deepest", "--tolerance", "1e-3")
        self.assertAlmostEqual(-1, result["value"].numbers[0], delta=2e-3)
        self.assertAlmostEqual(1, result["value"].numbers[1], delta=2e-3)
        self.assertEqual([1, 1], result["converged"].numbers)

    def test_a_tangent_triangle_touches(self):
        self.save_triangles([(2, -1, 2, 1, 5, 0)])
        result = self.collide("--triangles", "triangles.npy")
        self.assertEqual([TOUCHING], result["status"].numbers)

    def test_columns_of_space(self):
        self.save_triangles([(0, 0, 0, 5, 0, 0, 0, 5, 0), (9, 0, 0, 5, 9, 0, 0, 5, 9)], dimension=3)
        result = self.collide("--triangles", "triangles.npy", scene="sphere.json")
        self.assert_columns(result, 2, 3, triangles=True)
        self.assertEqual([OVERLAPPING, SEPARATED], result["status"].numbers)

    def test_no_triangles_give_empty_columns(self):
        self.save("triangles.npy", [], (0, 3, 2))
        done = self.succeed("collide", "circle.json", "--triangles", "triangles.npy", "-o", "out.npz", "--json")
        self.assert_columns(self.result("out.npz"), 0, 2, triangles=True)
        self.assertEqual(0, json.loads(done.stdout)["rows"])

    def test_a_bad_row_is_marked_and_the_others_are_answered(self):
        bad = [(math.nan, 0, 1, 0, 0, 1), (0, math.inf, 1, 0, 0, 1), (0, 0, 2e15, 0, 0, 1)]
        self.save_triangles([TRIANGLES[0], *bad, TRIANGLES[1]])
        done = self.succeed("collide", "circle.json", "--triangles", "triangles.npy", "-o", "out.npz", "--json")
        result = self.result("out.npz")
        self.assertEqual([SEPARATED, BAD_ROW, BAD_ROW, BAD_ROW, OVERLAPPING], result["status"].numbers)
        for name in ("value", "lower", "point", "normal", "barycentric"):
            for row in (1, 2, 3):
                row_numbers = result[name].rows()[row]
                self.assertTrue(all(math.isnan(number) for number in row_numbers), (name, row_numbers))
        report = json.loads(done.stdout)
        self.assertEqual((5, 3), (report["rows"], report["bad_rows"]))

    def test_the_report_counts_what_the_columns_hold(self):
        done = self.succeed("collide", "circle.json", "--triangles", "triangles.npy", "-o", "out.npz", "--json")
        report, result = json.loads(done.stdout), self.result("out.npz")
        self.assertEqual(
            {"separated": 2, "overlapping": 4, "touching": 0, "undecided": 0, "bad_row": 0}, report["status"]
        )
        self.assertEqual(sum(result["evaluations"].numbers), report["evaluations"])
        self.assertEqual("certified", report["method"])
        self.assertGreater(report["elapsed_seconds"], 0)

    def test_the_summary_is_on_stdout_and_quiet_silences_it(self):
        arguments = ("collide", "circle.json", "--triangles", "triangles.npy", "-o", "out.npz")
        self.assertIn(b"overlapping", self.succeed(*arguments).stdout)
        done = self.succeed(*arguments, "--quiet")
        self.assertEqual((b"", b""), (done.stdout, done.stderr))

    def test_stdin_and_stdout_carry_arrays(self):
        triangles = (self.folder / "triangles.npy").read_bytes()
        done = self.succeed("collide", "circle.json", "--triangles", "-", "-o", "-", stdin=triangles)
        self.assertEqual(VERDICTS, arrays.parse_npz(done.stdout)["status"].numbers)
        self.assertIn(b"overlapping", done.stderr)

    def test_meshes_are_triangles(self):
        obj = "".join(f"v {t[2 * i]} {t[2 * i + 1]} 0\n" for t in TRIANGLES for i in range(3))
        obj += "".join(f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}\n" for i in range(len(TRIANGLES)))
        (self.folder / "triangles.obj").write_text(obj, encoding="utf-8")
        self.assertEqual(VERDICTS, self.collide("--triangles", "triangles.obj")["status"].numbers)

    def test_options_are_read_strictly(self):
        collide = ("collide", "circle.json", "--triangles", "triangles.npy", "-o", "out.npz")
        for option, value in [
            ("--tolerance", "0"),
            ("--tolerance", "-1"),
            ("--tolerance", "nan"),
            ("--tolerance", "small"),
            ("--budget", "0"),
            ("--budget", "-1"),
            ("--budget", "4294967296"),
            ("--starts", "many"),
            ("--iterations", "1e3"),
            ("--method", "magic"),
            ("--goal", "quickest"),
            ("--gradient", "guess"),
            ("--start", "anywhere"),
            ("--step", "0"),
            ("--floor", "-1"),
            ("--stop", "little"),
        ]:
            with self.subTest(option=option, value=value):
                self.assertIn(f": {option}: ", self.refuse(*collide, option, value))

    def test_options_that_the_queries_do_not_take_are_refused(self):
        self.save("circles.npy", [4, 0, 1], (1, 3))
        self.save("poses.npy", [4, 0, 1], (1, 3))
        queries = {
            "--triangles": ("--triangles", "triangles.npy"),
            "--circles": ("--circles", "circles.npy"),
            "--with": ("--with", "circle.json", "--poses", "poses.npy"),
        }
        for asked, option in [
            ("--circles", ("--start", "halton")),
            ("--circles", ("--starts", "4")),
            ("--circles", ("--iterations", "4")),
            ("--circles", ("--stop-at-witness",)),
            ("--circles", ("--margin", "1")),
            ("--circles", ("--feature", "1")),
            ("--with", ("--explain", "0")),
            ("--with", ("--one-sided",)),
            ("--with", ("--step", "1")),
            ("--with", ("--floor", "1")),
            ("--with", ("--stop", "1")),
            ("--triangles", ("--region", "1")),
            ("--triangles", ("--paths",)),
        ]:
            with self.subTest(asked=asked, option=option):
                line = self.refuse("collide", "circle.json", *queries[asked], *option, "-o", "out.npz")
                self.assertRegex(line, rf": {option[0]}: expected --.*, found {asked}\n")

    def test_a_row_that_double_cannot_tell_has_not_converged(self):
        self.save_triangles([(-1e15, -1e15, 1e15, -1e15, 0, 1e15)])
        for goal in ("verdict", "deepest"):
            result = self.collide("--triangles", "triangles.npy", "--goal", goal)
            self.assertEqual([UNDECIDED], result["status"].numbers)
            self.assertEqual([0], result["converged"].numbers)
            self.assertEqual([STOP_BUDGET], result["stop"].numbers)

    def test_exactly_one_kind_of_query_is_asked(self):
        self.refuse("collide", "circle.json", "-o", "out.npz")
        self.refuse("collide", "circle.json", "--triangles", "triangles.npy", "--circles", "x.npy", "-o", "out.npz")

    def test_a_local_method_proves_no_separation(self):
        for method in LOCAL_METHODS + ("descent",):
            with self.subTest(method=method):
                result = self.collide("--triangles", "triangles.npy", "--method", method)
                self.assert_columns(result, len(TRIANGLES), 2, triangles=True)
                self.assertEqual(UNDECIDED, result["status"].numbers[0])
                self.assertEqual(0, result["claimed"].numbers[0])
                self.assertEqual(1, result["claimed"].numbers[1])

    def test_the_reason_of_stopping_is_reported(self):
        certified = self.collide("--triangles", "triangles.npy")
        self.assertEqual([STOP_GOAL] * len(TRIANGLES), certified["stop"].numbers)
        thesis = self.collide("--triangles", "triangles.npy", "--method", "thesis")
        self.assertEqual([STOP_ITERATIONS] * len(TRIANGLES), thesis["stop"].numbers)

    def test_starts_and_rules_of_local_methods_are_options(self):
        local = ("--triangles", "triangles.npy", "--method", "projected")
        result = self.collide(*local, "--start", "halton", "--starts", "5", "--iterations", "3")
        self.assertEqual([5] * len(TRIANGLES), result["starts"].numbers)
        self.assertTrue(all(n <= 15 for n in result["iterations"].numbers))
        result = self.collide(*local[:2], "--method", "thesis", "--step", "0.5", "--floor", "2", "--stop", "2")
        self.assertEqual([1] * len(TRIANGLES), result["iterations"].numbers)
        self.assertEqual([STOP_SMALL_STEP] * len(TRIANGLES), result["stop"].numbers)
        line = self.refuse("collide", "circle.json", *local, "--start", "vertices", "--starts", "4", "-o", "out2.npz")
        self.assertIn(": --starts: expected at most 3 for --start vertices, found 4", line)

    def test_help_lists_every_method_and_the_global_options(self):
        text = self.succeed("collide", "--help").stdout.decode()
        self.assertIn("--threads, --isa, --seed, --json, --quiet", text)
        self.assertRegex(text, r"midsurface +pairs; ")
        for method in ("certified", "published") + LOCAL_METHODS:
            self.assertIn(method, text)

    def test_threads_do_not_change_the_bytes(self):
        self.scene("thesis.json", THESIS)
        generator = random.Random(1)
        centres = [(generator.uniform(0, 1920), generator.uniform(0, 1080)) for _ in range(3000)]
        self.save_triangles([[c + generator.uniform(-60, 60) for c in centre * 3] for centre in centres])
        results = set()
        for threads in ("1", "2", "3", "0"):
            self.collide("--triangles", "triangles.npy", "--threads", threads, scene="thesis.json")
            results.add((self.folder / "out.npz").read_bytes())
        self.assertEqual(1, len(results))


class Contacts(CollideCase):
    """Two discs above an edge: the right one is the deeper."""

    def setUp(self):
        super().setUp()
        disc = {"op": "circle", "radius": 1}
        of = [{"op": "translate", "by": [x, y], "of": disc} for x, y in ((0, 0.9), (6, 0.8))]
        self.scene("discs.json", {"thalweg": 1, "dimension": 2, "shape": {"op": "union", "of": of}})
        self.save_triangles([(-3, 0, 9, 0, 3, -5), (-3, -9, 9, -9, 3, -12)])

    def contacts(self, *arguments: str) -> dict[str, arrays.Array]:
        return self.collide("--triangles", "triangles.npy", *arguments, scene="discs.json")

    def test_every_contact_is_listed_deepest_first(self):
        result = self.contacts("--contacts", "8")
        self.assertEqual([0, 2, 2], result["contact_offset"].numbers)
        self.assertEqual([2, 0], result["contact_found"].numbers)
        self.assertEqual([("<u4", (3,)), ("<u4", (2,)), ("<f4", (2,)), ("<f4", (2, 2)), ("<f4", (2, 2)), ("<f4", (2, 3))],
                         [(result["contact_" + name].descr, result["contact_" + name].shape)
                          for name in ("offset", "found", "value", "point", "normal", "barycentric")])
        for found, expected in zip(result["contact_value"].numbers, (-0.2, -0.1)):
            self.assertAlmostEqual(expected, found, delta=1e-3)
        for (x, y), expected in zip(result["contact_point"].rows(), (6, 0)):
            self.assertAlmostEqual(expected, x, delta=0.05)
            self.assertAlmostEqual(0, y, delta=1e-5)
        for x, y in result["contact_normal"].rows():
            self.assertAlmostEqual(-1, y, delta=1e-2)

    def test_the_cut_is_counted(self):
        result = self.contacts("--contacts", "1")
        self.assertEqual([0, 1, 1], result["contact_offset"].numbers)
        self.assertEqual([2, 0], result["contact_found"].numbers)

    def test_the_margin_reaches_out(self):
        result = self.contacts("--contacts", "4", "--margin", "9", "--feature", "0.5")
        self.assertGreaterEqual(result["contact_found"].numbers[1], 1)

    def test_circles_and_counts_that_make_no_sense_are_refused(self):
        self.save("circles.npy", [4, 0, 1], (1, 3))
        collide = ("collide", "discs.json", "-o", "out.npz")
        self.assertIn(": --contacts: ", self.refuse(*collide, "--circles", "circles.npy", "--contacts", "2"))
        self.assertIn(": --contacts: ", self.refuse(*collide, "--triangles", "triangles.npy", "--contacts", "0"))
        self.assertIn(": --margin: ", self.refuse(*collide, "--triangles", "triangles.npy", "--margin", "-1"))


class Proofs(CollideCase):
    def setUp(self):
        super().setUp()
        self.save_triangles(TRIANGLES)

    def check(self, proof: str) -> subprocess.CompletedProcess:
        return subprocess.run([CHECKER, "circle.json", proof], cwd=self.folder, capture_output=True, check=False)

    def test_the_proof_of_every_row_is_accepted(self):
        for row, verdict in enumerate(VERDICTS):
            with self.subTest(row=row):
                done = self.succeed("collide", "circle.json", "--triangles", "triangles.npy", "--explain", str(row),
                                    "-o", "proof.json", "--json")
                report = json.loads(done.stdout)
                self.assertEqual(("separated", "overlapping")[verdict], report["status"])
                proof = json.loads((self.folder / "proof.json").read_text(encoding="utf-8"))
                self.assertEqual((1, row, report["status"]), (proof["thalweg_proof"], proof["row"], proof["row_status"]))
                self.assertEqual(0, self.check("proof.json").returncode)

    def test_a_proof_of_a_circle_is_accepted_and_a_forged_one_is_not(self):
        self.save("circles.npy", [4, 0, 1.9], (1, 3))
        self.succeed("collide", "circle.json", "--circles", "circles.npy", "--explain", "0", "-o", "proof.json")
        self.assertEqual(0, self.check("proof.json").returncode)
        proof = json.loads((self.folder / "proof.json").read_text(encoding="utf-8"))
        for forge in (lambda p: p["cells"].pop(), lambda p: p.update(radius=2.1), lambda p: p.update(status="overlapping")):
            forged = json.loads(json.dumps(proof))
            forge(forged)
            (self.folder / "forged.json").write_text(json.dumps(forged), encoding="utf-8")
            done = self.check("forged.json")
            self.assertEqual(1, done.returncode)
            self.assertIn(b"expected a proof of", done.stderr)

    def test_a_tolerance_that_nobody_asked_for_is_refused(self):
        self.save_triangles([(2, -1, 2, 1, 5, 0)])
        explain = ("collide", "circle.json", "--triangles", "triangles.npy", "--explain", "0", "-o", "proof.json")
        self.succeed(*explain)
        self.assertEqual(0, self.check("proof.json").returncode)
        self.succeed(*explain, "--tolerance", "0.5")
        self.assertIn(b"the tolerance is not the one asked for", self.check("proof.json").stderr)

    def test_rows_that_are_not_there_are_refused(self):
        for row in ("6", "-1", "first"):
            line = self.refuse("collide", "circle.json", "--triangles", "triangles.npy", "--explain", row, "-o", "p.json")
            self.assertIn(": --explain: ", line)


class Circles(CollideCase):
    def test_verdicts_and_columns_of_the_plane(self):
        self.save("circles.npy", [4, 0, 1, 3, 0, 1.5, 0, 0, 0.5, 0, 0, 9, 1, 0, 0], (5, 3))
        result = self.collide("--circles", "circles.npy")
        self.assert_columns(result, 5, 2, triangles=False)
        self.assertEqual([SEPARATED, OVERLAPPING, OVERLAPPING, OVERLAPPING, OVERLAPPING], result["status"].numbers)

    def test_spheres_of_space(self):
        self.save("spheres.npy", [4, 0, 0, 1, 3, 0, 0, 1.5], (2, 4))
        result = self.collide("--circles", "spheres.npy", scene="sphere.json")
        self.assert_columns(result, 2, 3, triangles=False)
        self.assertEqual([SEPARATED, OVERLAPPING], result["status"].numbers)

    def test_no_circles_give_empty_columns(self):
        self.save("circles.npy", [], (0, 3))
        self.assert_columns(self.collide("--circles", "circles.npy"), 0, 2, triangles=False)

    def test_a_bad_row_is_marked(self):
        self.save("circles.npy", [4, 0, math.nan, 4, 0, 1], (2, 3))
        self.assertEqual([BAD_ROW, SEPARATED], self.collide("--circles", "circles.npy")["status"].numbers)

    def test_the_published_method_answers_circles(self):
        self.save("circles.npy", [4, 0, 1, 3, 0, 1.5], (2, 3))
        result = self.collide("--circles", "circles.npy", "--method", "published")
        self.assertEqual([0, 1], result["claimed"].numbers)

    def test_circles_of_another_width_are_refused(self):
        self.save("circles.npy", [4, 0, 1, 2], (1, 4))
        line = self.refuse("collide", "circle.json", "--circles", "circles.npy", "-o", "out.npz")
        self.assertIn("expected (N, 3) for circles, found (1, 4)", line)


if __name__ == "__main__":
    unittest.main()
