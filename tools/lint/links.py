# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""Every relative link of a markdown page leads to a file of the tree, and its anchor to a heading there."""

import posixpath
import re
from pathlib import Path

from source_tree import Finding, SourceFile, line_of

FENCE = re.compile(r"^(```|~~~).*?^\1[ \t]*$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`[^`\n]*`")
LINK = re.compile(r"!?\[[^\]\n]*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)|^\[[^\]]+\]:\s*(\S+)", re.MULTILINE)
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*$", re.MULTILINE)


def check(files: list[SourceFile]) -> list[Finding]:
    findings = []
    for file in files:
        if file.suffix == ".md":
            findings += _check_page(file)
    return findings


def _blank(match: re.Match) -> str:
    return re.sub(r"[^\n]", " ", match.group(0))


def _check_page(file: SourceFile) -> list[Finding]:
    text = CODE.sub(_blank, FENCE.sub(_blank, file.text))
    findings = []
    for match in LINK.finditer(text):
        fault = _fault(file, match.group(1) or match.group(2))
        if fault:
            findings.append(Finding(file.path, line_of(text, match.start()), fault))
    return findings


def _fault(file: SourceFile, target: str) -> str:
    if re.match(r"[a-z][a-z0-9+.-]*:", target):
        return ""
    path, _, anchor = target.partition("#")
    folder = posixpath.dirname(file.path)
    where = Path(file.root) / (posixpath.normpath(posixpath.join(folder, path)) if path else file.path)
    if not where.exists():
        return f"the link {target} leads nowhere"
    if anchor and where.suffix == ".md" and anchor not in _anchors(where.read_text(encoding="utf-8")):
        return f"{target}: no such heading"
    return ""


def _anchors(page: str) -> set[str]:
    """Anchors as the usual forges make them: lower case, punctuation dropped, blanks to hyphens."""
    headings = HEADING.findall(FENCE.sub(_blank, page))
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}
