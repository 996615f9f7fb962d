"""The shell scripts, as far as they go without building."""

import re
import subprocess
from pathlib import Path

import pytest

SCRIPTS = Path(__file__).parents[2] / "scripts"
ROSTESTS = [f"_ctest_robot_control_rostest_tests_system_{name}.test" for name in ("drives", "send_cmd", "start")]
ENTRIES = ["test_signals", "test_control", "test_lockstep", *ROSTESTS]


def shell(*command):
    return subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False, timeout=60)


def selected(*names):
    """Entries that `scripts/test NAME…` hands to CTest."""
    selection = SCRIPTS / "test_selection.sh"
    done = shell("bash", "-euc", 'source "$0"; ctest_pattern "$@"', str(selection), *names)
    return [entry for entry in ENTRIES if re.search(done.stdout.strip(), entry)]


@pytest.mark.parametrize("script", ["demo", "test", "setup", "lint", "bench"])
def test_help_says_how_to_call_it_and_does_nothing(script):
    done = shell(str(SCRIPTS / script), "--help")
    assert done.returncode == 0
    assert f"scripts/{script} [" in done.stdout
    assert "building" not in done.stdout


@pytest.mark.parametrize("script", ["test", "setup", "lint"])
def test_an_unknown_argument_is_refused_with_the_usage(script):
    done = shell(str(SCRIPTS / script), "--warp")
    assert done.returncode == 1
    assert "unknown argument '--warp'; usage:" in done.stderr


def test_a_part_of_the_projects_name_selects_no_rostest_by_it():
    assert selected("control") == ["test_control"]
    assert selected("robot") == []
    assert selected("test_control") == ["test_control"]


def test_a_rostest_is_selected_by_its_file_or_its_folder():
    assert selected("drives") == [ROSTESTS[0]]
    assert selected("system") == ROSTESTS


def test_several_names_select_each_its_own():
    assert selected("signals", "start") == ["test_signals", ROSTESTS[2]]
