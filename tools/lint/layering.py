# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""Which room may know which: core nothing above it, parallel core, tools the public headers only."""

import posixpath
import re

from cpp_text import code_only, includes
from source_tree import Finding, SourceFile, line_of

PUBLIC = {"core": "core/include", "parallel": "parallel/include"}
# Where the quoted includes of a room may lead, besides its own folder.
ROOTS = {
    "core": ["core/include", "core/src"],
    "parallel": ["parallel/include", "parallel/src", "core/include", "core/src"],
    "bench": ["bench", "bench/baselines", "tests/oracle", "parallel/include", "core/include", "parallel/src", "core/src"],
    "tools": ["tools", "tools/thalweg", "parallel/include", "core/include"],
    "tests": ["tests", "tests/oracle", "bench", "bench/baselines", "tools/thalweg", "parallel/include", "core/include", "parallel/src", "core/src"],
}
# The demo checks a sample of its answers with the oracle and is timed against the thesis' method; stress is held
# against native code.
DEMO = re.compile(r"^tools/thalweg/(demo\w*|stress_native)\.(cpp|h)$")
DEMO_ROOTS = ["tests/oracle", "bench/baselines"]
ALL_ROOTS = sorted({root for roots in ROOTS.values() for root in roots})
# A library of other people may be included in these rooms only.
LIBRARIES = {
    "hwy": {"core", "bench", "tests"},
    "nlohmann": {"core", "tools", "tests"},
    "tbb": {"parallel", "bench", "tests"},
    "oneapi": {"parallel", "bench", "tests"},
    "Eigen": {"bench", "tests"},
    "benchmark": {"bench"},
    "gtest": {"tests"},
    "gmock": {"tests"},
    "CLI": {"tools", "tests"},
    "fmt": {"tools", "tests"},
    "png.h": {"tools", "tests"},
    "zip.h": {"tools", "tests"},
}
NOT_IN_CORE = {
    "thread", "mutex", "shared_mutex", "condition_variable", "future", "semaphore", "latch", "barrier", "stop_token",
    "fstream", "filesystem", "iostream", "chrono", "ctime", "time.h", "pthread.h", "unistd.h", "sys/stat.h",
}  # fmt: skip
NOT_IN_LIBRARIES = re.compile(
    r"\b(std::(?:cout|cerr|clog)|(?:std::)?(?:printf|fprintf|puts|putchar|fopen|exit|_Exit|quick_exit|system))\b(?=\s*(?:\(|<<))"
)
ENVIRONMENT = re.compile(r"\b(?:secure_)?getenv\b")
# The one place that reads the environment: THALWEG_ISA, the SIMD override.
MAY_READ_ENVIRONMENT = re.compile(r"^core/src/kernels/\w*target\w*\.cpp$")
MOST_TBB_FILES = 2


def check(files: list[SourceFile]) -> list[Finding]:
    known = {f.path for f in files}
    rooms = [f for f in files if f.is_cpp and f.room in ROOTS]
    findings = []
    for file in rooms:
        findings += _check_includes(file, known)
        if file.room in ("core", "parallel"):
            findings += _check_words(file)
    return findings + _check_tbb(rooms)


def _check_includes(file: SourceFile, known: set[str]) -> list[Finding]:
    findings = []
    for index, quoted, path in includes(file.text):
        fault = _fault_of_quoted(file, path, known) if quoted else _fault_of_angled(file, path)
        if fault:
            findings.append(Finding(file.path, line_of(file.text, index), fault))
    return findings


def _fault_of_quoted(file: SourceFile, path: str, known: set[str]) -> str:
    beside = posixpath.normpath(posixpath.join(posixpath.dirname(file.path), path))
    if beside in known:
        leaves = beside.split("/")[0] != file.room
        return f'"{path}" leaves the room {file.room}/ by its path' if leaves else ""
    roots = ["core/include"] if file.path.startswith("core/include/") else ROOTS[file.room]
    if file.path.startswith("parallel/include/"):
        roots = ["core/include", "parallel/include"]
    if DEMO.match(file.path):
        roots = roots + DEMO_ROOTS
    if any(posixpath.join(root, path) in known for root in roots):
        return ""
    owner = next((root for root in ALL_ROOTS if posixpath.join(root, path) in known), None)
    return f'"{path}" belongs to {owner}/, which {posixpath.dirname(file.path)}/ must not know' if owner else ""


def _fault_of_angled(file: SourceFile, path: str) -> str:
    library = path.split("/")[0]
    if library == "thalweg":
        return f'<{path}>: the project\'s own headers are included as "{path}"'
    if library in LIBRARIES and file.room not in LIBRARIES[library]:
        return f"<{path}> is not for {file.room}/"
    if library in LIBRARIES and file.is_public_header:
        return f"<{path}> in a public header"
    if file.room == "core" and path in NOT_IN_CORE:
        return f"<{path}>: core has no thread, file or clock"
    return ""


def _check_words(file: SourceFile) -> list[Finding]:
    code = code_only(file.text)
    findings = [
        Finding(file.path, line_of(code, m.start()), f"{m.group(1)}: a library never prints, exits or opens files")
        for m in NOT_IN_LIBRARIES.finditer(code)
    ]
    if not MAY_READ_ENVIRONMENT.match(file.path):
        findings += [
            Finding(file.path, line_of(code, m.start()), "only the SIMD target selection reads the environment")
            for m in ENVIRONMENT.finditer(code)
        ]
    return findings


def _check_tbb(files: list[SourceFile]) -> list[Finding]:
    users = []
    for file in files:
        hits = [i for i, _, path in includes(file.text) if path.split("/")[0] in ("tbb", "oneapi")]
        if file.room == "parallel" and hits:
            users.append(Finding(file.path, line_of(file.text, hits[0]), "oneTBB"))
    findings = [
        Finding(u.path, u.line, "oneTBB belongs in a .cpp file") for u in users if not u.path.endswith(".cpp")
    ]
    if len(users) > MOST_TBB_FILES:
        findings += [Finding(u.path, u.line, f"oneTBB in more than {MOST_TBB_FILES} files") for u in users]
    return findings
