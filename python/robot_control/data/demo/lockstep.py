"""Drives in lockstep, by a command script: a busy machine makes it slower and changes no row."""

import time

from robot_control.data.demo.launched import (
    ANGULAR,
    LINEAR,
    REST_TIME,
    DemoError,
    Driven,
    ended_at_the_end,
    last_row,
    launch,
    progress,
    tail,
)
from robot_control.data.demo.tracking import ON_LEGS
from robot_control.loop.roles import CONTROLLER, LEGGED, Kind

STILL_LIMIT = 600.0
"""s without a new row, after which the loop is taken for dead; 3 s from the call to the first row when idle"""
SEND_PERIOD = 0.5
"""s between two messages of a script, as of send_cmd.py"""
REST_AFTER = {"wheels": 1.5, "legs": 6.0}
"""s between the zero and the last cycle: the ramp takes 0.5 s, the last step, the standing and the lying down 5 s"""
LIE_DOWN = f"{Kind(LEGGED).worded(CONTROLLER)}: {{lie_down_after: 1.0}}\n"
"""parameters of a robot on legs: it lies down by itself"""


def script(seconds: float, period: float, *, legged: bool) -> tuple[str, float, int]:
    """The text of a command script, the seconds that it asks for motion, and the cycles of the run,
    each of `period` s.

    A robot on legs is asked for longer, because it stands up first.
    """
    asked = seconds + (ON_LEGS.rise if legged else 0.0)
    begin, end = round(REST_TIME / period), round((REST_TIME + asked) / period)
    rows = [f"{cycle},{LINEAR},{ANGULAR}" for cycle in range(begin, end, round(SEND_PERIOD / period))]
    text = "\n".join(["cycle,linear,angular", *rows, f"{end},0,0"]) + "\n"
    return text, asked, end + round(REST_AFTER["legs" if legged else "wheels"] / period)


def drive(seconds: float, driven: Driven) -> float:
    """Starts everything and waits for its end. Returns the seconds for which motion was asked."""
    text, asked, cycles = script(seconds, driven.period, legged=driven.legged)
    out = driven.out
    commands = out / "commands.csv"
    commands.write_text(text)
    log = out / "run.bag"
    print(f"driving {LINEAR} m/s and {ANGULAR} rad/s for {asked:g} s of simulated time")
    with ended_at_the_end() as children:
        arguments = ("clock:=lockstep", f"cycles:={cycles}", f"command_script:={commands}")
        launched = launch(driven, arguments)
        children.append(launched)
        seen, since, wait = -1.0, time.monotonic(), 0.5
        while not launched.wait(wait):
            begun = time.monotonic()
            row = last_row(log)
            if row is not None and row["cycle"] != seen:
                seen, since = row["cycle"], begun
                print(progress(row, seen * driven.period))
            elif begun - since > STILL_LIMIT:
                raise DemoError(f"no new row within {STILL_LIMIT:g} s:\n{tail(launched.output)}")
            wait = max(0.5, 5 * (time.monotonic() - begun))  # the longer the log, the longer it takes to read it
    row = last_row(log)
    if row is None or row["cycle"] < cycles - 1:
        raise DemoError(f"a part of the loop has ended:\n{tail(out / 'launch.log')}")
    return asked
