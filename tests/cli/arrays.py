# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""NPY and NPZ with the standard library alone: a second opinion on the arrays that the command reads and writes."""

import ast
import io
import math
import struct
import zipfile
from typing import NamedTuple

CODES = {"<f4": "f", "<f8": "d", "|u1": "B", "<u4": "I", "<i4": "i", ">f4": ">f"}


class Array(NamedTuple):
    descr: str
    shape: tuple[int, ...]
    numbers: list

    def rows(self) -> list[tuple]:
        """The numbers, one tuple for each index along the first axis."""
        width = math.prod(self.shape[1:])
        return [tuple(self.numbers[i * width : (i + 1) * width]) for i in range(self.shape[0])]


def npy_bytes(numbers: list, shape: tuple[int, ...], descr: str = "<f4", fortran: bool = False) -> bytes:
    """The bytes that numpy.save writes."""
    header = f"{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape!r}, }}"
    header += " " * (-(10 + len(header) + 1) % 64) + "\n"
    code = CODES[descr]
    order, code = (">", code[1:]) if code.startswith(">") else ("<", code)
    data = struct.pack(f"{order}{len(numbers)}{code}", *numbers)
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + data


def parse_npy(data: bytes) -> Array:
    if data[:8] != b"\x93NUMPY\x01\x00":
        raise ValueError("not an NPY file of version 1.0")
    (length,) = struct.unpack("<H", data[8:10])
    header = ast.literal_eval(data[10 : 10 + length].decode())
    if set(header) != {"descr", "fortran_order", "shape"} or header["fortran_order"]:
        raise ValueError(f"unexpected header {header}")
    if (10 + length) % 64 != 0:
        raise ValueError("the numbers are not aligned")
    count = math.prod(header["shape"])
    numbers = struct.unpack(f"<{count}{CODES[header['descr']]}", data[10 + length :])
    return Array(header["descr"], header["shape"], list(numbers))


def parse_npz(data: bytes) -> dict[str, Array]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        if archive.testzip() is not None:
            raise ValueError("a member with a wrong checksum")
        return {name.removesuffix(".npy"): parse_npy(archive.read(name)) for name in archive.namelist()}
