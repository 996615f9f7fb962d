"""The programs of the loop, by role (signals/roles.h). A program names its node and its block of parameters alike.

The controller is a program of the robot's kind. Tools that work with any robot take it from a `Kind`; CONTROLLER is the
one of robots on wheels.
"""

import re
from dataclasses import dataclass

from robot_control._robot_control import signal_names

DRIVER, ESTIMATOR, CONTROLLER, MONITOR, TELEMETRY = (program for _, program in signal_names["Role"])
LOOP = (DRIVER, ESTIMATOR, CONTROLLER, MONITOR)
HARDWARE_DRIVER = "driver"
"""The program of every driver but the simulator's."""
WHEELED, LEGGED = (str(kind) for kind, _ in signal_names["RobotKind"])
"""The kinds of robots (signals/robot_kinds.h)."""
REQUEST_TOPICS = {
    WHEELED: ("cmd_vel", "cmd_vel_stamped"),
    LEGGED: ("cmd_vel", "cmd_vel_stamped", "body_pose", "foot_target", "joint_trajectory"),
}
"""The topics of requests of motion."""
NO_LATERAL = "this robot has wheels and does not move sideways"
NAMES_ON_LEGS = {
    "cmd_vel": "cmd_vel or body_pose",
    "cmd_vel_timeout": "request_timeout",
    CONTROLLER: dict(signal_names["RobotKind"])[LEGGED],
}
"""Words for topic, parameter and program of a robot on wheels → those of a robot on legs (signals/robot_kinds.h)."""


@dataclass(frozen=True)
class Kind:
    """The nodes, joints and components of a robot; before they are known, the nodes of a simulated robot on wheels."""

    name: str = ""  # differential_drive, quadruped; empty: not known yet
    driver: str = DRIVER
    estimator: str = ESTIMATOR
    controller: str = CONTROLLER
    monitor: str = MONITOR
    fault_components: tuple[str, ...] = ()
    fault_kinds: tuple[str, ...] = ()

    @property
    def legged(self) -> bool:
        """True for a robot on legs."""
        return self.name == LEGGED

    @property
    def wheeled(self) -> bool:
        """True for a robot that is known to stand on wheels."""
        return self.name == WHEELED

    @property
    def request_topics(self) -> tuple[str, ...]:
        """The topics of requests of motion; those of a robot on wheels, before the kind is known."""
        return REQUEST_TOPICS.get(self.name, REQUEST_TOPICS[WHEELED])

    @property
    def requests(self) -> str:
        """These topics, in words."""
        return " or ".join(self.request_topics)

    def worded(self, sentence: str) -> str:
        """A sentence of signals/names.h, which names topic, parameter and program of wheels, for this kind."""
        if not self.legged:
            return sentence
        return re.sub(r"\w+", lambda word: NAMES_ON_LEGS.get(word[0], word[0]), sentence)

    @property
    def loop(self) -> tuple[str, ...]:
        """The nodes of the loop."""
        return (self.driver, self.estimator, self.controller, self.monitor)

    def node(self, role: str) -> str:
        """The node of a role: driver, estimator, controller or monitor."""
        return str(getattr(self, role))


class WheelsOnlyError(ValueError):
    """The robot has no wheels, which the tool needs."""


def refuse_legs(kind: Kind, tool: str) -> None:
    """Ends the work of `tool` where the robot stands on legs.

    Raises:
        WheelsOnlyError: it does.
    """
    if kind.legged:
        raise WheelsOnlyError(f"this robot is a {kind.name}: {tool} works on wheels only")
