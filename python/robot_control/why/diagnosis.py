"""Derives the one reason why a robot does not move from its known state; no ROS in here."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from enum import Enum

from robot_control.common.roles import HARDWARE_DRIVER, Kind
from robot_control.safety.states import DRIVABLE
from robot_control.safety.zero_request import silent_long_enough

SILENCE = 3.0
"""s; every node reports once per second: after three it is absent, or hangs."""

MOVING = 0.01
"""m/s and rad/s; slower is standing."""


@dataclass(frozen=True)
class Cause:
    """A cause that stopped the robot."""

    name: str
    sentence: str
    remedy: str = ""  # action before the reset
    actor: str = ""  # operator, integrator, technician
    detail: str = ""  # measured value and limit
    first: bool = False  # true if it came first
    active: bool = False  # true if it still holds


@dataclass(frozen=True)
class Safety:
    """The last message of safety_monitor."""

    state: str  # INIT, READY, DRIVE, STOPPING, STOPPED, FAULT
    permit: str  # brake, ramp, drive
    held: float = 0.0  # s in this state
    age: float = 0.0  # s since it was received
    causes: tuple[Cause, ...] = ()
    warnings: tuple[str, ...] = ()
    speed_limit: float = float("inf")  # m/s
    missing: tuple[str, ...] = ()  # missing nodes, or their missing data
    refusal: tuple[str, ...] = ()  # reasons why the last reset was refused
    awaiting_zero: bool = False  # INIT ends with a zero request, or with silence on cmd_vel


@dataclass(frozen=True)
class Report:
    """A node's entry on /diagnostics."""

    message: str = ""
    values: Mapping[str, str] = field(default_factory=dict)
    age: float = 0.0  # s since it was received

    def reasons(self, whose: str) -> dict[str, str]:
        """Name → sentence of the values "whose: name"."""
        start = f"{whose}: "
        return {key.removeprefix(start): text for key, text in self.values.items() if key.startswith(start)}


@dataclass(frozen=True)
class Facts:
    """All facts on which the answer depends."""

    master: str  # URI
    master_answers: bool = True
    namespace: str = "/"
    kind: Kind = field(default_factory=Kind)
    safety: Safety | None = None
    reports: Mapping[str, Report] = field(default_factory=dict)  # by node, below the namespace
    registered: frozenset[str] = frozenset()  # nodes that the master knows, below the namespace
    elsewhere: tuple[str, ...] = ()  # namespaces of other robots
    senders: tuple[str, ...] = ()  # on cmd_vel and cmd_vel_stamped
    clearance_senders: tuple[str, ...] = ()  # on clearance
    limited: tuple[float, float] | None = None  # m/s, rad/s: the command after limits
    measured: tuple[float, float] | None = None  # m/s, rad/s: by odometry
    command_timeout: float = 0.0  # s, cmd_vel_timeout of the running controller; 0: off, or not known

    @property
    def driver(self) -> str:
        """The node of the driver: that of real machines if it is there, else the one that the robot's kind names."""
        here = HARDWARE_DRIVER in self.registered or self.there(HARDWARE_DRIVER)
        return HARDWARE_DRIVER if here else self.kind.driver

    @property
    def controller(self) -> str:
        """The node of the controller."""
        return self.kind.controller

    @property
    def loop(self) -> tuple[str, ...]:
        """The nodes of the loop."""
        return (self.driver, *self.kind.loop[1:])

    def there(self, node: str) -> bool:
        """True if the last report of the node is recent."""
        report = self.reports.get(node)
        return report is not None and report.age < SILENCE

    def received(self) -> Safety | None:
        """The last status of the monitor, unless it is too old to count."""
        fresh = self.safety is not None and self.safety.age < SILENCE
        return self.safety if fresh else None

    def value(self, node: str, key: str) -> str:
        """A value of a node that reports; else empty."""
        return self.reports[node].values.get(key, "") if self.there(node) else ""

    def reasons(self, node: str, whose: str) -> dict[str, str]:
        """The reasons of a node that reports, by name; else empty."""
        return self.reports[node].reasons(whose) if self.there(node) else {}

    def remedies(self, node: str, whose: str) -> dict[str, str]:
        """Name of a reason → its remedy, for those that have one."""
        return self.reasons(node, f"{whose} remedy")

    def not_real_time(self, node: str) -> bool:
        """True if the real-time thread of a node that reports has done what it must not, in the last 10 s."""
        return self.there(node) and "not real-time" in self.reports[node].message

    def commanders(self) -> tuple[str, ...]:
        """Nodes that send commands, as the controller reports; without it, those that are registered."""
        reported = self.value(self.controller, "senders")
        return tuple(reported.split(", ")) if reported else self.senders

    def sources(self) -> dict[str, str]:
        """The state of each command source, by priority; empty if the robot has no list of them."""
        text = self.value(self.controller, "sources")
        return dict(part.split(": ", 1) for part in text.split(", ")) if text else {}

    def path(self, name: str) -> str:
        """The absolute name of a topic or service."""
        return f"{self.namespace.rstrip('/')}/{name}"


class Verdict(Enum):
    """The answer in one word."""

    STOPPED = "stopped"  # something prevents motion
    IDLE = "idle"  # it may move, but no velocity command is received
    MOVING = "moving"


@dataclass(frozen=True)
class Answer:
    """The answer for a user."""

    verdict: Verdict
    headline: str
    actions: tuple[tuple[str, str], ...] = ()  # the role that has to act ("" if any may), and the action
    commands: tuple[str, ...] = ()  # lines for a shell


def judge(facts: Facts) -> Answer:
    """Chooses from all that prevents motion what has to be repaired first."""
    for look in (_no_nodes, _paused, _starting, _stopped, _gate, _no_path, _locked, _controller):
        answer = look(facts)
        if answer is not None:
            return answer
    return _moving(facts)


def missing_nodes(facts: Facts) -> tuple[str, ...]:
    """Missing nodes of the loop; the monitor, which checks their locks, detects them earlier than reports do."""
    safety = facts.received()
    if safety is None:
        return tuple(node for node in facts.loop if not facts.there(node))
    return tuple(node for node in facts.loop if node in safety.missing)


def senders_in_words(facts: Facts) -> str:
    """The publishers of cmd_vel."""
    senders = facts.commanders()
    if not senders:
        return "no node"
    if len(senders) == 1 or facts.sources():
        return ", ".join(senders)
    refused = "many_senders" in facts.reasons(facts.controller, "command")
    consequence = "all are refused" if refused else "each message overrides the one before"
    return f"{', '.join(senders)} ({len(senders)} senders: {consequence})"


def _launch(facts: Facts) -> str:
    namespace = f" __ns:={facts.namespace}" if facts.namespace != "/" else ""
    return f"roslaunch robot_control sim.launch{namespace}"


def _run(facts: Facts, node: str) -> str:
    namespace = f" __ns:={facts.namespace}" if facts.namespace != "/" else ""
    return f"rosrun robot_control {node}{namespace}"


def _no_nodes(facts: Facts) -> Answer | None:
    safety = facts.received()
    if safety is None and not facts.master_answers:
        return Answer(
            Verdict.STOPPED,
            f"There is no ROS master at {facts.master}.",
            (("", "start it with the robot, or set ROS_MASTER_URI to where it runs"),),
            (_launch(facts),),
        )
    absent = missing_nodes(facts)
    if safety is None and len(absent) == len(facts.loop):
        where = "" if facts.namespace == "/" else f" in {facts.namespace}"
        commands = [_launch(facts)]
        commands += [f"rosrun robot_control why.py __ns:={other}" for other in facts.elsewhere]
        others = f"a robot runs in {', '.join(facts.elsewhere)}: run why.py there, or " if facts.elsewhere else ""
        actions = (("", f"{others}start one"),)
        return Answer(Verdict.STOPPED, f"No node of the robot runs{where}.", actions, tuple(commands))
    if safety is None:
        monitor = facts.kind.monitor
        state = "hangs" if monitor in facts.registered and facts.there(monitor) else "does not run"
        return Answer(
            Verdict.STOPPED,
            f"{monitor} {state}: without its permit the gate brakes.",
            (("integrator", f"start {monitor}"),),
            (_run(facts, monitor),),
        )
    return None


def _paused(facts: Facts) -> Answer | None:
    if facts.value(facts.driver, "driver_state") != "paused":
        return None
    return Answer(
        Verdict.STOPPED,
        "The simulation is paused.",
        (("", "let it run"),),
        (f"rosservice call {facts.path(facts.driver)}/set_pause false",),
    )


def _starting(facts: Facts) -> Answer | None:
    safety = facts.received()
    if facts.value(facts.driver, "driver_state") != "starting" or safety is None or safety.causes:
        return None
    waits = facts.value(facts.driver, "suspicious")
    actions = tuple(("technician", line) for line in waits.split(". ") if line)
    return Answer(Verdict.STOPPED, "Not ready: the machine is starting.", actions)


def _stopped(facts: Facts) -> Answer | None:
    safety = facts.received()
    if safety is None or safety.state in DRIVABLE:
        return None
    absent = missing_nodes(facts)
    if safety.awaiting_zero and not safety.causes and not absent:
        senders, silence = facts.commanders(), silent_long_enough(facts.command_timeout)
        return Answer(
            Verdict.STOPPED,
            f"Not ready: it waits for a zero request; stop the sender{silence} or send zero.",
            (("operator", f"publishing on cmd_vel: {senders_in_words(facts)}"),) if senders else (),
        )
    if safety.state == "INIT" or not safety.causes:
        awaited = ", ".join(safety.missing) or "the first cycles"
        return Answer(
            Verdict.STOPPED,
            f"Not ready: the monitor waits: {awaited}.",
            tuple(("integrator", f"start {node}") for node in absent),
            tuple(_run(facts, node) for node in absent),
        )
    causes = sorted(safety.causes, key=lambda cause: not cause.first)
    doing = "Stopping" if safety.state == "STOPPING" else "Stopped"
    measured = f" ({causes[0].detail})" if causes[0].detail else ""
    return Answer(
        Verdict.STOPPED,
        f"{doing}: {causes[0].sentence}{measured}.",
        tuple(_actions(facts, causes, absent)),
        tuple(_commands(facts, causes, absent)),
    )


def _actions(facts: Facts, causes: list[Cause], absent: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    for node in absent:
        yield "integrator", f"start {node}"
    named = set()
    for cause in causes:
        if cause.remedy and cause.remedy not in named:
            named.add(cause.remedy)
            yield cause.actor, cause.remedy
    requested = _requested(facts)
    if requested and facts.senders:
        yield "operator", f"stop {', '.join(facts.senders)}: while a motion is requested, a reset is refused"
    yield "operator", "then call e_stop_reset" if named or absent or requested else "call e_stop_reset"


def _commands(facts: Facts, causes: list[Cause], absent: tuple[str, ...]) -> Iterator[str]:
    for node in absent:
        yield _run(facts, node)
    if any(cause.name == "e_stop_topic" and cause.active for cause in causes):
        yield f"rostopic pub -1 {facts.path('e_stop')} std_msgs/Bool false"
    yield f"rosservice call {facts.path('e_stop_reset')}"


def _gate(facts: Facts) -> Answer | None:
    # These reasons of permit and command only follow from others; a report is a second old, a permit is not.
    theirs = {"permit_brake", "controller_brake", "first_tick", "command_held"}
    reasons = {name: text for name, text in facts.reasons(facts.driver, "gate").items() if name not in theirs}
    if facts.value(facts.driver, "gate_verdict") != "brake" or not reasons:
        return None
    return Answer(
        Verdict.STOPPED,
        f"The gate brakes: {next(iter(reasons.values()))}.",
        tuple(("integrator", text) for name, text in facts.remedies(facts.driver, "gate").items() if name in reasons),
    )


def _no_path(facts: Facts) -> Answer | None:
    safety = facts.received()
    if safety is None or safety.speed_limit >= MOVING or not _requested(facts):
        return None
    remedy = "clear the path, and publish it on clearance in metres"
    if facts.clearance_senders:
        remedy += f": {', '.join(facts.clearance_senders)} {'does' if len(facts.clearance_senders) == 1 else 'do'}"
    return Answer(
        Verdict.STOPPED,
        "The path is not free: clearance leaves it no speed.",
        (("operator", remedy),),
        () if facts.clearance_senders else (f"rostopic pub -1 {facts.path('clearance')} std_msgs/Float64 inf",),
    )


def _locked(facts: Facts) -> Answer | None:
    locked = [state for state in facts.sources().values() if state.startswith("locked by ")]
    if not locked or "commands" in facts.sources().values():
        return None
    return Answer(
        Verdict.STOPPED,
        f"The commands are {locked[0]}: the result is zero.",
        (("operator", "publish false on the topic of this lock, and go on publishing it where it has a timeout"),),
    )


def _controller(facts: Facts) -> Answer | None:
    absent = [node for node in (facts.kind.estimator, facts.controller) if node in missing_nodes(facts)]
    if absent:
        return Answer(
            Verdict.STOPPED,
            f"{' and '.join(absent)} {'do' if len(absent) > 1 else 'does'} not run.",
            tuple(("integrator", f"start {node}") for node in absent),
            tuple(_run(facts, node) for node in absent),
        )
    reasons, remedies = facts.reasons(facts.controller, "command"), facts.remedies(facts.controller, "command")
    for name in ("bad_sensors", "no_state", "no_permit"):
        if name in reasons:
            return Answer(Verdict.STOPPED, f"The controller brakes: {reasons[name]}.", (("", remedies.get(name, "")),))
    revoked = facts.value(facts.controller, "revoked_senders")
    whose = {
        "many_senders": f"{remedies.get('many_senders', '')} of {', '.join(facts.commanders())}",
        "revoked": f"{revoked}: {remedies.get('revoked', '')}",
    }
    for name, action in whose.items():
        if name in reasons and (name != "revoked" or revoked):
            return Answer(Verdict.STOPPED, f"Commands are refused: {reasons[name]}.", (("operator", action),))
    silent = "timed_out" in reasons or "no_command" in reasons
    for name in ("refused", *(["stale"] if silent else []), "timed_out", "no_command"):
        if name not in reasons:
            continue
        text = reasons[name]
        if name == "timed_out" and facts.value(facts.controller, "requested_m_s"):
            text += " and so is taken for zero"
        remedy = remedies.get(name, "")
        if facts.senders:
            remedy = f"look at {', '.join(facts.senders)}: {remedy}"
        return Answer(
            Verdict.IDLE,
            f"It may move, but no velocity command is being received: {text}.",
            (("operator", remedy),),
            () if facts.senders else (f"rosrun robot_control send_cmd.py{_namespace(facts)}",),
        )
    if "holding" in reasons and not _motion_commanded(facts):
        return Answer(
            Verdict.IDLE,
            "It may move, but no command source sends."
            if facts.sources() and "commands" not in facts.sources().values()
            else "It may move, but the command is to stand: cmd_vel is zero.",
            (("operator", f"publishing on cmd_vel: {senders_in_words(facts)}"),),
        )
    return None


def _namespace(facts: Facts) -> str:
    return "" if facts.namespace == "/" else f" __ns:={facts.namespace}"


def _requested(facts: Facts) -> bool:
    return any(facts.value(facts.controller, key) not in {"", "0"} for key in ("requested_m_s", "requested_rad_s"))


def _motion_commanded(facts: Facts) -> bool:
    return facts.limited is not None and max(map(abs, facts.limited)) > MOVING


def speeds(pair: tuple[float, float]) -> str:
    """Both with their units."""
    return f"{pair[0]:.2f} m/s, {pair[1]:.2f} rad/s"


def _moving(facts: Facts) -> Answer:
    safety = facts.received()
    slow = f", no faster than {safety.speed_limit:.2g} m/s" if safety and safety.speed_limit < float("inf") else ""
    suspicious = facts.value(facts.driver, "suspicious")
    if suspicious and _motion_commanded(facts):
        return Answer(
            Verdict.MOVING,
            f"It may not move as commanded: {suspicious}.",
            (("integrator", "look at what touches the ground, and at the <collision> shapes of the links named"),),
            ("rosrun robot_control inspect_robot.py FILE",),
        )
    if facts.measured is not None and max(map(abs, facts.measured)) > MOVING:
        return Answer(Verdict.MOVING, f"It moves: {speeds(facts.measured)}{slow}.")
    if _motion_commanded(facts) and facts.limited is not None:
        return Answer(
            Verdict.MOVING,
            f"It is commanded to move ({speeds(facts.limited)}) and has not begun to{slow}.",
            (("", "if it stays so: look at ground, motors and torque limits"),),
        )
    return Answer(Verdict.IDLE, f"It may move{slow}; nothing stands against it, and no motion is requested.")
