# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""`thalweg render`: pictures of known size and orientation, with and without results drawn over them."""

import json
import struct
import unittest
import zlib

from cli_case import HALF_PLANE, CliCase


def pixels(png: bytes) -> tuple[int, int, list[bytes]]:
    """Width, height and the rows of a PNG of 8-bit RGB, unfiltered."""
    if png[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("not a PNG")
    at, data, size = 8, b"", (0, 0)
    while at < len(png):
        (length,) = struct.unpack(">I", png[at : at + 4])
        kind, body = png[at + 4 : at + 8], png[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            size = struct.unpack(">II", body[:8])
            if body[8:10] != b"\x08\x02":
                raise ValueError("not 8-bit RGB")
        if kind == b"IDAT":
            data += body
        at += 12 + length
    return *size, unfiltered(zlib.decompress(data), *size)


def unfiltered(data: bytes, width: int, height: int) -> list[bytes]:
    stride, rows, above = 3 * width, [], bytes(3 * width)
    for index in range(height):
        line = data[index * (stride + 1) : (index + 1) * (stride + 1)]
        row = bytearray(line[1:])
        for i in range(stride):
            left, up, corner = (row[i - 3] if i >= 3 else 0), above[i], (above[i - 3] if i >= 3 else 0)
            guess = left + up - corner
            nearest = min((left, up, corner), key=lambda c: abs(guess - c))
            row[i] = (row[i] + (0, left, up, (left + up) // 2, nearest)[line[0]]) & 255
        above = bytes(row)
        rows.append(above)
    return rows


class Render(CliCase):
    def setUp(self):
        super().setUp()
        self.scene("plane.json", HALF_PLANE)

    def picture(self, *arguments: str, scene: str = "circle.json") -> tuple[int, int, list[bytes]]:
        self.succeed("render", scene, "-o", "out.png", *arguments)
        return pixels((self.folder / "out.png").read_bytes())

    def test_the_size_and_the_modes(self):
        seen = set()
        for mode in ("inside", "distance", "gradient", "error", "steps"):
            width, height, rows = self.picture("--mode", mode, "--size", "64", "48")
            self.assertEqual((64, 48), (width, height))
            seen.add(b"".join(rows))
        self.assertEqual(5, len(seen))

    def test_a_strategy_shows_in_the_gradient_and_in_its_error(self):
        size = ("--size", "120", "100")
        for mode in ("gradient", "error"):
            exact = self.picture("--mode", mode, *size)
            rough = self.picture("--mode", mode, *size, "--gradient", "forward", "--gradient-offset", "1")
            self.assertNotEqual(exact, rough, mode)

    def test_an_error_map_is_darker_where_the_gradient_is_better(self):
        def lightness(*arguments: str) -> int:
            # Too small for a legend.
            return sum(map(sum, self.picture("--mode", "error", "--size", "40", "40", *arguments)[2]))

        exact = lightness()
        central = lightness("--gradient", "central", "--gradient-offset", "0.01")
        forward = lightness("--gradient", "forward", "--gradient-offset", "0.5")
        self.assertLess(exact, central)
        self.assertLess(central, forward)

    def test_a_map_of_numbers_has_a_legend_where_there_is_room(self):
        _, _, rows = self.picture("--mode", "error", "--size", "300", "300")
        self.assertLess(max(rows[10][-150:]), 160, "the map itself is dark")
        self.assertGreater(min(rows[290][-150:-30]), 200, "the panel of the legend is light")

    def test_a_dichotomy_of_space_is_refused(self):
        line = self.refuse("render", "sphere.json", "-o", "out.png", "--mode", "error", "--gradient", "dichotomy")
        self.assertIn(": --gradient: ", line)

    def test_y_points_up(self):
        _, _, rows = self.picture("--mode", "inside", "--bounds", "-1", "-1", "1", "1", "--size", "16", "16", scene="plane.json")
        top, bottom = rows[2][:3], rows[13][:3]
        self.assertGreater(top[0], top[2], "outside is warm, and above")
        self.assertGreater(bottom[2], bottom[0], "inside is blue, and below")

    def test_an_unbounded_shape_is_shown_around_the_origin(self):
        done = self.succeed("render", "plane.json", "-o", "out.png", "--size", "10", "10", "--json")
        self.assertEqual([-1, -1, 1, 1], json.loads(done.stdout)["bounds"])

    def test_the_default_bounds_are_those_of_the_shape_and_a_tenth(self):
        done = self.succeed("render", "circle.json", "-o", "out.png", "--size", "10", "10", "--json")
        for found, expected in zip(json.loads(done.stdout)["bounds"], (-2.4, -2.4, 2.4, 2.4), strict=True):
            self.assertAlmostEqual(expected, found, delta=1e-2)

    def test_options_are_read_strictly(self):
        render = ("render", "circle.json", "-o", "out.png")
        for arguments in [
            ("--bounds", "0", "0", "0", "1"),
            ("--bounds", "0", "0", "inf", "1"),
            ("--bounds", "0", "0", "1"),
            ("--size", "0", "10"),
            ("--size", "10.5", "10"),
            ("--size", "65535", "65535"),
            ("--mode", "magic"),
            ("--slice", "1"),
            ("--triangles", "t.npy"),
        ]:
            with self.subTest(arguments=arguments):
                self.refuse(*render, *arguments)
        self.assertIn(": --output: ", self.refuse("render", "circle.json", "-o", "out.jpg"))

    def test_a_slice_of_space(self):
        self.picture("--size", "20", "20", scene="sphere.json")
        _, _, middle = self.picture("--size", "21", "21", "--mode", "inside", "--slice", "0", scene="sphere.json")
        _, _, above = self.picture("--size", "21", "21", "--mode", "inside", "--slice", "5", scene="sphere.json")
        self.assertGreater(middle[10][32], middle[10][30])
        self.assertGreater(above[10][30], above[10][32])

    def test_results_are_drawn_over_the_field(self):
        self.save("triangles.npy", [1, 0, 4, -1, 4, 1, -2, -2, -2.3, -2, -2, -2.3], (2, 3, 2))
        self.succeed("collide", "circle.json", "--triangles", "triangles.npy", "-o", "result.npz")
        size = ("--size", "80", "80", "--bounds", "-5", "-5", "5", "5")
        plain = self.picture(*size)
        contacts = self.picture(*size, "--overlay", "result.npz")
        outlines = self.picture(*size, "--overlay", "result.npz", "--triangles", "triangles.npy")
        self.assertNotEqual(plain, contacts)
        self.assertNotEqual(contacts, outlines)

    def test_an_overlay_that_does_not_fit_is_refused(self):
        self.save("triangles.npy", [0] * 6, (1, 3, 2))
        self.save("two.npy", [0] * 12, (2, 3, 2))
        self.succeed("collide", "circle.json", "--triangles", "triangles.npy", "-o", "result.npz")
        render = ("render", "circle.json", "-o", "out.png", "--overlay")
        self.assertIn("two.npy: shape: ", self.refuse(*render, "result.npz", "--triangles", "two.npy"))
        self.assertIn("triangles.npy: zip archive: ", self.refuse(*render, "triangles.npy"))
        self.save("points.npy", [0, 0], (1, 2))
        self.succeed("eval", "circle.json", "--points", "points.npy", "-o", "value.npz")
        self.assertIn("value.npz[status]: ", self.refuse(*render, "value.npz"))
        self.refuse("render", "sphere.json", "-o", "out.png", "--overlay", "result.npz")

    def test_a_picture_goes_to_stdout(self):
        done = self.succeed("render", "circle.json", "--size", "8", "8", "-o", "-")
        self.assertEqual((8, 8), pixels(done.stdout)[:2])
        self.assertIn(b"picture", done.stderr)


if __name__ == "__main__":
    unittest.main()
