"""The emergency stop at the input of a motor board, and the drive through the board, in virtual time."""

import math
from pathlib import Path

import numpy as np
import pytest
from robot_control import ClosedLoop
from robot_control.installed_files import share_file
from robot_control.loop.signal_names import causes_in, number_of

COMMAND = (0.5, 0.2)
"""m/s, rad/s"""
STOPPED, FAULT = (number_of("SupervisorState", name) for name in ("STOPPED", "FAULT"))
BRAKE = number_of("GateVerdict", "brake")


@pytest.fixture
def drive_file(tmp_path):
    file = tmp_path / "board.yaml"
    text = Path(share_file("config/drives/board.yaml")).read_text()
    file.write_text(text.replace("e_stop_input: false", "e_stop_input: true "))
    return file


def board_loop(drive_file, rate=500):
    return ClosedLoop({"robot": {"driver": "board", "rate": rate}}, seed=3, drives=drive_file)


def driven(loop, seconds=5.0):
    log = loop.run(seconds, COMMAND)
    assert not np.isin(log["supervisor_state"], (STOPPED, FAULT)).any(), causes_in(log["permit_causes"][-1:])
    return log


def still_stopped_after_a_reset(loop):
    loop.run(2.0, (0.0, 0.0))
    loop.e_stop_reset()
    return loop.run(0.1, (0.0, 0.0))["supervisor_state"][-1] == STOPPED


@pytest.mark.parametrize("line", ["ok", "disturbed"])
@pytest.mark.parametrize("rate", [250, 500])
def test_the_robot_drives_through_the_board(drive_file, rate, line):
    loop = board_loop(drive_file, rate)
    loop.run(1.0, (0.0, 0.0))
    loop.inject_fault("line", line)
    log = driven(loop, 8.0)
    assert np.mean(log["truth_linear"][-rate:]) == pytest.approx(COMMAND[0], abs=0.01)
    assert math.hypot(*(log[f"estimate_{axis}"][-1] - log[f"truth_{axis}"][-1] for axis in "xy")) < 0.05


def test_the_same_seed_gives_the_same_bytes(drive_file):
    first, second = (driven(board_loop(drive_file), 2.0) for _ in range(2))
    assert all(first[name].tobytes() == second[name].tobytes() for name in first)


def test_a_pressed_button_brakes_latches_and_is_reset_only_when_released(drive_file):
    loop = board_loop(drive_file)
    driven(loop)
    loop.inject_fault("board", "e_stop")
    log = loop.run(2.0, COMMAND)
    # Three cycles of the board, and one each until the monitor's permit and the gate.
    assert np.argmax(log["gate_verdict"] == BRAKE) <= 5
    assert abs(log["truth_linear"][-1]) < 1e-3
    assert "e_stop_input" in causes_in(log["permit_causes"][-1:])
    assert still_stopped_after_a_reset(loop), "the button is pressed"
    loop.inject_fault("board", "ok")
    assert loop.run(0.5, COMMAND)["supervisor_state"][-1] == STOPPED, "released, and not reset"
    assert not still_stopped_after_a_reset(loop)
    assert driven(loop)["truth_linear"][-1] == pytest.approx(COMMAND[0], abs=0.02)


@pytest.mark.parametrize(
    ("component", "kind"),
    [("line", "cut"), ("line", "stalled"), ("board", "off"), ("board", "reset"), ("board", "brown_out")],
)
def test_a_loss_latches_and_the_board_stays_braked_when_it_is_back(drive_file, component, kind):
    loop = board_loop(drive_file)
    driven(loop, 3.0)
    loop.inject_fault(component, kind)
    log = loop.run(2.0, COMMAND)
    assert "driver_fault" in causes_in(log["permit_causes"][-1:])
    loop.inject_fault(component, "ok")
    log = loop.run(2.0, COMMAND)
    assert abs(log["truth_linear"][-1]) < 1e-3
