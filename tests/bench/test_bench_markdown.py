import re

from bench import markdown
from bench.rows import compared


def row(name, value, reference=0.0, reference_name="none", unit="ns"):
    return compared(name, value, unit, reference, reference_name)


def test_a_figure_stands_beside_its_ratio():
    result = {"bench": "step", "rows": [row("gate", 88.0, 44.0, "kernel"), row("allocations", 0.0, unit="")]}
    assert markdown.table(result).splitlines() == [
        "| figure | value | ratio |",
        "|---|---|---|",
        "| gate | 88 ns | 2 of kernel |",
        "| allocations | 0 |  |",
    ]


def test_robots_with_bounds_stand_side_by_side():
    bounded = {"reference_name": markdown.ALLOWED, "unit": "%"}
    rows = [row("diffbot overshoot", 0.1, 1.0, **bounded), row("boxer overshoot", 0.3, 1.0, **bounded)]
    rows.append(row("diffbot tracking RMS", 0.5, 2.0, **bounded))
    text = markdown.table({"bench": "drive", "rows": rows, "not_judged": ["kobuki"]})
    assert text.splitlines() == [
        "| figure | allowed | diffbot | boxer | worst, of what is allowed |",
        "|---|---|---|---|---|",
        "| overshoot [%] | 1 | 0.1 | 0.3 | 30 % |",
        "| tracking RMS [%] | 2 | 0.5 | – | 25 % |",
        "",
        "Not measured, for want of their descriptions: kobuki.",
    ]


def test_only_the_place_of_the_benchmark_is_replaced():
    page = "a\n<!-- scripts/bench step -->\nold\n<!-- end -->\nb\n<!-- scripts/bench plant -->\nkept\n<!-- end -->\n"
    done = markdown.replaced(page, {"bench": "step", "rows": [row("gate", 1.0)]})
    assert "old" not in done
    assert done.startswith("a\n<!-- scripts/bench step -->\n\n| figure |")
    assert done.endswith("<!-- end -->\nb\n<!-- scripts/bench plant -->\nkept\n<!-- end -->\n")


def test_a_benchmark_without_a_file_creates_it_and_replaces_its_table_later(tmp_path, monkeypatch):
    monkeypatch.setattr(markdown, "EVIDENCE", tmp_path)
    markdown.write([{"bench": "step", "rows": [row("gate", 1.0)]}])
    markdown.write([{"bench": "step", "rows": [row("gate", 2.0)]}])
    text = (tmp_path / "step.md").read_text()
    assert text.startswith("# scripts/bench step\n\n<!-- scripts/bench step -->\n\n| figure | value | ratio |")
    assert text.count("| gate |") == 1
    assert "| gate | 2 ns |" in text


def test_the_marks_of_a_page_are_those_of_its_benchmark():
    marks = {
        path.stem: set(re.findall(r"<!-- scripts/bench (\w+) -->", path.read_text()))
        for path in markdown.EVIDENCE.glob("*.md")
    }
    assert {name: found for name, found in marks.items() if found - {name}} == {}
    assert marks["drive"]
