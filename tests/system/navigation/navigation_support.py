"""The rostests of navigation share a map as message, tf of a known place, scans of a hall, and what was built."""

import math
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import roslib.packages
import rospy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import OccupancyGrid, Odometry
from sensor_msgs.msg import LaserScan
from tf2_msgs.msg import TFMessage

RAYS = 360
PERIOD = 0.1
"""s between two transforms"""


def missing() -> str:
    """The remedy if navigate was not built, or its messages are absent; else empty."""
    try:
        import move_base_msgs.msg  # noqa: F401
    except ImportError:
        return "needs Debian's python3-move-base-msgs: scripts/setup --navigation"
    found = roslib.packages.find_node("robot_control", "navigate")
    return "" if found else "navigate was built without libmove-base-msgs-dev: scripts/setup --navigation"


def missing_mrpt() -> str:
    """The remedy if slam and localization were not built; else empty."""
    found = roslib.packages.find_node("robot_control", "slam")
    return "" if found else "slam was built without MRPT: scripts/setup --navigation"


def message_of(map_: tuple[float, float, float, np.ndarray], frame: str = "map") -> OccupancyGrid:
    """The message of origin x, y [m], resolution [m] and cells."""
    message = OccupancyGrid()
    message.header.frame_id = frame
    message.info.origin.position.x, message.info.origin.position.y, message.info.resolution, cells = map_
    message.info.origin.orientation.w = 1.0
    message.info.height, message.info.width = cells.shape
    message.data = cells.ravel().tolist()
    return message


def transform(parent: str, child: str, x: float = 0.0, stamp: rospy.Time | None = None) -> TransformStamped:
    """`child` lies x m ahead in `parent`, not turned."""
    result = TransformStamped(child_frame_id=child)
    result.header.frame_id, result.header.stamp = parent, stamp or rospy.Time.now()
    result.transform.translation.x, result.transform.rotation.w = x, 1.0
    return result


def scan_of(hall: tuple[float, float, float, float] = (-1.95, 3.95, -1.95, 1.95)) -> LaserScan:
    """Returns the scan of a laser at the origin of the hall: left, right, bottom, top [m]."""
    scan = LaserScan(angle_min=-math.pi, angle_increment=2 * math.pi / RAYS, range_min=0.1, range_max=12.0)
    scan.header.frame_id, scan.header.stamp = "laser_link", rospy.Time.now()
    angles = scan.angle_min + np.arange(RAYS) * scan.angle_increment
    scan.angle_max = float(angles[-1])
    with np.errstate(divide="ignore"):
        walls = [np.where(np.cos(angles) * x > 0, x / np.cos(angles), np.inf) for x in hall[:2]]
        walls += [np.where(np.sin(angles) * y > 0, y / np.sin(angles), np.inf) for y in hall[2:]]
    scan.ranges = np.min(walls, axis=0).tolist()
    return scan


class World:
    """Publishes scan and odom at 10 Hz, as a robot that stands; `change` is applied to each scan."""

    def __init__(self) -> None:
        self.change: Callable[[LaserScan], LaserScan | None] = lambda scan: scan
        self._scan = rospy.Publisher("scan", LaserScan, queue_size=1)
        self._odom = rospy.Publisher("odom", Odometry, queue_size=1)
        self._timer = rospy.Timer(rospy.Duration(0.1), self._publish)

    def _publish(self, _event: object) -> None:
        odom = Odometry(child_frame_id="base_link")
        odom.header.frame_id, odom.header.stamp = "odom", rospy.Time.now()
        odom.pose.pose.orientation.w = 1.0
        self._odom.publish(odom)
        scan = self.change(scan_of())
        if scan is not None:
            self._scan.publish(scan)


class Localised:
    """Publishes that odometry is true: map and odom are the same. `place`: also where the base is in odom, x [m]."""

    def __init__(self, place: float | None = None) -> None:
        self.silent = False
        self.place = place
        self._publisher = rospy.Publisher("tf", TFMessage, queue_size=5)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def end(self) -> None:
        self._ended.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._ended.wait(PERIOD):
            ahead = rospy.Time.now() + rospy.Duration(PERIOD)  # as a localisation does, so that no scan waits for it
            found = [] if self.silent else [transform("map", "odom", stamp=ahead)]
            if self.place is not None:
                found += [transform("odom", "base_link", self.place, ahead)]
            self._publisher.publish(TFMessage(found))


def share(name: str) -> Path:
    """A file of the package."""
    return Path(roslib.packages.get_pkg_dir("robot_control")) / name
