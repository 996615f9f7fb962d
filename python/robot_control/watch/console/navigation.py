"""The view of navigation for the page: the grids of map and costmap, and where map, scan and particles are in odom."""

import base64
import math
import threading
import time
from typing import Any

import numpy as np
from geometry_msgs.msg import PoseArray
from nav_msgs.msg import OccupancyGrid, Odometry
from sensor_msgs.msg import LaserScan

from robot_control.drive.path.frames import Tf
from robot_control.drive.path.waypoints import PathError
from robot_control.robot.boundary import Latest, boundary
from robot_control.robot.pose import Pose, yaw_of

MAX_SIDE, MAX_PARTICLES = 1000, 300
"""cells and poses that are sent; a larger grid has coarser cells, of which the fullest counts"""
PERIOD = 0.2
"""s between two looks at tf"""
SILENCE = 2.0
"""s after which a scan or particles are not shown"""


class NoGridError(Exception):
    """There is no such grid; the message says why."""


class NavigationView:
    """The newest messages of navigation."""

    def __init__(self, odometry: Latest) -> None:
        self._odometry = odometry
        self._grids = {"map": Latest("map", OccupancyGrid), "costmap": Latest("costmap", OccupancyGrid)}
        self._scan, self._particles = Latest("scan", LaserScan), Latest("particlecloud", PoseArray)
        self._tf: Tf | None = None
        self._places: dict[str, Any] = {}
        self._map = (0.0, 0.0, 0.0)  # until tf says where it is, so that a place can be set on it
        threading.Thread(target=self._locate, daemon=True).start()

    def values(self) -> dict[str, Any]:
        """`map`: its pose in odom; `scan`, `particles`: points in odom and in the map; `grids`: name → age's mark."""
        marks = {name: grid.newest[1] for name, grid in self._grids.items() if grid.message is not None}
        return {**self._places, "grids": marks}

    def frame(self) -> str:
        """The frame of the map; empty without one."""
        grid = self._grids["map"].message
        return "" if grid is None else str(grid.header.frame_id)

    def grid(self, name: str) -> dict[str, Any]:
        """The newest grid of this name, as grid_of has it. Raises NoGridError."""
        message = self._grids[name].message if name in self._grids else None
        if message is None:
            raise NoGridError("grid not found")
        return grid_of(name, message)

    def _locate(self) -> None:
        while True:
            with boundary.crossing("the view of the map"):
                self._places = self._places_of_now()
            time.sleep(PERIOD)

    def _places_of_now(self) -> dict[str, Any]:
        odometry: Odometry | None = self._odometry.message
        frame = self.frame()
        if odometry is None or not frame:
            return {}
        self._map = self._pose(odometry.header.frame_id, frame) or self._map
        return {"map": self._map} | self._seen(odometry)

    def _pose(self, target: str, source: str) -> tuple[float, float, float] | None:
        self._tf = self._tf or Tf()  # a robot without a map needs none of its many messages
        try:
            pose = self._tf.lookup(target, source).pose
        except PathError:
            return None
        return pose.x, pose.y, pose.yaw

    def _seen(self, odometry: Odometry) -> dict[str, Any]:
        now, seen = time.monotonic(), {}
        scan, particles = (topic.fresh(now, SILENCE) for topic in (self._scan, self._particles))
        if scan is not None:
            laser = self._pose(odometry.header.frame_id, scan.header.frame_id)
            if laser is not None:
                seen["scan"] = points_of(scan, Pose(*laser))
        if particles is not None:
            step = max(1, math.ceil(len(particles.poses) / MAX_PARTICLES))
            seen["particles"] = [(each.position.x, each.position.y) for each in particles.poses[::step]]
        return seen


def grid_of(name: str, message: OccupancyGrid) -> dict[str, Any]:
    """Origin, cell size [m] and cells, row by row, -1 … 100 as bytes in base64. Raises NoGridError."""
    info, cells = message.info, np.asarray(message.data, dtype=np.int8)
    if cells.size != info.width * info.height or not cells.size:
        raise NoGridError(f"{name} has {cells.size} cells, and its width x height are others")
    step = max(1, math.ceil(max(info.width, info.height) / MAX_SIDE))
    rows, columns = (np.arange(0, size, step) for size in (info.height, info.width))
    cells = np.maximum.reduceat(cells.reshape(info.height, info.width), rows, axis=0)
    cells = np.maximum.reduceat(cells, columns, axis=1)
    origin = info.origin
    return {
        "x": origin.position.x,
        "y": origin.position.y,
        "yaw": yaw_of(origin.orientation),
        "resolution": info.resolution * step,
        "columns": cells.shape[1],
        "cells": base64.b64encode(cells.tobytes()).decode(),
    }


def points_of(scan: LaserScan, laser: Pose) -> list[tuple[float, float]]:
    """The ends of the rays that hit, at most 1,000, in the frame of the laser's pose."""
    step = max(1, math.ceil(len(scan.ranges) / 1000))
    ranges = np.asarray(scan.ranges[::step], dtype=float)
    angles = laser.yaw + scan.angle_min + scan.angle_increment * step * np.arange(len(ranges))
    hit = (ranges >= scan.range_min) & (ranges <= scan.range_max)
    points = np.column_stack([laser.x + ranges * np.cos(angles), laser.y + ranges * np.sin(angles)])[hit]
    return [(round(float(x), 3), round(float(y), 3)) for x, y in points]
