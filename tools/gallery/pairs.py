# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""The pictures of core/docs/pairs.md: two overlaps, a single start that ends in one of them, and the contacts of both.

    python3 tools/gallery/pairs.py build/release/bin/thalweg core/docs
"""

import json
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

VIEW = ("--bounds", "-3.6", "-1.6", "3.6", "1.6", "--size", "720", "320", "--mode", "distance", "--quiet")


def disc(x: float) -> dict:
    return {"op": "translate", "by": [x, 0], "of": {"op": "circle", "radius": 1}}


DISCS = {"op": "union", "of": [disc(-2), disc(2)]}
BAR = {"op": "box", "half_size": [2.5, 0.3]}
OFFSET, ANGLE = (0.1, 0.0), 0.05
# What the shapes have in common.
BOTH = {
    "op": "intersection",
    "of": [DISCS, {"op": "translate", "by": list(OFFSET), "of": {"op": "rotate", "angle": ANGLE, "of": BAR}}],
}


def write_scene(path: Path, shape: dict) -> Path:
    path.write_text(json.dumps({"thalweg": 1, "dimension": 2, "shape": shape}), encoding="utf-8")
    return path


def write_pose(path: Path) -> Path:
    header = "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 3), }"
    header += " " * (-(10 + len(header) + 1) % 64) + "\n"
    numbers = struct.pack("<3f", *OFFSET, ANGLE)
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + numbers)
    return path


def main(program: str, out: str) -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        discs, bar = write_scene(folder / "discs.json", DISCS), write_scene(folder / "bar.json", BAR)
        both, pose = write_scene(folder / "both.json", BOTH), write_pose(folder / "pose.npy")
        kinds = {
            "pairs-single-start": ("--method", "thesis", "--starts", "1", "--paths", "--contacts", "4"),
            "pairs-certified": ("--goal", "deepest"),
        }
        for picture, options in kinds.items():
            result = folder / f"{picture}.npz"
            queries = ("--with", bar, "--poses", pose, "-o", result, "--quiet")
            subprocess.run([program, "collide", discs, *queries, *options], check=True)
            target = Path(out) / f"{picture}.png"
            subprocess.run([program, "render", both, "-o", target, "--overlay", result, *VIEW], check=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
