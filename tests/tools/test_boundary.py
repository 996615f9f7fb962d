"""The boundary of the programs beside the loop."""

from __future__ import annotations

import contextlib
import io
import math

import pytest
from mutants import mutants
from nav_msgs.msg import Odometry
from robot_control.common.boundary import Boundary, UnfitError, _sealed, opened, unsealed
from sensor_msgs.msg import BatteryState


def wire(message: object) -> bytes:
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def sealed(kind: type, data: bytes) -> object:
    return _sealed(kind)().deserialize(data)


@pytest.fixture
def said() -> list[str]:
    return []


@pytest.fixture
def boundary(said: list[str]) -> Boundary:
    return Boundary(said.append)


def test_what_actionlib_cannot_read_arrives_empty_and_counts(
    monkeypatch: pytest.MonkeyPatch, boundary: Boundary
) -> None:
    monkeypatch.setattr("robot_control.common.boundary.boundary", boundary)
    kind = unsealed(Odometry)
    assert (kind._type, kind._md5sum) == (Odometry._type, Odometry._md5sum)
    data = wire(Odometry(child_frame_id="base_link"))
    assert [kind().deserialize(each).child_frame_id for each in (data, data[:-1])] == ["base_link", ""]
    assert boundary.dropped == {"nav_msgs/Odometry": 1}


def test_a_healthy_message_arrives() -> None:
    message = Odometry()
    message.pose.pose.position.x = 3.0
    assert opened(sealed(Odometry, wire(message))).pose.pose.position.x == 3.0


def test_the_type_on_the_wire_stays_that_of_the_message() -> None:
    assert (_sealed(Odometry)._type, _sealed(Odometry)._md5sum) == (Odometry._type, Odometry._md5sum)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_number_that_is_not_finite_is_refused_with_its_field(bad: float) -> None:
    message = Odometry()
    message.twist.covariance = [0.0] * 35 + [bad]
    with pytest.raises(UnfitError, match=r"twist\.covariance must be finite"):
        opened(sealed(Odometry, wire(message)))


def test_a_field_in_which_nan_has_a_meaning_keeps_it() -> None:
    message = BatteryState(percentage=math.nan)
    assert math.isnan(opened(sealed(BatteryState, wire(message)), ("percentage",)).percentage)


def test_every_truncation_is_refused() -> None:
    data = wire(Odometry(child_frame_id="base_link"))
    for end in range(len(data)):
        with pytest.raises(UnfitError):
            opened(sealed(Odometry, data[:end]))


def test_mutants_are_taken_or_refused_and_raise_nothing_else() -> None:
    data = wire(Odometry(child_frame_id="base_link"))
    for mutant in mutants(data, 2000, seed=1):
        with contextlib.suppress(UnfitError):
            opened(sealed(Odometry, mutant))


def test_what_surprises_the_program_stops_what_moves_first(boundary: Boundary, said: list[str]) -> None:
    order: list[str] = []
    boundary.stops(lambda: order.append("stopped"))
    boundary._say = order.append
    with boundary.crossing("order"):
        raise ZeroDivisionError("division by zero")
    assert order[0] == "stopped"
    assert order[1].startswith("order: an input is dropped (1 until now): ZeroDivisionError: division by zero (")
    assert boundary.dropped == {"order": 1}


def test_a_stop_that_fails_keeps_the_others_and_the_program(boundary: Boundary) -> None:
    stopped: list[int] = []

    def failing() -> None:
        raise RuntimeError

    for stop in (failing, lambda: stopped.append(1)):
        boundary.stops(stop)
    with boundary.crossing("order"):
        raise KeyError("x")
    assert stopped == [1]


def test_an_input_that_the_checks_refuse_stops_nothing(boundary: Boundary, said: list[str]) -> None:
    stopped: list[int] = []
    boundary.stops(lambda: stopped.append(1))
    with boundary.crossing("odom"):
        raise UnfitError("must be finite")
    assert (stopped, said) == ([], ["odom: an input is dropped (1 until now): must be finite"])


def test_a_flood_is_named_ever_more_rarely(boundary: Boundary, said: list[str]) -> None:
    for _ in range(1000):
        boundary.drop("odom", "must be finite")
    assert boundary.dropped == {"odom": 1000}
    assert len(said) == 10


def test_the_end_of_the_program_passes(boundary: Boundary) -> None:
    for end in (KeyboardInterrupt, SystemExit):
        with pytest.raises(end), boundary.crossing("odom"):
            raise end
