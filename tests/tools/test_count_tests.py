import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = Path(__file__).parents[2] / "tests/count_tests.py"

GTEST = """<testsuites><testsuite name="Gate">
  <testcase name="Passes" status="run" result="completed"/>
  <testcase name="Fails" status="run" result="completed"><failure message="no"/></testcase>
  <testcase name="Skips" classname="Gate" status="run" result="skipped">
    <skipped message="gate_test.cpp:7&#x0A;why"/></testcase>
  <testcase name="DISABLED_Rests" status="notrun" result="suppressed"/>
</testsuite></testsuites>"""
PASSED = '<testsuites><testsuite name="a"><testcase name="b"/></testsuite></testsuites>'
CTEST = """<Site><Testing><TestList><Test>./test_gate</Test></TestList>
  <Test Status="{status}"><Name>test_gate</Name></Test></Testing></Site>"""


@pytest.fixture
def output(tmp_path):
    def run(**files):
        for name, text in files.items():
            (tmp_path / f"{name}.xml").write_text(text)
        done = subprocess.run([sys.executable, "-I", PROGRAM, tmp_path], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout.splitlines()

    return run


@pytest.fixture
def count(output):
    def run(**files):
        code, lines = output(**files)
        return code, lines[-1]

    return run


def test_cases_are_counted_by_outcome(count):
    assert count(test_gate=GTEST) == (1, "1 passed, 1 failed, 2 skipped")


def test_what_was_skipped_is_named_with_its_reason(output):
    skipping = PASSED.replace("/></testsuite>", "><skipped>no root here</skipped></testcase></testsuite>")
    lines = output(test_gate=GTEST, pytest=skipping)[1]
    assert "skipped: why: Gate.Skips" in lines
    assert "skipped: no root here: b" in lines


def test_all_passed_is_success(count):
    assert count(test_gate=PASSED, pytest=PASSED) == (0, "2 passed, 0 failed, 0 skipped")


def test_nothing_at_all_is_no_success(count):
    assert count() == (1, "0 passed, 0 failed, 0 skipped")


def test_a_program_that_crashed_counts_as_one_failure(count):
    assert count(other=PASSED, Test=CTEST.format(status="failed")) == (1, "1 passed, 1 failed, 0 skipped")


def test_a_failed_case_is_not_counted_again_with_its_program(count):
    assert count(test_gate=GTEST, Test=CTEST.format(status="failed")) == (1, "1 passed, 1 failed, 2 skipped")


def test_a_passed_entry_adds_nothing(count):
    assert count(test_gate=PASSED, Test=CTEST.format(status="passed")) == (0, "1 passed, 0 failed, 0 skipped")


def test_a_broken_file_is_a_failure(count):
    assert count(test_gate=PASSED, half="<testsuites><testsuite") == (1, "1 passed, 1 failed, 0 skipped")


def test_rostest_cases_are_counted_once(count):
    files = {"rostest-timeout": PASSED, "rosunit-timeout": PASSED}
    assert count(**files) == (0, "1 passed, 0 failed, 0 skipped")


def test_a_rostest_whose_node_died_is_a_failure(count):
    died = PASSED.replace("/></testsuite>", "><error message='died'/></testcase></testsuite>")
    assert count(**{"rostest-timeout": died})[1] == "0 passed, 1 failed, 0 skipped"


@pytest.mark.parametrize("name", ["rostest-tests_system_drives", "rosunit-drives_test"])
def test_a_failed_rostest_is_counted_once(count, name):
    entry = CTEST.format(status="failed").replace("test_gate", "_ctest_robot_control_rostest_tests_system_drives.test")
    failed = PASSED.replace("/></testsuite>", "><failure message='no'/></testcase></testsuite>")
    assert count(**{name: failed, "Test": entry}) == (1, "0 passed, 1 failed, 0 skipped")
