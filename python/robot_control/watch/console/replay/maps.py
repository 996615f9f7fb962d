"""The maps of a recording: those of the bags beside the log that `record:=true` wrote in the same time."""

import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import genpy
import numpy as np
import rosbag
from nav_msgs.msg import OccupancyGrid

from robot_control.data.run_log import FloatArray
from robot_control.robot.pose import Pose, yaw_of
from robot_control.watch.console.navigation import NoGridError, grid_of

BAGS = "robot_control_*.bag"
"""names that record.py gives"""
MAP, TF = "nav_msgs/OccupancyGrid", "tf2_msgs/TFMessage"
TIMES, POSES, MESSAGE = "map_times", "map_poses", "map_{}"
"""keys of what is found: s of each map; rows of s, x, y, yaw of the map in odom; each map"""
DAMAGED = (rosbag.ROSBagException, genpy.MessageException, OSError, ValueError, KeyError)


def maps_beside(log: Path, begin: float, end: float, odom: str) -> dict[str, np.ndarray[Any, Any]]:
    """All maps of these ROS times, s, with times from `begin` on; `odom`: the name of its frame.

    A damaged bag has the maps that were read before the damage.
    """
    maps: list[tuple[float, bytes]] = []
    poses: list[tuple[float, float, float, float]] = []
    for path in sorted(log.parent.glob(BAGS)):
        try:
            with rosbag.Bag(str(path)) as bag:
                if bag.get_end_time() < begin or bag.get_start_time() > end:
                    continue
                for time, message in _messages(bag):
                    if isinstance(message, bytes):
                        maps.append((time - begin, message))
                    else:
                        poses += [(time - begin, *pose) for pose in _maps_in_odom(message, odom)]
        except DAMAGED:
            continue
    maps.sort()
    poses.sort()
    found = {MESSAGE.format(i): np.frombuffer(message, np.uint8) for i, (_, message) in enumerate(maps)}
    return found | {TIMES: np.array([time for time, _ in maps]), POSES: np.array(poses).reshape(-1, 4)}


def _messages(bag: rosbag.Bag) -> Iterator[tuple[float, Any]]:
    """Time, and the compressed bytes of a map or a message of tf."""
    topics = bag.get_type_and_topic_info().topics
    maps = [name for name, topic in topics.items() if topic.msg_type == MAP and name.endswith("/map")]
    for _, (_, data, *_), time in bag.read_messages(topics=maps, raw=True):
        yield time.to_sec(), zlib.compress(data, 1)
    for _, message, time in bag.read_messages(topics=[name for name, each in topics.items() if each.msg_type == TF]):
        yield time.to_sec(), message


def _maps_in_odom(message: Any, odom: str) -> Iterator[tuple[float, float, float]]:  # noqa: ANN401 (rosbag's own class)
    for each in message.transforms:
        if each.child_frame_id.strip("/") == odom:
            at, yaw = each.transform.translation, yaw_of(each.transform.rotation)
            yield *Pose(0.0, 0.0, 0.0).seen_from(Pose(at.x, at.y, yaw)), -yaw


class Maps:
    """The maps of a recording, by time."""

    def __init__(self, found: Mapping[str, np.ndarray[Any, Any]]) -> None:
        self._times: FloatArray = found[TIMES]
        self._poses: FloatArray = found[POSES]
        self._messages = [found[MESSAGE.format(i)] for i in range(len(self._times))]

    def values(self, at: float) -> dict[str, Any]:
        """As NavigationView.values, s after the begin of the log."""
        number = int(np.searchsorted(self._times, at, side="right"))
        if not number:
            return {"grids": {}}
        known = int(np.searchsorted(self._poses[:, 0], at, side="right"))
        pose = self._poses[known - 1, 1:].tolist() if known else (0.0, 0.0, 0.0)
        return {"grids": {"map": number}, "map": pose}

    def grid(self, name: str, at: float) -> dict[str, Any]:
        """As NavigationView.grid. Raises NoGridError."""
        number = int(np.searchsorted(self._times, at, side="right"))
        if name != "map" or not number:
            raise NoGridError(f"the recording holds no {name}")
        message = OccupancyGrid()
        try:
            message.deserialize(zlib.decompress(self._messages[number - 1].tobytes()))
        except genpy.MessageException as error:
            raise NoGridError(f"{name} cannot be read: {error}") from None
        return grid_of(name, message)
