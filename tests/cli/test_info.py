# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""`thalweg info` and `thalweg ops`: what programs read from them."""

import json
import unittest

from cli_case import HALF_PLANE, THESIS, CliCase


class Info(CliCase):
    def info(self, *arguments: str) -> dict:
        return json.loads(self.succeed("info", *arguments, "--json").stdout)

    def test_simd_targets_are_listed_without_a_scene(self):
        simd = self.info()["simd"]
        self.assertIn(simd["active"], [target["name"] for target in simd["available"]])
        for target in simd["available"]:
            self.assertEqual({"name": str, "fused_multiply_add": bool}, {key: type(v) for key, v in target.items()})

    def test_a_target_is_forced_by_name_in_any_case(self):
        for target in self.info()["simd"]["available"]:
            self.assertEqual(target["name"], self.info("--isa", target["name"].lower())["simd"]["active"])

    def test_facts_of_a_scene(self):
        self.scene("thesis.json", THESIS)
        report = self.info("thesis.json")
        self.assertEqual((2, 5), (report["dimension"], report["nodes"]))
        facts = report["facts"]
        self.assertEqual({"outside", "inside"}, set(facts["exactness"]))
        self.assertEqual((1, False, False), (facts["lipschitz"], facts["convex"], facts["unsigned"]))
        self.assertEqual([2, 2], [len(facts["bounds"][side]) for side in ("lo", "hi")])
        self.assertEqual({"instructions", "registers", "positions", "constants"}, set(report["tape"]))
        self.assertIn("slack", report)
        self.assertEqual(5, len(report["shapes"]))
        self.assertEqual("smooth_union", report["shapes"][-1]["op"])

    def test_infinite_bounds_are_null(self):
        self.scene("plane.json", HALF_PLANE)
        bounds = self.info("plane.json")["facts"]["bounds"]
        self.assertIn(None, bounds["lo"])
        self.assertFalse(bounds["empty"])

    def test_the_tape_is_printed_on_request(self):
        self.assertIn(b"circle", self.succeed("info", "circle.json", "--tape").stdout)
        self.assertIn("circle", self.info("circle.json", "--tape")["disassembly"])
        self.refuse("info", "--tape")

    def test_the_scene_may_come_from_stdin(self):
        self.succeed("info", "-", stdin=json.dumps(THESIS).encode())


class Ops(CliCase):
    def test_every_op_has_parameters_dimension_and_exactness(self):
        ops = json.loads(self.succeed("ops", "--json").stdout)["ops"]
        self.assertGreater(len(ops), 5)
        for op in ops:
            self.assertIn(op["dimension"], (2, 3, None), op)
            self.assertTrue(op["exactness"], op)
            for parameter in op["parameters"]:
                self.assertTrue(parameter["meaning"], op)
        circle = next(op for op in ops if op["name"] == "circle")
        self.assertEqual(["radius"], [parameter["name"] for parameter in circle["parameters"]])

    def test_the_table_names_every_op(self):
        ops = json.loads(self.succeed("ops", "--json").stdout)["ops"]
        table = self.succeed("ops").stdout.decode()
        for op in ops:
            self.assertIn(op["name"], table)

    def test_the_schema_is_json(self):
        schema = json.loads(self.succeed("ops", "--schema").stdout)
        self.assertIn("2020-12", schema["$schema"])

    def test_the_header_is_the_one_that_ships(self):
        self.assertIn(b"namespace thalweg", self.succeed("ops", "--header").stdout)

    def test_forms_exclude_each_other(self):
        self.refuse("ops", "--schema", "--header")
        self.refuse("ops", "--schema", "--json")


if __name__ == "__main__":
    unittest.main()
