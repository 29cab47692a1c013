# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""Takes the first fenced block of a language out of a page: into a file, or to hold it against a program's output."""

import argparse
import difflib
import re
import subprocess
import sys
from pathlib import Path


def first_block(page: Path, language: str) -> str:
    match = re.search(rf"^```{re.escape(language)}\n(.*?)^```$", page.read_text("utf-8"), re.MULTILINE | re.DOTALL)
    if not match:
        sys.exit(f"{page}: no {language} block")
    return match.group(1)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("page", type=Path)
    parser.add_argument("language")
    parser.add_argument("output", type=Path, nargs="?")
    parser.add_argument("--printed-by", metavar="PROGRAM")
    arguments = parser.parse_args()
    block = first_block(arguments.page, arguments.language)
    if arguments.output:
        arguments.output.write_text(block, "utf-8")
        return 0
    printed = subprocess.run([arguments.printed_by], check=True, capture_output=True, text=True).stdout
    difference = difflib.unified_diff(block.splitlines(), printed.splitlines(), "the page", "the program", lineterm="")
    lines = list(difference)
    print("\n".join(lines))
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
