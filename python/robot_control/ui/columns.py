"""Texts on a terminal, where a Chinese sign is two columns wide and a line may end before it."""

import re
import unicodedata

_WIDE = r"\u2e80-\u9fff\uf900-\ufaff\uff00-\uff60"
_CLOSING = "，。；：、）！？"
_PARTS = re.compile(rf"\s*[（“]*(?:[^\s{_WIDE}]+|[{_WIDE}])[{_CLOSING}]*")
"""A word or a wide sign, with the spaces before it and the signs that begin no line"""


def columns(text: str) -> int:
    """Columns that the text takes."""
    return sum(2 if unicodedata.east_asian_width(sign) in "WF" else 1 for sign in text)


def padded(text: str, width: int) -> str:
    """The text with spaces up to this width."""
    return text + " " * (width - columns(text))


def wrapped(text: str, width: int, indent: str = "") -> list[str]:
    """Lines of at most `width` columns, all but the first one indented; a longer word is broken."""
    lines, line = [], ""
    for part in _PARTS.findall(text):
        if line.strip() and columns(line + part) > width:
            lines.append(line)
            line = indent + part.lstrip()
        else:
            line += part
        while columns(line) > width:
            fits = next(end for end in range(len(line), 0, -1) if columns(line[:end]) <= width)
            lines.append(line[:fits])
            line = indent + line[fits:]
    return [*lines, line] if line else lines
