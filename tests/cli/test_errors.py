# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""Every error is one line of one form on stderr, with the right exit code and nothing left behind."""

import json
import os
import resource
import signal
import subprocess
import time
import unittest

from cli_case import CIRCLE, PROGRAM, CliCase


class Arguments(CliCase):
    def setUp(self):
        super().setUp()
        self.save("points.npy", [0, 0, 3, 0], (2, 2))
        self.eval = ("eval", "circle.json", "--points", "points.npy")

    def test_a_missing_command_is_refused_with_the_list(self):
        self.assertIn("info, ops, eval, collide, distance, sweep, render", self.refuse())

    def test_an_unknown_command_is_named(self):
        self.assertIn("'bogus'", self.refuse("bogus"))
        self.assertIn("--bogus", self.refuse("--bogus"))

    def test_commands_of_later_versions_are_unknown(self):
        for command in ("sweep", "simulate"):
            self.refuse(command, "circle.json")

    def test_unknown_options_and_extra_arguments_are_refused(self):
        self.assertIn("--bogus", self.refuse(*self.eval, "-o", "out.npz", "--bogus"))
        self.assertIn("extra", self.refuse(*self.eval, "-o", "out.npz", "extra"))

    def test_missing_arguments_are_named(self):
        self.assertIn(": SCENE: ", self.refuse("eval"))
        self.assertIn(": --points: ", self.refuse("eval", "circle.json", "-o", "out.npz"))
        self.assertIn(": --output: ", self.refuse(*self.eval))
        self.assertIn(": --output: ", self.refuse(*self.eval, "-o"))

    def test_numbers_are_read_strictly(self):
        for option, value in [
            ("--threads", "-1"),
            ("--threads", "two"),
            ("--threads", "1.5"),
            ("--threads", "5000"),
            ("--threads", "99999999999999999999"),
            ("--seed", "-1"),
            ("--seed", "0x10"),
        ]:
            with self.subTest(option=option, value=value):
                self.assertIn(f": {option}: ", self.refuse(*self.eval, "-o", "out.npz", option, value))

    def test_an_unknown_simd_target_is_refused_with_the_list(self):
        line = self.refuse("--isa", "abacus", *self.eval, "-o", "out.npz")
        available = json.loads(self.succeed("info", "--json").stdout)["simd"]["available"]
        for target in available:
            self.assertIn(target["name"], line)

    def test_a_flag_takes_no_value(self):
        self.refuse(*self.eval, "-o", "out.npz", "--json=3")

    def test_global_options_stand_before_or_after_the_command(self):
        self.succeed("--threads", "1", *self.eval, "-o", "out.npz")
        self.succeed(*self.eval, "-o", "out.npz", "--threads", "1", "--quiet")

    def test_help_and_version_are_on_stdout(self):
        self.assertIn(b"collide", self.succeed("--help").stdout)
        self.assertRegex(self.succeed("--version").stdout.decode(), r"\Athalweg \d+\.\d+\.\d+\n\Z")
        for command in ("info", "ops", "eval", "collide", "render"):
            self.assertIn(b"Usage:", self.succeed(command, "--help").stdout)


class Files(CliCase):
    def setUp(self):
        super().setUp()
        self.save("points.npy", [0, 0, 3, 0], (2, 2))

    def eval(self, scene: str, points: str, output: str = "out.npz", code: int = 1) -> str:
        return self.refuse("eval", scene, "--points", points, "-o", output, code=code)

    def test_missing_files_are_named(self):
        self.assertTrue(self.eval("none.json", "points.npy").startswith("thalweg: none.json: "))
        self.assertTrue(self.eval("circle.json", "none.npy").startswith("thalweg: none.npy: "))

    def test_a_folder_is_no_file(self):
        self.assertIn("a directory", self.eval(".", "points.npy"))
        (self.folder / "points").mkdir()
        self.assertIn("a directory", self.eval("circle.json", "points"))

    def test_an_empty_scene_is_refused_with_line_and_column(self):
        (self.folder / "empty.json").write_bytes(b"")
        self.assertRegex(self.eval("empty.json", "points.npy"), r"^thalweg: empty\.json: 1:\d+: ")

    def test_a_fault_in_a_scene_has_a_json_pointer(self):
        self.scene("bad.json", {"thalweg": 1, "dimension": 2, "shape": {"op": "circle", "radius": -1}})
        self.assertTrue(self.eval("bad.json", "points.npy").startswith("thalweg: bad.json: /shape/radius: "))

    def test_arrays_of_another_dimension_are_refused(self):
        self.save("points3.npy", [0, 0, 0], (1, 3))
        self.assertIn("points3.npy: shape: expected (N, 2) for points, found (1, 3)", self.eval("circle.json", "points3.npy"))
        self.save("flat.npy", [0] * 6, (1, 3, 2))
        line = self.refuse("collide", "sphere.json", "--triangles", "flat.npy", "-o", "out.npz")
        self.assertIn("flat.npy: shape: expected (N, 3, 3) for triangles, found (1, 3, 2)", line)

    def test_wrong_dtypes_and_truncations_are_refused(self):
        self.save("int.npy", [0, 0], (1, 2), "<i4")
        self.assertIn("int.npy: dtype: ", self.eval("circle.json", "int.npy"))
        self.save("big.npy", [0, 0], (1, 2), ">f4")
        self.assertIn("big.npy: dtype: ", self.eval("circle.json", "big.npy"))
        whole = (self.folder / "points.npy").read_bytes()
        (self.folder / "cut.npy").write_bytes(whole[:-1])
        self.assertIn("cut.npy: data: ", self.eval("circle.json", "cut.npy"))
        (self.folder / "cut.npy").write_bytes(whole[:40])
        self.assertIn("cut.npy: NPY header: ", self.eval("circle.json", "cut.npy"))

    def test_stdin_is_read_once(self):
        scene = json.dumps(CIRCLE).encode()
        line = self.refuse("eval", "-", "--points", "-", "-o", "out.npz", stdin=scene)
        self.assertIn("stdin named twice", line)

    def test_a_name_with_a_newline_stays_on_one_line(self):
        self.eval("no\nsuch.json", "points.npy")

    def test_result_names_are_checked_first(self):
        self.assertIn(": --output: ", self.eval("none.json", "none.npy", "out.txt"))
        line = self.refuse("eval", "circle.json", "--points", "points.npy", "--gradient", "autodiff", "-o", "out.npy")
        self.assertIn(".npz", line)
        self.save("triangles.npy", [0] * 6, (1, 3, 2))
        self.refuse("collide", "circle.json", "--triangles", "triangles.npy", "-o", "out.npy")


class Machine(CliCase):
    """Exit code 2: the machine failed us."""

    def setUp(self):
        super().setUp()
        self.save("points.npy", [0, 0, 3, 0], (2, 2))
        self.eval = ("eval", "circle.json", "--points", "points.npy")

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs /dev/full")
    def test_a_full_device(self):
        self.assertIn("/dev/full", self.refuse(*self.eval, "-o", "/dev/full", code=2))
        self.assertIn("/dev/full", self.refuse("render", "circle.json", "--size", "9", "9", "-o", "/dev/full", code=2))

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs /dev/full")
    def test_a_full_stdout(self):
        with open("/dev/full", "wb") as full:
            for arguments in [("info",), ("ops",), ("--help",), ("--version",), (*self.eval, "-o", "-")]:
                with self.subTest(arguments=arguments):
                    done = subprocess.run(
                        [PROGRAM, *arguments], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, check=False
                    )
                    self.assertEqual(2, done.returncode)
                    self.assertRegex(done.stderr.decode(), r"\Athalweg: stdout: .*\n\Z")

    def test_a_folder_that_is_not_there(self):
        self.refuse(*self.eval, "-o", "none/out.npz", code=2)

    def test_a_folder_as_target(self):
        (self.folder / "out.npz").mkdir()
        self.refuse(*self.eval, "-o", "out.npz", code=2)

    def test_a_file_size_limit_leaves_no_half_written_output(self):
        self.save("many.npy", [0.0] * 40000, (20000, 2))

        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))

        (self.folder / "out.npz").write_bytes(b"old")
        done = self.run_program("eval", "circle.json", "--points", "many.npy", "-o", "out.npz", preexec_fn=limit)
        self.assertEqual(2, done.returncode, done.stderr)
        self.assertEqual(b"old", (self.folder / "out.npz").read_bytes())
        self.assertFalse([path for path in self.folder.iterdir() if path.suffix == ".tmp"])

    def test_an_interrupt_removes_the_unfinished_file(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number):
                self.interrupt(number)
                self.assertFalse([path for path in self.folder.iterdir() if path.suffix in (".tmp", ".png")])

    def interrupt(self, number: signal.Signals) -> None:
        """Sends the signal once the unfinished file of a large picture is there."""
        arguments = ["render", "circle.json", "--size", "8000", "8000", "-o", "out.png"]
        with subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdout=subprocess.DEVNULL) as process:
            deadline = time.monotonic() + 60
            while not list(self.folder.glob("*.tmp")) and time.monotonic() < deadline:
                self.assertIsNone(process.poll(), "finished before it could be interrupted")
                time.sleep(0.001)
            process.send_signal(number)
            self.assertEqual(-number, process.wait(timeout=60))


if __name__ == "__main__":
    unittest.main()
