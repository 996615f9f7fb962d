#!/usr/bin/python3
"""Changes the sources of a folder one place at a time, and counts the changes that the tests of that folder find.

usage: mutate.py ROOM N [SEED]    ROOM: a folder below src (gate/wheeled); N: how many changes; SEED: which ones, 1

The changes are drawn at random among all of the room, without those that do not compile and those that equal.txt lists.
One is found if a test program fails, crashes or does not end. The programs are those of the folder below tests with the
same name, or of the nearest folder above it. Those that measure their own speed (FAST) are left out. An index outside
of an array ends them. Each change that no test finds is printed with its place. The exit code is 0 if and only if at
least 85 % are found.

A copy of the sources in build/mutants holds all changes of control, gate … at once, and an environment variable chooses
one (switch.h). A first run notes which test executes which place; a change is then tried with these tests alone.
"""

import fcntl
import os
import random
import re
import resource
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EQUAL = Path(__file__).with_name("equal.txt")
REQUIRED = 0.85
# The copy differs by file in this. Every test program notes which places its tests execute, and each of its sources is
# compiled alone. A library of another folder is that of the workspace.
DIFFERENCES = {
    "tests/CMakeLists.txt": {
        "add_executable(${name} ": "add_executable(${name} ${PROJECT_SOURCE_DIR}/tests/mutation/notes.cpp ",
        "UNITY_BUILD_BATCH_SIZE 0": "UNITY_BUILD OFF",
    },
    "cmake/library.cmake": {
        "  if(ARG_SOURCES)\n": """\
  set(built ${WORKSPACE_LIBRARIES}/librc_${name}.a)
  if(ARG_SOURCES AND EXISTS ${built} AND NOT CMAKE_CURRENT_SOURCE_DIR MATCHES "/src/${MUTATED}(/|$)")
    add_library(${name}_of_workspace STATIC IMPORTED GLOBAL)
    set_target_properties(${name}_of_workspace PROPERTIES IMPORTED_LOCATION ${built})
    target_link_libraries(${name}_of_workspace INTERFACE ${ARG_LINK})
    file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/none.cpp "")
    add_library(rc_${name} STATIC ${CMAKE_CURRENT_BINARY_DIR}/none.cpp)
    target_link_libraries(rc_${name} PUBLIC robot_control_options ${name}_of_workspace ${ARG_LINK})
  elseif(ARG_SOURCES)
""",
    },
}

TOKEN = re.compile(
    r"""(?P<skip>\s+|//[^\n]*|/\*.*?\*/|(?<![^\n])[ \t]*\#(?:[^\n]*\\\n)*[^\n]*)
      |(?P<text>"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])+')
      |(?P<number>\d[\d']*(?:\.[\d']*)?(?:[eE][+-]?\d+)?[uUlLfF]*)
      |(?P<word>[A-Za-z_]\w*)
      |(?P<mark><<=|>>=|<=>|->\*|->|::|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||\+=|-=|\*=|/=|%=|&=|\|=|\^=|.)""",
    re.VERBOSE | re.DOTALL,
)

BINARY = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "%": ("/",), "&": ("|",), "|": ("&",), "<<": (">>",),
    ">>": ("<<",),
}  # fmt: skip
ASSIGN = {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "&=": "|=", "|=": "&="}
LOGICAL = {"&&": "||", "||": "&&"}
PREFIX = {
    "!": ("Not", ""),
    "-": ("Minus", ""),
    "~": ("Complement", ""),
    "++": ("Increment", "--"),
    "--": ("Decrement", "++"),
}
FUNCTION = {
    "min": ("Min", "max"), "max": ("Max", "min"), "sin": ("Sin", "cos"), "cos": ("Cos", "sin"), "abs": ("Abs", ""),
    "floor": ("Floor", "ceil"), "ceil": ("Ceil", "floor"), "isfinite": ("IsFinite", "true || "), "clamp": ("Clamp", ""),
    "copysign": ("CopySign", ""),
}  # fmt: skip
# A statement that begins with one of these is a declaration or changes the flow, which `if` covers.
NO_STATEMENT = {
    "return", "break", "continue", "if", "for", "while", "do", "switch", "case", "default", "else", "using", "const",
    "constexpr", "static", "auto", "struct", "class", "enum", "template", "throw", "goto", "public", "private",
    "namespace", "delete", "new", "static_assert",
}  # fmt: skip
CONSTANT = re.compile(
    r"\b(?:(?:inline|static) )?constexpr (?P<type>double|float|int|bool|std::u?int\d+_t|std::size_t) (?P<name>\w+)\s*="
    r"(?=[^;,(]*(?:\([^;]*\)[^;,(]*)*;)"  # one name alone: several stay constants
)


@dataclass
class Token:
    """One token, its kind and where it stands in the text."""

    kind: str
    text: str
    begin: int

    @property
    def end(self) -> int:
        """The position behind it."""
        return self.begin + len(self.text)


@dataclass
class Change:
    """One change: `text` in place of what stands from `begin` to `end`."""

    number: int
    file: str  # below the root
    line: int
    before: str  # the source line
    after: str  # … with the change
    what: str


@dataclass
class Source:
    """One source file: finds its places and writes its copy with all changes."""

    file: str
    text: str
    freed: set[str]  # constants whose constexpr is left out
    first: int  # number of its first change
    bad_lines: set[int]  # whose changes do not compile

    def __post_init__(self) -> None:
        self.changes: list[Change] = []
        self.edits: list[tuple[int, int, int, str]] = []  # begin, rank, end, text
        self.tokens = [
            Token(match.lastgroup or "", match.group(), match.start())
            for match in TOKEN.finditer(self.text)
            if match.lastgroup != "skip"
        ]
        self.partner = self.brackets()
        self.fixed = self.fixed_places()
        for index, token in enumerate(self.tokens):
            if index in self.fixed or self.line_of(token.begin) in self.bad_lines:
                continue
            self.visit(index, token)

    # Places.

    def line_of(self, position: int) -> int:
        """Number of the line, from 1."""
        return self.text.count("\n", 0, position) + 1

    def brackets(self) -> dict[int, int]:
        """The index of the other one, for each bracket."""
        partner, stack = {}, []
        for index, token in enumerate(self.tokens):
            if token.kind != "mark":
                continue
            if token.text in "([{":
                stack.append(index)
            elif token.text in ")]}":
                partner[index] = stack.pop()
                partner[partner[index]] = index
        return partner

    def word(self, index: int) -> str:
        """Text of a token; empty outside."""
        return self.tokens[index].text if 0 <= index < len(self.tokens) else ""

    def end_of_statement(self, index: int) -> int:
        """Index of the `;` that ends it, or of its `{`."""
        while self.word(index) not in {";", ""}:
            if self.word(index) == "{" and self.opens_block(index):
                return index
            index = self.partner[index] + 1 if self.word(index) in {"(", "[", "{"} else index + 1
        return index

    def opens_block(self, index: int) -> bool:
        """The `{` at `index` begins a block of statements."""
        return self.word(index - 1) in {")", "]", "else", "do", "noexcept", "const", "override"} or (
            self.word(index - 1) in {";", "{", "}"} and self.in_block(index)
        )

    def in_block(self, index: int) -> bool:
        """The token stands directly between the braces of a block, not in brackets of an expression."""
        depth = index - 1
        while depth >= 0:
            if self.word(depth) in {")", "]", "}"}:
                depth = self.partner[depth] - 1
                continue
            if self.word(depth) in {"(", "["}:
                return False
            if self.word(depth) == "{":
                return self.opens_block(depth)
            depth -= 1
        return False

    def fixed_places(self) -> set[int]:
        """Tokens that belong to what only the compiler evaluates."""
        fixed: set[int] = set()
        for index, token in enumerate(self.tokens):
            if token.kind != "word":
                continue
            end = index
            if token.text in {"static_assert", "requires", "case", "enum"}:
                end = self.end_of_statement(index) if token.text != "case" else index
                while token.text == "case" and self.word(end) != ":":
                    end += 1
                if token.text == "enum" and "{" in {self.word(end - 1), self.word(end)}:
                    end = self.partner[end]
            elif token.text == "constexpr" and self.word(index - 1) != "if":
                match = CONSTANT.search(self.text, max(0, token.begin - 8))
                if match and match.start() <= token.begin < match.end() and match["name"] in self.freed:
                    self.free(index)
                    continue
                stop = next(i for i in range(index, len(self.tokens)) if self.word(i) in {"=", ";", "{", "("})
                if self.word(stop) != "(":
                    end = self.end_of_statement(index)
            elif token.text == "template" and self.word(index + 1) == "<":
                depth, end = 1, index + 1
                while depth > 0:
                    end += 1
                    depth += {"<": 1, ">": -1, ">>": -2}.get(self.word(end), 0)
            if end > index:
                fixed.update(range(index, end + 1))
        return fixed

    def free(self, index: int) -> None:
        """Makes a constant of the compiler one of the program."""
        token = self.tokens[index]
        static = self.word(index - 1) == "static" and not self.in_block(index)
        self.edits.append((token.begin, 0, token.end, "inline const" if static else "const"))
        equals = next(i for i in range(index, len(self.tokens)) if self.word(i) == "=")
        self.insert(self.tokens[equals].end, -9, " ::mutation::late(")
        self.insert(self.tokens[self.end_of_statement(index)].begin, 9, ")")

    # Changes.

    def add(self, begin: int, end: int, text: str, what: str) -> int:
        """Notes the change and returns its number."""
        number = self.first + len(self.changes)
        start = self.text.rfind("\n", 0, begin) + 1
        stop = self.text.find("\n", end)
        changed = self.text[start:begin] + text + self.text[end:stop]
        joined = " ".join(changed.split())
        before = " ".join(self.text[start:stop].split())
        self.changes.append(Change(number, self.file, self.line_of(begin), before, joined, what))
        return number

    def replace(self, token: Token, text: str) -> None:
        """Puts `text` in place of a token."""
        self.edits.append((token.begin, 0, token.end, text))

    def insert(self, position: int, rank: int, text: str) -> None:
        """Puts `text` between tokens; that of a lower rank first."""
        self.edits.append((position, rank, position, text))

    def visit(self, index: int, token: Token) -> None:
        """Finds the changes that begin at a token."""
        if token.kind == "number":
            self.number(index, token)
        elif token.text in {"true", "false"}:
            other = "false" if token.text == "true" else "true"
            self.replace(token, f"::mutation::flag<{self.add(token.begin, token.end, other, other)}>({token.text})")
        elif token.text in FUNCTION and self.word(index - 1) == "::" and self.word(index - 2) == "std":
            self.function(index, token)
        elif token.text == "if" and self.word(index + 1) == "(":
            self.condition(index)
        elif token.kind == "mark":
            self.operator(index, token)
        self.statement(index, token)

    def number(self, index: int, token: Token) -> None:
        """A number becomes its double and 0, and 0 becomes 1."""
        inside_template = self.text[token.begin - 1] == "<" or self.text[token.end] == ">"
        pure = token.text == "0" and self.word(index - 1) == "=" and self.word(index - 2) in {")", "const", "noexcept"}
        if inside_template or pure:
            return
        value = token.text.rstrip("uUlLfF").replace("'", "")
        if float(value) == 0:
            number = self.add(token.begin, token.end, "1", "1")
        else:
            twice = repr(2 * float(value)) if "." in value or "e" in value.lower() else str(2 * int(value))
            number = self.add(token.begin, token.end, twice, "doubled")
            self.add(token.begin, token.end, "0", "0")
        self.replace(token, f"::mutation::number<{number}>({token.text})")

    def function(self, index: int, token: Token) -> None:
        """std::min becomes std::max, and so on."""
        name, other = FUNCTION[token.text]
        begin = self.tokens[index - 2].begin
        arguments, end = "", token.end
        if self.word(index + 1) == "<":
            closing = next(i for i in range(index, len(self.tokens)) if self.word(i) == ">")
            end = self.tokens[closing].end
            arguments = ", " + self.text[self.tokens[index + 2].begin : self.tokens[closing].begin]
        elif self.word(index + 1) != "(":
            return
        text = f"std::{other}" if other.isalpha() else other
        number = self.add(begin, end, text + self.text[token.end : end], text or f"without {token.text}")
        self.edits.append((begin, 0, end, f"::mutation::{name}<{number}{arguments}>{{}}"))

    def condition(self, index: int) -> None:
        """A condition of `if` becomes its opposite, and false."""
        first, last = index + 2, self.partner[index + 1] - 1
        inside = {self.word(i) for i in range(first, last + 1)}
        if inside & {";", "="}:
            return
        begin, end = self.tokens[first].begin, self.tokens[last].end
        number = self.add(begin, end, f"!({self.text[begin:end]})", "negated")
        self.add(begin, end, "false", "never")
        self.insert(begin, -5, f"::mutation::condition<{number}>(static_cast<bool>(")
        self.insert(end, 5, "))")

    def operator(self, index: int, token: Token) -> None:
        """An operator becomes another one, or is left out."""
        spaced = self.text[token.begin - 1].isspace() and self.text[token.end].isspace()
        if token.text in {"<<", ">>"} and self.of_a_stream(index):
            return
        if spaced and token.text in BINARY:
            numbers = [self.add(token.begin, token.end, other, other) for other in BINARY[token.text]]
            self.replace(token, f"{token.text} ::mutation::Binary<{numbers[0]}>{{}} {token.text}")
        elif spaced and token.text in ASSIGN:
            number = self.add(token.begin, token.end, ASSIGN[token.text], ASSIGN[token.text])
            self.replace(token, f"{token.text} ::mutation::Assign<{number}>{{}} {token.text}")
        elif spaced and token.text in LOGICAL:
            self.logical(index, token)
        elif token.text in PREFIX and not self.text[token.end].isspace() and self.prefixes(index):
            name, other = PREFIX[token.text]
            number = self.add(token.begin, token.end, other, other or f"without {token.text}")
            self.replace(token, f"::mutation::{name}<{number}>{{}}->*")

    def of_a_stream(self, index: int) -> bool:
        """The statement has a text, so that its << write to a stream."""
        first = index
        while self.word(first) not in {";", "{", "}", ""}:
            first -= 1
        return any(token.kind == "text" for token in self.tokens[first + 1 : self.end_of_statement(index)])

    def prefixes(self, index: int) -> bool:
        """The operator stands before its operand, and no other one follows."""
        last = self.tokens[index - 1]
        after_value = (last.kind in {"word", "number"} and last.text != "return") or last.text in {")", "]", "}"}
        if after_value and not (last.text == ")" and self.text[self.tokens[index].begin - 1].isspace()):
            return False
        return self.word(index + 1) not in PREFIX

    def logical(self, index: int, token: Token) -> None:
        """a && b becomes (a != on ? b : on); with `on` that is a || b, and the other way round."""
        ends = {",", ";", "?", ":", "=", "return", *ASSIGN}
        stop = ends | {"||"} if token.text == "&&" else ends
        first = index
        while self.word(first - 1) not in stop | {"(", "[", "{", ""}:
            first -= 1
            if self.word(first) in {")", "]", "}"}:
                first = self.partner[first]
        last = index
        while self.word(last + 1) not in stop | {")", "]", "}", token.text, ""}:
            last += 1
            if self.word(last) in {"(", "[", "{"}:
                last = self.partner[last]
        number = self.add(token.begin, token.end, LOGICAL[token.text], LOGICAL[token.text])
        on = f"::mutation::on<{number}>()"
        same, shortcut = ("!=", on) if token.text == "&&" else ("==", f"!{on}")
        self.insert(self.tokens[first].begin, -1, "((static_cast<bool>(")
        self.replace(token, f") {same} {on}) ? static_cast<bool>(")
        self.insert(self.tokens[last].end, 1 if token.text == "&&" else 2, f") : {shortcut})")

    def statement(self, index: int, token: Token) -> None:
        """Drops what begins here, if that is a statement of its own and no declaration."""
        before = self.word(index - 1)
        after_header = before == ")" and self.word(self.partner[index - 1] - 1) in {"if", "for", "while"}
        if not (after_header or before in {";", "{", "}", "else"}) or token.text in NO_STATEMENT:
            return
        if token.kind == "mark" and token.text not in {"++", "--", "(", "*"}:
            return
        if not (self.in_block(index) or after_header):
            return
        end = self.end_of_statement(index)
        if self.word(end) != ";":
            return
        text = self.text[token.begin : self.tokens[end].begin]
        target = re.split(r" (?:[-+*/%&|^]|<<|>>)?= |\(", text, maxsplit=1)[0]
        if token.text not in {"++", "--", "("} and (re.search(r"\s", target) or target == text):
            return
        number = self.add(token.begin, self.tokens[end].end, ";", "dropped")
        self.insert(token.begin, -9, f"if (::mutation::on<{number}>()) {{}} else ")

    def changed(self) -> str:
        """The text with all changes."""
        out, position = [], 0
        for begin, _, end, text in sorted(self.edits, key=lambda edit: (edit[0], edit[2] > edit[0], edit[1])):
            out += [self.text[position:begin], text]
            position = end
        return '#include "mutation/switch.h"\n#line 1\n' + "".join(out) + self.text[position:]


def fail(message: str) -> None:
    """Ends with a sentence."""
    sys.exit(f"mutate.py: {message}")


def sources_below(folder: Path) -> list[Path]:
    """Headers and sources of a folder and those below."""
    return sorted(path for path in folder.rglob("*") if path.suffix in {".h", ".cpp"})


def constants_to_free(room: list[Path]) -> set[str]:
    """Constants of the room that nothing needs at compile time, and those elsewhere that are computed from them.

    Those of a function that may run at compile time are needed there.
    """
    texts = {path: path.read_text() for folder in ("src", "tests") for path in sources_below(ROOT / folder)}
    freed = {match["name"] for path in room for match in CONSTANT.finditer(texts[path])}
    function = re.compile(r"\bconstexpr [\w:]+ \w+\([^()]*\)[^{};]*\{[^}]*\}")
    for path in room:
        for body in function.findall(texts[path]):
            freed -= {match["name"] for match in CONSTANT.finditer(body)}
    statement = re.compile(r"\bconstexpr\b[^;{(]*[={][^;]*;")
    while True:
        last = set(freed)
        for text in texts.values():
            for name in sorted(freed):
                if name not in text:
                    continue
                if re.search(
                    rf"<[^<>;(){{}}\n]*\b{name}\b[^<>;(){{}}\n]*>|, {name}>|"
                    rf"static_assert\([^;]*\b{name}\b|\w\[{name}\]",
                    text,
                ):
                    freed.discard(name)
            for match in statement.finditer(text):
                used = {
                    name for name in freed if re.search(rf"=.*\b{name}\b|\{{.*\b{name}\b", match.group(), re.DOTALL)
                }
                constant = CONSTANT.match(match.group())
                if used and constant:
                    freed.add(constant["name"])
                else:
                    freed -= used
        if freed == last:
            return freed


def programs(room: str) -> list[str]:
    """Names of the test programs of the folder of tests that mirrors the room, or of the nearest above it."""
    folder = ROOT / "tests" / room
    while folder != ROOT / "tests":
        listing = folder / "CMakeLists.txt"
        names = re.findall(r"robot_control_test\((\w+)\b(?! FAST)", listing.read_text()) if listing.exists() else []
        if names:
            return [str(Path(folder.relative_to(ROOT)) / name) for name in names]
        folder = folder.parent
    fail(f"no folder of tests mirrors src/{room}")
    return []


def without_constexpr(text: str, freed: set[str]) -> str:
    """The text of a file that computes constants from those of the room."""

    def const(match: re.Match[str]) -> str:
        if match["name"] not in freed:
            return match.group()
        indented = text[text.rfind("\n", 0, match.start()) + 1 : match.start()].isspace()
        static = "static constexpr" in match.group() and indented
        return match.group().replace("constexpr", "inline const" if static else "const", 1)

    return CONSTANT.sub(const, text)


class Copy:
    """A copy of the repository that holds all changes of a folder directly below src, and its build."""

    def __init__(self, folder: str) -> None:
        self.folder = folder
        self.work = ROOT / "build/mutants" / folder
        self.tree = self.work / "tree"
        self.build = self.work / "build"
        self.work.mkdir(parents=True, exist_ok=True)
        self.lock = (self.work / "lock").open("w")
        fcntl.flock(self.lock, fcntl.LOCK_EX)  # another run in the same folder ends first

    def prepare(self, targets: list[str]) -> list[Change]:
        """Builds it; leaves out the changes of lines that do not compile with them."""
        freed = constants_to_free(sources_below(ROOT / "src" / self.folder))
        bad: dict[str, set[int]] = defaultdict(set)
        for _ in range(8):
            changes = self.write(freed, bad)
            messages = self.compile(targets)
            if not messages:
                return changes
            constants = set(re.findall(r"the value of ‘(?:\w+::)*(\w+)’ is not usable in a constant", messages)) & freed
            places = {(name, int(line)) for name, line in re.findall(r"\b(src/[\w/.]+):(\d+):", messages)}
            places -= {(name, line) for name in bad for line in bad[name]}
            if not places and not constants:
                break
            freed -= constants
            for name, line in () if constants else places:
                bad[name].add(line)
        fail(f"the copy with all changes does not compile; see {self.work / 'build.log'}")
        return []

    def write(self, freed: set[str], bad: dict[str, set[int]]) -> list[Change]:
        """Writes the files that differ, and returns the changes in them."""
        listing = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
        listed = subprocess.run(listing, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\0")
        files = {name for name in listed if name and (ROOT / name).is_file()}
        changes: list[Change] = []
        for name in sorted(files):
            content = (ROOT / name).read_bytes()
            for before, after in DIFFERENCES.get(name, {}).items():
                if before.encode() not in content:
                    fail(f"{name} does not contain {before!r}: adapt DIFFERENCES in {Path(__file__).name}")
                content = content.replace(before.encode(), after.encode())
            if name.startswith(f"src/{self.folder}/") and name.endswith((".h", ".cpp")):
                source = Source(name, content.decode(), freed, len(changes), bad[name])
                changes += source.changes
                content = source.changed().encode()
            elif name.startswith(("src/", "tests/")) and name.endswith((".h", ".cpp")):
                content = without_constexpr(content.decode(), freed).encode()
            copy = self.tree / name
            if not copy.exists() or copy.read_bytes() != content:
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_bytes(content)
        for copy in self.tree.rglob("*"):
            if copy.is_file() and str(copy.relative_to(self.tree)) not in files:
                copy.unlink()
        return changes

    def compile(self, targets: list[str]) -> str:
        """Returns the compiler's messages, empty if it succeeds."""
        flags = f"-O1 -w -Wno-narrowing -D_GLIBCXX_ASSERTIONS -I{self.tree}/tests"
        workspace = [f"-DMUTATED={self.folder}", f"-DWORKSPACE_LIBRARIES={ROOT}/build/robot_control/devel/lib"]
        options = [*workspace, "-DROBOT_CONTROL_ROS=OFF", "-DCMAKE_BUILD_TYPE=None", f"-DCMAKE_CXX_FLAGS={flags}"]
        configure = ["cmake", "-S", str(self.tree), "-B", str(self.build), *options]
        subprocess.run(configure, check=True, stdout=subprocess.DEVNULL)
        build = ["cmake", "--build", str(self.build), "-j", str(os.cpu_count()), "--target", *targets, "--", "-k"]
        result = subprocess.run(build, capture_output=True, text=True, check=False)
        (self.work / "build.log").write_text(result.stdout + result.stderr)
        return result.stderr if result.returncode != 0 else ""


class Programs:
    """The test programs, built with all changes."""

    def __init__(self, copy: Copy, names: list[str]) -> None:
        self.paths = [copy.build / name for name in names]
        self.known: set[int] = set()
        self.tests: dict[int, list[tuple[Path, str]]] = defaultdict(list)
        self.seconds: dict[tuple[Path, str], float] = {}

    def explore(self) -> None:
        """Runs all tests without a change, and notes the places that each executes."""
        for path in self.paths:
            notes = path.with_suffix(".reached")
            notes.unlink(missing_ok=True)
            if self.run(path, "*", {"MUTATION_NOTES": str(notes)}, None) is False:
                fail(f"{path.name} fails without a change: run scripts/test {path.name} first")
            for line in notes.read_text().splitlines():
                kind, name, seconds, *numbers = line.split()
                if kind == "known":
                    self.known |= {int(number) for number in numbers}
                    continue
                self.seconds[path, name] = float(seconds)
                for number in numbers:
                    self.tests[int(number)].append((path, name))

    def run(self, path: Path, tests: str, environment: dict[str, str], seconds: float | None) -> bool:
        """Runs tests of a program; false if one fails, crashes or uses more than `seconds` of a processor."""

        def limit() -> None:
            if seconds is not None:
                resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))
                resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
                resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))

        try:
            done = subprocess.run(
                [str(path), "--gtest_fail_fast", "--gtest_brief=1"],
                cwd=path.parent,
                env=os.environ | environment | {"GTEST_FILTER": tests},
                preexec_fn=limit,
                timeout=None if seconds is None else 30 + 20 * seconds,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return False
        return done.returncode == 0

    def find(self, change: Change) -> bool:
        """Whether a test finds the change; the fast ones first."""
        for path in self.paths:
            names = sorted((self.seconds[test], test[1]) for test in set(self.tests[change.number]) if test[0] == path)
            for group in groups(names):
                budget = 1 + 5 * sum(seconds for seconds, _ in group)
                if not self.run(path, ":".join(name for _, name in group), {"MUTANT": str(change.number)}, budget):
                    return True
        return False


def groups(names: list[tuple[float, str]]) -> Iterator[list[tuple[float, str]]]:
    """The tests from fast to slow, in groups that take 0.2 s, 0.4 s, 0.8 s and so on together."""
    group: list[tuple[float, str]] = []
    bound = 0.2
    for test in names:
        if group and sum(seconds for seconds, _ in [*group, test]) > bound:
            yield group
            group, bound = [], 2 * bound
        group.append(test)
    if group:
        yield group


def equal_changes(room: str) -> dict[tuple[str, str, str], bool]:
    """The listed changes of the room that change nothing: file, line before, line after; whether it was met."""
    listed = {}
    block: dict[str, str] = {}
    for line in [*EQUAL.read_text().splitlines(), ""]:
        if line.strip():
            key, _, value = line.partition(" ")
            block[key] = value.strip()
        elif block:
            if "why" not in block or not {"file", "-", "+"} <= block.keys():
                if block.keys() != {"#"}:
                    fail(f"{EQUAL.name}: a block needs the lines file, -, +, why; this one has {' '.join(block)}")
            elif block["file"].startswith(f"src/{room}/"):
                listed[block["file"], block["-"], block["+"]] = False
            block = {}
    return listed


def main() -> int:
    """Prints what survives, and the share that is found."""
    if not 3 <= len(sys.argv) <= 4 or not all(argument.isdigit() for argument in sys.argv[2:]):
        fail("usage: mutate.py ROOM N [SEED]")
    room, count, seed = sys.argv[1].strip("/"), int(sys.argv[2]), int((sys.argv[3:] or ["1"])[0])
    if not sources_below(ROOT / "src" / room):
        fail(f"src/{room} has no sources; ROOM is a folder below src")
    tests = programs(room)
    copy = Copy(room.split("/")[0])
    changes = [
        change for change in copy.prepare([Path(name).name for name in tests]) if change.file.startswith(f"src/{room}/")
    ]
    runner = Programs(copy, tests)
    runner.explore()
    equal = equal_changes(room)
    possible = []
    for change in changes:
        key = (change.file, change.before, change.after)
        if key in equal:
            equal[key] = True
        elif change.number in runner.known:
            possible.append(change)
    for (name, before, after), met in equal.items():
        if not met:
            fail(f"{EQUAL.name}: {name} has no change any more from '{before}' to '{after}'; remove it")
    drawn = random.Random(seed).sample(possible, min(count, len(possible)))
    if not drawn:
        fail(f"{', '.join(tests)} has no change of src/{room} in it: the program links nothing of the folder")
    found = 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for change, is_found in zip(drawn, pool.map(runner.find, drawn), strict=True):
            found += is_found
            if not is_found:
                note = "" if runner.tests[change.number] else " (no test executes it)"
                print(
                    f"{change.file}:{change.line}: {change.what}{note}\n  - {change.before}\n  + {change.after}",
                    flush=True,
                )
    share = found / len(drawn)
    print(
        f"{room}: {found} of {len(drawn)} changes found, {100 * share:.1f} %, of {len(possible)} possible ones; "
        f"{100 * REQUIRED:.0f} % are required; seed {seed}"
    )
    return 0 if share >= REQUIRED else 1


if __name__ == "__main__":
    sys.exit(main())
