"""Quality of a link and the speed that it allows, in virtual time."""

import math
import random

import pytest
from robot_control.settings.files import SettingsError
from robot_control.watch.console.link import FALL, RISE, Excess, RoundTrips, SpeedCap
from robot_control.watch.console.settings import Settings, read_settings


def measured(*round_trips, period=0.1):
    trips, now = RoundTrips(), 0.0
    for number, each in enumerate(round_trips):
        trips.ping(str(number), now)
        trips.pong(str(number), now + each)
        now += period
    return trips, now


def test_95_of_100_pings_are_no_slower():
    trips, now = measured(*(number / 1000 for number in range(1, 101)))
    assert trips.percentile95(now) == pytest.approx(0.095)
    assert trips.last() == pytest.approx(0.1)


def test_an_unknown_link_is_infinitely_slow():
    assert RoundTrips().percentile95(0.0) == math.inf
    trips, now = measured(0.01, 0.01)
    assert trips.percentile95(now) == math.inf


def test_a_stall_counts_before_its_end():
    trips, now = measured(*[0.01] * 50)
    for number in range(10):
        trips.ping(f"stalled {number}", now + 0.1 * number)
    assert trips.percentile95(now + 2.0) > 1.0


def test_an_answer_without_its_ping_does_not_count():
    trips, now = measured(*[0.5] * 10)
    for _ in range(100):
        trips.pong("guessed", now)
        trips.pong("3", now)
    assert trips.percentile95(now) == pytest.approx(0.5)


def test_excess_is_over_the_fastest_message_whatever_the_foreign_clock_says():
    for offset in (-1e6, 0.0, 1e9):
        excess = Excess()
        assert excess.of(offset, 0.02) == pytest.approx(0.0)
        assert excess.of(offset + 1.0, 1.32) == pytest.approx(0.3, abs=1e-6)
        assert excess.of(offset + 2.0, 2.02) == pytest.approx(0.0, abs=1e-6)


def test_a_page_cannot_make_its_messages_younger_than_their_receipt():
    random_numbers = random.Random(1)
    excess = Excess()
    for step in range(10_000):
        assert excess.of(random_numbers.uniform(0, 1e9), step * 0.05) >= 0.0


def test_a_clock_that_drifts_is_followed():
    excess = Excess()
    late = [excess.of(0.999 * now, now) for now in (0.05 * step for step in range(20_000))]
    assert max(late) < 0.07


@pytest.mark.parametrize("round_trip", [0.0, 0.02, 0.1, 0.4, 0.8])
def test_the_cap_reaches_the_law(round_trip):
    cap = SpeedCap(0.3, 0.4)
    for step in range(300):
        cap.step(round_trip, 0.02 * step)
    assert cap.value * (round_trip + 0.4) == pytest.approx(0.3)


def test_the_cap_falls_and_rises_smoothly():
    cap, before, now = SpeedCap(0.3, 0.4), 0.0, 0.0
    for step in range(2000):
        now += 0.02
        value = cap.step((0.0, 0.8, math.inf)[step // 200 % 3], now)
        assert -FALL * 0.02 - 1e-9 <= value - before <= RISE * 0.02 + 1e-9
        before = value


def test_the_installed_settings_are_the_defaults(tmp_path):
    from robot_control.installed_files import share_file

    assert read_settings(tmp_path.__class__(share_file("config/console.yaml"))) == Settings()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("distance: 0", "distance = 0: must be a number from 0.001 to 1000"),
        ("distance: .nan\nlink_gap: x", "link_gap = x: must be"),
        ("distanze: 1", "distanze: is unknown; known are distance, link_gap"),
        ("- 1", "must hold keys with values"),
        ("a: [", "is not YAML"),
    ],
)
def test_wrong_settings_are_refused_with_their_reason(tmp_path, text, words):
    path = tmp_path / "own.yaml"
    path.write_text(text)
    with pytest.raises(SettingsError, match=words.replace("[", r"\[")):
        read_settings(path)
