"""The rules that the measurements of first_steps.py must keep; no ROS in here.

Each check raises StepError with the measurement, its rule and the remedy. `loads` are the loads of the feet in N,
`share` is a quarter of the weight.
"""

from collections.abc import Mapping, Sequence

GREEN = (
    *("package", "build", "core", "realtime_priority", "memory_lock", "can", "device_files", "master", "dead_nodes"),
    *("simulated_time", "command_senders", "duplicate_nodes", "other_master", "log_space"),
)
"""Lines of doctor.py that must have no WARNING; no line at all may have a FAULT"""
HANGS, STANDS = 0.1, 0.4
"""of `share`: the most load of a foot in the air, the least of a foot on the ground"""
TILT = 0.15
"""rad, of a body that hangs, lies or stands level"""
ALONG = 0.5
"""of the ordered turn, which no other joint may reach"""
TURN_ERROR = 0.06
"""rad, of a joint that moves without load"""
SINKING = 0.5
"""rad/s, at which a damped leg may sink after it was let go of"""
SPEED_ERROR = 0.3
"""of the ordered speed, in the mean"""


class StepError(RuntimeError):
    """A step failed; the message names what, where, the value, the rule and the remedy."""


def require(condition: bool, text: str) -> None:  # noqa: FBT001 (as of assert)
    """Raises StepError with the text unless the condition holds."""
    if not condition:
        raise StepError(text)


def hung(loads: Mapping[str, float], share: float) -> None:
    """No foot carries load."""
    rule = f"at most {HANGS * share:.1f} N while the robot hangs: lift it until all feet hang free"
    for foot, load in loads.items():
        require(load <= HANGS * share, f"{foot} carries {load:.1f} N, {rule}")


def stood(loads: Mapping[str, float], share: float) -> None:
    """Every foot carries load."""
    rule = f"at least {STANDS * share:.1f} N while the robot stands: check the zeros of its joints, and the floor"
    for foot, load in loads.items():
        require(load >= STANDS * share, f"{foot} carries {load:.1f} N, {rule}")


def level(roll: float, pitch: float) -> None:
    """The tilt of the body, rad."""
    remedy = "level the body; if it is level, check how the IMU is mounted (robot.imu_link)"
    tilt = f"roll and pitch are {roll:+.2f} and {pitch:+.2f} rad, at most ±{TILT} rad"
    require(abs(roll) <= TILT and abs(pitch) <= TILT, f"{tilt}: {remedy}")


def green(findings: Sequence[Mapping[str, str]]) -> None:
    """The findings of doctor.py --json."""
    missing = set(GREEN) - {each["name"] for each in findings}
    require(not missing, f"doctor.py has no line {', '.join(sorted(missing))}: use the doctor.py of this version")
    for each in findings:
        bad = each["verdict"] == "fault" or (each["verdict"] == "warning" and each["name"] in GREEN)
        require(not bad, f"doctor.py: {each['verdict']} {each['name']}: {each['value']}; remedy: {each['remedy']}")


def charged(causes: Sequence[str], voltage: float | None) -> None:
    """The warnings and causes of safety_status; the voltage of the battery, V, None if it is not measured."""
    low = [each for each in causes if each.startswith("battery_")]
    shown = "" if voltage is None else f": {voltage:.1f} V"
    require(not low, f"the safety monitor reports {', '.join(low)}{shown}: charge the battery")


def pressed(first_cause: str) -> None:
    """The cause of the stop that came first; empty without a stop."""
    require(bool(first_cause), "no stop was latched: check cable, receiver and input of the emergency stop")
    by_hand = first_cause.startswith("e_stop_")
    require(by_hand, f"the stop was latched by {first_cause}, not by an e_stop_… cause: run why.py")


def yielded(fastest: float) -> None:
    """The speed of the fastest joint after all were let go of, rad/s."""
    remedy = "let go of the legs; if they fall by themselves, check the supply of the motors and their damping"
    require(fastest <= SINKING, f"a joint moves at {fastest:.2f} rad/s, at most {SINKING} rad/s: {remedy}")


def moved(names: Sequence[str], index: int, ordered: float, turns: Sequence[float]) -> None:
    """The turns of all joints, rad, while that of `index` was ordered to turn."""
    own, name, least = turns[index], names[index], ALONG * abs(ordered)
    other = max((each for each in range(len(turns)) if each != index), key=lambda each: abs(turns[each]))
    along = f", and {names[other]} moved by {turns[other]:+.3f} rad" if abs(turns[other]) > least else ""
    found = f"{name} moved by {own:+.3f} rad, ordered {ordered:+.3f} rad{along}: "
    exchanged = abs(own) < least and bool(along)
    require(not exchanged, f"{found}exchange their keys in the drive file (zero_joints.py finds exchanged motors)")
    require(abs(own) >= least, f"{found}check the supply of its motor, and that nothing blocks the leg")
    require(own * ordered >= 0, f"{found}it is the wrong direction, change it in the drive file (zero_joints.py)")
    off = abs(own - ordered) > TURN_ERROR
    require(not off, f"{found}at most {TURN_ERROR} rad off, check range, gear, sign of torque and friction")
    require(not along, f"{found}only one joint may move, check supply and linkage of the other one")


def walked(gait: str, used: str, ordered: float, speed: float) -> None:
    """The gait that was ordered and the one in use; the ordered speed and the mean measured one ahead, m/s."""
    require(used == gait, f"the gait is '{used}', ordered '{gait}': read the reasons in leg_state")
    rule = f"at most {100 * SPEED_ERROR:.0f} % off: check the signs of the IMU, the floor and why.py"
    near = abs(speed - ordered) <= SPEED_ERROR * ordered
    require(near, f"{gait}: {speed:.3f} m/s ahead, ordered {ordered:.3f} m/s, {rule}")
