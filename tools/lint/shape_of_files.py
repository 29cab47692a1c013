# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""What each file owes its reader: a licence header, a bounded length, functions that fit a screen."""

import ast
import re

from cpp_text import functions, macros
from source_tree import Finding, SourceFile, line_of

HEADER = ("SPDX-FileCopyrightText: The thalweg authors", "SPDX-License-Identifier: MIT")
MOST_FILE_LINES = 500
MOST_FUNCTION_LINES = 60
MACHINE_PATH = re.compile(r"(?<![\w.$}~*-])/(?:home|root|Users|work|mnt|media|srv)/[\w.]")


def _is_source(file: SourceFile) -> bool:
    return file.is_cpp or file.is_script or file.is_cmake


def check_headers(files: list[SourceFile]) -> list[Finding]:
    findings = []
    for file in filter(_is_source, files):
        lines = file.text.split("\n")
        lines = lines[1:] if lines[0].startswith("#!") else lines
        for offset, expected in enumerate(HEADER):
            if offset >= len(lines) or not re.fullmatch(rf"(//|#) {re.escape(expected)}", lines[offset]):
                findings.append(Finding(file.path, offset + 1, f"expected the comment: {expected}"))
    return findings


def check_sizes(files: list[SourceFile]) -> list[Finding]:
    findings = []
    for file in files:
        lines = file.text.count("\n")
        if (file.is_cpp or file.is_script) and lines > MOST_FILE_LINES:
            findings.append(Finding(file.path, lines, f"{lines} lines, at most {MOST_FILE_LINES}"))
        findings += [
            Finding(file.path, first, f"{name} has {length} lines, at most {MOST_FUNCTION_LINES}")
            for name, first, length in _bodies(file)
            if length > MOST_FUNCTION_LINES
        ]
    return findings


def _bodies(file: SourceFile) -> list[tuple[str, int, int]]:
    if file.is_cpp:
        return [(b.name, b.first_line, b.lines) for b in functions(file.text) + macros(file.text)]
    if file.suffix == ".py":
        return [
            (node.name, node.lineno, node.end_lineno - node.lineno + 1)
            for node in ast.walk(ast.parse(file.text))
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
        ]
    return []


def check_machine_paths(files: list[SourceFile]) -> list[Finding]:
    """A path below a home or work folder is true on one machine only."""
    return [
        Finding(file.path, line_of(file.text, match.start()), f"a path of one machine: {match.group(0)}...")
        for file in files
        for match in MACHINE_PATH.finditer(file.text)
    ]
