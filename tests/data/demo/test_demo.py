import itertools
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from robot_control import ClosedLoop
from robot_control.data.demo import launched, lockstep
from robot_control.data.demo import main as demo
from robot_control.data.demo.arguments import parse
from robot_control.installed_files import share_file
from robot_control.ui.child import Child

WAIT = "import time\nprint('ready')\nfor _ in range(6000): time.sleep(0.01)"
"""The sleeps are short, because a signal just before one is handled at its end."""


def test_each_kind_of_refusal_is_said_once_with_its_remedy():
    line = (
        "\x1b[33m[ WARN] [123.4]: memory is not locked (limit 8192 KiB; remedy: X), "
        "SCHED_FIFO priority 81 is not granted (limit 0; remedy: Y): see docs/realtime.md\x1b[0m"
    )
    assert demo.refusals("\n".join([line, line.replace("81", "80"), "noise"])) == [
        "memory is not locked (limit 8192 KiB; remedy: X)",
        "SCHED_FIFO priority 81 is not granted (limit 0; remedy: Y)",
    ]


def test_nothing_is_said_when_all_was_granted():
    assert demo.refusals("state_estimator: priority 81 on core 0\n") == []


def child(tmp_path, code):
    started = Child([sys.executable, "-u", "-c", code], tmp_path / "output")
    wait_for_text(tmp_path / "output", "ready")
    return started


def wait_for_text(path, text):
    deadline = time.monotonic() + 20
    while not path.exists() or text not in path.read_text():
        assert time.monotonic() < deadline, f"no {text!r} in {path}"
        time.sleep(0.01)


def test_a_child_that_heeds_sigint_ends_in_order(tmp_path):
    one = child(tmp_path, f"try: exec({WAIT!r})\nexcept KeyboardInterrupt: print('bye')")
    assert one.end()
    assert not one.running
    assert "bye" in (tmp_path / "output").read_text()


def test_a_child_heeds_sigint_although_this_program_was_started_deaf_to_it(tmp_path):
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        assert child(tmp_path, WAIT).end()
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_child_that_ignores_sigint_is_killed(tmp_path):
    one = child(tmp_path, "import signal, time\nsignal.signal(2, signal.SIG_IGN)\nprint('ready')\ntime.sleep(60)")
    assert not one.end(limit=0.2)
    assert not one.running


def test_a_child_ends_in_order_with_a_program_that_is_killed(tmp_path):
    """The output shows the end, because the process may stay as a zombie."""
    heeds = f"try: exec({WAIT!r})\nexcept KeyboardInterrupt: print('bye')"
    starts = f"""
import pathlib, sys, time
from robot_control.installed_files import share_file
from robot_control.ui.child import Child
Child([sys.executable, "-u", "-c", {heeds!r}], pathlib.Path({str(tmp_path / "output")!r}))
time.sleep(60)"""
    parent = subprocess.Popen([sys.executable, "-c", starts])
    try:
        wait_for_text(tmp_path / "output", "ready")
    finally:
        parent.kill()
        parent.wait()
    wait_for_text(tmp_path / "output", "bye")


def test_what_was_started_is_ended_after_an_error(tmp_path):
    with pytest.raises(RuntimeError, match="broken"), launched.ended_at_the_end() as children:
        children.append(child(tmp_path, WAIT))
        raise RuntimeError("broken")
    assert not children[0].running


def test_the_last_complete_row_of_a_growing_file_is_found(tmp_path):
    log = tmp_path / "run.bag"
    assert launched.last_row(log) is None
    loop = ClosedLoop()
    loop.log_into(tmp_path)
    assert launched.last_row(log) is None
    loop.run(2.5, (0.5, 0.2))
    assert 1990 <= launched.last_row(log)["cycle"] <= 2010, "whole seconds are in the file"
    assert launched.last_row(log)["requested_linear"] == launched.LINEAR
    loop.end_log()
    assert launched.last_row(log)["cycle"] == 2499


@pytest.mark.parametrize("seconds", ["0", "-3", "1.9", "nan", "inf", "ten"])
def test_a_run_too_short_to_judge_is_refused(seconds, capsys):
    with pytest.raises(SystemExit):
        parse([f"--seconds={seconds}"])
    assert "--seconds" in capsys.readouterr().err


def test_drives_that_do_not_fit_the_robot_are_refused(tmp_path, capsys):
    assert parse(["--robot", "quadbot", "--out", str(tmp_path)]).robot == "quadbot"
    with pytest.raises(SystemExit):
        parse(["--robot", "quadbot", "--drives", "odrive", "--out", str(tmp_path)])
    assert "--drives odrive do not move quadbot: take one of damiao, cybergear, ak, moteus" in capsys.readouterr().err
    assert parse(["--robot", "quadbot", "--drives", "damiao", "--out", str(tmp_path)]).drive.driver == "can"
    with pytest.raises(SystemExit):
        parse(["--drives", "damiao", "--out", str(tmp_path)])
    assert "--drives damiao do not move diffbot: take one of odrive, cia402, vesc" in capsys.readouterr().err


def test_a_robot_and_its_drives_may_be_files(tmp_path, capsys):
    go2, urdf, text = share_file("config/robots/go2.yaml"), tmp_path / "go2.urdf", tmp_path / "text.yaml"
    urdf.touch()
    given = parse(["--robot", str(urdf), "--drives", go2, "--rate", "500", "--out", str(tmp_path)])
    assert (given.robot, str(given.drives), given.drive.driver, given.rate) == (str(urdf), go2, "unitree_go", 500)
    assert demo.overlay(given.drives, given.rate, velocity=False).endswith("robot: {rate: 500}\n")
    text.write_text("- [")
    (tmp_path / "circle").symlink_to(tmp_path / "circle")
    (tmp_path / "$(env HOME)").touch()
    no_files = ["motors", str(tmp_path), str(tmp_path / "circle"), str(tmp_path / "$(env HOME)"), "a" * 300]
    wrong = {"--drives": [str(urdf), str(text), *no_files], "--robot": no_files, "--rate": ["10", "2001", "1e3"]}
    for name, value in [(name, value) for name, values in wrong.items() for value in values]:
        with pytest.raises(SystemExit):
            parse([name, value, "--out", str(tmp_path)])
        assert value in capsys.readouterr().err


@pytest.mark.parametrize("out", ["file", "file/below", "/proc/xx"])
def test_a_folder_that_cannot_be_written_to_is_refused_before_anything_starts(out, tmp_path, capsys):
    (tmp_path / "file").touch()
    with pytest.raises(SystemExit) as ended:
        parse(["--out", str(tmp_path / out)])
    assert ended.value.code == 2
    assert "cannot be written to" in capsys.readouterr().err


@pytest.mark.parametrize(("drives", "velocity"), [("odrive", False), (None, True)])
def test_what_does_not_fit_a_robot_on_legs_of_a_file_is_refused(drives, velocity, tmp_path):
    file = None if drives is None else Path(share_file(f"config/drives/{drives}.yaml"))
    with pytest.raises(demo.DemoError, match=f"quadbot.urdf .*{drives or '--wheel-command'}"):
        demo.run_demo(2.0, tmp_path, share_file("urdf/quadbot.urdf"), file, velocity=velocity)


def test_the_command_line_is_judged_before_anything_is_built(tmp_path):
    code = "import sys; sys.modules['robot_control._robot_control'] = None"
    code += f"; from robot_control.data.demo.arguments import parse; parse(['--out', {str(tmp_path)!r}])"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_the_folder_is_made_and_left_empty(tmp_path):
    assert parse(["--out", str(tmp_path / "new" / "out")]).out == tmp_path / "new" / "out"
    assert list((tmp_path / "new" / "out").iterdir()) == []


def test_a_disk_that_fails_during_the_run_is_reported_without_a_traceback(tmp_path, monkeypatch, capsys):
    def fail(seconds, out, *_, **__):
        raise OSError(28, "No space left on device", str(out / "run.png"))

    monkeypatch.setattr(demo, "run_demo", fail)
    monkeypatch.setattr(sys, "argv", ["demo", "--out", str(tmp_path)])
    before = signal.getsignal(signal.SIGTERM)
    try:
        assert demo.main() == 2
    finally:
        signal.signal(signal.SIGTERM, before)
    assert "no space left on the disk" in capsys.readouterr().err


def test_sigterm_ends_like_an_interrupt():
    with pytest.raises(KeyboardInterrupt):
        demo._interrupt(signal.SIGTERM, None)


@pytest.mark.parametrize(("legged", "period"), [(False, 1e-3), (True, 1e-3), (True, 2e-3)])
def test_the_script_repeats_its_command_before_it_is_too_old(legged, period):
    text, asked, cycles = lockstep.script(3.2, period, legged=legged)
    rows = [[float(cell) for cell in line.split(",")] for line in text.splitlines()[1:]]
    times = [cycle * period for cycle, _, _ in rows]
    assert times[0] == launched.REST_TIME
    assert max(later - one for one, later in itertools.pairwise(times)) <= 0.5
    assert rows[-1][1:] == [0, 0]
    assert times[-1] == pytest.approx(launched.REST_TIME + asked)
    assert asked >= 3.2
    assert cycles > rows[-1][0]
