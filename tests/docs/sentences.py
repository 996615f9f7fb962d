"""Checks comments, docstrings and names: sentences a reader understands at once.

    /usr/bin/python3 tests/docs/sentences.py FILE…

No comment begins with Of, What, Where or Likewise, no sentence has more than 25 words, and no name is listed below.
Tables, formulas and indented lines are no sentences. Ends with 1 if anything is found.
"""

from __future__ import annotations

import io
import re
import sys
import tokenize
from collections.abc import Iterator
from pathlib import Path

MAX_WORDS = 25
FRAGMENT = re.compile(r"(Of|What|Where|Likewise)\b")
WORD = re.compile(r"[A-Za-z][\w'’-]*")
NO_PROSE = re.compile(r"\s*(```|\||- |\d\.|>>>)|\s{2,}|.*([=←≤∫Σ→]|\S {2,}\S)")
NAMES = re.compile(
    r"\bk(Most|Least|Longest|Shortest|Largest)[A-Z]\w*"
    r"|\b(auto|bool|double|int|size_t|string|uint64_t)[&*]? (of|there|news|way|most|drove)\b"
    r"|^\s+(static |virtual )?\w[\w:<>]* (look|take|see|note|judge|ask)\("
)

Block = tuple[int, list[str]]


def cpp_comments(text: str) -> Iterator[Block]:
    """First line and lines of each comment; a comment behind code is a block of its own."""
    block: list[str] = []
    first = 0
    for number, line in enumerate([*text.splitlines(), ""], 1):
        if alone := re.match(r"\s*///?(?!<)(.*)$", line):
            first = first if block else number
            block.append(alone[1])
            continue
        if block:
            yield first, block
            block = []
        if behind := re.search(r'(///<|(?<![:"\'])// )(.*)$', line):
            yield number, [behind[2].strip()]


def python_comments(text: str) -> Iterator[Block]:
    """Docstrings and comments."""
    docstring_may_follow = True
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], [token.string.lstrip("# ")]
        elif token.type == tokenize.STRING and docstring_may_follow and '"""' in token.string:
            yield token.start[0], token.string.strip('rf"').splitlines()
        if token.type not in (tokenize.COMMENT, tokenize.NL):
            docstring_may_follow = token.type in (tokenize.INDENT, tokenize.NEWLINE, tokenize.DEDENT)


def sentences(block: list[str], indent: int) -> Iterator[str]:
    """The sentences of a comment whose prose is indented by `indent` columns."""
    paragraph = ""
    for line in [*block, ""]:
        body = line[indent:] if line[:indent].isspace() else line.lstrip()
        if body.strip() and not NO_PROSE.match(body):
            paragraph += " " + body.strip()
            continue
        yield from re.split(r"(?<=[.!?;:])\s+(?=[A-Z`])", paragraph.strip())
        paragraph = ""


def problems(path: Path) -> Iterator[tuple[int, str]]:
    """Line and message of each finding."""
    text = path.read_text(encoding="utf-8")
    cpp = path.suffix in (".h", ".cpp")
    for number, block in cpp_comments(text) if cpp else python_comments(text):
        indent = 1 if cpp else min((len(line) - len(line.lstrip()) for line in block[1:] if line.strip()), default=0)
        for sentence in sentences(block, indent):
            if FRAGMENT.match(sentence):
                yield number, f"begins as a fragment: {sentence[:80]}"
            if len(WORD.findall(sentence)) > MAX_WORDS:
                yield number, f"{len(WORD.findall(sentence))} words, at most {MAX_WORDS}: {sentence[:80]}"
    for number, line in enumerate(text.splitlines() if cpp else [], 1):
        if name := NAMES.search(line.split("//")[0]):
            yield number, f"name: {name[0].strip()}"


def main() -> int:
    """Prints what is found."""
    found = [f"{name}:{line}: {text}" for name in sys.argv[1:] for line, text in problems(Path(name))]
    print("\n".join([*found, f"{len(found)} problems"]))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
