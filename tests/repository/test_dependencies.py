"""The project uses no package and no variable beyond those of scripts/shell/dependencies.txt."""

import ast
import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest
import roslib.packages

ROOT = Path(__file__).parents[2]
ONLY_LISTED = ROOT / ".ci/only_listed.py"
OPTIONAL = {"aiohttp", "evdev", "gymnasium", "jsonschema", "mcap", "bokeh", "paho", "xacro"}
"""modules of a section of the list, or of PyPI, without which the programs offer less"""
OF_SECTIONS = {"navigation": {"slam", "localization"}, "unitree": {"unitree_bridge"}}
"""programs that load libraries of a section of the list, without which they are not built"""


@pytest.fixture(scope="module")
def only_listed():
    specification = importlib.util.spec_from_file_location("only_listed", ONLY_LISTED)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def hidden(*command, names=None, tmp_path=None):
    """Runs a command that has access to the listed packages alone; `names`: of another list."""
    given = []
    if names is not None:
        (tmp_path / "list").write_text("\n".join(names))
        given = ["--list", str(tmp_path / "list")]
    done = subprocess.run(
        [sys.executable, str(ONLY_LISTED), *given, *command], capture_output=True, text=True, check=False, timeout=300
    )
    if done.returncode == 125:
        pytest.skip(done.stderr.strip())
    return done


def test_a_section_of_the_list_counts_where_it_is_asked_for(only_listed, tmp_path):
    path = tmp_path / "list"
    path.write_text("# a comment\ncmake\n\n[view]\nrviz  # a picture\n[export]\npypi: mcap==1.*\n")
    assert only_listed.listed(path, []) == ["cmake"]
    assert only_listed.listed(path, ["view", "export"]) == ["cmake", "rviz"]


def test_what_a_package_needs_counts_and_what_needs_it_does_not(only_listed):
    packages = {
        "bash": {"Essential": "yes", "Pre-Depends": "libc (>= 2)"},
        "libc": {},
        "apt": {},
        "robot": {"Depends": "wheel:any (>= 1) | leg, absent | tyre-1.0, python3"},
        "leg": {},
        "wheel": {},
        "rubber": {"Provides": "tyre-1.0 (= 3), gum"},
        "python3": {"Priority": "optional"},
        "desk": {"Depends": "robot"},
    }
    kept = only_listed.closure(["robot"], packages)
    assert kept == {"bash", "libc", "apt", "robot", "wheel", "rubber", "python3"}
    with pytest.raises(LookupError, match="not installed: ship; scripts/setup installs"):
        only_listed.closure(["robot", "ship"], packages)


def test_a_name_that_the_list_forgets_is_found(only_listed, tmp_path):
    """Its module and the packages that only it brings are absent; the rest is there."""
    names = only_listed.listed(only_listed.LIST, [])
    names.remove("python3-visualization-msgs")
    done = hidden(sys.executable, "-c", "import rospy; import visualization_msgs", names=names, tmp_path=tmp_path)
    assert done.returncode == 1
    assert done.stderr.strip().endswith("No module named 'visualization_msgs'")


def test_what_was_installed_by_hand_is_hidden(only_listed, tmp_path):
    """The program belongs to a package outside the list; the command finds it outside, and not inside."""
    packages = only_listed.installed()
    others = packages.keys() - only_listed.closure(only_listed.listed(only_listed.LIST, []), packages)
    programs = [
        path
        for name in sorted(others)
        for path in sorted(only_listed.paths_of(name, packages[name]))
        if path.startswith("/usr/bin/") and Path(path).is_file()
    ][:50]
    if not programs:
        pytest.skip("no program is installed beside the list's; any other one shows it: apt-get install hello")
    assert hidden("/bin/ls", *programs).stdout == ""
    assert hidden("/bin/ls", "/usr/local").returncode != 0


def imported():
    """Modules that the shipped programs import, also inside of functions."""
    for path in [*(ROOT / "scripts").rglob("*.py"), *(ROOT / "python").rglob("*.py")]:
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                yield from (name.name for name in node.names)
            elif isinstance(node, ast.ImportFrom) and node.module:
                yield node.module


def test_the_programs_import_and_load_what_the_list_names():
    modules = sorted({name.split(".")[0] for name in imported()} - {"__future__"})
    assert len(modules) > 40
    asked = "import importlib.util, sys; print(*(n for n in sys.argv[1:] if importlib.util.find_spec(n) is None))"
    done = hidden(sys.executable, "-c", asked, *modules)
    assert done.returncode == 0, done.stderr
    assert set(done.stdout.split()) <= OPTIONAL

    installed = Path(roslib.packages.find_node("robot_control", "telemetry")[0]).parent
    programs = {path for path in installed.iterdir() if path.suffix != ".py"}
    optional = {
        f"--section={section}": {path for path in programs if path.name in names}
        for section, names in OF_SECTIONS.items()
    }
    plain = programs - set().union(*optional.values())
    for given, chosen in (([], plain), *(([section], chosen) for section, chosen in optional.items())):
        if chosen:
            loaded = hidden(*given, "/usr/bin/ldd", *sorted(map(str, chosen))).stdout
            assert loaded.count("libc.so.6") >= len(chosen)
            assert "not found" not in loaded


@pytest.mark.parametrize("script", ["scripts/test", ".ci/run"])
def test_the_environment_of_the_caller_is_left_behind_first_of_all(script):
    statements = [line for line in (ROOT / script).read_text().splitlines() if line and not line.startswith("#")]
    assert statements[0].startswith("source ")
    assert statements[0].endswith('shell/clean_environment.sh"')


def test_a_clean_environment_holds_what_its_list_names(tmp_path):
    script = tmp_path / "script"
    script.write_text(f'source {ROOT}/scripts/shell/clean_environment.sh; printf "%s\\0" "$@"; env -0\n')
    kept = {"HOME": "/home/robot", "CI": "true", "ROBOT_CORPUS": "a b\nc", "https_proxy": "http://proxy"}
    dropped = {"PYTHONUNBUFFERED": "1", "ROS_MASTER_URI": "http://elsewhere", "XCI": "1", "CIX": "1", "LANG": "de_DE"}
    dropped |= {"PATH": f"/opt/bin:{os.environ['PATH']}"}
    command = ["/bin/bash", str(script), "an argument", ""]
    done = subprocess.run(command, env=kept | dropped, capture_output=True, text=True, check=True)
    first, second, *variables = done.stdout.removesuffix("\0").split("\0")
    assert (first, second) == ("an argument", "")
    of_the_shell = {"SHLVL", "PWD", "OLDPWD", "_"}
    environment = dict(variable.split("=", 1) for variable in variables)
    assert {name: value for name, value in environment.items() if name not in of_the_shell} == kept | {
        "PATH": "/usr/bin:/bin:/usr/sbin:/sbin",
        "LANG": "C.UTF-8",
        "PYTHONNOUSERSITE": "1",
    }
