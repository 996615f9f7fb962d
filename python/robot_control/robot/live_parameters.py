"""Parameters of the running controller that set_parameters changes, as it publishes them."""

import rospy
from dynamic_reconfigure.msg import Config

from robot_control.robot.boundary import subscribe
from robot_control.robot.robot_kind import running_kind

MAX_VALUES = 1000
"""far more than a controller has"""


class LiveParameters:
    """The newest parameters; there are none until a message arrives."""

    def __init__(self) -> None:
        self._values: dict[str, float] = {}
        self._subscriber: rospy.Subscriber | None = None
        self._of = ""
        self._follow()

    @property
    def controller(self) -> str:
        """The node whose parameters they are."""
        self._follow()
        return self._of

    def value(self, name: str, default: float) -> float:
        """The value in force, or `default` if it is not known."""
        self._follow()
        return self._values.get(name, default)

    @property
    def command_timeout(self) -> float:
        """s of silence after which a command has ended; 0: never, or not known."""
        return self.value("cmd_vel_timeout", 0.0)

    def _follow(self) -> None:
        """Turns to the controller of the robot's kind once that is known."""
        controller = running_kind().controller
        if controller == self._of:
            return
        if self._subscriber is not None:
            self._subscriber.unregister()
        self._of, self._values = controller, {}
        self._subscriber = subscribe(f"{controller}/parameter_updates", Config, self._receive, queue_size=1)

    def _receive(self, message: Config) -> None:
        values = self._values | {parameter.name: float(parameter.value) for parameter in message.doubles}
        self._values = dict(list(values.items())[:MAX_VALUES])
