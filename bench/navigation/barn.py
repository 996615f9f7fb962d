"""BARN: 10 m to a goal behind a field of cylinders, without a given map; in virtual time.

Worlds and metric are those of D. Perille, A. Truong, X. Xiao and P. Stone, Benchmarking metric ground navigation, SSRR
2020, doi:10.1109/SSRR50563.2020.9292572, and of its challenges. The optimal time OT is
that of the shortest way at 2 m/s. A drive that takes AT counts OT / clip(AT, 4 OT, 8 OT). One that touches, or takes
longer than 100 s, counts 0. Since 2023 the lower end of the clip is 2 OT.

A field is 30 cells of 0.15 m wide and long. Each cell is filled with a probability of 0.15 … 0.3, and smoothed 2 … 4
times: it is filled with more than 4 filled neighbours and empty with less than 2. A cylinder stands in each filled
cell. Walls of such cylinders are on both sides and behind the start. A field without a way for a robot that takes two
more cells on each side is drawn again. The start is the origin, and the goal counts as reached within 1 m.
"""

from __future__ import annotations

import heapq
import json
import math
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bench.navigation.goals import NEIGHBOURS
from bench.navigation.scene_map import Obstacle
from bench.navigation.tour import DIFFBOT, Machine, Place, Scan, covariance_of
from bench.navigation.trajectories import between, composed
from bench.navigation.virtual import Robot, Trip
from bench.robot_corpus import urdf_of
from bench.rows import Row, Say, bounded
from bench.runs.runner import Processes

GENERATED = 50
ROWS, COLUMNS, FIELD, WALL = 30, 90, (34, 64), 64  # cells
CELL, RADIUS = 0.15, 0.075  # m
ORIGIN = (-2.925, -1.925)  # m, of cell (0, 0)
REACH = 2  # cells on each side of the robot's
FILLS, SMOOTHINGS = (0.15, 0.2, 0.25, 0.3), (2, 3, 4)
GOAL: Place = (10.0, 0.0, 0.0)
AT_GOAL, LIMIT, OPTIMAL = 1.0, 100.0, 2.0  # m, s, m/s
CLIPS = {0.5: 4.0, 1.0: 2.0}  # speed in m/s: lower end in OT

SUCCESSES = {"none": 0.96, "slam": 0.9}
METRICS = {0.5: 0.225, 1.0: 0.36}

Cells = NDArray[np.bool_]


@dataclass(frozen=True)
class Fields:
    """The map ("none", "slam") and the speed in m/s of the robot, and a folder of public worlds."""

    map: str = "none"
    speed: float = 0.5
    worlds: Path | None = None


@dataclass(frozen=True)
class World:
    """A field, and the length of its shortest way in m."""

    name: str
    cylinders: tuple[tuple[float, float], ...]  # m
    length: float


@dataclass(frozen=True)
class Drive:
    """One drive through a world."""

    trip: Trip
    arrived: bool

    @property
    def touched(self) -> bool:
        """True if there was no air left."""
        return self.trip.air <= 0

    @property
    def end(self) -> str:
        """How it ended, in words."""
        if self.touched:
            return "touched"
        return "arrived" if self.arrived else f"{self.trip.state or 'too late'}: {self.trip.reason}"


def generated(seed: int) -> World:
    """The world of this seed."""
    random = np.random.default_rng(seed)
    fill, smoothings = FILLS[seed % len(FILLS)], SMOOTHINGS[seed // len(FILLS) % len(SMOOTHINGS)]
    while True:
        cells = np.zeros((ROWS, COLUMNS), bool)
        cells[:, 0] = cells[0, :WALL] = cells[-1, :WALL] = True
        cells[:, slice(*FIELD)] = _field(random, fill, smoothings)
        length = shortest(cells)
        if math.isfinite(length):
            places = [(ORIGIN[0] + CELL * column, ORIGIN[1] + CELL * row) for row, column in np.argwhere(cells)]
            return World(f"seed {seed}", tuple(places), length)


def _field(random: np.random.Generator, fill: float, smoothings: int) -> Cells:
    cells = random.random((ROWS, FIELD[1] - FIELD[0])) < fill
    cells[0] = cells[-1] = True
    for _ in range(smoothings):
        cells = smoothed(cells)
    return cells


def smoothed(cells: Cells) -> Cells:
    """One step of the rule. Beyond the first and the last row all cells are filled, beyond the other sides none."""
    rows, columns = cells.shape
    around = np.pad(np.pad(cells, ((1, 1), (0, 0)), constant_values=True), ((0, 0), (1, 1))).astype(int)
    shifts = [(down, right) for down in range(3) for right in range(3) if (down, right) != (1, 1)]
    filled = np.sum([around[down : down + rows, right : right + columns] for down, right in shifts], axis=0)
    after: Cells = (filled > 4) | (cells & (filled >= 2))
    return after


def shortest(cells: Cells) -> float:
    """m of the shortest way from start to goal in steps to 8 neighbours; infinite without one."""
    padded, window = np.pad(cells, REACH), range(2 * REACH + 1)
    blocked = np.any([padded[i : i + ROWS, k : k + COLUMNS] for i in window for k in window], axis=0)
    row = round(-ORIGIN[1] / CELL)
    begin, end = (row, round(-ORIGIN[0] / CELL)), (row, round((GOAL[0] - ORIGIN[0]) / CELL))
    steps = [step for step in NEIGHBOURS if step[2] < 2]
    best, queue = {begin: 0.0}, [(0.0, begin)]
    while queue:
        way, at = heapq.heappop(queue)
        if at == end:
            return way * CELL
        if way > best[at]:
            continue
        for down, right, length in steps:
            to = at[0] + down, at[1] + right
            inside = 0 <= to[0] < ROWS and 0 <= to[1] < COLUMNS
            if inside and not blocked[to] and way + length < best.get(to, math.inf):
                best[to] = way + length
                heapq.heappush(queue, (way + length, to))
    return math.inf


def public(folder: Path) -> list[World]:
    """The worlds of the folder: files N.json with `cyl`, the middles of the cylinders, and `length`, both in m.

    Raises:
        RuntimeError: there are none.
    """
    worlds = []
    for path in sorted(folder.glob("*.json"), key=lambda path: (len(path.stem), path.stem)):
        content = json.loads(path.read_text())
        worlds.append(World(path.stem, tuple((x, y) for x, y in content["cyl"]), float(content["length"])))
    if not worlds:
        raise RuntimeError(f"{folder}: no worlds of BARN there, files N.json with `cyl` and `length`")
    return worlds


def scene_of(world: World) -> str:
    """The scene in MJCF."""
    cylinders = "".join(
        f'<geom type="cylinder" size="{RADIUS} 0.5" pos="{x} {y} 0.5" friction="0.5 0.005 0.0001"/>'
        for x, y in world.cylinders
    )
    return (
        '<mujoco><worldbody><geom name="floor" type="plane" size="50 50 1" friction="1.0 0.005 0.0001"/>'
        f'<site name="start" pos="0 0 0"/>{cylinders}</worldbody></mujoco>'
    )


def jackal(folder: Path) -> Machine:
    """The robot of the challenges, from the folder of real robots, with a laser on its front mount: 270°, 10 m.

    Raises:
        FileNotFoundError: there is no description.
    """
    given = Path(urdf_of("jackal"))
    laser = (
        '<link name="laser_link"/><joint name="laser_joint" type="fixed"><parent link="front_mount"/>'
        '<child link="laser_link"/><origin xyz="0 0 0.05"/></joint></robot>'
    )
    text = given.read_text().replace("</robot>", laser).replace("package://", f"file://{given.parent}/")
    path = folder / "jackal.urdf"
    path.write_text(text)
    half = math.radians(135)
    view = {"rays": 720, "angle_min": -half, "angle_max": half, "range_max": 10.0}
    return Machine(str(path), (0.12, 0.0, 0.0), view)


def drive(task: tuple[World, str, float, bool]) -> Drive:
    """One drive: world, map ("none", "slam"), speed in m/s, whether the robot is a Jackal, else diffbot."""
    world, kind, speed, real = task
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "world.xml"
        scene.write_text(scene_of(world))
        obstacles = [Obstacle(x, y, RADIUS, 0.0) for x, y in world.cylinders]
        machine = jackal(Path(folder)) if real else DIFFBOT
        robot = Explorer(scene, obstacles, machine, kind == "slam")
        robot.speed = speed
        trip = robot.drive(GOAL, LIMIT)
        return Drive(trip, robot.arrived)


class Explorer(Robot):
    """A robot without a given map. Its place is that of odometry, or with `slam` that in the map that it makes."""

    MAP_PERIOD = 20
    """scans between two maps: 2 s"""

    def __init__(self, scene: Path, obstacles: list[Obstacle], machine: Machine, slam: bool) -> None:  # noqa: FBT001
        self._mapper, self._scans = None, 0
        if slam:
            from robot_control._mrpt import Mapper  # noqa: PLC0415 (without MRPT the other map runs)

            self._mapper = Mapper()
        super().__init__(scene, obstacles, None, 0, machine)
        self._origin = self._odometry
        self.arrived = False

    def _arrived(self) -> bool:
        """True within 1 m of the goal, by the true place."""
        self.arrived = math.dist(self.place[:2], GOAL[:2]) < AT_GOAL
        return self.arrived

    def _assumed(self) -> Place:
        if self._mapper is None:
            return self._odometry
        since = between(np.array(self._origin), np.array(self._odometry))
        x, y, yaw = composed(np.array(self._mapper.pose), since).tolist()
        return x, y, yaw

    def _locate(self, scan: Scan) -> str:
        if self._mapper is None:
            return ""
        self._mapper.update(scan, self.machine.laser, self._odometry, covariance_of(self._state))
        self._origin = self._odometry
        if self._scans % self.MAP_PERIOD == 0:
            self.navigation.set_map(self._mapper.map, unknown_is_free=True)
        self._scans += 1
        return f"the robot is not localised: {self._mapper.reason}" if self._mapper.reason else ""


def rows_of(worlds: list[World], fields: Fields, say: Say, *, real: bool) -> list[Row]:
    """Rows of these worlds."""
    kind, speed = fields.map, fields.speed
    tasks = [(world, kind, speed, real) for world in worlds]
    drives = list(Processes().outcomes(drive, tasks, say))
    clip, metric = CLIPS[speed], 0.0
    for world, each in zip(worlds, drives, strict=True):
        optimal = world.length / OPTIMAL
        success = each.arrived and not each.touched
        share = optimal / min(max(each.trip.seconds, clip * optimal), 8 * optimal) if success else 0.0
        metric += share / len(worlds)
        say(f"{world.name}: {share:.3f}, {each.trip.seconds:.1f} s, air {each.trip.air:.3f} m, {each.end}")
    name = f"{'jackal' if real else 'diffbot'}, map {kind}, {speed:g} m/s"
    succeeded = sum(each.arrived and not each.touched for each in drives)
    wrong = sum(each.trip.state == "reached" and not each.arrived for each in drives)
    touches = sum(each.touched for each in drives)
    count = f"of {len(worlds)}"
    return [
        bounded(f"lowest share of successes: {name}", succeeded / len(worlds), count, SUCCESSES[kind]),
        bounded(f"touches: {name}", touches, count, 0),
        bounded(f"reached elsewhere: {name}", wrong, count, 0),
        bounded(f"lowest metric: {name}", metric, f"of {1 / clip:g}", METRICS[speed]),
    ]


def barn(first: int, runs: int, fields: Fields, say: Say) -> list[Row]:
    """Rows of the generated worlds, and of those of the folder. A Jackal drives where its description is."""
    try:
        urdf_of("jackal")
        real = True
    except FileNotFoundError as error:
        say(f"diffbot drives: {error}")
        real = False
    worlds = [generated(seed) for seed in range(first, first + runs)]
    rows = [_named(row, "generated") for row in rows_of(worlds, fields, say, real=real)]
    if fields.worlds is not None:
        rows += [_named(row, "public") for row in rows_of(public(fields.worlds), fields, say, real=real)]
    return rows


def _named(row: Row, which: str) -> Row:
    return {**row, "name": f"{row['name']}, {which}"}
