# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""Every source and public header stands in a list of its CMakeLists.txt: one forgotten is not compiled, or installed."""

import re
from pathlib import PurePosixPath

from source_tree import Finding, SourceFile


def check(files: list[SourceFile]) -> list[Finding]:
    lists = {PurePosixPath(f.path).parent: f for f in files if PurePosixPath(f.path).name == "CMakeLists.txt"}
    findings = []
    for file in files:
        if file.suffix != ".cpp" and not file.is_public_header:
            continue
        path = PurePosixPath(file.path)
        folder = next((parent for parent in path.parents if parent in lists), None)
        if folder is None:
            findings.append(Finding(file.path, 1, "no CMakeLists.txt above it compiles it"))
        elif not _named(path.relative_to(folder), lists[folder].text):
            findings.append(Finding(lists[folder].path, 1, f"{path.relative_to(folder)} is in no list of sources"))
    return findings


def _named(path: PurePosixPath, text: str) -> bool:
    """By its path, or, as the test programs list theirs, by its path below the program's folder."""
    spellings = {path.as_posix(), PurePosixPath(*path.parts[1:]).as_posix()} - {"."}
    return any(re.search(rf"(?<![\w./-]){re.escape(spelling)}(?![\w./-])", text) for spelling in spellings)
