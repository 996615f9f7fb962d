"""The beginning of a rospy program."""

import sys

import rospy


def begin_node(name: str, *, anonymous: bool = False) -> None:
    """`rospy.init_node`; ends the program without a traceback where SIGINT or SIGTERM came before it was done."""
    try:
        rospy.init_node(name, anonymous=anonymous)
    except rospy.exceptions.ROSInitException:
        if not rospy.is_shutdown():
            raise
        sys.exit(0)
