"""The boundary of the programs beside the loop."""

from __future__ import annotations

import contextlib
import math
import struct
import time
from types import SimpleNamespace

import pytest
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from robot_control.msg import LegState, SafetyStatus
from robot_control.robot.boundary import (
    MAX_BYTES,
    MAX_LONG_BYTES,
    Boundary,
    Latest,
    UnfitError,
    _sealed,
    guard_action,
    next_message,
    opened,
    unsealed,
)
from robot_control.robot.boundary import boundary as boundary_of_this_process
from robot_control.robot.diagnosis.recent import MAX_NAMES, MAX_SENDERS, MAX_SIZE, Diagnostics
from robot_control.robot.interruptions import SURPRISE
from robot_control.robot.safety_watch import SafetyWatch
from sensor_msgs.msg import BatteryState
from support.mutants import mutants
from support.timed import timed
from support.topics import Topics, wire


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
    monkeypatch.setattr("robot_control.robot.boundary.boundary", boundary)
    kind = unsealed(Odometry)
    assert (kind._type, kind._md5sum) == (Odometry._type, Odometry._md5sum)
    data = wire(Odometry(child_frame_id="base_link"))
    assert [kind().deserialize(each).child_frame_id for each in (data, data[:-1])] == ["base_link", ""]
    assert boundary.dropped == {"nav_msgs/Odometry": 1}


@pytest.mark.parametrize("of", [GoalID, GoalStatusArray])
def test_what_actionlib_subscribes_to_by_itself_is_guarded(
    of: type, monkeypatch: pytest.MonkeyPatch, boundary: Boundary
) -> None:
    monkeypatch.setattr("robot_control.robot.boundary.boundary", boundary)
    guard_action("guarded", **{of.__name__: unsealed(of)})
    kind = rospy.Subscriber(f"guarded/{of.__name__}", of, print).impl.data_class
    message = GoalID(id="1") if of is GoalID else GoalStatusArray(status_list=[GoalStatus(text="driving")])
    for mutant in mutants(wire(message), 2000, seed=1):
        kind().deserialize(mutant)
    assert boundary.dropped[of._type] > 100


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
    assert math.isnan(opened(sealed(BatteryState, wire(message))).percentage)


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
    assert order[1].startswith("order: an input is ignored (1 until now): ZeroDivisionError: division by zero (")
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
    assert (stopped, said) == ([], ["odom: an input is ignored (1 until now): must be finite"])


def test_a_flood_is_named_ever_more_rarely(boundary: Boundary, said: list[str]) -> None:
    for _ in range(1000):
        boundary.drop("odom", "must be finite")
    assert boundary.dropped == {"odom": 1000}
    assert len(said) == 10


def test_the_end_of_the_program_passes(boundary: Boundary) -> None:
    for end in (KeyboardInterrupt, SystemExit):
        with pytest.raises(end), boundary.crossing("odom"):
            raise end


def test_a_polled_topic_shows_the_newest_message_that_passed_and_its_age(monkeypatch: pytest.MonkeyPatch) -> None:
    topics = Topics(monkeypatch)
    latest = Latest("odom", Odometry)
    assert (latest.message, latest.age(0.0)) == (None, None)
    message = Odometry(child_frame_id="base_link")
    topics.send("odom", message)
    received = latest.newest[1]
    topics.send_bytes("odom", wire(message)[:40])
    assert latest.message.child_frame_id == "base_link"
    assert latest.newest[1] == received
    assert latest.fresh(received + 0.5, 1.0) is latest.message
    assert latest.fresh(received + 1.5, 1.0) is None
    assert latest.message._connection_header["callerid"] == "/node"


def test_a_message_that_is_waited_for_is_none_where_none_comes_or_it_is_truncated(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(rospy, "Subscriber", lambda *_, **__: SimpleNamespace(unregister=lambda: None))
    assert next_message("odom", Odometry, 0.05) is None


@pytest.mark.parametrize(("kind", "size"), [(Odometry, MAX_BYTES), (OccupancyGrid, MAX_LONG_BYTES)])
def test_a_message_that_is_too_long_for_its_type_is_refused_before_it_is_read(kind: type, size: int) -> None:
    with pytest.raises(UnfitError, match=f"has {size + 1} bytes, more than {size}"):
        opened(sealed(kind, bytes(size + 1)))


def test_a_long_text_in_a_map_is_refused() -> None:
    grid = OccupancyGrid()
    grid.header.frame_id = "m" * (MAX_BYTES + 1)
    with pytest.raises(UnfitError, match="is no nav_msgs/OccupancyGrid"):
        opened(sealed(OccupancyGrid, wire(grid)))


def test_a_text_with_a_zero_byte_is_refused() -> None:
    with pytest.raises(UnfitError, match="child_frame_id must not contain a zero byte"):
        opened(sealed(Odometry, wire(Odometry(child_frame_id="a\0b"))))


def test_a_limit_that_is_none_and_a_load_that_is_not_measured_pass() -> None:
    assert math.isinf(opened(sealed(SafetyStatus, wire(SafetyStatus(speed_limit=math.inf)))).speed_limit)
    assert math.isnan(opened(sealed(LegState, wire(LegState(load=[math.nan])))).load[0])


def test_a_surprise_ends_what_was_requested_before_it(monkeypatch: pytest.MonkeyPatch) -> None:
    Topics(monkeypatch)
    watch, requested = SafetyWatch(), time.monotonic()
    assert watch.revoked(requested, waited=True) == ""
    with boundary_of_this_process.crossing("a page"):
        raise ZeroDivisionError
    assert watch.revoked(requested, waited=True) == SURPRISE
    assert (watch.interrupted(), watch.interrupted()) == (SURPRISE, "")


def report(*names: str, text: str = "") -> DiagnosticArray:
    return DiagnosticArray(status=[DiagnosticStatus(name=name, values=[KeyValue("key", text)]) for name in names])


@pytest.fixture
def diagnostics(monkeypatch: pytest.MonkeyPatch) -> tuple[Diagnostics, Topics, SimpleNamespace]:
    topics, clock = Topics(monkeypatch), SimpleNamespace(now=0.0)
    monkeypatch.setattr("robot_control.robot.diagnosis.recent.time", SimpleNamespace(monotonic=lambda: clock.now))
    return Diagnostics(life=3.0), topics, clock


def test_a_hundred_thousand_names_of_one_sender_are_few_expire_and_displace_no_other_sender(diagnostics) -> None:
    table, topics, clock = diagnostics
    topics.send("/diagnostics", report("safety_monitor"), "/safety_monitor")
    clock.now = 1.0
    for first in range(0, 130_000, 1000):
        topics.send("/diagnostics", report(*(f"name {first + each}" for each in range(1000))), "/flood")
    assert len(table.items(2.0)) == MAX_NAMES + 1
    assert table.items(2.0)["/safety_monitor"][0] == 0.0
    assert list(table.items(3.5)) == [f"/name {each}" for each in range(130_000 - MAX_NAMES, 130_000)]
    clock.now = 4.0
    for number in range(1000):
        topics.send("/diagnostics", report("name"), f"/sender_{number}")
    assert len(table._senders) == MAX_SENDERS
    assert list(table.items(4.0)) == ["/name"]


def test_long_reports_of_one_sender_are_few(diagnostics) -> None:
    table, topics, _ = diagnostics
    topics.send("/diagnostics", report("safety_monitor"), "/safety_monitor")
    for number in range(20):
        topics.send("/diagnostics", report(f"name {number}", text="x" * 10_000), "/flood")
    assert list(table.items(0.0)) == ["/safety_monitor", *(f"/name {number}" for number in range(14, 20))]
    topics.send("/diagnostics", report("name", text="x" * MAX_SIZE), "/flood")
    assert list(table.items(0.0)) == ["/safety_monitor"]


def test_a_sealed_message_is_printed_without_its_bytes() -> None:
    assert str(sealed(OccupancyGrid, wire(OccupancyGrid(data=[7] * 100)))) == ""


def test_the_longest_map_and_the_longest_path_are_opened_in_time() -> None:
    grid = OccupancyGrid()
    cells = MAX_LONG_BYTES - len(wire(grid))
    timed(opened, sealed(OccupancyGrid, wire(grid)[:-4] + struct.pack("<I", cells) + bytes(cells)))
    path = Path(poses=[PoseStamped()] * 3600)
    timed(opened, sealed(Path, wire(path)))
    with pytest.raises(UnfitError, match="bytes, more than"):
        opened(sealed(Path, wire(Path(poses=[PoseStamped()] * 20_000))))
    assert len(opened(sealed(Path, wire(Path(poses=[PoseStamped()] * 20_000))), longest=MAX_LONG_BYTES).poses) == 20_000


def test_a_map_has_its_cells_and_one_that_is_cut_off_is_refused() -> None:
    data = wire(OccupancyGrid(data=[-1, 0, 100]))
    assert list(opened(sealed(OccupancyGrid, data)).data) == [-1, 0, 100]
    for end in range(len(data)):
        with pytest.raises(UnfitError):
            opened(sealed(OccupancyGrid, data[:end]))
