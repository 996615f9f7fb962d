import signal
import sys
import time

import pytest
from robot_control import demo


def test_each_kind_of_refusal_is_said_once_with_its_remedy():
    line = (
        "[ WARN] [123.4] state_estimator: SCHED_FIFO priority 81 is not granted: 'Operation not permitted'; remedy: X"
    )
    log = "\n".join([line, line.replace("81", "80"), "memory is not locked: the limit is 8192 KiB; remedy: Y", "noise"])
    said = demo.refusals(log)
    assert len(said) == 2
    assert said[0].startswith("SCHED_FIFO priority 81")
    assert said[1].endswith("remedy: Y")


def test_nothing_is_said_when_all_was_granted():
    assert demo.refusals("state_estimator: priority 81 on core 0\n") == []


def child(tmp_path, code):
    started = demo.Child([sys.executable, "-u", "-c", code], tmp_path / "output")
    deadline = time.monotonic() + 20
    while "ready" not in (tmp_path / "output").read_text() and time.monotonic() < deadline:
        time.sleep(0.01)
    return started


def test_a_child_that_heeds_sigint_ends_in_order(tmp_path):
    one = child(tmp_path, "import time\nprint('ready')\ntry: time.sleep(60)\nexcept KeyboardInterrupt: print('bye')")
    assert one.end()
    assert not one.running
    assert "bye" in (tmp_path / "output").read_text()


def test_a_child_heeds_sigint_although_this_program_was_started_deaf_to_it(tmp_path):
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        assert child(tmp_path, "import time\nprint('ready')\ntime.sleep(60)").end()
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_child_that_ignores_sigint_is_killed(tmp_path):
    one = child(tmp_path, "import signal, time\nsignal.signal(2, signal.SIG_IGN)\nprint('ready')\ntime.sleep(60)")
    assert not one.end(limit=0.2)
    assert not one.running


def test_what_was_started_is_ended_after_an_error(tmp_path):
    with pytest.raises(RuntimeError, match="broken"), demo._ended_at_the_end() as children:
        children.append(child(tmp_path, "import time\nprint('ready')\ntime.sleep(60)"))
        raise RuntimeError("broken")
    assert not children[0].running


def test_the_last_complete_row_of_a_growing_file_is_found(tmp_path):
    log = tmp_path / "run.csv"
    assert demo._last_row(log) is None
    log.write_text("run,cycle\n")
    assert demo._last_row(log) is None
    log.write_text("run,cycle\n0,1\n0,2\n0,")
    assert demo._last_row(log) == {"run": "0", "cycle": "2"}


@pytest.mark.parametrize("seconds", ["0", "-3", "1.9", "nan", "inf", "ten"])
def test_a_run_too_short_to_judge_is_refused(seconds, capsys):
    with pytest.raises(SystemExit):
        demo.parse([f"--seconds={seconds}"])
    assert "--seconds" in capsys.readouterr().err


def test_sigterm_ends_like_an_interrupt():
    with pytest.raises(KeyboardInterrupt):
        demo._interrupt(signal.SIGTERM, None)
