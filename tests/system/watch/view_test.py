"""view.launch on a display without a screen: RViz shows the robot, without an error or a warning in its log.

ROBOT_CONTROL_SCREENSHOT=FILE.png keeps the picture, to be looked at.
"""

import os
import re
import shutil
import signal
import struct
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import rospy
from nav_msgs.msg import Path as PathMessage
from system.system_support import Program, RobotTestCase, nightly, repository, wait_for

WIDTH, HEIGHT = 1280, 900
MUST_RUN = bool(os.environ.get("CI") and os.environ.get("ROBOT_CONTROL_NIGHTLY"))
COMPLAINT = re.compile(r"\[ ?(?:WARN|ERROR|FATAL)\].*")


def missing() -> str:
    """The name of the program that is missing."""
    return next((program for program in ("Xvfb", "rviz") if shutil.which(program) is None), "")


def read_xwd(path: Path) -> np.ndarray:
    """The frame buffer that Xvfb keeps in a file (XWDFile.h, version 7): height × width × RGB."""
    data = path.read_bytes()
    header = struct.unpack(">25I", data[:100])
    size, width, height, bytes_per_line, colours = header[0], header[4], header[5], header[12], header[19]
    pixels = np.frombuffer(data, np.uint8, height * bytes_per_line, size + 12 * colours)
    return pixels.reshape(height, bytes_per_line // 4, 4)[:, :width, 2::-1]


def near(picture: np.ndarray, colour: tuple[int, int, int]) -> int:
    """Number of pixels with this colour."""
    return int((np.abs(picture.astype(int) - colour).max(axis=2) < 40).sum())


class ViewTest(RobotTestCase):
    @nightly
    def test_rviz_shows_the_robot_and_complains_about_nothing(self) -> None:
        absent = missing()
        if absent and not MUST_RUN:
            self.skipTest(f"{absent} is not installed: scripts/setup --view")
        folder = Path(tempfile.mkdtemp(prefix="view-"))
        self.addCleanup(shutil.rmtree, folder)
        reading, writing = os.pipe()
        screen = ["-screen", "0", f"{WIDTH}x{HEIGHT}x24", "-fbdir", str(folder), "-nolisten", "tcp"]
        display = subprocess.Popen(["Xvfb", "-displayfd", str(writing), *screen], pass_fds=[writing])
        self.addCleanup(display.wait)
        self.addCleanup(display.terminate)
        number = os.read(reading, 16).decode().strip()
        log = (folder / "log").open("w")
        self.addCleanup(log.close)
        launch = subprocess.Popen(
            ["roslaunch", "--screen", str(repository() / "launch" / "view.launch"), "state_publisher:=true"],
            env={**os.environ, "DISPLAY": f":{number}", "LIBGL_ALWAYS_SOFTWARE": "1", "XDG_RUNTIME_DIR": str(folder)},
            stdout=log,
            stderr=subprocess.STDOUT,
        )
        self.addCleanup(launch.wait)
        self.addCleanup(launch.send_signal, signal.SIGINT)
        path = rospy.Subscriber("path_wanted", PathMessage)
        self.addCleanup(path.unregister)
        drive = Program("drive_path.py", "circle", "--size", "1.5")
        self.addCleanup(drive.end)
        self.assertEqual(drive.wait(60.0), 0, drive.output)
        picture = np.zeros((1, 1, 3), np.uint8)

        def shown() -> bool:
            nonlocal picture
            self.assertIsNone(launch.poll(), (folder / "log").read_text())
            picture = read_xwd(folder / "Xvfb_screen0")
            return near(picture, (255, 170, 0)) > 50 and near(picture, (80, 160, 255)) > 50

        try:
            wait_for("both paths in the picture", shown, limit=90.0)
            time.sleep(2.0)
            shown()
        finally:
            if os.environ.get("ROBOT_CONTROL_SCREENSHOT"):
                self.save(picture)
        self.assertGreater(near(picture, (77, 230, 102)), 50, "the text of the safety state")
        self.assertEqual(COMPLAINT.findall((folder / "log").read_text()), [])

    @staticmethod
    def save(picture: np.ndarray) -> None:
        import matplotlib.image

        matplotlib.image.imsave(os.environ["ROBOT_CONTROL_SCREENSHOT"], np.ascontiguousarray(picture))
