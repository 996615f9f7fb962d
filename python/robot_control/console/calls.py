"""The calls of a page: services, paths and the simulation, each with the role that it needs."""

from __future__ import annotations

import io
import math
import secrets
import time
from collections.abc import Callable, Mapping
from typing import Any

import rospy
from actionlib_msgs.msg import GoalID
from geometry_msgs.msg import PoseStamped
from std_srvs.srv import SetBool, Trigger

from robot_control.common.roles import CONTROLLER, DRIVER
from robot_control.console.desk import Desk, Page, RefusedError, Role
from robot_control.console.messages import CALLS
from robot_control.msg import FollowPathActionGoal
from robot_control.path.shapes import SHAPES
from robot_control.path.waypoints import PathError, Waypoint, checked, placed, read_csv_text
from robot_control.srv import InjectFault, SetOdometry, SetParameters, Step

CALL_NAMES = tuple(CALLS)
RESET_PAUSE, RESET_WINDOW = 0.5, 10.0
"""s between the two steps of a reset"""
PATH_SERVER = "follow_path"

Arguments = Mapping[str, Any]

ROLES: Mapping[str, Role] = {
    "set_parameters": Role.MAINTAIN,
    "pause": Role.MAINTAIN,
    "step": Role.MAINTAIN,
    "simulation_reset": Role.MAINTAIN,
    "inject_fault": Role.MAINTAIN,
}
"""Others need OPERATE"""
SERVICES: Mapping[str, str] = {
    "reset": "e_stop_reset",
    "reset_odometry": "reset_odometry",
    "set_odometry": "set_odometry",
    "set_parameters": f"{CONTROLLER}/set_parameter_map",
    "path_pause": f"{PATH_SERVER}/pause",
    "path_resume": f"{PATH_SERVER}/resume",
    "path_points": f"{PATH_SERVER}/pause",
    "path_shape": f"{PATH_SERVER}/pause",
    "path_csv": f"{PATH_SERVER}/pause",
    "path_cancel": f"{PATH_SERVER}/pause",
    "pause": f"{DRIVER}/set_pause",
    "step": f"{DRIVER}/step",
    "simulation_reset": f"{DRIVER}/reset",
    "inject_fault": f"{DRIVER}/inject_fault",
}
"""The service without which the call cannot work"""


def against(name: str, page: Page, desk: Desk, services: set[str]) -> str:
    """Why this page cannot make the call now; empty if it can. `services`: those of the robot, by relative name."""
    role = ROLES.get(name, Role.OPERATE)
    if page.role < role:
        return f"needs the role {role.name.lower()}"
    if desk.commander is not page:
        return "take the command first"
    service = SERVICES.get(name, "")
    if service and service not in services:
        program = "follow_path.py" if service.startswith(PATH_SERVER) else service.rpartition("/")[0] or "the robot"
        return f"{program} does not run"
    return ""


class Calls:
    """Makes the calls; each may take seconds, so it is made in a thread of its own."""

    def __init__(self, pose: Callable[[], tuple[float, float, float] | None]) -> None:
        """`pose`: of the robot in odom."""
        self._pose = pose
        self._goals = rospy.Publisher(f"{PATH_SERVER}/goal", FollowPathActionGoal, queue_size=1)
        self._cancel = rospy.Publisher(f"{PATH_SERVER}/cancel", GoalID, queue_size=1)
        self._keys: dict[int, tuple[str, float]] = {}  # page → key of its first step of a reset, and when

    def make(self, page: Page, name: str, given: Arguments) -> str:
        """The answer. Raises RefusedError with the reason of a refusal."""
        plain: Mapping[str, Callable[[], Any]] = {
            "reset_odometry": lambda: _call("reset_odometry", Trigger),
            "set_odometry": lambda: _call("set_odometry", SetOdometry, given["x"], given["y"], given["yaw"]),
            "set_parameters": lambda: _call(f"{CONTROLLER}/set_parameter_map", SetParameters, given["parameters"]),
            "path_pause": lambda: _call(f"{PATH_SERVER}/pause", Trigger),
            "path_resume": lambda: _call(f"{PATH_SERVER}/resume", Trigger),
            "pause": lambda: _call(f"{DRIVER}/set_pause", SetBool, given["on"]),
            "step": lambda: _call(f"{DRIVER}/step", Step, given["cycles"]),
            "simulation_reset": lambda: _call(f"{DRIVER}/reset", Trigger),
            "inject_fault": lambda: _call(f"{DRIVER}/inject_fault", InjectFault, given["component"], given["kind"]),
            "path_cancel": lambda: self._cancel.publish(GoalID()) or "the path was cancelled",
            "path_points": lambda: self._start([Waypoint(x, y) for x, y in given["points"]], given["speed"]),
            "path_shape": lambda: self._start(self._shape(given["shape"], given["size"]), given["speed"]),
            "path_csv": lambda: self._start(_from_csv(given["text"]), given["speed"]),
            "reset_asked": lambda: self._reset_asked(page),
        }
        try:
            return str(plain[name]())
        except PathError as error:
            raise RefusedError(str(error)) from None
        except (rospy.ServiceException, rospy.ROSException, OSError) as error:
            raise RefusedError(f"{name}: {error}") from None

    def confirm_reset(self, page: Page, key: str) -> None:
        """The second step of a reset: it names the key of the first one, and comes neither at once nor late."""
        known, at = self._keys.pop(page.number, ("", 0.0))
        elapsed = time.monotonic() - at
        if not (known and secrets.compare_digest(known, key) and RESET_PAUSE <= elapsed <= RESET_WINDOW):
            raise RefusedError("ask for the reset again, read what stands against it, and confirm within 10 s")

    def forget(self, page: Page) -> None:
        """The page has ended."""
        self._keys.pop(page.number, None)

    def _reset_asked(self, page: Page) -> str:
        key = secrets.token_hex(8)
        self._keys[page.number] = key, time.monotonic()
        return key

    def _shape(self, shape: str, size: float) -> list[Waypoint]:
        pose = self._pose()
        if shape not in SHAPES or pose is None:
            raise RefusedError("no odometry" if pose is None else f"a shape is one of {', '.join(SHAPES)}")
        return placed(SHAPES[shape](size), *pose)

    def _start(self, points: list[Waypoint], speed: float) -> str:
        if not math.isfinite(speed) or speed < 0:
            raise RefusedError("speed must be a number from zero on")
        message = FollowPathActionGoal()
        message.goal_id.stamp = message.header.stamp = rospy.Time.now()
        message.goal_id.id = f"console {secrets.token_hex(4)}"
        message.goal.speed = speed
        message.goal.path.header.frame_id = "odom"
        for point in checked(points):
            pose = PoseStamped()
            pose.pose.position.x, pose.pose.position.y = point.x, point.y
            if point.yaw is not None:
                pose.pose.orientation.z, pose.pose.orientation.w = math.sin(point.yaw / 2), math.cos(point.yaw / 2)
            message.goal.path.poses.append(pose)
        self._goals.publish(message)
        return f"sent: {len(message.goal.path.poses)} points"


def _from_csv(text: str) -> list[Waypoint]:
    return read_csv_text("the file", io.StringIO(text, newline=""))


def _call(name: str, kind: type, *arguments: Any) -> str:  # noqa: ANN401 (of the service)
    answer = rospy.ServiceProxy(name, kind)(*arguments)
    if not answer.success:
        raise RefusedError(answer.message or "refused")
    return str(answer.message) or "done"
