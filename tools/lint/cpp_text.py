# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""Enough C++ to find includes, words of code and function bodies; it relies on code that clang-format accepts.

`code_only` blanks comments, strings and preprocessor lines in place, so that indices and line numbers stay true.
"""

import re
from dataclasses import dataclass, field

_LITERAL = re.compile(
    r"""//[^\n]*                                    # line comment
      | /\*.*?\*/                                   # block comment
      | \bu?8?[LUu]?R"(?P<tag>[^()\s\\]{0,16})\(.*?\)(?P=tag)"  # raw string
      | "(?:\\.|[^"\\\n])*"                         # string
      | (?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'         # character; not the separator in 1'000
    """,
    re.VERBOSE | re.DOTALL,
)
_DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n\\]|\\\n|\\.)*", re.MULTILINE)
_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"\n]+)[>"]', re.MULTILINE)


def _blank(match: re.Match) -> str:
    return re.sub(r"[^\n]", " ", match.group(0))


def without_comments(text: str) -> str:
    """Comments, strings and characters become blanks; preprocessor lines stay."""
    return _LITERAL.sub(_blank, text)


def code_only(text: str) -> str:
    return _DIRECTIVE.sub(_blank, without_comments(text))


def includes(text: str) -> list[tuple[int, bool, str]]:
    """(index, is quoted, path) of each include that is not in a comment."""
    bare = without_comments(text)
    return [
        (m.start(), m.group(1) == '"', m.group(2))
        for m in _INCLUDE.finditer(text)
        if bare[m.start() : m.end()].lstrip().startswith("#")
    ]


@dataclass
class Body:
    """A function body, or a macro's definition: its lines, first and last included."""

    name: str
    first_line: int
    last_line: int

    @property
    def lines(self) -> int:
        return self.last_line - self.first_line + 1


@dataclass
class _State:
    """What is open at a point of the file: the blocks, and where the current statement began."""

    blocks: list = field(default_factory=list)  # (kind, index of the brace, statement start, name)
    start: int = 0

    def copy(self) -> "_State":
        return _State(list(self.blocks), self.start)


def macros(text: str) -> list[Body]:
    bare = without_comments(text)
    bodies = []
    for match in _DIRECTIVE.finditer(bare):
        name = re.match(r"\s*#\s*define\s+(\w+)", match.group(0))
        if name:
            first = bare.count("\n", 0, match.start()) + 1
            bodies.append(Body(name.group(1), first, first + match.group(0).count("\n")))
    return bodies


def functions(text: str) -> list[Body]:
    """Outermost function bodies, from the line of the opening brace to that of the closing one."""
    bare = without_comments(text)
    code = _DIRECTIVE.sub(_blank, bare)
    events = [(m.start(), m.group(0)) for m in re.finditer(r"[{};]", code)]
    events += [(m.start(), m.group(0).lstrip(" \t#")) for m in _DIRECTIVE.finditer(bare)]
    state, at_if, bodies = _State(), [], []
    for index, event in sorted(events):
        if event == "{":
            _open(code, index, state)
        elif event == "}":
            _close(code, index, state, bodies)
        elif event != ";":
            state = _branch(event, state, at_if)
        elif not _inside_function(state) and code.count("(", state.start, index) == code.count(")", state.start, index):
            state.start = index + 1
    return bodies


def _branch(directive: str, state: _State, at_if: list) -> _State:
    """Alternatives of the preprocessor start from the same state, whatever braces each of them opens."""
    if directive.startswith("if"):
        at_if.append(state.copy())
    elif directive.startswith("el") and at_if:
        return at_if[-1].copy()
    elif directive.startswith("endif") and at_if:
        at_if.pop()
    return state


def _inside_function(state: _State) -> bool:
    return any(block[0] == "function" for block in state.blocks)


def _open(code: str, index: int, state: _State) -> None:
    head = code[state.start : index]
    kind = "block" if _inside_function(state) else _kind(head)
    state.blocks.append((kind, index, state.start, _name(head) if kind == "function" else ""))
    if kind != "initializer":
        state.start = index + 1


def _close(code: str, index: int, state: _State, bodies: list) -> None:
    if not state.blocks:
        return
    kind, opened, start, name = state.blocks.pop()
    # After an initializer the statement goes on: `Foo() : a_{1}, b_{2} {`.
    state.start = start if kind == "initializer" else index + 1
    if kind == "function":
        bodies.append(Body(name, code.count("\n", 0, opened) + 1, code.count("\n", 0, index) + 1))


def _without_parentheses(head: str) -> str:
    """The head with what stands in closed parentheses taken out; an open one stays as `(`."""
    previous = None
    while previous != head:
        previous, head = head, re.sub(r"\([^()]*\)", "\x01", head)
    return head.replace("\x01", "()")


def _without_template(head: str) -> str:
    return re.sub(r"\btemplate\s*<(?:[^<>]|<(?:[^<>]|<[^<>]*>)*>)*>", " ", head)


def _kind(head: str) -> str:
    """What the brace after `head` opens, outside any function: scope, function or initializer."""
    flat = _without_template(_without_parentheses(head))
    flat = re.sub(r"\b(public|private|protected)\s*:(?!:)", " ", flat)
    if re.search(r"\bconcept\b", flat):
        return "initializer"
    if re.search(r"\b(namespace|class|struct|union|enum)\b", flat) or re.search(r"\bextern\s*$", flat):
        return "scope"
    if re.fullmatch(r"\s*[A-Z][A-Z0-9_]+\s*", flat):
        return "scope"  # a macro that opens a class: THALWEG_OP {
    flat = flat.rsplit("(", 1)[-1] if flat.count("(") > flat.count(")") else flat
    is_constructor_list = re.search(r"\)\s*(noexcept\s*)?:(?!:)", flat)
    ends_like_body = re.search(r"(\)|[}\]]|\b(const|noexcept|override|final|try|mutable)|&)\s*$", flat)
    if is_constructor_list and not ends_like_body:
        return "initializer"
    if "(" in flat and (ends_like_body or re.search(r"\)[^()]*->[^()]*$", flat)):
        return "function"
    return "function" if re.search(r"\[[^\]]*\]\s*$", flat) and "=" in flat else "initializer"


def _name(head: str) -> str:
    flat = _without_template(_without_parentheses(head))
    # Macro calls on lines of their own, without a semicolon, stand before the function.
    flat = re.sub(r"^[ \t]*[A-Z][A-Z0-9_]+\(\)[ \t]*\n(?=[\s\S]*\()", "", flat, flags=re.MULTILINE)
    names = re.findall(r"(operator\s*[^\s(]+|[~\w:]+)\s*\(\)", flat)
    return names[0] if names else " ".join(flat.split())[-40:]
