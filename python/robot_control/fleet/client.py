"""The robot under the order rules: messages in, legs for follow_path and messages out. It reads no clock and needs
neither ROS nor MQTT, whose parts it sees as `Robot` and as the list that `step` returns.
"""

import math
import sys
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Protocol

from robot_control.fleet.settings import Settings
from robot_control.fleet.v2.capability import INSTANT, Capabilities
from robot_control.fleet.v2.leg import Leg, PathPoint, aligned, leg_of
from robot_control.fleet.v2.messages import INBOUND, MAX_ID, Error, Message, RefusedError, decoded, is_connection
from robot_control.fleet.v2.order import NONE, Action, Node, Order, order_of
from robot_control.fleet.v2.state import STATE_PERIOD, Facts, Machine, factsheet, state, visualization
from robot_control.fleet.v2.vehicle import FAILED, FINISHED, RUNNING, ActionState, Vehicle
from robot_control.robot.boundary import Boundary
from robot_control.robot.pose import FARTHEST

IDLE, DRIVING, DONE, ENDED = "idle", "driving", "done", "ended"
OFF_EDGE = 0.3
"""m beside an edge from which the robot joins it; farther away it drives straight to its end. follow_path's off_path"""
REST = 0.02
"""m of a leg that are driven again after a pause at its end"""
GAP = 1.0
"""s without a pass after which messages may have waited, and for which they are then refused"""
LATE = 0.4
"""s by which the distance that follow_path reports is late at most"""
DUPLICATE_SILENCE = 60.0
"""s without a sign of another client of this serial number after which it is gone; it connects again within 30 s"""
DUPLICATE_CLIENT = Error(
    "connectionError",
    "another client uses this serial number",
    hint="set a different serial_number for each robot; then stopPause or vda5050/resume",
    fatal=True,
)


@dataclass(frozen=True)
class Progress:
    """The progress on the present leg."""

    status: str = IDLE  # done: its end was reached; ended: it failed or was stopped
    distance: float = 0.0  # m along it
    reason: str = ""  # why it failed; empty if it was stopped


class Robot(Protocol):
    """The robot as the client sees it."""

    progress: Progress

    def facts(self) -> Facts:
        """As measured now."""

    def drive(self, points: list[PathPoint], begin_at: float) -> None:
        """Replaces the present leg without a stop."""

    def stop(self) -> None:
        """Ends the present leg."""

    def set_position(self, x: float, y: float, theta: float, map_id: str) -> str:
        """Why it is refused; empty if the robot is there from now on."""

    def begin(self, action: Action) -> None:
        """Its end comes with `results`; stopPause: the path that is held at the robot goes on."""

    def end(self, action_id: str) -> bool:
        """True if the action was interrupted; else its end comes with `results`."""

    def results(self) -> list[tuple[str, str, str]]:
        """actionId, FINISHED or FAILED and a description of the actions that ended since the last call."""


class Client:
    """One robot; `step` is called 50 times per second."""

    def __init__(
        self,
        robot: Robot,
        settings: Settings,
        machine: Machine,
        vehicle: Vehicle,
        *,
        keep: Callable[[Vehicle], str] = lambda _: "",
        boundary: Boundary | None = None,
    ) -> None:
        """`keep` saves what an order makes of the vehicle; why it cannot, empty if it did. An exception that nothing
        foresaw drops the order; `boundary` names it.
        """
        self.robot, self.settings, self.machine, self.vehicle = robot, settings, machine, vehicle
        self._keep, self._boundary = keep, boundary or Boundary()
        self._boundary.stops(self.robot.stop)
        self._boundary.stops(self._drop_order)
        self._leg: Leg | None = None
        self._facts = robot.facts()
        self._mode, self._permit = self._facts.mode, self._facts.permit
        self._driving_error: Error | None = None
        self._blocked: tuple[Error, ...] = ()  # while the leg waits before an obstacle
        self._blocked_at = 0.0  # s
        self.file_problem = ""
        """why the order's progress is not in the file; empty if it is"""
        self._outbox: list[tuple[str, Message]] = []
        self._sent_key: object = None  # what the last state said
        self._state_at = self._visualization_at = -math.inf
        self._requests: deque[Callable[[], None]] = deque()
        """of other threads: what the next pass does first with the vehicle, which is that of one thread"""
        self._stepped_at, self._ignore_until = math.inf, -math.inf
        self._duplicate_until = -math.inf
        self._planned: object = None  # revision of the order that the present leg is made of
        self._state_due = True  # whatever it says

    # messages

    def connected(self) -> None:
        """The broker is there (again): everything is sent at once."""
        self._state_due = True
        self._outbox.append(("factsheet", factsheet(self.machine)))

    def receive(self, topic: str, payload: bytes, now: float, *, retained: bool = False) -> None:
        """Takes a message of the master at `now` s; one that waited while this program stood still moves nothing. A
        message that surprises the program ends the leg and drops the order.
        """
        with self._boundary.crossing(topic), self._refusing(topic):
            if now - self._stepped_at > GAP:
                self._ignore_until = now + GAP
            if now < self._ignore_until:
                raise RefusedError(
                    "orderError", f"{topic} arrived while the client of the robot did not run: send it again"
                )
            if topic == "connection":
                if is_connection(payload):  # the link passes on no own one
                    self._duplicate_until = now + DUPLICATE_SILENCE
                return
            if now < self._duplicate_until:
                raise RefusedError("orderError", f"{topic}: {DUPLICATE_CLIENT.description}")
            if topic not in INBOUND or retained:
                raise RefusedError("validationError", f"{topic} must not be retained: its age is unknown")
            message = decoded(payload, topic, self.settings.manufacturer, self.settings.serial_number)
            if topic == "order":
                self._take_order(message)
            else:
                for raw in message["actions"]:
                    with self._boundary.crossing(topic), self._refusing(topic):
                        self._take_instant(Action.of(raw))

    @contextmanager
    def _refusing(self, topic: str) -> Iterator[None]:
        """The block may refuse a message or an action of this topic, which the state reports."""
        try:
            yield
        except RefusedError as refused:
            self.vehicle.refuse(replace(refused.error, references=(*refused.error.references, ("topic", topic))))

    def _drop_order(self) -> None:
        """Called in any thread, where an exception is handled that nothing foresaw: an order that led to it must not do
        so again.
        """
        why = f"the order was dropped: {type(sys.exception()).__name__}: {sys.exception()}"
        self._requests.append(lambda: self._drop(why))

    def _drop(self, why: str) -> None:
        self._leg, self._state_due = None, True
        self._driving_error = Error("internalError", why, (), "the log of vda5050 names it; send another order")
        self._interrupt(self.vehicle.clear("an internal error"))

    def _take_order(self, message: Message) -> None:
        order = order_of(message)
        new = order.id != self.vehicle.order_id
        if self._facts.mode != "AUTOMATIC":
            raise RefusedError("orderError", f"the mode is {self._facts.mode}", **order.references)
        taken = self.vehicle.copy()
        if taken.receive(order, self._near, self._refuse, self._aligned):
            if why := self._keep(taken):
                raise RefusedError("orderError", f"the order cannot be kept over a restart: {why}", **order.references)
            self.vehicle, self._state_due = taken, True
            self._driving_error = None if new else self._driving_error

    def _refuse(self, order: Order) -> None:
        continued = None
        if order.id == self.vehicle.order_id:
            known = [*self.vehicle.nodes, *([self.vehicle.last] if self.vehicle.last else [])]
            continued = next((node for node in known if node.sequence == order.nodes[0].sequence), None)
        actions = dict(self.machine.actions)
        Capabilities(self._facts.map_id, self.machine.height, actions).refuse(order, continued)

    def _near(self, node: Node) -> bool:
        if node.place is None:
            return True  # refused with its reason by the capabilities
        off = math.dist((node.place.x, node.place.y), (self._facts.x, self._facts.y))
        return off <= max(node.place.deviation_xy, self.settings.node_tolerance)

    def _aligned(self, node: Node) -> bool:
        return aligned(node.place, self._facts.theta, self.settings.heading_tolerance)

    def _take_instant(self, action: Action) -> None:
        state = self.vehicle.add_instant(action)
        if state is None:
            return
        self._state_due = True
        try:
            Capabilities(actions=dict(self.machine.actions)).refuse_action(action, INSTANT)
        except RefusedError:
            state.end(FAILED, "this robot does not know it as an instant action, or a parameter is missing")
            raise
        match action.kind:
            case "cancelOrder":
                self._interrupt(self.vehicle.cancel(state))
            case "startPause":
                self.vehicle.paused, state.status = True, RUNNING
            case "stopPause":
                if why := self._against_resuming():
                    state.end(FAILED, why)
                else:
                    self._resume(state)
            case "stateRequest":
                state.end(FINISHED)
            case "factsheetRequest":
                self._outbox.append(("factsheet", factsheet(self.machine)))
                state.end(FINISHED)

    def pause(self) -> str:
        """startPause at the robot, in any thread; empty, for nothing stands against it."""
        self._requests.append(lambda: setattr(self.vehicle, "paused", True))
        return ""

    def resume(self) -> str:
        """stopPause at the robot, in any thread; why it does not go on, empty if it does."""
        if not (why := self._against_resuming()):
            self._requests.append(lambda: self._resume(ActionState(Action({}, "", "stopPause", NONE), -1)))
        return why

    def _against_resuming(self) -> str:
        if not self._facts.may_drive or self._facts.silent:
            return "the safety monitor permits no motion, or safety_status or odom is missing"
        return DUPLICATE_CLIENT.description if self._stepped_at < self._duplicate_until else ""

    def _resume(self, state: ActionState) -> None:
        """The path that is held at the robot goes on, or not; that ends the action then."""
        self.vehicle.paused, self._driving_error = False, None
        if self._facts.held_by:
            state.status = RUNNING
            self.robot.begin(state.action)
        else:
            state.end(FINISHED)

    # one pass

    def step(self, now: float) -> list[tuple[str, Message]]:
        """One pass at `now` s, monotonic; topics and messages that are due, without their headers."""
        self._stepped_at = now
        with self._boundary.crossing("a pass"):
            self._advance(now)
        with self._boundary.crossing("a state"):
            self._publish(now)
        outbox, self._outbox = self._outbox, []
        return outbox

    def _advance(self, now: float) -> None:
        while self._requests:
            self._requests.popleft()()
        before, self._facts = self._facts, self.robot.facts()
        vehicle, facts = self.vehicle, self._facts
        vehicle.standing = not facts.driving and self.robot.progress.status != DRIVING
        if facts.mode != self._mode:
            self._mode = facts.mode
            self._interrupt(vehicle.clear(f"the mode became {facts.mode}"))
        if vehicle.nodes and (now < self._duplicate_until or not facts.may_drive or facts.permit != self._permit):
            vehicle.paused = True
        self._permit = facts.permit
        self._follow(before)
        self._await_free_way(now)
        for action_id, status, result in self.robot.results():
            for each in vehicle.actions:
                if each.action.id == action_id:
                    each.end(status, result)
        for begun in vehicle.started():
            self._begin(begun)
        vehicle.settle()
        self._drive()

    def _begin(self, state: ActionState) -> None:
        if state.action.kind != "initPosition":
            self.robot.begin(state.action)
            return
        given = state.action.parameters
        try:
            x, y, theta = float(given["x"]), float(given["y"]), float(given["theta"])
        except (TypeError, ValueError):
            x = y = theta = math.nan
        if self.vehicle.executing or not self.vehicle.standing:
            why = "the robot must stand still without an order"
        elif not all(abs(each) <= FARTHEST for each in (x, y, theta)) or not 0 < len(str(given["mapId"])) <= MAX_ID:
            why = f"x, y and theta must be numbers up to {FARTHEST:g}, and mapId a name"
        else:
            why = self.robot.set_position(x, y, theta, str(given["mapId"]))
        if not why:
            self.vehicle.last_id, self.vehicle.last_sequence = str(given.get("lastNodeId", ""))[:MAX_ID], 0
            self.vehicle.last, self._facts = None, self.robot.facts()
        state.end(FAILED if why else FINISHED, why)

    def _interrupt(self, states: list[ActionState]) -> None:
        for each in states:
            if self.robot.end(each.action.id):
                each.end(FAILED, "interrupted")

    def _follow(self, before: Facts) -> None:
        """Notes which nodes of the leg were reached since the pass before."""
        progress, leg, vehicle = self.robot.progress, self._leg, self.vehicle
        if leg is None:
            return
        if progress.status == ENDED and progress.reason:
            self._fail(progress.reason)
        late = abs(self._facts.linear) * LATE
        for node, along in zip(leg.nodes, leg.ends, strict=True):
            if not vehicle.nodes or node.sequence < vehicle.nodes[0].sequence or node.place is None:
                continue
            radius = max(node.place.deviation_xy, self.settings.node_tolerance)
            last = node is leg.nodes[-1]
            off = _from_segment(node.place.x, node.place.y, before, self._facts)
            if progress.status == DONE or (not last and off <= radius and progress.distance + late >= along - radius):
                self._traverse()
            else:
                if not last and progress.distance > along + radius:
                    self._fail(f"node {node.id} was passed at {off:.2f} m, more than {radius:g} m")
                break
        if progress.status != DRIVING:
            self._leg = None

    def _await_free_way(self, now: float) -> None:
        """Before an obstacle the leg waits, and goes on by itself; after `blocked_timeout` the order fails, paused."""
        why, limit = self._facts.blocked_by, self.settings.blocked_timeout
        if not why or self.robot.progress.status != DRIVING or self._facts.driving:
            self._blocked = ()
        elif not self._blocked:
            hint = f"remove the obstacle: the order continues by itself within {limit:g} s; or cancelOrder"
            self._blocked, self._blocked_at = (Error("pathBlocked", why, self._place, hint),), now
        elif now - self._blocked_at > limit:
            self._fail(f"{self._blocked[0].description} (for {limit:g} s)")

    @property
    def _place(self) -> tuple[tuple[str, str], ...]:
        """References to the order and to its next edge and node."""
        vehicle = self.vehicle
        edge = (("edgeId", vehicle.edges[0].id),) if vehicle.edges else ()
        node = vehicle.nodes[0].id if vehicle.nodes else ""
        return ("orderId", vehicle.order_id), *edge, ("nodeId", node)

    def _traverse(self) -> None:
        for ended in self.vehicle.traverse():
            self.robot.end(ended.action.id)

    def _fail(self, reason: str) -> None:
        self._driving_error = Error("drivingError", reason, self._place, "cancelOrder, or stopPause to continue")
        self.vehicle.paused = bool(self.vehicle.nodes)

    def _drive(self) -> None:
        vehicle = self.vehicle
        driving = self.robot.progress.status == DRIVING
        permitted = self._facts.may_drive and not self._facts.silent
        if not vehicle.may_drive or not permitted or vehicle.last is None:
            if driving:
                self.robot.stop()
            return
        if driving and self._planned == vehicle.revision:
            return
        self._planned = vehicle.revision
        wanted = leg_of(vehicle.last, vehicle.base, self.settings.heading_tolerance)
        if not wanted.nodes:
            return
        if driving and self._leg is not None:
            self._extend(self._leg, wanted)
        elif not self._facts.driving:  # after a stop it rolls for a moment
            self._begin_leg(wanted)

    def _extend(self, leg: Leg, wanted: Leg) -> None:
        """Sends the present leg with the edges that were released since, if there are some."""
        if leg.nodes[-1].sequence != wanted.nodes[-1].sequence:
            done = sum(node.sequence <= self.vehicle.last_sequence for node in leg.nodes)
            longer = Leg(leg.begin, (*leg.ways[:done], *wanted.ways), (*leg.nodes[:done], *wanted.nodes))
            self._send(*longer.without_driven(self.robot.progress.distance))

    def _begin_leg(self, wanted: Leg) -> None:
        """Sends it from where the robot stands."""
        along, off = wanted.foot(self._facts.x, self._facts.y, OFF_EDGE)
        if off > OFF_EDGE and not self._near(wanted.begin):
            end = wanted.nodes[0].id
            self._fail(f"the robot is {off:.2f} m off the path to node {end}, more than {OFF_EDGE:g} m")
            return
        if not wanted.length and self._aligned(wanted.nodes[0]):
            self._traverse()
            return
        if off > OFF_EDGE or not wanted.length:
            wanted, along = _from_here(wanted, self._facts), 0.0
        passed = [end for end in wanted.ends[:-1] if end <= along - self.settings.node_tolerance]
        for _ in passed:  # while this program did not run; follow_path drove them as they were ordered
            self._traverse()
        if not passed:
            self._send(wanted, min(along, wanted.length - REST))

    def _send(self, leg: Leg, begin_at: float) -> None:
        self._leg = leg
        self.robot.drive(leg.path(self.machine.speed), max(0.0, begin_at))

    # messages out

    @property
    def _base_is_short(self) -> bool:
        vehicle = self.vehicle
        if not vehicle.horizon:
            return False
        base, leg = vehicle.base, self._leg
        if not base or leg is None:
            return not base
        left = leg.length - self.robot.progress.distance
        stop = self._facts.linear**2 / (2 * self.machine.deceleration)
        return leg.nodes[-1].sequence == base[-1].sequence and left <= stop + self.settings.base_reserve

    def _publish(self, now: float) -> None:
        vehicle, facts = self.vehicle, self._facts
        if self._driving_error is not None:
            facts = replace(facts, errors=(*facts.errors, self._driving_error))
        facts = replace(facts, errors=(*facts.errors, *self._blocked))
        if self.file_problem:
            error = Error("fileError", self.file_problem, (), "remove files from the disk, or repair the file")
            facts = replace(facts, errors=(*facts.errors, error))
        if now < self._duplicate_until:
            facts = replace(facts, errors=(*facts.errors, DUPLICATE_CLIENT))
        short = self._base_is_short
        known = facts.driving, facts.mode, facts.map_id, facts.stopped, facts.held_by, facts.errors
        key = vehicle.revision, tuple(vehicle.refusals), short, known
        if self._state_due or key != self._sent_key or now - self._state_at >= STATE_PERIOD:
            self._state_due, self._sent_key, self._state_at = False, key, now
            charge = self.settings.unknown_battery_charge
            self._outbox.append(("state", state(vehicle, facts, charge, new_base=short)))
        if self.settings.visualization_rate * (now - self._visualization_at) >= 1:
            self._visualization_at = now
            self._outbox.append(("visualization", visualization(facts)))


def _from_segment(x: float, y: float, a: Facts, b: Facts) -> float:
    """m from a point to the way between two poses."""
    dx, dy = b.x - a.x, b.y - a.y
    size = dx * dx + dy * dy
    share = min(1.0, max(0.0, ((x - a.x) * dx + (y - a.y) * dy) / size)) if size else 0.0
    return math.hypot(x - a.x - share * dx, y - a.y - share * dy)


def _from_here(leg: Leg, facts: Facts) -> Leg:
    """The leg whose first edge, or turn, begins where the robot stands, within the deviation that the master allows."""
    first, here = leg.ways[0], (facts.x, facts.y)
    points = (here, first.points[-1]) if len(first.points) > 1 else (here,)
    return Leg(leg.begin, (replace(first, points=points), *leg.ways[1:]), leg.nodes)
