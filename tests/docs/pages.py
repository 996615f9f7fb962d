"""The pages of the documentation: their links, anchors, code blocks and inline code."""

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
CHINESE = [ROOT / "README.zh.md", *sorted((ROOT / "docs").rglob("*.zh.md"))]
"""Translations: their structure is that of the page of the same name without `.zh`."""
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
    """Anchors as GitHub derives them from the headings, in their order."""
    headings = re.findall(r"^#+ (.*)$", prose(page), re.MULTILINE)
    return [re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings]


def tables(page):
    """Rows of cells of each table, from its head on."""
    for lines in re.findall(r"(?:^\|.*\n)+", prose(page), re.MULTILINE):
        head, _, *rows = (re.split(r"(?<!\\)\|", line.strip())[1:-1] for line in lines.splitlines())
        yield [[cell.strip() for cell in row] for row in (head, *rows)]


def english(chinese):
    """The page of which this one is the translation; a page that is none is itself."""
    return chinese.with_name(chinese.name.replace(".zh.", "."))


def structure(page):
    """The parts that a page and its translation share; a link to a translation counts as one to its page."""
    marks = re.findall(r"^(#+|\s*-|\s*\d+\.) ", prose(page), re.MULTILINE)
    return {
        "headings and lists": [re.sub(r"\d+", "1", mark) for mark in marks],
        "rows and columns": [[len(row) for row in table] for table in tables(page)],
        "code without comments": [(block.language, block.commands()) for block in blocks(page)],
        "links": sorted(filter(None, (_destination(page, link) for link in links(page)))),
        "inline code": sorted(set(inline_code(page))),
    }


def _destination(page, link):
    """The page or file, and the number of its heading; empty for a link between a page and its translation."""
    path, _, anchor = link.partition("#")
    file = (page.parent / path).resolve() if path else page
    if not anchor and english(file) == english(page):
        return ""
    return f"{english(file).relative_to(ROOT)} {anchors(file).index(anchor) if anchor else ''}"


def inline_code(page):
    return re.findall(r"`([^`\n]+)`", prose(page))
