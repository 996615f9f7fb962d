"""Derives the one reason why a robot does not move from its known state; no ROS in here."""

from collections.abc import Iterator

from robot_control.robot.diagnosis.answer import RESET, THEN_RESET, Answer, Verdict
from robot_control.robot.diagnosis.lateness import ACTOR, REMEDY, SENTENCE, late
from robot_control.robot.diagnosis.legs import execution
from robot_control.robot.diagnosis.state import Cause, Facts, speeds
from robot_control.robot.safety_states import DRIVABLE
from robot_control.robot.zero_request import silent_long_enough

NAVIGATE = "navigate"
MOVING = 0.01
"""m/s and rad/s; slower is standing."""


def judge(facts: Facts) -> Answer:
    """Chooses from all that prevents motion what has to be repaired first."""
    for rule in (_no_nodes, _paused, _starting, _stopped, _gate, _navigation, _no_path, _locked, _controller):
        answer = rule(facts)
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
    """The publishers of requests."""
    senders = facts.commanders()
    if not senders:
        return "no node"
    if len(senders) == 1 or facts.sources():
        return ", ".join(senders)
    refused = "many_senders" in facts.reasons(facts.controller, "command")
    consequence = "all are refused" if refused else "each message overrides the previous one"
    return f"{', '.join(senders)} ({len(senders)} senders: {consequence})"


def _launch(facts: Facts) -> str:
    return f"roslaunch robot_control sim.launch{_namespace(facts)}"


def _run(facts: Facts, node: str) -> str:
    return f"rosrun robot_control {node}{_namespace(facts)}"


def _to_start(facts: Facts, headline: str, *nodes: str) -> Answer:
    """Nodes are missing."""
    actions = tuple(("integrator", f"start {node}") for node in nodes)
    return Answer(Verdict.STOPPED, headline, actions, tuple(_run(facts, node) for node in nodes))


def _no_nodes(facts: Facts) -> Answer | None:
    safety = facts.received()
    if safety is None and not facts.master_answers:
        to_do = (("", "start it with the robot, or set ROS_MASTER_URI to its address"),)
        return Answer(Verdict.STOPPED, f"No ROS master answers at {facts.master}.", to_do, (_launch(facts),))
    absent = missing_nodes(facts)
    if safety is None and len(absent) == len(facts.loop) and facts.refused:
        why, *more = facts.refused.splitlines()
        actions = tuple(("" if line.startswith("Found: ") else "integrator", line.strip()) for line in more)
        return Answer(Verdict.STOPPED, f"No node of the robot runs. Its start was refused: {why}", actions)
    if safety is None and len(absent) == len(facts.loop):
        where = "" if facts.namespace == "/" else f" in {facts.namespace}"
        commands = [_launch(facts)]
        commands += [f"rosrun robot_control why.py __ns:={other}" for other in facts.elsewhere]
        others = f"a robot runs in {', '.join(facts.elsewhere)}: run why.py there, or " if facts.elsewhere else ""
        actions = (("", f"{others}start one"),)
        return Answer(Verdict.STOPPED, f"No node of the robot runs{where}.", actions, tuple(commands))
    if safety is None:
        monitor = facts.kind.monitor
        state = "does not respond" if monitor in facts.registered and facts.there(monitor) else "does not run"
        return _to_start(facts, f"{monitor} {state}: without its permit, the robot brakes.", monitor)
    return None


def _paused(facts: Facts) -> Answer | None:
    if facts.value(facts.driver, "driver_state") != "paused":
        return None
    commands = (f"rosservice call {facts.path(facts.driver)}/set_pause false",)
    return Answer(Verdict.STOPPED, "The simulation is paused.", (("", "resume the simulation"),), commands)


def _starting(facts: Facts) -> Answer | None:
    safety = facts.received()
    if facts.value(facts.driver, "driver_state") != "starting" or safety is None or safety.causes:
        return None
    suspicious = facts.value(facts.driver, "suspicious")
    actions = tuple(("technician", line) for line in suspicious.split(". ") if line)
    return Answer(Verdict.STOPPED, "Not ready: the hardware is starting.", actions)


def _stopped(facts: Facts) -> Answer | None:
    safety = facts.received()
    if safety is None or safety.state in DRIVABLE:
        return None
    absent = missing_nodes(facts)
    if safety.awaiting_zero and not safety.causes and not absent:
        senders, silence = facts.commanders(), silent_long_enough(facts.command_timeout)
        stop = f"Stop publishing on {facts.kind.requests}{silence}, or publish zero."
        headline = f"Not ready: waiting for a zero velocity command. {stop}"
        actions = (
            (("operator", f"check the senders on {facts.kind.requests}: {senders_in_words(facts)}"),) if senders else ()
        )
        return Answer(Verdict.STOPPED, headline, actions)
    if safety.state == "INIT" or not safety.causes:
        awaited = ", ".join(safety.missing) or "the first cycles"
        return _to_start(facts, f"Not ready: the safety monitor waits for: {awaited}.", *absent)
    causes = sorted(safety.causes, key=lambda cause: not cause.first)
    doing = "Stopping" if safety.state == "STOPPING" else "Stopped"
    measured = f" ({causes[0].detail})" if causes[0].detail else ""
    headline, to_do = f"{doing}: {causes[0].sentence}{measured}.", list(_actions(facts, causes, absent))
    slipped = facts.value(facts.driver, "slipped_s").strip("0.")
    if late(causes[0].name, absent, delayed=facts.busy or bool(slipped)):
        seen = ", ".join(part for part in (f"{causes[0].name}{measured}", facts.load) if part)
        headline = f"{doing}: {SENTENCE}: {seen}."
        to_do.insert(0, (ACTOR, REMEDY))
    return Answer(Verdict.STOPPED, headline, tuple(to_do), tuple(_commands(facts, causes, absent)))


def _actions(facts: Facts, causes: list[Cause], absent: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    for node in absent:
        yield "integrator", f"start {node}"
    named = set()
    for cause in causes:
        if cause.remedy and cause.remedy not in named:
            named.add(cause.remedy)
            yield cause.actor, cause.remedy
    requested = _requested(facts)
    if requested and facts.commanders():
        yield "operator", f"stop {', '.join(facts.commanders())}: a reset is refused while motion is requested"
    yield "operator", THEN_RESET if named or absent or requested else RESET


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
        f"The driver brakes: {next(iter(reasons.values()))}.",
        tuple(("integrator", text) for name, text in facts.remedies(facts.driver, "gate").items() if name in reasons),
    )


def _navigation(facts: Facts) -> Answer | None:
    """A goal in the map waits, or was refused or given up."""
    state = facts.value(NAVIGATE, "goal")
    if state not in {"waiting", "failed"} or _motion_commanded(facts):
        return None
    waiting = state == "waiting"
    verdict, what = (Verdict.STOPPED, "The goal waits") if waiting else (Verdict.IDLE, "The goal failed")
    then = "; the robot then continues" if waiting else ", and send the goal again"
    headline = f"{what}: {facts.reports[NAVIGATE].message}."
    return Answer(verdict, headline, (("operator", f"remove this cause{then}"),))


def _no_path(facts: Facts) -> Answer | None:
    if facts.speed_limit >= MOVING or not _requested(facts):
        return None
    if facts.kind.legged and "permit_slow" not in facts.reasons(facts.controller, "command"):
        return None  # it stands in the pose that is requested
    remedy = "remove the obstacle, and publish the free distance on clearance, in metres"
    if facts.clearance_senders:
        remedy += f": {', '.join(facts.clearance_senders)} {'does' if len(facts.clearance_senders) == 1 else 'do'}"
    headline = "Blocked: the free distance (clearance) is 0."
    commands = () if facts.clearance_senders else (f"rostopic pub -1 {facts.path('clearance')} std_msgs/Float64 inf",)
    return Answer(Verdict.STOPPED, headline, (("operator", remedy),), commands)


def _locked(facts: Facts) -> Answer | None:
    locked = [state for state in facts.sources().values() if state.startswith("locked by ")]
    if not locked or "commands" in facts.sources().values():
        return None
    actions = (("operator", "publish false on the topic of this lock; if it has a timeout, publish it repeatedly"),)
    return Answer(Verdict.STOPPED, f"Blocked: the commands are {locked[0]}; the result is zero.", actions)


def _controller(facts: Facts) -> Answer | None:
    absent = [node for node in (facts.kind.estimator, facts.controller) if node in missing_nodes(facts)]
    if absent:
        return _to_start(facts, f"{' and '.join(absent)} {'do' if len(absent) > 1 else 'does'} not run.", *absent)
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
    return execution(facts) if facts.kind.legged else _without_motion(facts)


def _without_motion(facts: Facts) -> Answer | None:
    """No velocity command is received, or it is zero."""
    reasons, remedies = facts.reasons(facts.controller, "command"), facts.remedies(facts.controller, "command")
    silent = "timed_out" in reasons or "no_command" in reasons
    for name in ("refused", *(["stale"] if silent else []), "timed_out", "no_command"):
        if name not in reasons:
            continue
        text = reasons[name]
        if name == "timed_out" and facts.value(facts.controller, "requested_m_s"):
            text += " and therefore counts as zero"
        remedy = remedies.get(name, "")
        if facts.senders:
            remedy += f" (sender: {', '.join(facts.senders)})"
        headline = f"Ready: no velocity command is received: {text}."
        commands = () if facts.senders else (_run(facts, "send_cmd.py"),)
        return Answer(Verdict.IDLE, headline, (("operator", remedy),), commands)
    if "holding" in reasons and not _motion_commanded(facts):
        return Answer(
            Verdict.IDLE,
            "Ready: no command source sends."
            if facts.sources() and "commands" not in facts.sources().values()
            else "Ready: standstill is commanded; cmd_vel is zero.",
            (("operator", f"check the senders on {facts.kind.requests}: {senders_in_words(facts)}"),),
        )
    return None


def _namespace(facts: Facts) -> str:
    return "" if facts.namespace == "/" else f" __ns:={facts.namespace}"


def _requested(facts: Facts) -> bool:
    """True if motion is requested; of a robot on legs the reports hold only who requests it."""
    if facts.kind.legged:
        return bool(facts.value(facts.controller, "senders"))
    return any(facts.value(facts.controller, key) not in {"", "0"} for key in ("requested_m_s", "requested_rad_s"))


def _motion_commanded(facts: Facts) -> bool:
    return facts.limited is not None and max(map(abs, facts.limited)) > MOVING


def _moving(facts: Facts) -> Answer:
    slow = f", at most {facts.speed_limit:.2g} m/s" if facts.speed_limit < float("inf") else ""
    suspicious = facts.value(facts.driver, "suspicious")
    if suspicious and _motion_commanded(facts):
        actions = (("integrator", "check what touches the ground, and the <collision> shapes of the links named"),)
        commands = ("rosrun robot_control inspect_robot.py FILE",)
        return Answer(Verdict.MOVING, f"Moving, perhaps not as commanded: {suspicious}.", actions, commands)
    if facts.measured is not None and max(map(abs, facts.measured)) > MOVING:
        return Answer(Verdict.MOVING, f"Moving: {speeds(facts.measured)}{slow}.")
    if _motion_commanded(facts) and facts.limited is not None:
        headline = f"Starting: motion is commanded ({speeds(facts.limited)}), but the robot does not move yet{slow}."
        return Answer(Verdict.MOVING, headline, (("", "if this persists: check ground, motors and torque limits"),))
    return Answer(Verdict.IDLE, f"Ready{slow}: no motion is requested.")
