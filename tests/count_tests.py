#!/usr/bin/python3
"""Counts test cases in result files and prints the last line of scripts/test.

usage: count_tests.py FOLDER…

The skipped cases stand above it by name, one line per reason, and after them the failed ones. JUnit files of gtest,
pytest and rosunit count case by case. CTest's own Test.xml counts a whole entry, and only if it failed without a failed
case in a JUnit file of its name. That is a program that crashed, hung or never started. The exit code is 0 if and only
if something passed and nothing failed.
"""

import sys
import xml.etree.ElementTree as ET
from collections import Counter
from pathlib import Path

PASSED, FAILED, SKIPPED = "passed", "failed", "skipped"


def outcome(case: ET.Element) -> str:
    """Outcome of one <testcase>."""
    if case.find("failure") is not None or case.find("error") is not None:
        return FAILED
    if case.find("skipped") is not None or case.get("status") == "notrun" or case.get("result") == "skipped":
        return SKIPPED
    return PASSED


def full_name(case: ET.Element) -> str:
    """Suite and name of one <testcase>."""
    return f"{case.get('classname', '')}.{case.get('name', '')}".lstrip(".")


def skips(root: ET.Element) -> list[tuple[str, str]]:
    """Reason and name of every skipped <testcase>. gtest writes the source's place into the message, a line before."""
    found = []
    for case in root.iter("testcase"):
        if outcome(case) != SKIPPED:
            continue
        note = case.find("skipped")
        text = "" if note is None else note.get("message") or note.text or ""
        lines = [line.strip() for line in text.splitlines() if line.strip() and ".cpp:" not in line]
        found.append((" ".join(lines) or "no reason given", full_name(case)))
    return found


def count_junit(root: ET.Element) -> Counter[str]:
    """Cases of one JUnit file by outcome."""
    return Counter(outcome(case) for case in root.iter("testcase"))


def failed_entries(root: ET.Element) -> set[str]:
    """Names of the CTest entries that failed, from Test.xml."""
    return {test.findtext("Name", "") for test in root.iter("Test") if test.get("Status") == FAILED}


def is_summary_of_nodes(path: Path) -> bool:
    """rostest writes rosunit-NAME.xml with the cases, and rostest-NAME.xml with one line per node that ran them."""
    return path.name.startswith("rostest-")


def ros_name(stem: str) -> str:
    """The part of the name that a result file of rostest shares with its CTest entry."""
    return stem.removeprefix("rostest-").removeprefix("rosunit-").removesuffix("_test")


def count(folders: list[Path]) -> tuple[Counter[str], list[str], dict[str, list[str]]]:
    """All cases; what failed, cases, CTest entries and files; names of the skipped cases by reason."""
    total: Counter[str] = Counter()
    failed: list[str] = []
    wholly_failed: list[str] = []
    explained: set[str] = set()
    entries: set[str] = set()
    skipped: dict[str, list[str]] = {}
    for path in sorted(file for folder in folders for file in folder.rglob("*.xml")):
        try:
            root = ET.parse(path).getroot()
        except ET.ParseError:  # its writer was killed
            wholly_failed.append(f"{path} (broken)")
            continue
        if path.name == "Test.xml":
            entries |= failed_entries(root)
            continue
        if root.tag not in ("testsuites", "testsuite"):
            continue
        cases = count_junit(root)
        if is_summary_of_nodes(path):
            cases = Counter({FAILED: cases[FAILED]})
        else:
            failed += [full_name(case) for case in root.iter("testcase") if outcome(case) == FAILED]
            for reason, name in skips(root):
                skipped.setdefault(reason, []).append(name)
        if cases[FAILED]:
            explained.add(path.stem)
        total += cases
    wholly_failed += [
        entry for entry in sorted(entries) if not any(stem == entry or ros_name(stem) in entry for stem in explained)
    ]
    total[FAILED] += len(wholly_failed)
    return total, failed + [f"{name}, as a whole" for name in wholly_failed], skipped


def main(folders: list[str]) -> int:
    """Prints the skipped cases, the failed ones, then the last line."""
    total, failed, skipped = count([Path(folder) for folder in folders])
    for reason, names in sorted(skipped.items()):
        print(f"skipped: {reason}: {', '.join(sorted(set(names)))}")
    for name in failed:
        print(f"failed: {name}")
    print(f"{total[PASSED]} passed, {total[FAILED]} failed, {total[SKIPPED]} skipped")
    return 0 if total[PASSED] > 0 and total[FAILED] == 0 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
