# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""The files of the project as the checks see them. Walks the tree itself, so that it works without git."""

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

# `.git` is a file in a worktree.
SKIPPED = {"build", "out", ".git", ".cache", ".vscode", ".idea", "__pycache__"}
CPP_SUFFIXES = {".h", ".cpp", ".inl"}


@dataclass(frozen=True)
class SourceFile:
    """One file of the tree; `path` is relative to the root, with forward slashes."""

    root: Path
    path: str

    @cached_property
    def text(self) -> str:
        return (self.root / self.path).read_text(encoding="utf-8", errors="replace")

    @property
    def suffix(self) -> str:
        return Path(self.path).suffix

    @property
    def room(self) -> str:
        return self.path.split("/")[0] if "/" in self.path else ""

    @property
    def is_cpp(self) -> bool:
        return self.suffix in CPP_SUFFIXES

    @property
    def is_public_header(self) -> bool:
        return "/include/thalweg/" in self.path

    @property
    def is_script(self) -> bool:
        return self.suffix in {".py", ".sh"} or self.text.startswith("#!")

    @property
    def is_cmake(self) -> bool:
        return self.path.endswith(("CMakeLists.txt", ".cmake", ".cmake.in"))


@dataclass(frozen=True)
class Finding:
    path: str
    line: int
    message: str

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {self.message}"


def files(root: Path) -> list[SourceFile]:
    """Every text file below root, in a fixed order. Binary files (a NUL byte early on) are left out."""
    found = []
    for folder, folders, names in os.walk(root):
        folders[:] = sorted(f for f in folders if f not in SKIPPED)
        for name in sorted(names):
            path = Path(folder) / name
            if name in SKIPPED or path.is_symlink() or not path.is_file():
                continue
            with path.open("rb") as stream:
                if b"\0" in stream.read(4096):
                    continue
            found.append(SourceFile(root, path.relative_to(root).as_posix()))
    return found


def line_of(text: str, index: int) -> int:
    return text.count("\n", 0, index) + 1
