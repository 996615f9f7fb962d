"""Drives in real time: a sender on cmd_vel, paced by the wall clock, as a user drives."""

import time
from pathlib import Path

from robot_control.data.demo.launched import (
    ANGULAR,
    LINEAR,
    REST_TIME,
    Driven,
    ended_at_the_end,
    is_in,
    last_row,
    launch,
    progress,
    see_alive,
    wait_until,
)
from robot_control.ui.child import Child

START_LIMIT = 60.0
"""s for master, nodes and first rows, and again for the sender; 3 s and 1 s on an idle machine."""
RAMP_TIME = 1.5
"""s between the sender's zero and the end of the log: 0.5 s of ramp at 1 m/s², tripled."""


def drive(seconds: float, driven: Driven) -> float:
    """Starts everything, drives, ends everything. Returns the seconds from the command's arrival, or from full speed of
    a robot that stands up first, to the command's end.
    """
    out = driven.out
    log = out / "run.bag"
    with ended_at_the_end() as children:
        launched = launch(driven, [])
        children.append(launched)
        rested = lambda row: row["cycle"] * driven.period >= REST_TIME  # noqa: E731
        wait_until(log, rested, f"rest of {REST_TIME:g} s", START_LIMIT, launched)
        print(f"sending {LINEAR} m/s and {ANGULAR} rad/s for {seconds:g} s")
        sender = Child(["rosrun", "robot_control", "send_cmd.py"], out / "send_cmd.log")
        children.append(sender)
        wait_until(log, lambda row: row["requested_linear"] == LINEAR, "command", START_LIMIT, launched, sender)
        if driven.legged:
            fast = lambda row: is_in(row, "walking") and row["limited_linear"] == LINEAR  # noqa: E731
            wait_until(log, fast, "walk at full speed", START_LIMIT, launched, sender)
        start, due = time.monotonic(), 0.0
        while (asked := time.monotonic() - start) < seconds:
            time.sleep(max(0.0, min(1.0, seconds - asked)))
            see_alive(launched, sender)
            if asked >= due:  # the longer the log, the longer it takes to read it
                print(progress(last_row(log), time.monotonic() - start))
                due = 1.1 * asked
        print("stopping")
        if not sender.end():
            print(f"send_cmd.py had to be killed; see {sender.output}")
        if driven.legged:
            _lie_down(log, launched, children, out)
        time.sleep(RAMP_TIME)
        if not launched.end():
            print(f"roslaunch had to be killed; see {launched.output}")
    return asked


def _lie_down(log: Path, launched: Child, children: list[Child], out: Path) -> None:
    wait_until(log, lambda row: is_in(row, "standing"), "standing robot", START_LIMIT, launched)
    print("lying down")
    children.append(Child(["rosservice", "call", "set_posture", "lying"], out / "set_posture.log"))
    wait_until(log, lambda row: is_in(row, "lying"), "lying robot", START_LIMIT, launched)
