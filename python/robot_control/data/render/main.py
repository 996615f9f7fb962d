"""scripts/render: PNGs, and where ffmpeg is installed an MP4, of a log."""

import argparse
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import IO, cast

import matplotlib.image

from robot_control import _robot_control
from robot_control.data.render.mujoco import Camera, Picture, Renderer, make_current
from robot_control.data.render.run import Moment, read_moments
from robot_control.data.render.scene import Scene, colours_of
from robot_control.files.files import given_path, one_message, printable, utf8
from robot_control.installed_files import share_file
from robot_control.loop.roles import DRIVER
from robot_control.robot.send_plan import positive
from robot_control.settings.parameter_layers import DEFAULTS
from robot_control.ui.program import run

FRAMES_PER_SECOND = 25
AHEAD = 12
"""moments before and after the present one over which the camera's place is averaged"""
FAR = 6.0
"""the camera's distance over the robot's size"""
AZIMUTH, ELEVATION = 125.0, -24.0
MAX_PIXELS = 4096
"""pixels"""


def scene_of(given: argparse.Namespace) -> Scene:
    """The model that the simulation uses for this robot in this scene, in the colours of the robot in the log."""
    path = share_file(DEFAULTS) if given.params is None else str(given.params)
    values = []
    if given.urdf is not None:
        values.append(("robot.urdf", str(given.urdf.resolve())))
    if given.scene is not None:
        known = not {"/", "."} & set(given.scene)
        scene = share_file(f"urdf/scenes/{given.scene}.xml") if known else str(Path(given.scene).resolve())
        values.append((f"{DRIVER}.scene", scene))
    urdf = str(_robot_control.read_run_header(utf8(given.run))["urdf"])
    return Scene(_robot_control.mjcf(path, values), colours_of(urdf))


class Film:
    """All moments of a run; each is drawn when it is requested."""

    def __init__(self, scene: Scene, moments: Sequence[Moment], given: argparse.Namespace) -> None:
        self._places = [scene.place(moment) for moment in moments]
        self._distance = given.distance or FAR * scene.size
        self._renderer = Renderer(scene.written(moments, *given.size), *given.size)

    def picture(self, number: int) -> Picture:
        """The camera follows the robot, smoothly."""
        reach = min(AHEAD, number, len(self._places) - 1 - number)  # as many moments on both sides
        near = self._places[number - reach : number + reach + 1]
        x, y, z = (sum(parts) / len(near) for parts in zip(*near, strict=True))
        return self._renderer.draw(number, Camera((x, y, z), self._distance, AZIMUTH, ELEVATION))

    def pictures(self) -> Iterator[Picture]:
        """All pictures."""
        return (self.picture(number) for number in range(len(self._places)))


def write_video(film: Film, size: tuple[int, int], path: Path) -> str:
    """Why there is no video; empty if it is written."""
    ffmpeg = shutil.which("ffmpeg")
    if ffmpeg is None:
        return "no MP4: ffmpeg is not installed (apt install ffmpeg)"
    width, height = size
    source = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(FRAMES_PER_SECOND), "-i", "-"]
    result = ["-c:v", "libx264", "-pix_fmt", "yuv420p", "-movflags", "+faststart", str(path)]
    process = subprocess.Popen([ffmpeg, "-y", "-loglevel", "error", *source, *result], stdin=subprocess.PIPE)
    stdin = cast(IO[bytes], process.stdin)
    for picture in film.pictures():
        stdin.write(picture.tobytes())
    stdin.close()
    return "" if process.wait() == 0 else f"no MP4: ffmpeg ended with {process.returncode}"


def size_of(text: str) -> tuple[int, int]:
    """WIDTHxHEIGHT in pixels."""
    width, _, height = text.partition("x")
    try:
        size = int(width), int(height)
    except ValueError:
        size = 0, 0
    if min(size) < 2 or size[0] % 2 or size[1] % 2 or max(size) > MAX_PIXELS:
        raise argparse.ArgumentTypeError(f"{text!r} is not WIDTHxHEIGHT, even numbers of 2 to {MAX_PIXELS}")
    return size


def arguments(given: list[str] | None) -> argparse.Namespace:
    """The command line; ends the program on a wrong one."""
    parser = argparse.ArgumentParser(
        prog="scripts/render",
        description="Draws a run: the robot in its scene, a camera that follows it. Writes render_1.png, render_2.png "
        "… and, where ffmpeg is installed, render.mp4. Needs no display.",
    )
    parser.add_argument("run", type=given_path, help="run.bag of the telemetry (telemetry:=true) or of scripts/demo")
    parser.add_argument("--urdf", type=given_path, help="of the run; default: from the parameter file")
    parser.add_argument("--params", type=given_path, metavar="YAML", help="parameter file of the run")
    parser.add_argument("--scene", help="of the run, as for sim.launch: flat, slope_5deg, bumps …, or an MJCF file")
    parser.add_argument("--out", type=given_path, help="folder for the pictures (default: from the run)")
    parser.add_argument("--pictures", type=int, default=4, help="how many PNGs (default %(default)s)")
    parser.add_argument("--no-video", action="store_true", help="no MP4, also where ffmpeg is installed")
    parser.add_argument("--size", type=size_of, default=(960, 540), metavar="WxH", help="pixels (default 960x540)")
    parser.add_argument("--distance", type=positive, help="m from the camera to the robot (default: by its size)")
    return parser.parse_args(given)


@one_message("scripts/render", OSError, ValueError, RuntimeError)
def main(given: list[str] | None = None) -> None:
    """Entry point."""
    options = arguments(given)
    out = options.out or options.run.parent
    moments = read_moments(options.run, 1 / FRAMES_PER_SECOND)
    scene = scene_of(options)
    out.mkdir(parents=True, exist_ok=True)
    make_current()
    film = Film(scene, moments, options)
    for number in range(1, options.pictures + 1):
        path = out / f"render_{number}.png"
        moment = round((len(moments) - 1) * number / options.pictures)
        matplotlib.image.imsave(path, film.picture(moment))
        print(f"wrote {printable(str(path))} ({moments[moment].time:.1f} s)")
    if not options.no_video:
        refusal = write_video(film, options.size, out / "render.mp4")
        print(refusal or f"wrote {printable(str(out / 'render.mp4'))} ({moments[-1].time - moments[0].time:.0f} s)")


if __name__ == "__main__":
    run(main)
