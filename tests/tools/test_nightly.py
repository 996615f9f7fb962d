"""docs/tests.md names every case that was moved to the nightly suite, and only cases that exist and are marked."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROW = re.compile(r"^\|[^|]+\| `(tests/[^`]+)` \| `(\w+)` \|[^|]+\|$", re.MULTILINE)
TABLE = ROW.findall((ROOT / "docs/tests.md").read_text())
MARKED = re.compile(r"INSTANTIATE_TEST_SUITE_P\(\s*Nightly,\s*(\w+)|TEST_F\((Nightly\w+),")
LABELLED = re.compile(r"set\(nightly ([\w ]+)\)")
TESTS = [path for path in (ROOT / "tests").rglob("*") if path.suffix in (".py", ".cpp") and path != Path(__file__)]


def suites(text):
    """Suites of a gtest program that have nightly cases."""
    return {instantiated or named for instantiated, named in MARKED.findall(text)}


def decorated(path):
    """Tests of a Python file one of whose decorators names nightly."""
    text = path.read_text()
    functions = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.FunctionDef)]
    return {
        function.name
        for function in functions
        if function.name.startswith("test_")
        and any("nightly" in ast.get_source_segment(text, part).lower() for part in function.decorator_list)
    }


def labelled():
    """Files of tests/system that are nightly as a whole."""
    (names,) = LABELLED.findall((ROOT / "tests/system/CMakeLists.txt").read_text())
    return {f"tests/system/{name}_test.py" for name in names.split()}


def marked():
    """(file, case) of everything with a marker of its own."""
    found = set()
    for path in TESTS:
        name = str(path.relative_to(ROOT))
        cases = suites(path.read_text()) if path.suffix == ".cpp" else decorated(path)
        found |= {(name, case) for case in cases}
    return found


def test_the_table_has_rows():
    assert len(TABLE) > 10
    assert len(set(TABLE)) == len(TABLE)


@pytest.mark.parametrize(("file", "case"), TABLE)
def test_every_entry_exists_and_is_nightly(file, case):
    text = (ROOT / file).read_text()
    if file.endswith(".cpp"):
        assert case in suites(text)
    else:
        assert re.search(rf"def {case}\(", text)
        assert "mark.nightly" in text or "@nightly" in text or file in labelled()


def test_every_marked_case_stands_in_the_table():
    assert marked() <= set(TABLE)


def test_every_file_with_a_marker_stands_in_the_table():
    files = {str(path.relative_to(ROOT)) for path in TESTS if "mark.nightly" in path.read_text()}
    assert files | labelled() <= {file for file, _ in TABLE}
