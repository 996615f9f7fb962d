"""The pictures of README, of the console or of legs, made of the programs as they are: scripts/pictures."""

from __future__ import annotations

import argparse
import math
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import matplotlib.image
import rosgraph
import rospy
from geometry_msgs.msg import PoseStamped, Quaternion
from nav_msgs.msg import OccupancyGrid, Odometry
from robot_control import ClosedLoop
from robot_control.data.demo.main import run_demo
from robot_control.data.render.main import Film, arguments, scene_of
from robot_control.data.render.mujoco import make_current
from robot_control.data.render.run import read_moments
from robot_control.robot.pose import Pose, pose_of, turned
from robot_control.ui.child import Child, children
from robot_control.ui.program import run

from bench.console.browser import Browser, missing
from bench.console.pictures import main as console_pictures
from bench.console.process import Console, wait_for
from bench.gif import write_gif

DOCS = Path(__file__).resolve().parents[1] / "docs"
SIZE, LEGS_SIZE = (720, 406), (360, 202)
"""px of README's film, and of that of legs"""
RATE, PAGE_RATE, COLOURS = 10, 5, 48
"""pictures per second of the film, and of the page in it, and its colours"""
WALK = slice(2.5, 9.5)
"""s of the walk that are shown, standing up included"""
PLACES = (Pose(2.0, 0.0, 0.0), Pose(1.0, 2.0, math.pi / 2), Pose(2.2, 3.5, 0.0))
"""m, rad: the goals that are driven while the map is made"""
STEP, RADIUS, NEAR = 0.08, 0.2, 0.15
"""m between two pictures of the page; of a turn, at this radius; m from a goal that count as reached"""
LIMIT, PATIENCE = 120.0, 5.0
"""s for a goal; s without motion after which it is sent again"""


def drawn(run: Path, span: slice) -> Iterator[Path]:
    """Pictures of quadbot in these seconds of a log, beside it."""
    options = arguments(
        [str(run), "--urdf", "urdf/quadbot.urdf", "--size", f"{SIZE[0]}x{SIZE[1]}", "--distance", "1.6"]
    )
    moments = [each for each in read_moments(run, 1 / RATE) if span.start <= each.time <= span.stop]
    make_current()
    film = Film(scene_of(options), moments, options)
    for number, picture in enumerate(film.pictures()):
        path = run.parent / f"walk_{number:03}.png"
        matplotlib.image.imsave(path, picture)
        yield path


def walk(folder: Path) -> Iterator[Path]:
    """Pictures of quadbot that stands up and walks, in the demo's run."""
    run_demo(6.0, folder, "quadbot")
    return drawn(folder / "run.bag", WALK)


def legs(folder: Path) -> Iterator[Path]:
    """Pictures of quadbot that stands up, walks, halts and lies down."""
    loop = ClosedLoop(urdf="urdf/quadbot.urdf")
    loop.log_into(folder)
    loop.run(0.5)
    loop.set_posture("standing")
    loop.run(2.5)
    loop.run(4.5, (0.4, 0.3))
    loop.run(1.5)
    loop.set_posture("lying")
    loop.run(2.0)
    loop.end_log()
    return drawn(folder / "run.bag", slice(0.0, 11.0))


def mapping(folder: Path) -> Iterator[Path]:
    """Pictures of the console while a room is mapped and driven: one after each STEP of the robot."""
    with children() as started:
        command = ["roslaunch", "robot_control", "navigation.launch", "scene:=room", "unknown_is_free:=true"]
        started.append(Child(command, folder / "launch.log"))
        wait_for("a master", rosgraph.is_master_online)
        rospy.init_node("pictures", disable_signals=True)
        goals = rospy.Publisher("move_base_simple/goal", PoseStamped, queue_size=1)
        console, browser = Console(), Browser(1280, 720)
        try:
            browser.open(console.address)
            wait_for("a map", lambda: browser.data("model") and goals.get_num_connections() > 0)
            browser.click("hints-close")
            browser.tab("map")
            rospy.wait_for_message("map", OccupancyGrid, LIMIT)
            number, shown = 0, Pose(math.inf, 0.0, 0.0)
            for place in PLACES:
                began, moved = time.monotonic(), 0.0
                while math.dist((shown.x, shown.y), (place.x, place.y)) > NEAR:
                    if time.monotonic() - began > LIMIT:
                        raise TimeoutError(f"the robot did not reach {place}")
                    if time.monotonic() - moved > PATIENCE:  # a goal is given up where the machine is busy
                        goals.publish(goal(place))
                        moved = time.monotonic()
                    pose = pose_of(rospy.wait_for_message("odom", Odometry, LIMIT))
                    way = math.dist((pose.x, pose.y), (shown.x, shown.y)) + RADIUS * abs(turned(pose.yaw - shown.yaw))
                    if way > STEP:
                        path = folder / f"page_{number:03}.png"
                        browser.picture(path)
                        number, shown, moved = number + 1, pose, time.monotonic()
                        yield path
        finally:
            browser.end()
            console.end()


def goal(place: Pose) -> PoseStamped:
    """The message of a goal in the map."""
    message = PoseStamped()
    message.header.frame_id = "map"
    message.pose.position.x, message.pose.position.y = place.x, place.y
    message.pose.orientation = Quaternion(0, 0, math.sin(place.yaw / 2), math.cos(place.yaw / 2))
    return message


def draw_plot(folder: Path, path: Path) -> None:
    """Runs the first program of README, and keeps the plot that it saves."""
    readme = (DOCS.parent / "README.md").read_text()
    program = readme.partition("```python\n")[2].partition("```")[0]
    style = "import matplotlib\nmatplotlib.use('Agg')\nmatplotlib.rcParams['figure.figsize'] = 7.2, 3\n"
    subprocess.run([sys.executable, "-c", style + program], cwd=folder, check=True)
    shutil.copy(folder / "turn.png", path)


def main() -> int:
    """Entry point of scripts/pictures."""
    parser = argparse.ArgumentParser(prog="scripts/pictures", description=__doc__)
    parser.add_argument(
        "what", nargs="?", choices=("readme", "console", "legs"), default="readme", help="default readme"
    )
    parser.add_argument("--out", type=Path, default=DOCS, help="folder (default docs)")
    given = parser.parse_args()
    if missing():
        print(f"scripts/pictures: {missing()}")
        return 2
    given.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="pictures-") as name:
        folder = Path(name)
        os.environ["ROS_HOME"] = str(folder / "ros")
        if given.what == "console":
            return console_pictures(given.out, folder)
        if given.what == "legs":
            film = given.out / "quadbot_walk.gif"
            return finish(film, [*legs(folder)], [(folder / "walk_%03d.png", RATE)], LEGS_SIZE)
        draw_plot(folder, given.out / "first_plot.png")
        pictures = [*walk(folder / "demo"), *mapping(folder)]
        parts = [(folder / "demo" / "walk_%03d.png", RATE), (folder / "page_%03d.png", PAGE_RATE)]
        return finish(given.out / "film.gif", pictures, parts, SIZE)


def finish(film: Path, pictures: list[Path], parts: Sequence[tuple[Path, int]], size: tuple[int, int]) -> int:
    """Writes a film; the exit code."""
    write_gif(film, parts, RATE, size, COLOURS)
    print(f"wrote {film}: {len(pictures)} pictures, {film.stat().st_size / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    run(main)
