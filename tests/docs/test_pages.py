"""Files and names that README and docs link to and mention exist."""

import re
import subprocess

import parameters_page
import pytest
from pages import CHINESE, PAGES, README, ROOT, anchors, english, inline_code, links, prose, structure, tables

by_name = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)


@pytest.fixture(scope="module")
def tree():
    """Paths of all files of the project."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    return [path for path in listed.stdout.splitlines() if (ROOT / path).exists()]


@pytest.fixture(scope="module")
def words(tree):
    """Every identifier of the program: sources, scripts, configuration, messages."""
    folders = ("src/", "scripts/", "python/", "bench/", "config/", "msg/", "srv/", "launch/")
    texts = ((ROOT / path).read_text(errors="replace") for path in tree if path.startswith(folders))
    return set().union(*(re.findall(r"\w+", text) for text in texts))


@by_name
def test_every_link_leads_to_a_file_and_a_heading(page):
    for target in links(page):
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        assert file.exists(), target
        assert not anchor or anchor in anchors(file), target


@by_name
def test_every_source_file_that_is_named_exists(page, tree):
    for code in inline_code(page):
        for name in re.findall(r"[\w/.]*\w\.(?:h|cpp|(?<!\.launch\.)py)\b", code):
            assert any(f"/{path}".endswith(f"/{name}") for path in tree), name


@by_name
def test_every_path_that_is_named_exists(page):
    for code in inline_code(page):
        if re.fullmatch(r"(src|scripts|tests|config|launch|msg|srv|urdf|docs)(/[\w.]+)*/?", code):
            assert (ROOT / code).exists(), code


@by_name
def test_every_key_of_a_block_exists(page, words):
    """`robot.wheel_base`, `state_estimator.odom_rate`, `max_linear_speed`."""
    for code in inline_code(page):
        key = re.fullmatch(
            r"(?:robot|mujoco_plant|state_estimator|diff_drive_controller|safety_monitor|telemetry)[./](\w+)", code
        )
        if key:
            assert key[1] in words, code


@by_name
def test_every_entry_script_of_a_table_exists_with_its_selection(page, tree):
    """`scripts/bench stops` names a bench, `scripts/test lockstep` a part of a test's name."""
    benches = (ROOT / "scripts" / "bench").read_text()
    cmake = [
        (ROOT / path).read_text()
        for path in tree
        if path.startswith(("tests/", "bench/")) and path.endswith("CMakeLists.txt")
    ]
    tests = "\n".join([*(path for path in tree if path.startswith("tests/")), *cmake])
    for code in inline_code(page):
        call = re.fullmatch(r"(?:scripts|\.ci)/(\w+)((?: [\w-]+)*)(?: [A-Z].*)?", code)
        if not call or "/" + call[1] + "/" in code:
            continue
        path = code.split()[0]
        assert (ROOT / path).exists(), code
        for name in re.findall(r"--[\w-]+|\b[a-z_]+", call[2]):
            if name.startswith("--"):
                assert name in (ROOT / path).read_text(), code
            elif call[1] == "bench":
                assert re.search(rf"\b{name}\b", benches), code
            elif call[1] == "test":
                assert name in tests or name.removeprefix("test_") in tests, code


LENGTHS = {
    "README.md": (120, 900),
    "docs/console.md": (75, 600),
    "docs/driving.md": (110, 1100),
    "docs/legs.md": (150, 1550),
    "docs/navigation.md": (75, 800),
    "docs/robots.md": (95, 800),
    "docs/safety.md": (140, 1250),
}
"""The most lines and words of the entrance and of the pages for users."""


@pytest.mark.parametrize("page", LENGTHS)
def test_a_page_for_users_is_short(page):
    text = (ROOT / page).read_text()
    lines, words = LENGTHS[page]
    assert len(text.splitlines()) <= lines
    assert len(text.split()) <= words


def test_the_film_of_the_readme_is_one_that_a_code_host_plays():
    film = next(ROOT / target for target in links(README) if "film" in target)
    data = film.read_bytes()
    assert data.startswith(b"GIF89a")
    assert int.from_bytes(data[6:8], "little") == 720
    assert len(data) <= 3_000_000


@pytest.mark.parametrize("page", [page for page in PAGES if page.parent.name != "evidence"], ids=lambda page: page.name)
def test_a_page_for_users_has_no_measured_table_of_more_than_five_rows(page):
    """A table is one of measurements where more than a third of the cells beside its names begin with a number."""
    for _, *rows in tables(page):
        cells = [cell for row in rows for cell in row[1:]]
        numbers = [cell for cell in cells if re.match(r"[≤≥<>±~−-]?\s*[\d.,]+(\s|$|[a-z%°µ])", cell)]
        assert len(rows) <= 5 or 3 * len(numbers) <= len(cells), rows[0]


def test_every_folder_of_the_source_is_on_the_map():
    on_the_map = set(re.findall(r"`src/(\w+)`", prose(ROOT / "docs" / "architecture.md")))
    assert on_the_map == {path.name for path in (ROOT / "src").iterdir() if path.is_dir()}


def test_every_page_is_reached_from_the_readme():
    reached, ahead = set(), [README]
    while ahead:
        page = ahead.pop()
        if page not in reached:
            reached.add(page)
            targets = [(page.parent / link.partition("#")[0]).resolve() for link in links(page)]
            ahead += [path for path in targets if path.suffix == ".md"]
            ahead += [file for path in targets if path.is_dir() for file in path.glob("*.md")]
    assert set(PAGES) <= reached


def glossary():
    rows = (ROOT / "docs" / "glossary.md").read_text().splitlines()
    return [row for row in rows if row.startswith("| ") and not row.startswith("| term ")]


def test_the_glossary_is_short_and_says_each_term_once():
    terms = [row.split("|")[1].strip() for row in glossary()]
    assert len(terms) <= 72
    assert len(set(terms)) == len(terms)


def test_each_term_of_the_glossary_has_a_chinese_word_of_its_own():
    chinese = [row.split("|")[2].strip() for row in glossary()]
    assert [word for word in chinese if not re.match(r"[\u4e00-\u9fff]+", word)] == []
    assert len(set(chinese)) == len(chinese)


def test_every_name_in_the_glossary_is_one_of_the_program(words):
    named = (word for row in glossary() for code in re.findall(r"`([^`]+)`", row) for word in re.findall(r"\w+", code))
    assert [word for word in named if word not in words and word not in ("csv", "odom")] == []


def test_parameter_file_and_page_are_those_of_the_tables():
    written = parameters_page.YAML.read_text(), parameters_page.PAGE.read_text()
    assert written == parameters_page.written(), "run tests/docs/parameters_page.py"


@pytest.mark.parametrize("chinese", CHINESE, ids=lambda page: page.name)
def test_a_chinese_page_has_the_structure_of_the_english_one(chinese):
    """Headings, lists, tables, code without comments, links and names in code; only the sentences differ."""
    ours, theirs = structure(chinese), structure(english(chinese))
    assert {part: ours[part] for part in ours if ours[part] != theirs[part]} == {
        part: theirs[part] for part in ours if ours[part] != theirs[part]
    }


@pytest.mark.parametrize("chinese", CHINESE, ids=lambda page: page.name)
def test_a_chinese_page_and_the_english_one_lead_to_each_other(chinese):
    assert chinese.name in links(english(chinese))
    assert english(chinese).name in links(chinese)
