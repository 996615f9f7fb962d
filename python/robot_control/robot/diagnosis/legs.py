"""Explains what a robot on legs that may move does with its requests; no ROS in here."""

from robot_control.robot.diagnosis.answer import Answer, Verdict
from robot_control.robot.diagnosis.state import Facts, speeds

REFUSALS = {"refused": "", "not_standing": "standing", "not_lying": "lying", "out_of_reach": "", "too_steep": ""}
"""Reason why a request is not executed → the posture that it needs."""
LIMITS = ("no_plan", "leg_speed", "speed_limited", "permit_slow", "timed_out", "stale", "met_riser", "reaching")
"""Reasons why a walk differs from what is requested, or ends."""
POSTURES = {"gathering": "the legs move to the lying posture", "rising": "standing up", "lowering": "lying down"}
"""The postures in which it moves by itself, in words."""


def execution(facts: Facts) -> Answer:
    """The answer by the posture and by the reasons why a request is not executed."""
    posture = facts.value(facts.controller, "posture")
    if posture in POSTURES:
        return Answer(Verdict.MOVING, f"Moving: {POSTURES[posture]}.{_ground(facts)}")
    reasons, remedies = facts.reasons(facts.controller, "command"), facts.remedies(facts.controller, "command")
    if posture == "walking":
        known = [name for name in LIMITS if name in reasons]
        why = "".join(f"; {reasons[name]}" for name in known)
        actions = tuple(("operator", remedies[name]) for name in known if remedies.get(name))
        return Answer(Verdict.MOVING, f"Walking{_speed(facts)}{why}.{_ground(facts)}", actions)
    for name, needed in REFUSALS.items():
        if name in reasons:
            to_do = (("operator", remedies.get(name, "")),)
            return Answer(Verdict.IDLE, f"Ready: {reasons[name]}.", to_do, _set_posture(facts, needed))
    if posture == "lying":
        action = ("operator", "call set_posture with 'standing'")
        return Answer(Verdict.IDLE, "Ready: the robot lies.", (action,), _set_posture(facts, "standing"))
    does = {"standing": ": standing", "joints": ": lying, and joint commands are accepted"}.get(posture, "")
    senders = facts.value(facts.controller, "senders")
    requested = f"the robot follows {senders}" if senders else "no motion is requested"
    requested += f"; {reasons['permit_slow']}" if "permit_slow" in reasons else ""
    silent = next((name for name in ("stale", "timed_out") if name in reasons and not senders), "")
    actions = (("operator", remedies[silent]),) if remedies.get(silent) else ()
    return Answer(Verdict.IDLE, f"Ready{does}; {requested}.{_ground(facts)}", actions)


def _speed(facts: Facts) -> str:
    if facts.limited is not None and not any(facts.limited):
        return " in place until its feet are in position, then standing"
    return "" if facts.measured is None else f": {speeds(facts.measured)}"


def _ground(facts: Facts) -> str:
    ground = facts.value(facts.controller, "ground")
    return f" The ground {ground}." if ground else ""


def _set_posture(facts: Facts, posture: str) -> tuple[str, ...]:
    return (f"rosservice call {facts.path('set_posture')} {posture}",) if posture else ()
