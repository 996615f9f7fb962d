"""scripts/privileges in a throw-away root: what it writes, that none stays, and that its service starts the robot."""

import contextlib
import os
import re
import shlex
import shutil
import signal
import socket
import subprocess
import time
import xmlrpc.client
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
SETUP = ROOT / "install/setup.bash"
UNIT = "etc/systemd/system/robot_control.service"
LIMITS = "etc/security/limits.d/robot_control.conf"
RULES = "etc/udev/rules.d/70-robot_control.rules"
LOOP = {"/driver", "/state_estimator", "/diff_drive_controller", "/safety_monitor"}


def privileges(action, root, *arguments):
    command = [ROOT / "scripts/privileges", action, "--root", root, *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def snapshot(root):
    """Every path with its mode and bytes."""
    return {
        str(path.relative_to(root)): (path.stat().st_mode, path.read_bytes() if path.is_file() else None)
        for path in sorted(root.rglob("*"))
    }


@pytest.fixture
def root(tmp_path):
    """A system with files of its own, without a folder for rules of udev."""
    for name, text in {
        "etc/security/limits.d/audio.conf": "@audio - rtprio 95\n",
        "etc/systemd/system/other.service": "[Service]\nExecStart=/bin/true\n",
    }.items():
        path = tmp_path / "root" / name
        path.parent.mkdir(parents=True)
        path.write_text(text)
    (tmp_path / "setup.bash").write_text("")
    return tmp_path / "root"


DRIVES = ("--", "driver:=can", "drives:=/home/robot/drives.yaml")


def install(root, *arguments):
    given = ("--user", "robot", "--setup", root.parent / "setup.bash", *(arguments or DRIVES))
    done = privileges("install", root, *given)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_install_show_and_uninstall_leave_the_system_byte_for_byte(root):
    before = snapshot(root)
    install(root)
    installed = snapshot(root)
    assert {LIMITS, RULES, UNIT} <= set(installed)
    assert {name: installed[name] for name in before} == before
    privileges("show", root)
    assert snapshot(root) == installed
    assert privileges("uninstall", root).returncode == 0
    assert snapshot(root) == before


def test_a_second_installation_replaces_the_first_and_is_removed_as_well(root):
    before = snapshot(root)
    install(root)
    assert privileges("install", root, "--user", "other", "--setup", root.parent / "setup.bash").returncode == 0
    assert "other - rtprio 99" in (root / LIMITS).read_text()
    privileges("uninstall", root)
    assert snapshot(root) == before


def test_every_line_is_said_before_it_is_written(root):
    given = ("--user", "robot", "--setup", root.parent / "setup.bash", *DRIVES)
    shown = privileges("show", root, *given).stdout
    assert not (root / UNIT).exists()
    said = install(root)
    assert said.startswith(shown)
    for name in (LIMITS, RULES, UNIT):
        assert "".join(f"    {line}\n" for line in (root / name).read_text().splitlines()) in shown
    later = privileges("show", root, *given).stdout
    assert later.count(" is installed\n") == 3


def test_it_grants_what_the_nodes_ask_for(root):
    install(root)
    assert "robot - rtprio 99\nrobot - memlock unlimited\n" in (root / LIMITS).read_text()
    assert 'KERNEL=="cpu_dma_latency", OWNER="robot", MODE="0600"' in (root / RULES).read_text()
    unit = (root / UNIT).read_text()
    for line in ("User=robot", "LimitRTPRIO=99", "LimitMEMLOCK=infinity", "MemoryMax=1G", "Restart=on-failure"):
        assert f"\n{line}\n" in unit
    assert re.search(r"^CPUAffinity=\d+( \d+)*$", unit, re.MULTILINE)


def test_without_arguments_of_the_launch_no_service_is_made(root):
    before = snapshot(root)
    done = privileges("install", root, "--user", "robot")
    assert (done.returncode, "systemctl" in done.stdout) == (0, False)
    assert (root / LIMITS).exists()
    assert not (root / UNIT).exists()
    (root / "etc/systemd/system/other.service").unlink()
    (root / "etc/systemd/system").rmdir()
    install(root)
    assert (root / UNIT).exists()
    privileges("uninstall", root)
    assert not (root / "etc/systemd/system").exists(), "the second installation made it"
    assert {name for name in before if "systemd/system" not in name} == set(snapshot(root))


def test_files_of_others_are_neither_overwritten_nor_removed(root):
    (root / LIMITS).write_text("mine\n")
    before = snapshot(root)
    done = privileges("install", root, "--user", "robot", "--setup", root.parent / "setup.bash")
    assert done.returncode == 1
    assert "was not written by scripts/privileges" in done.stderr
    assert privileges("uninstall", root).returncode == 0
    assert snapshot(root) == before


def test_a_folder_that_others_use_by_now_stays(root):
    install(root)
    (root / "etc/udev/rules.d/mine.rules").write_text("")
    done = privileges("uninstall", root)
    assert "it holds other files by now" in done.stdout
    assert not (root / RULES).exists()
    assert (root / "etc/udev/rules.d/mine.rules").exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--user", "ro bot"], "is no name of a user"),
        (["--user"], "--user needs a value"),
        (["--", "drives:=/a b"], "NAME:=VALUE without blanks"),
        (["--", "driver:=can", "drives:=a.yaml"], "a service needs an absolute path"),
        (["--", "driver:=can"], "needs drives:=FILE"),
        (["--", "foo:=1"], "robot.launch has no such argument"),
        (
            ["--setup", "/nonexistent/setup.bash", "--", "driver:=can", "drives:=/d.yaml"],
            "is absent, which the service needs",
        ),
        (["--fast"], "unknown argument"),
    ],
)
def test_a_wrong_argument_is_one_message_and_writes_nothing(root, arguments, said):
    before = snapshot(root)
    done = privileges("install", root, *arguments)
    assert done.returncode == 1
    assert said in done.stderr
    assert snapshot(root) == before


def test_the_unit_passes_systemds_own_check(root):
    if shutil.which("systemd-analyze") is None:
        pytest.skip("systemd-analyze is not installed: scripts/setup --realtime")
    install(root, "--user", "root", "--", "driver:=can", "drives:=/d.yaml")
    done = subprocess.run(
        ["systemd-analyze", "verify", "--man=no", root / UNIT], capture_output=True, text=True, check=False
    )
    # It also reads the units of this machine, some of which may be at fault.
    own = [line for line in done.stderr.splitlines() if "robot_control" in line]
    assert (done.returncode, own) == (0, []), done.stderr


def exec_start(unit):
    """The arguments of ExecStart, as systemd.service(5) reads them."""
    line = re.search(r"^ExecStart=(.*)$", unit, re.MULTILINE)[1]
    return [word.replace("$$", "$").replace("%%", "%") for word in shlex.split(line)]


def registered(uri):
    with contextlib.suppress(OSError, xmlrpc.client.Error):
        state = xmlrpc.client.ServerProxy(uri).getSystemState("/test")[2]
        return {node for part in state for _, nodes in part for node in nodes}
    return set()


def test_the_service_starts_the_robot(root, tmp_path):
    drives = yaml.safe_load((ROOT / "config/drives/odrive.yaml").read_text())
    drives["bus"]["address"] = f"unix:{tmp_path}"
    (tmp_path / "drives.yaml").write_text(yaml.safe_dump(drives))
    arguments = ("driver:=can", f"drives:={tmp_path}/drives.yaml", f"out:={tmp_path}/out")
    install(root, "--setup", SETUP, "--", *arguments)
    with socket.create_server(("127.0.0.1", 0)) as probe:
        uri = f"http://127.0.0.1:{probe.getsockname()[1]}"
    values = {"HOME": str(tmp_path), "PATH": "/usr/bin:/bin", "ROS_MASTER_URI": uri}
    log = tmp_path / "service.log"
    with log.open("w") as output:
        service = subprocess.Popen(
            exec_start((root / UNIT).read_text()), env=values, stdout=output, stderr=output, cwd="/"
        )
    try:
        end = time.monotonic() + 240.0  # 6 s on an idle machine
        while not registered(uri) >= LOOP and service.poll() is None and time.monotonic() < end:
            time.sleep(0.2)
        assert registered(uri) >= LOOP, log.read_text()[-3000:]
    finally:
        service.send_signal(signal.SIGINT)
        try:
            service.wait(timeout=120)
        except subprocess.TimeoutExpired:
            os.kill(service.pid, signal.SIGKILL)
            raise
