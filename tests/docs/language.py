"""Counts what makes pages and messages hard to read: long sentences, long table cells and words of a list.

    /usr/bin/python3 tests/docs/language.py [--list] [--write] [PAGE…]

Without arguments it compares the counts with `language_counts.txt`. A page that has no row there has none of them, and
no count may rise. After a count has fallen, `--write` lowers it in the file. `--list` prints each finding of the named
pages, or of all.

A sentence has at most 25 words, a cell at most 15; code in backquotes counts as one word. Code blocks are no prose.
The messages are the texts of at least four words in the sources of a folder.
"""

from __future__ import annotations

import argparse
import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from sentences import MAX_WORDS, WORD, sentences

ROOT = Path(__file__).parents[2]
COUNTS = Path(__file__).with_name("language_counts.txt")
MAX_CELL_WORDS = 15
KINDS = ("sentence", "cell", "word")

FRAGMENT = r"^(?:Of|What|Where|Likewise|Who|Not|So|There)\b(?!.*\?$)"
"""The begin of a sentence that has no noun as its subject; a question may begin so."""
WORDS = (
    r"\b(?:the|a|no|its|another|whose) ways?\b",  # path, distance, method
    r"\b(?:the|a|its|their|wrong|true) places?\b",  # pose, position
    r"\b(?:bears?|bore|borne)\b",  # is in stance, carries load
    r"\bblows?\b",  # impact
    r"\befforts\b",  # torques
    r"\blaws?\b",  # controller, algorithm
    r"\bshipped\b",  # included
    r"\blaid over\b",  # overrides, merged
    r"\blook(?:s|ed|ing)? (?:at|whether|for|what)\b",  # check, inspect
    r"\bthe machine\b(?! model)",  # computer, hardware
    r"\bgrip\b",  # friction
    r"\bto and fro\b",  # oscillates
    r"\blet it run\b",  # resume
    r"\bby (?:the )?truth\b",  # by ground truth
    r"\bg(?:ive|ives|ave|iven|iving)(?: \w+)* back\b",  # return
    r"\b(?:go|goes|went|going|gone) on\b",  # continue
    r"\b(?:knows|says|asks|notices|speaks|told|tells|believes|hears)\b",  # things do not act like people
    r"\bstands? against\b|\bthere stands?\b",  # prevents
    r"\b(?:gets?|from) (?:its|their) core\b",  # gets enough CPU time
    r"\b(?:that|those) of\b|\bthe one\b|\bof before\b",  # repeat the noun
    r"(?<!there )\b(?:is|are) no\b",  # is not a
    r", too\b|(?<!-)\balone\b",  # also, only: before the verb
    r"\bnobody\b|\bwhoever\b",
)
LISTED = re.compile(f"{FRAGMENT}|(?i:{'|'.join(WORDS)})")


class Finding(NamedTuple):
    """One place that is hard to read."""

    line: int
    kind: str
    text: str


def plain(text: str) -> str:
    """The words of a piece of Markdown: without emphasis, targets of links and code."""
    text = re.sub(r"`[^`]*`", "`c`", text)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    return text.replace("*", "")


def judged(line: int, text: str) -> Iterator[Finding]:
    """Findings of a paragraph or of a message."""
    for sentence in sentences([text], 0):
        if (words := len(WORD.findall(sentence))) > MAX_WORDS:
            yield Finding(line, "sentence", f"{words} words: {sentence[:90]}")
        yield from listed(line, sentence)


def listed(line: int, text: str) -> Iterator[Finding]:
    """Words of the list."""
    for match in LISTED.finditer(text):
        around = text[max(0, match.start() - 30) : match.end() + 30]
        yield Finding(line, "word", f"'{match[0]}' in: {around}")


def paragraphs(page: str) -> Iterator[tuple[int, str]]:
    """First line and text of each heading, paragraph and list item; a row of a table is a paragraph of its own."""
    page = re.sub(r"^```.*?^```$|<!--.*?-->", lambda code: "\n" * code[0].count("\n"), page, flags=re.M | re.S)
    first, block = 0, ""
    for number, line in enumerate([*page.splitlines(), ""], 1):
        begins = re.match(r"\s*(?:[-*]|\d+\.|#+)\s|\s*\||\s*$", line)
        if begins and block:
            yield first, block
            block = ""
        if line.startswith("    ") and not block and not begins:
            continue
        if line.strip():
            first = first if block else number
            block = f"{block} {line.strip()}".strip()
        if re.match(r"#+ ", line):
            yield first, block
            block = ""


def of_page(text: str) -> Iterator[Finding]:
    """Findings of a page of Markdown."""
    for line, block in paragraphs(text):
        if block.startswith("|"):
            for cell in re.split(r"(?<!\\)\|", plain(block).strip("|")):
                if (words := len(WORD.findall(cell))) > MAX_CELL_WORDS:
                    yield Finding(line, "cell", f"{words} words: {cell.strip()[:90]}")
                yield from listed(line, cell.strip())
        else:
            yield from judged(line, re.sub(r"^(?:[-*]|\d+\.|#+)\s+", "", plain(block)))


def cpp_texts(source: str) -> Iterator[tuple[int, str]]:
    """Line and text of each string literal; adjacent ones are one text."""
    code = re.sub(r"^\s*(?://|#include).*$|(?<![:\"'])// .*$", "", source, flags=re.M)
    for match in re.finditer(r'"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*', code):
        yield code.count("\n", 0, match.start()) + 1, re.sub(r'"\s*"', "", match[0])[1:-1]


def python_texts(source: str) -> Iterator[tuple[int, str]]:
    """Line and text of each string that is no docstring; a value within one is the word x."""
    left_out: set[ast.AST] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Expr):
            left_out.add(node.value)
        elif isinstance(node, ast.JoinedStr):
            left_out |= {*ast.walk(node)}
            parts = (str(part.value) if isinstance(part, ast.Constant) else "x" for part in node.values)
            yield node.lineno, "".join(parts)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node not in left_out:
            yield node.lineno, node.value


def of_source(path: str, text: str) -> Iterator[Finding]:
    """Findings in the messages of a source."""
    for line, message in python_texts(text) if path.endswith(".py") else cpp_texts(text):
        if len(WORD.findall(message)) >= 4:
            yield from judged(line, " ".join(message.split()))


def findings() -> dict[str, list[tuple[str, Finding]]]:
    """Findings with their file of each row of the counts: an English page, a table of messages, a folder of sources."""
    tables = ("src/signals/stop_causes.def", "src/signals/names.h")
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    listed_files = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    rows: dict[str, list[tuple[str, Finding]]] = {}
    for path in sorted({path for path in listed_files if (ROOT / path).exists()}):
        row = path if path in tables or path.endswith(".md") else f"{path.split('/')[0]}/"
        if path.endswith(".md") and not path.endswith(".zh.md"):
            found = of_page((ROOT / path).read_text())
        elif path in tables or re.match(r"src/.*\.(h|cpp)$|(python|scripts)/.*\.py$", path):
            found = of_source(path, (ROOT / path).read_text())
        else:
            continue
        rows.setdefault(row, []).extend((path, finding) for finding in found)
    return rows


def counted(found: list[tuple[str, Finding]]) -> list[int]:
    """Numbers of findings of each kind."""
    return [sum(finding.kind == kind for _, finding in found) for kind in KINDS]


def allowed() -> dict[str, list[int]]:
    """The committed counts of each row."""
    lines = (line.split() for line in COUNTS.read_text().splitlines() if not line.startswith("#"))
    return {row: [int(count) for count in counts] for row, *counts in lines}


def differences(found: dict[str, list[int]], committed: dict[str, list[int]]) -> list[str]:
    """Sentences that name the counts that rose, and those that fell without their row."""
    none = [0, 0, 0]
    wrong = []
    for row in sorted({*found, *committed}):
        for kind, now, most in zip(KINDS, found.get(row, none), committed.get(row, none), strict=True):
            if now > most:
                wrong.append(f"{row}: {kind}: {now}, at most {most}; language.py --list {row} shows them")
            elif now < most:
                wrong.append(f"{row}: {kind}: only {now} of {most} are left; language.py --write lowers the count")
    return wrong


def lowered(found: dict[str, list[int]], committed: dict[str, list[int]]) -> dict[str, list[int]]:
    """The committed counts, none of them above what was found."""
    rows = {row: [*map(min, counts, found.get(row, [0, 0, 0]))] for row, counts in committed.items()}
    return {row: counts for row, counts in sorted(rows.items()) if any(counts)}


def main() -> int:
    """Compares, lists or writes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--list", action="store_true", help="print each finding")
    parser.add_argument("--write", action="store_true", help="lower the committed counts")
    parser.add_argument("pages", nargs="*", help="rows of the table; all if none is named")
    arguments = parser.parse_args()
    found = {row: of for row, of in findings().items() if not arguments.pages or row in arguments.pages}
    if arguments.list:
        print("\n".join(f"{path}:{it.line}: {it.kind}: {it.text}" for of in found.values() for path, it in of))
    counts, committed = {row: counted(of) for row, of in found.items()}, allowed()
    if arguments.write:
        head = [line for line in COUNTS.read_text().splitlines() if line.startswith("#")]
        rows = lowered({**committed, **counts}, committed)
        COUNTS.write_text("\n".join([*head, *(f"{row} {' '.join(map(str, of))}" for row, of in rows.items())]) + "\n")
        committed = allowed()
    if arguments.pages:
        committed = {row: counts for row, counts in committed.items() if row in arguments.pages}
    wrong = differences(counts, committed)
    print("\n".join([*wrong, f"{len(wrong)} counts differ from {COUNTS.name}"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
