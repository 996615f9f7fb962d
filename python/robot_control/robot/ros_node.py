"""The beginning of a rospy program, and its end."""

import contextlib
import sys
from collections.abc import Callable, Iterator

import rosgraph.names
import rospy
from std_srvs.srv import Trigger, TriggerResponse

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
            what = f"{name}: a node {printable(own)} already runs. Stop it"
            sys.exit(f"{what} (rosnode kill {printable(own)}), or set another name for this one: __name:={name}_2")
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


def serve(name: str, act: Callable[[], str], done: str = "") -> None:
    """A service Trigger that calls `act`, which says why it is refused; empty: it answers `done`."""

    def answer(_request: object) -> TriggerResponse:
        why = act()
        return TriggerResponse(success=not why, message=why or done)

    rospy.Service(name, Trigger, answer)


def _resolved(name: str) -> str:
    """Resolves the name as `init_node` does, with __name and __ns of the command line."""
    given = rosgraph.names.load_mappings(sys.argv).get("__name", name)
    return str(rosgraph.names.ns_join(rosgraph.names.get_ros_namespace(argv=sys.argv), given))
