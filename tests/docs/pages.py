"""The pages of the documentation: their links, anchors, code blocks and inline code."""

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
CHINESE = [ROOT / "README.zh.md", *sorted((ROOT / "docs").rglob("*.zh.md"))]
"""Translations: their code blocks are those of the page of the same name without `.zh`."""
ENGLISH = [README, ROOT / "CONTRIBUTING.md", *sorted({*(ROOT / "docs").rglob("*.md")} - {*CHINESE})]
PAGES = [page for page in ENGLISH if page.exists()]

FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Block:
    """A fenced code block."""

    page: Path
    line: int
    language: str
    text: str

    @property
    def place(self):
        return f"{self.page.name}:{self.line}"

    def commands(self):
        """Logical lines without comments: a backslash at the end of a line continues it."""
        bare = (re.sub(r"(^|\s)#\s.*$", "", line).strip() for line in self._lines())
        return [line for line in bare if line]

    def refused(self):
        """The commands with the comment `# refused`: they end with a message and another exit code than 0."""
        return {line.split(" # ")[0].strip() for line in self._lines() if line.endswith(" # refused")}

    def _lines(self):
        return re.sub(r"\\\n\s*", "", self.text).splitlines()


def blocks(page):
    text = page.read_text()
    return [Block(page, text.count("\n", 0, match.start()) + 1, match[1], match[2]) for match in FENCE.finditer(text)]


def prose(page):
    """The text without its code blocks."""
    return FENCE.sub("", page.read_text())


def links(page):
    """Targets of relative links and pictures."""
    found = re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`\n]*`", "", prose(page)))
    return [target for target in found if not re.match(r"\w+:", target)]


def anchors(page):
    """Anchors as GitHub derives them from the headings."""
    headings = re.findall(r"^#+ (.*)$", prose(page), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def inline_code(page):
    return re.findall(r"`([^`\n]+)`", prose(page))
