"""Samples out of a rosbag: joint_states or wheel odometry, and an IMU topic. Needs no running ROS."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from robot_control.data.estimate.samples import FloatArray, InputError, Robot, Samples, Stream, merged, wheel_joints
from robot_control.data.estimate.wheels import wheel_angles
from robot_control.files.bag_file import BagFile
from robot_control.files.files import listed

JOINT_STATE, ODOMETRY, IMU = "sensor_msgs/JointState", "nav_msgs/Odometry", "sensor_msgs/Imu"
NO_IMU = "none"  # of --imu


@dataclass(frozen=True)
class BagTopics:
    """The topics that hold the samples; None stands for the only topic of the right type."""

    wheels: str | None = None
    imu: str | None = None  # "none": wheels alone
    joints: tuple[str, str] | None = None  # left, right; None: those of the robot
    odometry: str | None = None  # "pose" or "twist"; None: the pose, where it moves


def read_bag(path: Path, robot: Robot, topics: BagTopics) -> Samples:
    """Reads wheels and IMU, by their header stamps.

    Raises:
        InputError: a topic that is not there or of another type, more than one that could be meant.
        BagFileError: no sound bag.
        OSError: it cannot be opened.
    """
    reader = _Reader(path, BagFile(path))
    imu = None if topics.imu == NO_IMU else reader.imu_topic(topics.imu)
    wheels, type_of_wheels = reader.wheel_topic(topics.wheels, robot, topics.joints)
    if type_of_wheels == JOINT_STATE:
        left, right = reader.joints(wheels, robot, topics.joints)
    else:
        left, right = reader.odometry(wheels, robot, topics.odometry)
    streams = [left, right, *([] if imu is None else reader.imu(imu, robot))]
    time_ns, tables = merged(streams)
    gyro, accel = (tables[2], tables[3]) if imu is not None else (None, None)
    known = [None if table is None or np.all(np.isnan(table)) else table for table in (gyro, accel)]
    by_side = [table[:, 0] if table.shape[1] == 1 else table for table in tables[:2]]
    return Samples(time_ns, by_side[0], by_side[1], known[0], known[1], reader.notes, reader.warnings)


class _Reader:
    """The topics of one bag."""

    def __init__(self, path: Path, bag: BagFile) -> None:
        self.notes: list[str] = []
        self.warnings = [bag.cut] if bag.cut else []
        self._path = path
        self._bag = bag
        self._types = bag.topics

    def imu_topic(self, wanted: str | None) -> str | None:
        """The topic of the IMU; None if there is none, which is noted."""
        if wanted is not None:
            return self._known(wanted, (IMU,))
        found = self._of_type(IMU)
        raw = [name for name in found if name.endswith("/data_raw")]
        # REP 145: imu/data is imu/data_raw with an orientation.
        found = [name for name in found if name.removesuffix("data") + "data_raw" not in raw or name in raw]
        if len(found) > 1:
            raise InputError(f"{self._path} has several IMU topics: set --imu to one of {listed(found)}, or none")
        if not found:
            self.notes.append(f"no topic of {IMU}; only the wheels are used")
            return None
        self.notes.append(f"IMU: {found[0]}")
        return found[0]

    def wheel_topic(self, wanted: str | None, robot: Robot, joints: tuple[str, str] | None) -> tuple[str, str]:
        """Topic and type of the wheels. Joint states are preferred to odometry, which may have been fused with another
        sensor already.
        """
        if wanted is not None:
            name = self._known(wanted, (JOINT_STATE, ODOMETRY))
            return name, self._types[name]
        states = self._of_type(JOINT_STATE)
        for candidates, type_of in (
            ([name for name in states if self._names_of(name, robot, joints) is not None], JOINT_STATE),
            (self._of_type(ODOMETRY), ODOMETRY),
        ):
            if len(candidates) > 1:
                others = f"; none of {listed(states)} holds the wheels' positions" if states else ""
                raise InputError(
                    f"{self._path} has several topics of {type_of}: set --wheels to one of "
                    f"{listed(candidates)}{others if type_of == ODOMETRY else ''}"
                )
            if candidates:
                self.notes.append(f"wheels: {candidates[0]}")
                return candidates[0], type_of
        self._refuse_joints(states, robot, joints)
        raise InputError(
            f"{self._path} has no topic of {JOINT_STATE} or {ODOMETRY}; it has "
            f"{listed([f'{name} ({kind})' for name, kind in sorted(self._types.items())]) or 'no topic at all'}"
        )

    def joints(self, topic: str, robot: Robot, joints: tuple[str, str] | None) -> tuple[Stream, Stream]:
        """Angles of the wheels on each side."""
        names = self._names_of(topic, robot, joints)
        if names is None:
            self._refuse_joints([topic], robot, joints)
            raise InputError(f"{self._path}: {topic} contains no message")
        stamps: dict[str, list[int]] = {side: [] for side in names}
        rows: dict[str, list[list[float]]] = {side: [] for side in names}
        for message, stamp in self._messages(topic):
            at = {name: i for i, name in enumerate(message.name)}
            for side, of_side in names.items():  # a driver may send a message per wheel
                if all(name in at and at[name] < len(message.position) for name in of_side):
                    stamps[side].append(stamp)
                    rows[side].append([message.position[at[name]] for name in of_side])
        left, right = (self._stream(topic, stamps[side], rows[side], len(names[side])) for side in ("left", "right"))
        return left, right

    def odometry(self, topic: str, robot: Robot, source: str | None) -> tuple[Stream, Stream]:
        """Wheel angles that give the odometry's motion."""
        stamps, rows = [], []
        for message, stamp in self._messages(topic):
            pose, twist = message.pose.pose, message.twist.twist
            q = pose.orientation
            yaw = np.arctan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
            stamps.append(stamp)
            rows.append([pose.position.x, pose.position.y, float(yaw), twist.linear.x, twist.angular.z])
        ordered = self._stream(topic, stamps, rows, 5)
        angles, used = wheel_angles(ordered, robot, source)
        self.notes.append(f"wheel angles from the {used} of {topic}, by the wheel radius and base that are given here")
        return Stream(ordered.time_ns, angles[:, :1]), Stream(ordered.time_ns, angles[:, 1:])

    def imu(self, topic: str, robot: Robot) -> list[Stream]:
        """Angular velocity and specific force; a first covariance of −1 declares that there is none (REP 145)."""
        stamps, rows = [], []
        frame = ""
        for message, stamp in self._messages(topic):
            rate, force = message.angular_velocity, message.linear_acceleration
            row = [rate.x, rate.y, rate.z, force.x, force.y, force.z]
            if message.angular_velocity_covariance[0] == -1:
                row[:3] = [np.nan] * 3
            if message.linear_acceleration_covariance[0] == -1:
                row[3:] = [np.nan] * 3
            frame = frame or message.header.frame_id
            stamps.append(stamp)
            rows.append(row)
        known = robot["imu"]["link"] or robot["base_link"]
        if frame and frame.lstrip("/") != known:
            self.notes.append(f"{topic} is in the frame {frame}; it is read as the robot's {known}")
        both = self._stream(topic, stamps, rows, 6)
        return [Stream(both.time_ns, both.values[:, :3]), Stream(both.time_ns, both.values[:, 3:])]

    def _messages(self, topic: str) -> Iterator[tuple[Any, int]]:
        """Message and stamp [ns]; a header without stamp is replaced by the time of recording."""
        unstamped = 0
        for message, recorded in self._bag.messages(topic):
            stamp = message.header.stamp.to_nsec()
            if stamp == 0:
                unstamped += 1
                stamp = recorded
            yield message, stamp
        if unstamped > 1:  # simulated time may begin at zero
            self.notes.append(f"{unstamped} messages of {topic} have no stamp; their time of recording is taken")

    def _stream(self, topic: str, stamps: list[int], rows: list[list[float]], width: int) -> Stream:
        if not rows:
            raise InputError(f"{self._path}: {topic} contains no usable message")
        values: FloatArray = np.array(rows, dtype=np.float64).reshape(-1, width)
        stream, back, same = Stream(np.array(stamps, dtype=np.int64), values).ordered()
        if back:
            self.notes.append(f"time ran back {back} times on {topic}; its messages were sorted")
        if same:
            self.notes.append(f"{same} messages of {topic} repeat the stamp of another; the first one counts")
        return stream

    def _of_type(self, type_of: str) -> list[str]:
        return sorted(name for name, kind in self._types.items() if kind == type_of)

    def _known(self, wanted: str, types: tuple[str, ...]) -> str:
        names = [name for name in self._types if name.strip("/") == wanted.strip("/")]
        if names and self._types[names[0]] in types:
            return names[0]
        what = f"is of {self._types[names[0]]}" if names else "is not in it"
        candidates = sorted(name for name, kind in self._types.items() if kind in types)
        why = f"{self._path}: {wanted} {what}; topics of {' or '.join(types)}: {listed(candidates) or 'none at all'}"
        raise InputError(why)

    def _names_of(self, topic: str, robot: Robot, joints: tuple[str, str] | None) -> dict[str, list[str]] | None:
        """The joints of each side whose positions a topic holds; None if some are missing."""
        if joints is not None:
            wanted = {"left": [joints[0]], "right": [joints[1]]}
        else:
            wanted = {side: wheel_joints(robot, side) for side in ("left", "right")}
        return wanted if {*wanted["left"], *wanted["right"]} <= self._positions_in(topic) else None

    def _positions_in(self, topic: str) -> set[str]:
        """Joints with a position in the first messages."""
        joints: set[str] = set()
        for count, (message, _) in enumerate(self._bag.messages(topic)):
            joints |= {name for name, _ in zip(message.name, message.position, strict=False)}
            if count == 100:
                break
        return joints

    def _refuse_joints(self, states: list[str], robot: Robot, joints: tuple[str, str] | None) -> None:
        if not states:
            return
        wanted = list(joints or (*wheel_joints(robot, "left"), *wheel_joints(robot, "right")))
        positions = "; ".join(f"{name}: {listed(sorted(self._positions_in(name))) or 'none'}" for name in states)
        what = f"{self._path}: no topic holds positions of the wheels {listed(wanted)}. Joints with a position"
        raise InputError(f"{what}: {positions}. Name two of them: --joints left=…,right=…")
