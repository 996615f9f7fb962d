#!/usr/bin/python3
"""Writes docs/parameters.md from the schema (ranges, units) and config/robot_params.yaml (defaults, meaning). Before
that it writes the lines of this file for the conditions of the safety monitor from src/signals/stop_causes.def.

tests/docs/parameters_page.py      after a build with tests; writes both
"""

import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "parameters.md"
YAML = ROOT / "config" / "robot_params.yaml"
SCHEMA = ROOT / "build" / "robot_control" / "tests" / "parameters" / "print_schema"

CONDITIONS = "  # (lines of src/signals/stop_causes.def, written by tests/docs/parameters_page.py)"

HEAD = """# Parameters

Every key of [config/robot_params.yaml](../config/robot_params.yaml). Written by `tests/docs/parameters_page.py` from
the schema and from the comments of that file; do not edit it here.

A default in parentheses is derived from the robot, or left out, unless it is set; a number there is that of diffbot.
*Live* parameters can be changed [while the robot drives](tuning.md#tuning-while-it-drives). Precedence of file, your
own file and parameter server: [interfaces.md](interfaces.md#parameters).
"""

BLOCK = re.compile(r"^(\w+):\s*$")
VALUE = r"\{.*?\}|\[.*?\]|\"[^\"]*\"|[^#\s]\S*"
KEY = re.compile(rf"^  (?P<off># )?(?P<key>\w+):(?:\s+(?P<value>{VALUE}))?\s*(?:#\s*(?P<text>.*))?$")
MEMBER = re.compile(r"^  (?P<off># )?  (?P<key>\w+):\s+(?P<value>\S+)\s*(?:#\s*(?P<text>.*))?$")
CONTINUED = re.compile(r"^\s{4,}#\s*(?P<text>.*)$")
REMARK = re.compile(r"^(?:  )?# ?(?P<text>.*)$")


class Entry:
    """A line of the YAML file: the default and its meaning."""

    def __init__(self, value, off, text):
        self.value, self.off, self.text = value, off, text


def read_yaml(text, paths):
    """The lines in their order: ("block", name), ("remark", text), ("key", path, Entry)."""
    items, block, group, latest = [], "", "", None
    for line in text.splitlines():
        if found := BLOCK.match(line):
            block, group, latest = found[1], "", None
            remarks = []
            while items and items[-1][0] == "remark":
                remarks.insert(0, items.pop())
            items += [("block", block), *remarks]
        elif (found := MEMBER.match(line)) and f"{block}.{group}.{found['key']}" in paths:
            latest = Entry(found["value"], bool(found["off"]), found["text"] or "")
            items.append(("key", f"{block}.{group}.{found['key']}", latest))
        elif (found := KEY.match(line)) and is_known(f"{block}.{found['key']}", paths):
            group = found["key"]
            latest = Entry(found["value"] or "", bool(found["off"]), found["text"] or "")
            items.append(("key", f"{block}.{group}", latest))
        elif latest and (found := CONTINUED.match(line)):
            latest.text += " " + found["text"]
        elif not line.strip():
            latest = None
            items.append(("gap",))
        elif found := REMARK.match(line):
            latest = None
            items.append(("remark", found["text"]))
    return items


def is_known(path, paths):
    return path in paths or any(other.startswith(path + ".") for other in paths)


def cell(text):
    return re.sub(r"\s+", " ", text).strip().replace("|", "\\|").replace("<", "&lt;")


def page(schema, yaml):
    rules = {}
    for line in schema.splitlines():
        path, *rest = line.split("\t")
        rules[path] = rest
    lines, table, shown = [HEAD], False, set()
    for item in read_yaml(yaml, rules):
        if item[0] == "block":
            lines += ["", f"## {item[1]}", ""]
            table = False
        elif item[0] == "gap":
            table = False
        elif item[0] == "remark" and lines != [HEAD]:
            lines += [] if lines[-1] == "" or not lines[-1].startswith("|") else [""]
            lines.append(item[1])
            table = False
        elif item[0] == "key":
            if not table:
                lines += ["", "| key | default | allowed | meaning |", "|---|---|---|---|"]
                table = True
            lines.append(row(item[1], item[2], rules))
            shown |= {path for path in rules if path == item[1] or path.startswith(item[1] + ".")}
    others = [path for path in rules if path not in shown]
    missing = [path for path in others if not rules[path][3]]
    if missing:
        raise ValueError(f"no line in {YAML.name}: {', '.join(missing)}")
    lines += ["", "## Other names", "", "| key | the same as |", "|---|---|"]
    lines += [f"| `{path}` | `{path.rsplit('.', 1)[0]}.{rules[path][3]}` |" for path in others]
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines) + "\n")


def row(path, entry, rules):
    """A condition is one row: limit, persistence and reaction."""
    name = path.split(".", 1)[1]
    parts = {part.removeprefix(path + "."): rule for part, rule in rules.items() if part.startswith(path + ".")}
    if path in rules:
        allowed, _, live, _ = rules[path]
        allowed += "; live" if live else ""
    elif "reaction" in parts:
        allowed = f"limit: {parts['limit'][0]}" if "limit" in parts else "no limit; persistence and reaction alone"
    else:
        allowed = "a map of " + ", ".join(parts)
    value = f"`{entry.value}`" if entry.value else ""
    if entry.off:
        value = f"({value})" if value else "(left out)"
    return f"| `{name}` | {value} | {cell(allowed)} | {cell(without_unit(entry.text, allowed))} |"


def without_unit(text, allowed):
    """The meaning without the unit at its begin, which another column holds already."""
    unit = re.search(r"… \S+ (?!of )([^\s;]+)", allowed)
    if unit and re.match(re.escape(unit[1]) + r"(?![\w·/²³√])", text):
        return text.removeprefix(unit[1]).lstrip(",:; ")
    return text


def printed(*arguments):
    return subprocess.run([SCHEMA, *arguments], capture_output=True, text=True, check=True).stdout


def with_conditions(yaml, table):
    """The file with the conditions of `table` below the line that names their source."""
    lines = []
    for row in table.splitlines():
        name, limit, persistence, reaction, meaning = row.split("\t")
        given = "" if limit == "{}" else f"limit: {limit}, "
        value = f"{{{given}persistence: {persistence}, reaction: {reaction[1:].lower()}}}"
        lines.append(f"  {name + ':':<19} {value:<49} # {meaning}")
    return re.sub(rf"(?<={re.escape(CONDITIONS)}\n).*?\n(?=\n)", "\n".join(lines) + "\n", yaml, flags=re.DOTALL)


def written():
    """The YAML file and the page."""
    yaml = with_conditions(YAML.read_text(), printed("conditions"))
    return yaml, page(printed(), yaml)


if __name__ == "__main__":
    new_yaml, new_page = written()
    YAML.write_text(new_yaml)
    PAGE.write_text(new_page)
