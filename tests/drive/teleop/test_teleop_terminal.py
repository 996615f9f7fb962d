"""teleop.py restores its terminal at every end of the program."""

import os
import re
import signal
import sys
import time

import pytest
from robot_control.drive.teleop.terminal import END, NoTerminalError, Terminal
from system.pseudo_terminal import PseudoTerminal

IMPORTS = """
import os, signal, sys, time
"""
BEGIN = """
from robot_control.drive.teleop.terminal import NoTerminalError, Terminal
with Terminal() as terminal:
    print("printed meanwhile")
    terminal.draw(["drawn"])
"""
LOOP = """
    try:
        while True:
            data = terminal.read(0.02)
            if data:
                terminal.draw([f"read {data}"])
    except NoTerminalError:
        sys.exit(3)
"""


@pytest.fixture
def started():
    programs = []

    def start(code, before="", **given):
        path, code = os.pathsep.join(sys.path), IMPORTS + before + BEGIN + code
        programs.append(PseudoTerminal([sys.executable, "-c", code], {"PYTHONPATH": path}, **given))
        return programs[-1]

    yield start
    for program in programs:
        program.end()


def wait_for(condition):
    end = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def assert_restored(program):
    """Settings and screen are restored; a guard may still be busy after the program's end."""
    wait_for(lambda: program.settings() == program.before)
    wait_for(lambda: END in program.written)


def test_within_the_block_keys_come_at_once_and_the_screen_is_drawn(started):
    program = started(LOOP)
    wait_for(lambda: "drawn" in program.screen)
    assert program.settings() != program.before
    program.type("w")
    wait_for(lambda: "read b'w'" in program.screen)


def test_what_was_typed_before_the_block_is_no_key(started):
    program = started(LOOP, 'import termios, tty; tty.setraw(0); print("begins", flush=True); time.sleep(1.0)')
    wait_for(lambda: b"begins" in program.written)
    program.type("w")
    wait_for(lambda: "drawn" in program.screen)
    program.type("x")
    wait_for(lambda: "read b'x'" in program.screen)


@pytest.mark.parametrize(
    ("end", "code"),
    [
        ("pass", 0),
        ("sys.exit(4)", 4),
        ("1 / 0", 1),
        ("os.kill(os.getpid(), signal.SIGKILL)", 128 + signal.SIGKILL),
        ("os.kill(os.getpid(), signal.SIGSEGV)", 128 + signal.SIGSEGV),
        ("os._exit(5)", 5),
    ],
)
def test_it_is_as_before_after_every_end(started, end, code):
    program = started(f"    {end}\n")
    assert program.wait() == code
    assert_restored(program)


def test_it_is_as_before_after_its_process_group_was_killed(started):
    own_group = "signal.signal(signal.SIGTTOU, signal.SIG_IGN); os.setpgid(0, 0); os.tcsetpgrp(0, os.getpid())"
    program = started("    os.killpg(0, signal.SIGKILL)\n", own_group)
    assert program.wait() == 128 + signal.SIGKILL
    assert_restored(program)


@pytest.mark.parametrize("end", ["pass", "os.kill(os.getpid(), signal.SIGKILL)"])
def test_a_terminal_that_takes_nothing_has_its_settings_at_the_end_and_its_screen_when_it_takes_bytes(
    started, tmp_path, end
):
    full = tmp_path / "full"
    code = f"""
    for number in range(200):
        terminal.draw(["x" * 79] * 24)
    open({str(full)!r}, "w").write("done")
    {end}
"""
    program = started(code, reading=False)
    wait_for(full.exists)
    wait_for(lambda: program.settings() == program.before)
    program.read_on()
    wait_for(lambda: END in program.written)


def private_modes(written, modes):
    """Modes that are on after these bytes (xterm's DECSET, DECRST, XTSAVE, XTRESTORE), from those on before."""
    saved, modes = {}, set(modes)
    for numbers, action in re.findall(rb"\x1b\[\?([0-9;]+)([hlsr])", written):
        for mode in map(int, numbers.split(b";")):
            if action == b"s":
                saved[mode] = mode in modes
            elif action == b"h" or (action == b"r" and saved[mode]):
                modes.add(mode)
            else:
                modes.discard(mode)
    return modes


@pytest.mark.parametrize("before", [set(), {9, 1007}, {1000, 1006}, {1003, 1015, 1004, 2004}, {1002, 1005, 1001, 1016}])
@pytest.mark.parametrize("end", ["pass", "os.kill(os.getpid(), signal.SIGKILL)"])
def test_the_mouse_and_the_focus_are_not_reported_and_a_paste_is_marked_until_the_end(started, before, end):
    shown, own = {25}, {25, 1049, 2004}
    program = started(f"    {end}\n")
    program.wait()
    assert_restored(program)
    begin = program.written[: program.written.index(b"drawn")]
    assert private_modes(begin, before | shown) == own - shown
    assert private_modes(program.written, before | shown) == before | shown


def test_what_was_printed_meanwhile_comes_afterwards(started):
    program = started("    1 / 0\n")
    program.wait()
    wait_for(lambda: b"ZeroDivisionError" in program.written)
    assert program.written.index(b"printed meanwhile") > program.written.index(END)


def test_a_hang_up_is_noticed(started):
    program = started("    signal.signal(signal.SIGHUP, signal.SIG_IGN)\n" + LOOP)
    wait_for(lambda: "drawn" in program.screen)
    program.close()
    assert program.wait() == 3


def test_a_terminal_that_takes_nothing_delays_nothing(started, tmp_path):
    count = tmp_path / "count"
    code = f"""
    for number in range(200):
        terminal.draw(["x" * 79] * 24)
    open({str(count)!r}, "w").write("done")
"""
    started(code, reading=False)
    wait_for(count.exists)


def test_ctrl_c_is_a_signal_and_ctrl_z_and_ctrl_s_are_none(started):
    program = started(LOOP)
    wait_for(lambda: "drawn" in program.screen)
    program.type("\x1a\x13\x1c")
    wait_for(lambda: r"read b'\x1a\x13\x1c'" in program.screen)
    program.type("\x03")
    assert program.wait() == 128 + signal.SIGINT
    assert_restored(program)


def test_without_a_terminal_it_says_so():
    reading, writing = os.pipe()
    with pytest.raises(NoTerminalError, match="not a terminal"):
        Terminal(reading)
    os.close(reading)
    os.close(writing)


WHOLE_PROGRAM = """
import sys, types
messages = types.ModuleType("robot_control.msg")
messages.SafetyStatus = messages.RobotKind = None
sys.modules["robot_control.msg"] = messages
from robot_control.drive.teleop import main
main.require_master = lambda: None
main.main()
"""


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("TERM=dumb", "TERM=dumb"),
        ("TERM=unknown", "TERM=unknown"),
        ("TERM=", "TERM is not set"),
        ("-uTERM", "TERM is not"),
    ],
)
def test_a_terminal_without_control_sequences_is_refused_with_one_message_and_receives_none(given, words):
    program = PseudoTerminal(
        ["env", given, sys.executable, "-c", WHOLE_PROGRAM], {"PYTHONPATH": os.pathsep.join(sys.path)}
    )
    assert program.wait() == 1
    wait_for(lambda: program.written.endswith(b"\n"))
    text = program.written.decode()
    assert text.startswith(f"teleop.py: {words}")
    assert text.rstrip().endswith("with TERM=xterm")
    assert text.count("\n") == 1
    assert "\x1b" not in text
    program.end()
