"""The package in the workspace of a user, beside other packages."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TOPLEVEL = Path("/usr/share/catkin/cmake/toplevel.cmake")


@pytest.mark.nightly
def test_it_is_configured_without_a_warning(tmp_path):
    if not TOPLEVEL.is_file():
        pytest.skip("catkin is not installed")
    ignored = ["build", "install", "log", ".git", "shared"]  # at the top: src/log is code
    shutil.copytree(
        ROOT, tmp_path / "src" / "robot_control", ignore=lambda folder, _: ignored if Path(folder) == ROOT else []
    )
    shutil.copy(TOPLEVEL, tmp_path / "src" / "CMakeLists.txt")
    done = subprocess.run(
        ["/usr/bin/cmake", "-S", "src", "-B", "build", f"-DCATKIN_DEVEL_PREFIX={tmp_path / 'devel'}"],
        cwd=tmp_path,
        env=os.environ | {"PATH": f"/usr/bin:{os.environ['PATH']}"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "Warning" not in done.stderr
