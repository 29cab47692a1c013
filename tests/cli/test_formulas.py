# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""Programs and expressions as scenes."""

import json
import math
import unittest

from cli_case import CliCase

DISC = """# a disc of radius 2
x var-x
y var-y
x2 square x
y2 square y
sum add x2 y2
r sqrt sum
two const 2
f sub r two
"""


class Formulas(CliCase):
    def setUp(self):
        super().setUp()
        (self.folder / "disc.vm").write_text(DISC, encoding="utf-8")
        self.save("points.npy", [0, 0, 3, 4, 2, 0], (3, 2))

    def expression(self, name: str, text: str, dimension: int = 2) -> None:
        self.scene(name, {"thalweg": 1, "dimension": dimension, "shape": {"op": "expression", "text": text}})

    def test_a_program_is_a_scene(self):
        self.succeed("eval", "disc.vm", "--points", "points.npy", "--gradient", "autodiff", "-o", "out.npz")
        result = self.result("out.npz")
        for found, expected in zip(result["value"].numbers, (-2, 3, 0), strict=True):
            self.assertAlmostEqual(expected, found, delta=1e-6)
        for found, expected in zip(result["gradient"].rows()[1], (0.6, 0.8), strict=True):
            self.assertAlmostEqual(expected, found, delta=1e-6)

    def test_the_dimension_follows_from_the_coordinates(self):
        (self.folder / "ball.vm").write_text(DISC.replace("two const 2", "two var-z"), encoding="utf-8")
        for scene, dimension in [("disc.vm", 2), ("ball.vm", 3)]:
            report = json.loads(self.succeed("info", scene, "--json").stdout)
            self.assertEqual(dimension, report["dimension"])
            self.assertEqual("sign only", report["facts"]["exactness"]["outside"])

    def test_a_picture_shows_what_is_around_the_origin(self):
        done = self.succeed("render", "disc.vm", "-o", "out.png", "--size", "16", "16", "--json")
        self.assertEqual([-1, -1, 1, 1], json.loads(done.stdout)["bounds"])
        self.assertEqual(b"\x89PNG", (self.folder / "out.png").read_bytes()[:4])

    def test_a_node_may_name_a_program_beside_its_scene(self):
        (self.folder / "parts").mkdir()
        (self.folder / "parts" / "disc.vm").write_text(DISC, encoding="utf-8")
        moved = {"op": "translate", "by": [3, 4], "of": {"op": "vm", "file": "disc.vm"}}
        scene = json.dumps({"thalweg": 1, "dimension": 2, "shape": moved})
        (self.folder / "parts" / "scene.json").write_text(scene, encoding="utf-8")
        self.succeed("eval", "parts/scene.json", "--points", "points.npy", "-o", "out.npz")
        self.assertAlmostEqual(-2, self.result("out.npz")["value"].numbers[1], delta=1e-6)
        line = self.refuse("eval", "-", "--points", "points.npy", "-o", "no.npz", stdin=scene.replace("disc", "none").encode())
        self.assertIn("stdin: /shape/of/file: expected a readable file", line)

    def test_faults_have_a_line_and_a_column(self):
        (self.folder / "bad.vm").write_text("x var-x\ny foo x\n", encoding="utf-8")
        self.assertIn('bad.vm: 2:3: expected an opcode, found "foo"', self.refuse("info", "bad.vm"))
        (self.folder / "mix.vm").write_text("x var-x\ny rand x\n", encoding="utf-8")
        self.assertIn("mix.vm: 2:3: expected an opcode that is supported", self.refuse("info", "mix.vm"))
        self.expression("bad.json", "x + (y")
        self.assertIn("bad.json: /shape/text:1:7: expected", self.refuse("info", "bad.json"))
        self.assertIn(": expected a readable file", self.refuse("info", "none.vm"))

    def test_undefined_values_are_counted(self):
        self.expression("root.json", "sqrt(x) + 1/y + log(x + 1)")
        self.save("some.npy", [1, 1, -1, 1, 1, 0, math.nan, 0], (4, 2))
        for threads in ("1", "2"):
            done = self.succeed("eval", "root.json", "--points", "some.npy", "-o", "out.npz", "--json", "--threads", threads)
            report = json.loads(done.stdout)
            self.assertEqual((4, 1, 2), (report["rows"], report["bad_rows"], report["undefined_rows"]))
            value = self.result("out.npz")["value"].numbers
            self.assertEqual([False, True, True, True], [math.isnan(x) for x in value])

    def test_queries_are_proven(self):
        self.expression("waves.json", "y - sin(x)")
        self.save("triangles.npy", [0, 2, 1, 3, 2, 2, 0, -3, 1, 1, 2, -3, 0, 0, 0, 0, 0, 0, 1, 1.5, 2, 1.5, 1, 1.6], (4, 3, 2))
        done = self.succeed("collide", "waves.json", "--triangles", "triangles.npy", "-o", "out.npz", "--json")
        result = self.result("out.npz")
        self.assertEqual([0, 1, 2, 0], result["status"].numbers, done.stdout)
        self.assertEqual(4, json.loads(done.stdout)["rows"])
        self.save("circles.npy", [0, 3, 1, 0, 0, 0.5, 1.5708, 1.5, 0.49], (3, 3))
        self.succeed("collide", "waves.json", "--circles", "circles.npy", "-o", "out.npz", "--goal", "deepest")
        self.assertEqual([0, 1, 0], self.result("out.npz")["status"].numbers)

    def test_undefined_queries_are_undecided(self):
        self.expression("root.json", "1 + sqrt(x)")
        self.save("triangles.npy", [-3, 0, -2, 0, -2, 1, 1, 0, 2, 0, 2, 1], (2, 3, 2))
        self.succeed("collide", "root.json", "--triangles", "triangles.npy", "-o", "out.npz")
        self.assertEqual([3, 0], self.result("out.npz")["status"].numbers)

    def test_local_methods_prove_their_witness(self):
        self.save("triangles.npy", [0, 0, 1, 0, 0, 1, 5, 5, 6, 5, 5, 6], (2, 3, 2))
        for method in ("thesis", "projected", "frank_wolfe", "accelerated"):
            self.succeed("collide", "disc.vm", "--triangles", "triangles.npy", "--method", method, "-o", "out.npz")
            self.assertEqual([1, 3], self.result("out.npz")["status"].numbers, method)

    def test_pairs_are_refused(self):
        self.save("poses.npy", [0, 0, 0], (1, 3))
        line = self.refuse("collide", "circle.json", "--with", "disc.vm", "--poses", "poses.npy", "-o", "out.npz")
        self.assertIn("expected shapes with a Lipschitz constant, found a formula", line)


if __name__ == "__main__":
    unittest.main()
