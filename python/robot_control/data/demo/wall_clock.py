"""Drives in real time: a sender on cmd_vel, paced by the wall clock, as a user drives."""

import time
from pathlib import Path

from robot_control.data.demo.arguments import LEGGED_ROBOT
from robot_control.data.demo.launched import (
    ANGULAR,
    LINEAR,
    PERIOD,
    REST_TIME,
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


def drive(seconds: float, out: Path, robot: str, drives: Path | None, parameters: Path) -> float:
    """Starts everything, drives, ends everything. Returns the seconds from the command's arrival, or from full speed of
    a robot that stands up first, to the command's end.
    """
    log = out / "run.bag"
    with ended_at_the_end() as children:
        launched = launch(out, robot, drives, parameters, [])
        children.append(launched)
        wait_until(
            log, lambda row: row["cycle"] * PERIOD >= REST_TIME, f"rest of {REST_TIME:g} s", START_LIMIT, launched
        )
        print(f"sending {LINEAR} m/s and {ANGULAR} rad/s for {seconds:g} s")
        sender = Child(["rosrun", "robot_control", "send_cmd.py"], out / "send_cmd.log")
        children.append(sender)
        wait_until(log, lambda row: row["requested_linear"] == LINEAR, "command", START_LIMIT, launched, sender)
        if robot == LEGGED_ROBOT:
            fast = lambda row: is_in(row, "walking") and row["limited_linear"] == LINEAR  # noqa: E731
            wait_until(log, fast, "walk at full speed", START_LIMIT, launched, sender)
        start, due = time.monotonic(), 0.0
        while (driven := time.monotonic() - start) < seconds:
            time.sleep(max(0.0, min(1.0, seconds - driven)))
            see_alive(launched, sender)
            if driven >= due:  # the longer the log, the longer it takes to read it
                print(progress(last_row(log), time.monotonic() - start))
                due = 1.1 * driven
        print("stopping")
        if not sender.end():
            print(f"send_cmd.py had to be killed; see {sender.output}")
        if robot == LEGGED_ROBOT:
            _lie_down(log, launched, children, out)
        time.sleep(RAMP_TIME)
        if not launched.end():
            print(f"roslaunch had to be killed; see {launched.output}")
    return driven


def _lie_down(log: Path, launched: Child, children: list[Child], out: Path) -> None:
    wait_until(log, lambda row: is_in(row, "standing"), "standing robot", START_LIMIT, launched)
    print("lying down")
    children.append(Child(["rosservice", "call", "set_posture", "lying"], out / "set_posture.log"))
    wait_until(log, lambda row: is_in(row, "lying"), "lying robot", START_LIMIT, launched)
