"""The package as type checkers and help() show it."""

import inspect
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from robot_control import ClosedLoop, _robot_control

ROOT = Path(__file__).parents[2]
MYPY = ROOT / "build/linters/bin/mypy"
OUTSIDE = """
from robot_control import ClosedLoop, RobotError

loop = ClosedLoop(seed=1)
reveal_type(loop.run(seconds=1.0, command=(0.5, 0.2)))
reveal_type(loop.robot)
reveal_type(RobotError("x"))
loop.run(seconds="long")
"""


def installed_package():
    return Path(inspect.getfile(_robot_control)).parent


def test_a_type_checker_sees_the_types_from_outside(tmp_path):
    if not MYPY.is_file():
        pytest.skip("mypy is not installed: scripts/setup --linters")
    (tmp_path / "outside.py").write_text(OUTSIDE)
    done = subprocess.run(
        [MYPY, "--strict", "--cache-dir", tmp_path / "cache", "--python-executable", sys.executable, "outside.py"],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": os.pathsep.join((str(installed_package().parent), os.environ["PYTHONPATH"]))},
        capture_output=True,
        text=True,
        check=False,
    )
    found = re.findall(r'outside.py:(\d+): (?:note: Revealed type is "([^"]*)"|error: (.*))', done.stdout)
    assert len(found) == 4, done.stdout + done.stderr
    assert found[0][1].startswith(("dict[", "builtins.dict["))
    assert "float64" in found[0][1].replace("_64Bit", "float64")
    assert found[1][1].replace("builtins.", "") == "dict[str, Any]"
    assert found[2][1].endswith("RobotError")
    assert found[3][0] == "8"
    assert '"str"; expected "float"' in found[3][2]


def test_the_stub_has_the_names_of_the_compiled_module_and_no_other():
    text = (installed_package() / "_robot_control.pyi").read_text()
    stated = set(re.findall(r"^(?:class|def) (\w+)|^([a-z]\w*):", text, re.MULTILINE))
    names = {name for pair in stated for name in pair if name}
    assert names == {name for name in dir(_robot_control) if not name.startswith("__")}
    for name, owner in vars(_robot_control).items():
        if not inspect.isclass(owner) or issubclass(owner, Exception):
            continue
        body = re.search(rf"^class {name}:\n((?:    .*\n)+)", text, re.MULTILINE)[1]
        members = {member for member in vars(owner) if not member.startswith("_")}
        assert set(re.findall(r"^    (?:def )?([a-z]\w*)(?:\(|: )", body, re.MULTILINE)) == members, name


def test_help_of_the_closed_loop_begins_with_a_map_of_all_that_it_can_do():
    page = inspect.getdoc(ClosedLoop)
    members = {name: member for name, member in vars(ClosedLoop).items() if not name.startswith("_")}
    table = page[page.index("drive it") : page.index("The same arguments")]
    assert set(members) == set(re.findall(r"[a-z]\w*(?=,|$)", table, re.MULTILINE))
    for name, member in members.items():
        assert re.match(r"[A-Z].*[.:]", member.__doc__ or member.fget.__doc__, re.DOTALL), name
