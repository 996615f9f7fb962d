"""The beginning of a rospy program, and its end."""

import contextlib
import sys
from collections.abc import Iterator

import rosgraph.names
import rospy

from robot_control.files.files import printable
from robot_control.robot.ros_master import living, require_master
from robot_control.robot.topic_sender import Signals, ended_by_signals


def begin_node(name: str, *, anonymous: bool = False) -> None:
    """`rospy.init_node`; ends the program without a traceback where SIGINT or SIGTERM came before it was done.

    A running node of this name is not replaced, although the master would do so. It may be driving the robot, or
    another program may rely on it. This program ends with a message instead.
    """
    if not anonymous:
        own = _resolved(name)
        if living(own):
            sys.exit(
                f"{name}: a node {printable(own)} runs already. End it (rosnode kill {printable(own)}), or give this "
                f"one a name of its own: __name:={name}_2"
            )
    try:
        rospy.init_node(name, anonymous=anonymous)
    except rospy.exceptions.ROSInitException:
        if not rospy.is_shutdown():
            raise
        sys.exit(0)


@contextlib.contextmanager
def running_node(name: str) -> Iterator[Signals]:
    """A node that lives as long as the block; ends the program with a message where no ROS master answers."""
    require_master()
    begin_node(name)
    with ended_by_signals() as signals:
        yield signals


def _resolved(name: str) -> str:
    """Resolves the name as `init_node` does, with __name and __ns of the command line."""
    given = rosgraph.names.load_mappings(sys.argv).get("__name", name)
    return str(rosgraph.names.ns_join(rosgraph.names.get_ros_namespace(argv=sys.argv), given))
