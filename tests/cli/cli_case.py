# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""What every test of the command shares: the program, a folder of its own, scenes, and the form of an error."""

import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import arrays

PROGRAM = os.environ["THALWEG"]
ERROR_LINE = re.compile(r"thalweg: [^\n]+: [^\n]+: expected [^\n]+, found [^\n]+\n")

CIRCLE = {"thalweg": 1, "dimension": 2, "shape": {"op": "circle", "radius": 2}}
SPHERE = {"thalweg": 1, "dimension": 3, "shape": {"op": "sphere", "radius": 2}}
HALF_PLANE = {"thalweg": 1, "dimension": 2, "shape": {"op": "half_plane", "normal": [0, 1], "offset": 0}}
THESIS = {
    "thalweg": 1,
    "dimension": 2,
    "shape": {
        "op": "smooth_union",
        "k": 1.0,
        "of": [
            {
                "op": "translate",
                "by": [1000, 550],
                "of": {"op": "star", "radius": 300, "points": 12, "sharpness": 4.0},
            },
            {"op": "translate", "by": [750, 400], "of": {"op": "circle", "radius": 200}},
        ],
    },
}


class CliCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.scene("circle.json", CIRCLE)
        self.scene("sphere.json", SPHERE)

    def scene(self, name: str, scene: dict) -> None:
        (self.folder / name).write_text(json.dumps(scene), encoding="utf-8")

    def save(self, name: str, numbers: list, shape: tuple[int, ...], descr: str = "<f4") -> None:
        (self.folder / name).write_bytes(arrays.npy_bytes(numbers, shape, descr))

    def run_program(self, *arguments: str, stdin: bytes = b"", **options) -> subprocess.CompletedProcess:
        """Runs the command in the test's folder; output and errors are bytes."""
        return subprocess.run(
            [PROGRAM, *arguments], cwd=self.folder, input=stdin, capture_output=True, timeout=300, check=False, **options
        )

    def succeed(self, *arguments: str, stdin: bytes = b"") -> subprocess.CompletedProcess:
        done = self.run_program(*arguments, stdin=stdin)
        self.assertEqual(0, done.returncode, done.stderr.decode())
        return done

    def refuse(self, *arguments: str, code: int = 1, stdin: bytes = b"") -> str:
        """The error line of a command that must fail, and must leave no new file behind."""
        before = sorted(self.folder.iterdir())
        done = self.run_program(*arguments, stdin=stdin)
        line = done.stderr.decode()
        self.assertEqual(code, done.returncode, line)
        self.assertRegex(line, re.compile(rf"\A{ERROR_LINE.pattern}\Z"))
        self.assertEqual(b"", done.stdout)
        self.assertEqual(before, sorted(self.folder.iterdir()))
        return line

    def result(self, name: str) -> dict[str, arrays.Array]:
        return arrays.parse_npz((self.folder / name).read_bytes())
