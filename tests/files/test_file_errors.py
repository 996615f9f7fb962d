"""A missing file and a missing build are reported in words."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from robot_control import _robot_control
from robot_control.files.files import in_words

PYTHON = Path(__file__).parents[2] / "python"


def error_of(path):
    with pytest.raises(OSError) as raised:
        Path(path).read_text()
    return raised.value


def test_a_missing_file_is_named_without_an_error_number(tmp_path, monkeypatch):
    path = tmp_path / "none.csv"
    assert in_words(error_of(path)) == f"{path}: file not found"
    monkeypatch.chdir(tmp_path)
    assert in_words(error_of("none.csv")) == f"none.csv: file not found ({path})"
    assert "Errno" not in in_words(error_of(tmp_path))


def test_any_other_error_keeps_its_words():
    assert in_words(ValueError("no columns")) == "no columns"
    assert in_words(OSError("the disk is gone")) == "the disk is gone"
    assert in_words(OSError(28, "No space left on device")) == "No space left on device"


def failed(code, path):
    """The message of `code` with `path` alone."""
    environment = {**os.environ, "PYTHONPATH": path}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, cwd="/", capture_output=True, text=True, check=False, timeout=60
    )
    assert done.returncode == 1
    return done.stderr.splitlines()[-1]


def imported(folder):
    return failed("from robot_control import ClosedLoop", str(folder))


def test_sources_that_are_not_built_say_what_to_do():
    message = imported(PYTHON)
    assert "the compiled part of robot_control is not in" in message
    assert "source install/setup.bash" in message


def test_for_another_python_the_message_names_the_right_one(tmp_path):
    shutil.copytree(PYTHON / "robot_control", tmp_path / "robot_control", ignore=shutil.ignore_patterns("*.so"))
    (tmp_path / "robot_control" / "_robot_control.cpython-300-x86_64-linux-gnu.so").touch()
    message = imported(tmp_path)
    assert "is not for this Python" in message
    assert "/usr/bin/python3" in message


@pytest.mark.parametrize(
    "code",
    [
        "import robot_control._navigation",
        'from robot_control._robot_control import ClosedLoop; ClosedLoop("", [])',
        'from robot_control._robot_control import OfflineEstimator; OfflineEstimator("", [], True)',
        'from robot_control._robot_control import replay_log; replay_log("", ("", []), None)',
        'from robot_control._robot_control import read_run_bag; read_run_bag("", [])',
        'from robot_control._robot_control import each_part_of_run_bag; each_part_of_run_bag("", print)',
    ],
)
def test_a_numpy_whose_arrays_would_be_misread_is_refused(code, tmp_path):
    (tmp_path / "numpy").mkdir()
    (tmp_path / "numpy" / "__init__.py").write_text('__version__ = "2.4.6"')
    built = Path(_robot_control.__file__).parents[1]
    message = failed(code, f"{tmp_path}:{built}")
    assert f"numpy 2.4.6 of {tmp_path}/numpy/__init__.py" in message
    assert "/usr/bin/python3" in message
