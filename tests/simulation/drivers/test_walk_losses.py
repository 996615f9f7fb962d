"""Losses behind the simulated drives of a robot that trots: one phase of scripts/bench devices --robot quadbot."""

import pytest
from robot_control.loop.drives import DRIVES

from bench.devices.disturbed_walk import DisturbedWalk, run_walk
from bench.devices.walk_loss import LOSSES, WalkLoss, run_loss

SAME_LAW = ("cybergear", "ak", "moteus")
"""drives in MIT mode beside damiao"""
KEEPS_ITS_ORDER = {("ak", "bus gone"), ("ak", "cable of a leg")}
"""The motors have no timeout: the robot falls over with the last order of its legs (docs/drivers.md)."""


def test_every_drive_of_legs_has_its_losses():
    assert set(LOSSES) == {name for name, row in DRIVES.items() if not row.wheel_commands}


@pytest.mark.parametrize(
    ("drive", "kind"),
    [
        pytest.param(drive, kind, marks=[pytest.mark.nightly] if drive in SAME_LAW else [])
        for drive, losses in LOSSES.items()
        for kind in losses
        if (drive, kind) not in KEEPS_ITS_ORDER
    ],
)
def test_a_loss_is_named_in_time_and_folds_the_robot_upright(drive, kind):
    outcome = run_loss(WalkLoss(drive, kind, 7))
    assert outcome.broken == (), outcome
    assert outcome.named <= LOSSES[drive][kind].latest


@pytest.mark.parametrize("drive", ["damiao", "unitree_legged", "unitree_go"])
def test_a_disturbed_line_latches_nothing(drive):
    walk = run_walk(DisturbedWalk(drive, "disturbed", 10.0, 1))
    assert walk.causes == ()
    assert walk.longest > 0
