"""Tests the fit on drives that obey its law."""

import numpy as np
import pytest
from robot_control.loop.signal_names import mask_of
from robot_control.setup.identify.fit import identify
from robot_control.setup.identify.rows import UnfitError
from support.recordings import synthetic_drive as drive


def values(found):
    return {name: found.mean(name).value for name in ("straight", "turning", "damping", "friction")}


TRUTH = {
    "straight": drive.STRAIGHT,
    "turning": drive.TURNING,
    "damping": drive.DAMPING,
    "friction": drive.FRICTION,
}


@pytest.fixture
def log():
    return drive.drive()


def test_finds_the_law_that_a_drive_follows(log):
    found = identify(log, drive.BASE)
    # Within a cycle the torque is constant and the plan is not, which is of second order in the period.
    assert values(found) == pytest.approx(TRUTH, rel=1e-4)
    assert found.mean("scrub").value == pytest.approx(0, abs=1e-4)
    assert found.delay.value == pytest.approx(0, abs=0.01)
    assert found.period == pytest.approx(drive.PERIOD)


def test_counts_of_the_encoders_do_not_bias_it():
    found = identify(drive.drive(counts=4096), drive.BASE)
    assert values(found) == pytest.approx(TRUTH, rel=0.01)


def test_the_standard_errors_cover_what_noise_does(log):
    random = np.random.default_rng(1)
    beyond = 0
    for _ in range(5):
        noisy = dict(log)
        for wheel in drive.BASE.wheels:
            noise = np.convolve(random.normal(0, 0.3, len(log["cycle"])), np.ones(50) / 50, mode="same")
            noisy[f"{wheel.joint}_effort"] = log[f"{wheel.joint}_effort"] + noise
        for side in identify(noisy, drive.BASE).sides:
            for name, truth in TRUTH.items():
                estimate = getattr(side, name)
                beyond += abs(estimate.value - truth) > 2.5 * estimate.error
    # A normal value lies beyond 2.5 standard errors in 1 of 80 cases; errors half too small would leave 8 of 40 there.
    assert beyond <= 4


def test_the_same_log_gives_the_same_bits(log):
    assert identify(log, drive.BASE) == identify(log, drive.BASE)


@pytest.mark.parametrize("delay", [1, 3, 12])
def test_finds_the_delay_of_a_drive_that_measures_its_torque(delay):
    found = identify(drive.drive(delay=delay, counts=4096), drive.BASE)
    assert found.delay.value == pytest.approx(delay, abs=0.5)


@pytest.mark.parametrize("delay", [1, 3, 12])
def test_finds_the_delay_of_a_drive_that_repeats_its_command(delay):
    found = identify(drive.drive(delay=delay, echo=True, counts=4096), drive.BASE)
    assert found.delay.value == pytest.approx(delay, abs=0.5)
    assert values(found) == pytest.approx(TRUTH, rel=0.01)


def test_rows_that_are_missing_split_the_log_and_harm_nothing(log):
    keep = np.ones(len(log["cycle"]), dtype=bool)
    keep[5_000:5_050] = keep[20_000] = False
    found = identify({name: column[keep] for name, column in log.items()}, drive.BASE)
    assert values(found) == pytest.approx(TRUTH, rel=1e-4)


def test_a_stretch_of_mere_standing_harms_nothing():
    rests = 1000  # rows
    log = drive.drive(np.concatenate([drive.plan(), np.zeros((rests, 2))]))
    keep = np.ones(len(log["cycle"]), dtype=bool)
    keep[len(keep) - rests] = False
    found = identify({name: column[keep] for name, column in log.items()}, drive.BASE)
    assert values(found) == pytest.approx(TRUTH, rel=1e-4)


def test_what_the_gate_braked_is_left_out(log):
    log["gate_verdict"][10_000:11_000] = 0
    for wheel in drive.BASE.wheels:
        log[f"{wheel.joint}_effort"][10_000:11_000] = 3.0
    assert values(identify(log, drive.BASE)) == pytest.approx(TRUTH, rel=1e-4)


def refusal(log):
    with pytest.raises(UnfitError) as error:
        identify(log, drive.BASE)
    return str(error.value)


def test_refuses_the_log_of_another_robot(log):
    message = refusal({name.replace("left_", "front_left_"): column for name, column in log.items()})
    assert "no joint left, but front_left, right" in message


def test_refuses_a_log_in_which_nothing_was_driven_and_says_why(log):
    log["gate_verdict"][:] = 0
    assert "why.py" in refusal(log)
    log["permit_causes"][:] = mask_of("StopCause", "e_stop_service")
    assert "e_stop_service" in refusal(log)
    log["permit_causes"][:] = 0
    log["requests_received"][:] = 0
    assert "nothing arrived on cmd_vel" in refusal(log)


def test_refuses_a_robot_that_was_asked_for_nothing(log):
    for wheel in drive.BASE.wheels:
        log[f"{wheel.joint}_velocity_command"][:] = 0
    assert "only zero" in refusal(log)


def test_refuses_a_drive_that_measures_no_torque(log):
    log["right_effort"][:] = 0
    assert "right: its measured effort is 0 N·m throughout" in refusal(log)


def test_refuses_saturated_torque(log):
    log["gate_reasons"][::10] = mask_of("GateReason", "effort_clamped")
    assert "at its limit" in refusal(log)


def test_refuses_slipping_wheels(log):
    log["estimate_flags"][: len(log["cycle"]) // 2] = mask_of("StateFlag", "valid", "slip")
    assert "slipped" in refusal(log)


def test_refuses_too_short_a_motion(log):
    assert "of 2 s needed" in refusal({name: column[:2_000] for name, column in log.items()})


def test_refuses_a_log_without_turns():
    message = refusal(drive.drive(drive.plan(turns=False)))
    assert "inertia turning" in message
    assert "turns on the spot, both ways" in message


def test_refuses_a_log_without_straight_moves():
    message = refusal(drive.drive(drive.plan(straight=False)))
    assert "inertia straight" in message


def test_refuses_a_torque_that_does_not_cause_the_motion(log):
    for wheel in drive.BASE.wheels:
        log[f"{wheel.joint}_effort"] += np.sin(np.arange(len(log["cycle"])) / 50)
    assert "do not fit" in refusal(log)


def test_refuses_a_torque_with_the_sign_of_its_opposite(log):
    for wheel in drive.BASE.wheels:
        log[f"{wheel.joint}_effort"] *= -1
        log[f"{wheel.joint}_effort_command"] *= -1
    assert "must be > 0" in refusal(log)
