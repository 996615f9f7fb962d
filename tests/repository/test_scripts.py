"""Tests the shell scripts without building."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

SCRIPTS = Path(__file__).parents[2] / "scripts"


def shell(*command):
    return subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False, timeout=60)


@pytest.mark.parametrize("script", ["demo", "test", "setup", "lint", "bench", "behaviour", "privileges"])
def test_help_says_how_to_call_it_and_does_nothing(script):
    done = shell(str(SCRIPTS / script), "--help")
    assert done.returncode == 0
    assert f"scripts/{script} [" in done.stdout
    assert "building" not in done.stdout


@pytest.mark.parametrize("script", ["demo", "test", "lint", "bench", "behaviour", "privileges"])
def test_help_needs_nothing_that_is_not_installed_yet(script, tmp_path):
    """It is called from another folder, by a relative path, with other arguments before it: scripts/setup is not
    called.
    """
    copied = tmp_path / "scripts"
    shutil.copytree(SCRIPTS, copied, ignore=shutil.ignore_patterns("robot_control"))
    (copied / "setup").write_text("#!/bin/bash\necho installing >&2\nexit 9\n")
    (tmp_path / "elsewhere").mkdir()
    done = subprocess.run(
        [f"../scripts/{script}", "--seconds", "3", "-h"],
        cwd=tmp_path / "elsewhere",
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert f"scripts/{script} [" in done.stdout


@pytest.mark.parametrize("name", ["a b", "a;b", "a$b", "(a)", "a\tb", "a'b", "[a]", "a:b", "a#b"])
def test_a_checkout_whose_path_cannot_be_built_is_refused_at_once(name, tmp_path):
    checkout = tmp_path / name / "robot_control"
    for folder in ("scripts", "cmake"):
        shutil.copytree(SCRIPTS.parent / folder, checkout / folder, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(SCRIPTS.parent / "CMakeLists.txt", checkout)
    for script in ("demo", "test", "setup"):
        done = shell(str(checkout / "scripts" / script))
        assert done.returncode == 1
        assert "the path of the checkout" in done.stderr
        assert "move it to a path without" in done.stderr
    done = shell("cmake", "-S", str(checkout), "-B", str(tmp_path / "build"))
    assert done.returncode == 1
    assert "the path of the checkout" in " ".join(done.stderr.split())


@pytest.mark.parametrize("own_build", ["install", "build"])
def test_a_catkin_workspace_refuses_a_checkout_with_a_build_of_its_own(own_build, tmp_path):
    """roslaunch searches the whole checkout and would find every launch file and node twice."""
    checkout = tmp_path / "src" / "robot_control"
    (checkout / own_build / "robot_control").mkdir(parents=True)
    shutil.copytree(SCRIPTS.parent / "cmake", checkout / "cmake")
    shutil.copy(SCRIPTS.parent / "CMakeLists.txt", checkout)
    (tmp_path / "src" / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.18)\nproject(workspace NONE)\nadd_subdirectory(robot_control)\n"
    )
    done = shell("cmake", "-S", str(tmp_path / "src"), "-B", str(tmp_path / "build"))
    assert done.returncode == 1
    assert f"rm -r {checkout}/build" in " ".join(done.stderr.split())


@pytest.mark.parametrize("script", ["test", "setup", "lint", "behaviour"])
def test_an_unknown_argument_is_refused_with_the_usage(script):
    done = shell(str(SCRIPTS / script), "--warp")
    assert done.returncode == 1
    assert "unknown argument '--warp'; usage:" in done.stderr


MAKEFILE = """
all: src/all
all: CMakeFiles/messages.dir/all
src/all: src/CMakeFiles/library.dir/all
src/CMakeFiles/library.dir/all: CMakeFiles/messages.dir/all
src/CMakeFiles/program.dir/all: src/CMakeFiles/library.dir/all
src/CMakeFiles/library.dir/all:
\t$(MAKE) -f src/CMakeFiles/library.dir/build.make
tests/all: tests/CMakeFiles/docs.dir/all
src/all: src/CMakeFiles/program.dir/all
"""  # docs belongs to a folder that `all` does not build


OBJECTS = {"src/CMakeFiles/library.dir/Unity/unity_0.cxx.o": 72_000, "src/CMakeFiles/program.dir/main.cpp.o": 2_000}
"""bytes of their sources; with 8 kB each the work is 80 and 10"""


def make_build_folder(folder):
    """Configured, nothing compiled; the library is a unity build of two sources."""
    entries = []
    for name, size in [*OBJECTS.items(), ("tests/CMakeFiles/docs.dir/docs.cpp.o", 10_000)]:
        source = folder / name.removesuffix(".o")
        source.parent.mkdir(parents=True)
        source.write_text("x" * (size - 1) + "\n")
        if "Unity" in name:
            halves = [source.with_name("a.cpp"), source.with_name("b.cpp")]
            source.write_text("".join(f'#include "{half}"\n' for half in halves))
            for half in halves:
                half.write_text("x" * (size // 2 - 1) + "\n")
        place, _, inside = name.partition("/CMakeFiles/")
        command = f'c++ -DNAME=\\"r\\" -o CMakeFiles/{inside} -c {source}'
        entries.append(f'{{\n  "directory": "{folder / place}",\n  "command": "{command}",\n  "file": "{source}"\n}}')
    (folder / "compile_commands.json").write_text("[\n" + ",\n".join(entries) + "\n]")
    (folder / "CMakeFiles").mkdir(exist_ok=True)
    (folder / "CMakeFiles" / "Makefile2").write_text(MAKEFILE)


def progress(folder, *lines, target="all"):
    """The progress of a build with such a log."""
    (folder / "log").write_text("".join(f"{line}\n" for line in lines))
    script = 'source "$0"; build_progress "$@"'
    command = ["bash", "-euc", script, str(SCRIPTS / "shell" / "build_progress.sh"), str(folder / "log"), str(folder)]
    return shell(*command, target).stdout


def test_a_build_says_how_much_of_its_work_and_how_many_of_its_targets_are_done(tmp_path):
    assert progress(tmp_path, "-- The CXX compiler identification is GNU") == "configuring\n"
    make_build_folder(tmp_path)
    library, program = OBJECTS
    log = ["[ 33%] Built target messages", f"[ 50%] Building CXX object {library}"]
    assert progress(tmp_path, *log) == "0 % of the work, 1 of 3 targets\n"
    (tmp_path / library).touch()  # compiled, not linked
    assert progress(tmp_path, *log) == "88 % of the work, 1 of 3 targets\n"
    assert progress(tmp_path, *log, target="library") == "100 % of the work, 1 of 2 targets\n"
    log += ["[ 66%] Built target library", f"[ 80%] Building CXX object {program}"]
    assert progress(tmp_path, *log) == "88 % of the work, 2 of 3 targets\n"
    log += ["[100%] Built target program"]
    assert progress(tmp_path, *log) == "100 % of the work, 3 of 3 targets\n"


def test_a_long_build_is_not_silent_and_its_exit_code_is_that_of_the_command(tmp_path):
    make_build_folder(tmp_path)
    printed = f"[ 12%] Built target messages\n[ 20%] Building CXX object {next(iter(OBJECTS))}"
    command = f'source "$0"; with_progress {tmp_path}/log {tmp_path} bash -c "echo \'{printed}\'; sleep 4; exit 7"'
    done = shell("env", "BUILD_PROGRESS_PAUSE=1", "bash", "-euc", command, str(SCRIPTS / "shell" / "build_progress.sh"))
    assert done.returncode == 7
    assert "0 % of the work, 1 of 3 targets" in done.stdout


def test_every_build_shows_its_progress():
    for name in ("shell/environment.sh", "test"):
        builds = re.findall(r"^.*(?:colcon build|cmake --build).*$", (SCRIPTS / name).read_text(), re.MULTILINE)
        assert builds
        assert all("with_progress" in line for line in builds)


def listed_packages(sections):
    """The packages that scripts/setup would install, with the names of the sections that its arguments select."""
    command = """cd "$0"/..; sections=$1; eval "$(sed -n '/^listed()/,/^}/p' scripts/setup)"; listed"""
    done = shell("bash", "-euc", command, str(SCRIPTS), sections)
    assert done.returncode == 0, done.stderr
    return set(done.stdout.split())


def test_packages_of_a_section_are_installed_only_where_they_are_asked_for():
    plain = listed_packages("")
    assert {"cmake", "python3-pytest"} <= plain
    assert listed_packages(" [linters]") - plain == {"clang-format", "clang-tidy"}
    assert "rviz" in listed_packages(" [view]") - plain
    assert listed_packages(" [operator]") - plain == {"python3-evdev"}
    assert listed_packages(" [browser]") - plain == {"chromium", "chromium-driver", "python3-selenium"}
    assert "python3-aiohttp" in listed_packages(" [console]") - plain
    assert listed_packages(" [report]") == listed_packages(" [export]") == plain  # from PyPI
    assert listed_packages(" [cluster]") - plain == {"python3-distributed"}
    assert listed_packages(" [linters] [cluster]") - plain == {"clang-format", "clang-tidy", "python3-distributed"}


@pytest.mark.parametrize(("arguments", "testing"), [([], "ON"), (["without_tests"], "OFF")])
def test_a_build_without_tests_switches_them_off_in_catkin(arguments, testing, tmp_path):
    """The options are always given, because CMake remembers those of an earlier build."""
    script = 'source "$0"; cd "$1"; colcon() { echo "$@"; }; build_workspace "${@:2}"; cat build/colcon.log'
    done = shell("bash", "-euc", script, str(SCRIPTS / "shell" / "environment.sh"), str(tmp_path), *arguments)
    assert f"-DCATKIN_ENABLE_TESTING={testing}" in done.stdout.split()
    assert "build_workspace without_tests\n" in (SCRIPTS / "demo").read_text()


def test_continuous_integration_refuses_an_unknown_argument():
    done = shell(str(SCRIPTS.parent / ".ci" / "run"), "--warp")
    assert (done.returncode, done.stdout) == (2, "")


def test_continuous_integration_builds_and_tests_the_navigation_programs():
    of_a_change, of_a_night = re.findall(r"sections=\(([^)]+)\)", (SCRIPTS.parent / ".ci/run").read_text())
    assert {"console", "browser", "navigation"} <= set(of_a_change.split()) < set(of_a_night.split())
