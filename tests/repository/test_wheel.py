"""`pip install .` in a clean environment, as docs/install.md says: without ROS, catkin and any package beside its list.

It fetches nothing: scripts/setup --wheel has fetched what pip takes.
"""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FILES = ROOT / "build/pypi"
PIP = ("-m", "pip", "--disable-pip-version-check", "--quiet")
FETCHED = ("--no-index", "--find-links", str(FILES))
DEBIAN = {"PATH": "/usr/bin:/bin", "LANG": "C.UTF-8"}

JOB = """
import hashlib, importlib.util, json, sys
from pathlib import Path
import numpy
from robot_control import ClosedLoop, Estimator, legs
from robot_control.data.run_log import read_run
from robot_control.installed_files import share_file

out = {"numpy": numpy.__version__, "ROS": importlib.util.find_spec("rospy") is not None}
for robot in ("diffbot", "quadbot"):
    urdf, folder = share_file(f"urdf/{robot}.urdf"), Path(sys.argv[1]) / robot
    loop = ClosedLoop(seed=3, urdf=urdf)
    folder.mkdir()
    loop.log_into(str(folder))
    if robot == "quadbot":
        loop.set_posture("standing")
        loop.run(3.0)
    log = loop.run(5.0, (0.2, 0.1))
    loop.end_log()
    run = read_run(str(folder / "run.bag"))
    rows = {name: values.tobytes() for name, values in run.columns.items()}
    settled = slice(-2000, None)
    out[robot] = {
        "sum": hashlib.sha256(repr(sorted(rows.items())).encode()).hexdigest(),
        "rows": len(run.ros_time),
        "build": run.header["build"],
        "speed": log["truth_linear"][settled].mean(),
        "turn": log["truth_angular"][settled].mean(),
    }
feet = legs.forward(share_file("urdf/quadbot.urdf"), numpy.zeros(12))
time = numpy.arange(0, 4, 0.01)
angle = numpy.where(time < 1, 0, 4 * (time - 1))
path = Estimator(wheel_radius=0.1, wheel_base=0.5).process(time, angle, angle)
out |= {"feet": feet.tolist(), "estimate": path["x"].tolist()}
print(json.dumps(out))
"""


def run(*command, tmp_path, listed=None, environment=DEBIAN):
    """The output; `listed`: the only packages that the command sees."""
    hidden = ()
    if listed is not None:
        (tmp_path / "list").write_text("\n".join(listed))
        hidden = (sys.executable, str(ROOT / ".ci/only_listed.py"), "--list", str(tmp_path / "list"))
    done = subprocess.run([*hidden, *command], env=environment, capture_output=True, text=True, check=False)
    if hidden and done.returncode == 125:
        pytest.skip(done.stderr.strip())
    assert done.returncode == 0, f"{done.stdout[-4000:]}\n{done.stderr[-4000:]}"
    return done.stdout


def figures(python, folder, environment=DEBIAN):
    """The figures that the job prints with this Python; its logs lie below `folder`."""
    folder.mkdir()
    return json.loads(run(python, "-c", JOB, folder, tmp_path=folder, environment=environment))


@pytest.fixture(scope="module")
def packages():
    """Those that the page names."""
    page = (ROOT / "docs/install.md").read_text()
    return re.search(r"apt-get install ((?:.*\\\n)*.*)", page)[1].replace("\\", " ").split()


@pytest.fixture(scope="module")
def install(packages, tmp_path_factory):
    """Returns the Python of a new environment: with a numpy, and the package of a MuJoCo, which is built once."""
    if not list(FILES.glob("scikit_build_core*")):
        pytest.skip("scripts/setup --wheel fetches what pip builds with")
    built = {}

    def build(mujoco):
        folder = tmp_path_factory.mktemp("wheel")
        listed = [name for name in packages if not (mujoco and name == "libmujoco-dev")]
        run("/usr/bin/python3", "-m", "venv", folder / "env", tmp_path=folder, listed=packages)
        pip = (folder / "env/bin/python3", *PIP, "wheel", *FETCHED, "--no-deps", "--wheel-dir", folder, ROOT)
        kept = {name: value for name, value in os.environ.items() if re.match("CMAKE_CXX_COMPILER_L|CCACHE_", name)}
        chosen = {"ROBOT_CONTROL_MUJOCO": mujoco} if mujoco else {}
        run(*pip, tmp_path=folder, listed=[*listed, *(["ccache"] if kept else [])], environment=DEBIAN | kept | chosen)
        (wheel,) = folder.glob("robot_control-*.whl")
        return wheel

    def install_it(numpy, mujoco=""):
        if mujoco not in built:
            built[mujoco] = build(mujoco)
        folder = tmp_path_factory.mktemp("environment")
        run("/usr/bin/python3", "-m", "venv", folder, tmp_path=folder)
        run(folder / "bin/python3", *PIP, "install", *FETCHED, numpy, built[mujoco], tmp_path=folder)
        return folder / "bin/python3"

    return install_it


@pytest.fixture(scope="module")
def of_the_workspace(tmp_path_factory):
    """The figures of the colcon build."""
    return figures(sys.executable, tmp_path_factory.mktemp("colcon") / "out", dict(os.environ))


@pytest.mark.parametrize("numpy", ["1.26", "2"])
def test_pip_builds_what_imports_drives_and_walks_with_the_bytes_of_the_workspace(
    numpy, install, of_the_workspace, tmp_path
):
    found = figures(install(f"numpy=={numpy}.*"), tmp_path / "out")
    assert found.pop("numpy").startswith(numpy)
    assert found.pop("ROS") is False
    assert found == {name: value for name, value in of_the_workspace.items() if name in found}
    assert found["diffbot"]["rows"] == 5000


def test_with_the_mujoco_of_pypi_it_keeps_bounds_of_its_own(install, packages, tmp_path):
    """Another solver gives other bits: what holds is the command, as docs/install.md states it."""
    assert "libmujoco-dev" in packages
    found = figures(install("numpy==2.*", mujoco="pypi"), tmp_path / "out")
    for robot, share in (("diffbot", 0.001), ("quadbot", 0.01)):
        assert found[robot]["speed"] == pytest.approx(0.2, rel=share)
        assert found[robot]["turn"] == pytest.approx(0.1, rel=share)
