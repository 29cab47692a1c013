# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""The path of a descent: where `thalweg collide` stands after 1, 2, 3, ... iterations from one start."""

import io
import struct
import subprocess
import zipfile


def npy(points: list[tuple[float, float]]) -> bytes:
    header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': (1, {len(points)}, 2), }}"
    header += " " * (-(10 + len(header) + 1) % 64) + "\n"
    numbers = [x for point in points for x in point]
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + struct.pack(f"<{len(numbers)}d", *numbers)


def member(archive: bytes, name: str) -> tuple[float, ...]:
    """The float32 numbers of an array of a result."""
    with zipfile.ZipFile(io.BytesIO(archive)) as file:
        data = file.read(f"{name}.npy")
    (length,) = struct.unpack("<H", data[8:10])
    numbers = data[10 + length :]
    return struct.unpack(f"<{len(numbers) // 4}f", numbers)


def ask(studio, scene: str, triangle: list, *arguments: str) -> tuple[float, float]:
    """Where a query on one triangle ends."""
    queries = studio.folder / "triangle.npy"
    queries.write_bytes(npy(triangle))
    command = [studio.program, "collide", studio.scene(scene), "--triangles", queries, "-o", "-", "--quiet", *arguments]
    done = subprocess.run(command, check=True, capture_output=True)
    x, y = member(done.stdout, "point")
    return x, y


def descent(studio, scene: str, triangle: list, method: str, gradient: str) -> list[tuple[float, float]]:
    """From the method's own start; a path that stands still has ended."""
    path: list[tuple[float, float]] = []
    for iterations in range(1, 65):
        point = ask(studio, scene, triangle, "--method", method, "--gradient", gradient, "--iterations", str(iterations))
        if len(path) > 2 and path[-1] == path[-2] == point:
            break
        path.append(point)
    return path


def deepest(studio, scene: str, triangle: list) -> tuple[float, float]:
    """The proven one."""
    return ask(studio, scene, triangle, "--goal", "deepest", "--tolerance", "1e-4")
