"""The tables of messages: remedies begin with a verb, sentences are short, and all words are those of the field."""

import re
import subprocess
from pathlib import Path

from language import cpp_texts
from sentences import MAX_WORDS, WORD, sentences

ROOT = Path(__file__).parents[2]
TABLES = ("src/signals/stop_causes.def", "src/signals/names.h", "src/drivers/drive/drive_status.cpp")
ROW = re.compile(r'[{(]k?[A-Z]\w+, (?:"?[\w.]+"?),\s*((?:"[^"]*"\s*)+),\s*((?:"[^"]*"\s*)+)[,)}]')
CAUSE_WORDS = re.compile(r'\{((?:"[^"]+"\s*)+),\s*((?:"[^"]*"\s*)+)\}')

VERBS = re.compile(
    r"(?i:add|call|charge|check|correct|exchange|export|fetch|give|install|merge|mirror|move|press|publish|reduce|release"
    r"|remove|rename|replace|report|request|reset|restart|resume|run|save|send|set|start|stop|wait)\b"
)
"""A remedy begins with one of these."""
PRIVATE = re.compile(
    r"\blook (?:at|what|whether|for)\b|\b(?:gets|from) (?:its|their) core\b|to and fro|\bdescends?\b|in spite of"
    r"|stands against|let it run|hangs on itself|cannot be opened or written|\ball the same\b|robot/\w+_wheel_joints"
    r"|no format that is read"
)
"""Words that no message has."""


def joined(literals: str) -> str:
    return "".join(re.findall(r'"([^"]*)"', literals))


def rows() -> list[tuple[str, str, str]]:
    """File, sentence and remedy of each row of the tables."""
    found = []
    for path in TABLES:
        row = CAUSE_WORDS if path.endswith("drive_status.cpp") else ROW
        found += [(path, joined(one[1]), joined(one[2])) for one in row.finditer((ROOT / path).read_text())]
    return found


def last_argument(call: str) -> str:
    """The last argument of a call, whose text begins behind its opening bracket."""
    depth, begin, quoted = 0, 0, False
    for i, char in enumerate(call):
        quoted ^= char == '"' and call[i - 1] != "\\"
        if quoted:
            continue
        depth += (char in "([{") - (char in ")]}")
        if depth < 0:
            return call[begin:i].strip()
        begin = i + 1 if char == "," and depth == 0 else begin
    return ""


def refusals() -> list[str]:
    """Remedies of robot descriptions: the last argument of refuse(), and constants of that name."""
    found = []
    for path in (ROOT / "src/machine").rglob("*.[ch]*"):
        text = path.read_text()
        remedies = [last_argument(text[call.end() :]) for call in re.finditer(r"\brefuse\(", text)]
        remedies += re.findall(r"\bk\w*(?:Remedy|Wheels|Radius|Axis|Shape|Continuous) =\s*((?:\"[^\n]*\"\s*)+);", text)
        found += [remedy for remedy in remedies if remedy.startswith('"')]
    return [text for text in found if WORD.search(text)]


def test_every_table_has_rows():
    assert {path for path, *_ in rows()} == set(TABLES)
    assert len(rows()) > 150
    assert len(refusals()) > 60


def test_a_remedy_begins_with_a_verb_of_the_list():
    remedies = [remedy for _, _, remedy in rows() if remedy] + [text[1:] for text in refusals()]
    assert [text for text in remedies if not VERBS.match(text)] == []


def test_a_sentence_of_a_message_has_at_most_25_words():
    texts = [text for _, sentence, remedy in rows() for text in (sentence, remedy)]
    assert [text for text in texts for part in sentences([text], 0) if len(WORD.findall(part)) > MAX_WORDS] == []


def test_no_message_has_words_of_this_project_alone():
    command = ["git", "ls-files", "src/*.cpp", "src/*.h", "src/*.def", "python/*.py", "python/*.js"]
    files = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    found = []
    for path in files:
        for number, line in enumerate((ROOT / path).read_text().splitlines(), 1):
            texts = re.findall(r'"(?:[^"\\]|\\.)*"', re.sub(r'^\s*(//|#|""").*|"""[^"]*"""', "", line))
            found += [f"{path}:{number}: {text}" for text in texts if PRIVATE.search(text)]
    assert found == []


def test_a_latch_file_that_is_not_writable_is_named_before_what_it_costs():
    texts = [text for _, text in cpp_texts((ROOT / "src/ros/nodes/monitor_node.cpp").read_text())]
    assert "latch_file is not writable: a stop would be lost after a reboot: " in texts
