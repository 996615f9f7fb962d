"""The beginning of a rospy program."""

import sys

import rosgraph.names
import rospy

from robot_control.common.files import printable
from robot_control.common.ros_master import living


def begin_node(name: str, *, anonymous: bool = False) -> None:
    """`rospy.init_node`; ends the program without a traceback where SIGINT or SIGTERM came before it was done.

    A node that lives under this name is not replaced, as the master would: it may be driving the robot, or another
    program relies on it. This one ends with a message instead.
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


def _resolved(name: str) -> str:
    """As `init_node` does, with __name and __ns of the command line."""
    given = rosgraph.names.load_mappings(sys.argv).get("__name", name)
    return str(rosgraph.names.ns_join(rosgraph.names.get_ros_namespace(argv=sys.argv), given))
