"""Sends a program's commands to the topic of its source if the robot has a list of command sources, else to
cmd_vel_stamped.

Both topics are advertised. The controller subscribes to its sources alone, and that decides; the other topic stays
silent.
"""

import rospy
from geometry_msgs.msg import TwistStamped

from robot_control.robot.command import Command
from robot_control.robot.robot_kind import running_kind
from robot_control.robot.topic_sender import Sender

PLAIN = "cmd_vel_stamped"


class CommandTopic:
    """Sends to the topic `source` of the program, for instance key_vel."""

    def __init__(self, source: str) -> None:
        self._publishers = [
            rospy.Publisher(name, TwistStamped, queue_size=1, tcp_nodelay=True) for name in (source, PLAIN)
        ]
        self._senders = [Sender(publisher, TwistStamped()) for publisher in self._publishers]
        running_kind()

    @property
    def name(self) -> str:
        """Absolute name of the topic that is used now."""
        return str(self._publishers[self._chosen()].resolved_name)

    def send(self, command: Command, stamp: rospy.Time | None = None) -> None:
        """Sends it, stamped with the time of the request, which is now if it is not given."""
        message = TwistStamped()
        message.header.stamp = rospy.Time.now() if stamp is None else stamp
        message.twist.linear.x, message.twist.linear.y = command.linear, command.lateral
        message.twist.angular.z = command.angular
        self._senders[self._chosen()].send(message)

    @property
    def connected(self) -> bool:
        """True if the controller receives what is sent."""
        return self._reaches(0) or self._reaches(1)

    def _chosen(self) -> int:
        return 0 if self._reaches(0) else 1

    def _reaches(self, number: int) -> bool:
        controller = rospy.resolve_name(running_kind().controller)
        connections = list(self._publishers[number].impl.connections)
        return any(connection.endpoint_id == controller for connection in connections)
