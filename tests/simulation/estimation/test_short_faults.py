"""Each kind of fault of each sensor lasts 20 ms … 3 s, and leaves no error after 20 s of rest."""

import pytest

from bench.odometry.short_faults import COMBINATIONS, Verdict, drive, estimate, judge

QUICK = {
    ("garbage", "gyro", 0.02),
    ("garbage", "accelerometer", 0.02),
    ("stuck", "left encoder", 1.0),
    ("absent", "left encoder", 1.0),
}


@pytest.fixture(scope="module")
def sound():
    return drive()


@pytest.fixture(scope="module")
def undisturbed(sound):
    return estimate(sound)


def verdict(sound, undisturbed, combination) -> Verdict:
    return judge(sound, undisturbed, estimate(sound, *combination))


def test_sound_sensors_leave_nothing_behind_either(sound, undisturbed):
    assert not judge(sound, undisturbed, undisturbed).broken()


@pytest.mark.parametrize(
    "combination",
    [
        pytest.param(one, id="-".join(str(word) for word in one), marks=() if one in QUICK else pytest.mark.nightly)
        for one in COMBINATIONS
    ],
)
def test_a_short_fault_is_forgotten_after_a_rest(sound, undisturbed, combination):
    assert not verdict(sound, undisturbed, combination).broken()
