"""scripts/render: from a log to pictures; what is drawn is looked at where EGL is there."""

import ctypes.util
import math
import os
import shutil
import subprocess
import xml.etree.ElementTree as ET
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from robot_control import ClosedLoop
from robot_control.data.render.main import arguments, main, scene_of
from robot_control.data.render.run import moments_of, read_moments
from robot_control.data.render.scene import UNCOLOURED, Scene, colours_of
from robot_control.data.run_log import LogError

ROOT = Path(__file__).parents[3]
MUST_RUN = bool(os.environ.get("CI") and os.environ.get("ROBOT_CONTROL_NIGHTLY"))
needs_egl = pytest.mark.skipif(
    ctypes.util.find_library("EGL") is None and not MUST_RUN, reason="libegl1 is not installed: scripts/setup --render"
)
BLUE = (26, 99, 219)
"""of the path driven"""
COLUMNS = "run,cycle,time,truth_x,truth_y,truth_yaw,truth_tilt,estimate_x,estimate_y,estimate_yaw,estimate_z"
MJCF = """<mujoco><worldbody><geom name="floor" type="plane" size="9 9 1"/><light pos="0 0 4"/>
<body name="box"><joint name="door" type="slide"/><geom size="0.1"/></body>
<body name="base" pos="1 0 0.1" quat="0.7071067811865476 0 0 0.7071067811865476"><joint type="free"/><geom size="0.2"/>
<body name="wheel" pos="0 0.25 0"><joint name="left" axis="0 1 0"/>
<geom name="robot_control/wheel/0" type="ellipsoid" size="0.1 0.1 0.02"/></body></body></worldbody></mujoco>"""


def log_of(rows, columns=COLUMNS):
    """Rows of numbers, in the order of the columns; the rest is NaN."""
    names = columns.split(",")
    table = np.array([[*row, *[math.nan] * (len(names) - len(row))] for row in rows], dtype=float)
    return dict(zip(names, table.T, strict=True))


def straight(seconds, speed=0.5, run=7):
    """A row per millisecond along x."""
    return [(run, n, 1e-3 * n, speed * 1e-3 * n, 0.0, 0.0, 0.0) for n in range(round(1000 * seconds))]


def driven(folder, seconds):
    """The run.bag of a robot that drives so long."""
    loop = ClosedLoop()
    loop.log_into(folder)
    loop.run(seconds, (0.5, 0.0))
    loop.end_log()
    return folder / "run.bag"


def test_moments_are_a_period_apart():
    moments = moments_of(log_of(straight(1.0)), 0.04)
    assert len(moments) == 25
    assert [moment.x for moment in moments] == pytest.approx([0.5 * 0.04 * n for n in range(25)], abs=6e-4)


def test_without_a_true_pose_the_estimate_is_drawn():
    columns = COLUMNS.replace("truth_", "other_")
    rows = [(1, n, 0.1 * n, 9.0, 9.0, 9.0, 9.0, 0.1 * n, 0.5, 0.2) for n in range(3)]
    moments = moments_of(log_of(rows, columns), 0.04)
    assert [(moment.x, moment.y, moment.yaw) for moment in moments] == [(x, 0.5, 0.2) for x in (0.0, 0.1, 0.2)]


def test_height_is_that_of_the_estimate_where_the_robot_tilts_and_none_on_a_plane():
    rows = [(1, n, 0.1 * n, 0, 0, 0, 0.0, 0, 0, 0, 0.1 * n) for n in range(3)]
    assert [moment.z for moment in moments_of(log_of(rows), 0.04)] == [0.0] * 3
    rows[1] = (*rows[1][:6], 0.05, *rows[1][7:])
    assert moments_of(log_of(rows), 0.04)[2].z == pytest.approx(0.2)


def test_a_robot_on_legs_that_stands_up_without_tilting_is_drawn_at_its_height(tmp_path):
    loop = ClosedLoop(urdf=str(ROOT / "urdf" / "quadbot.urdf"))
    loop.log_into(tmp_path)
    loop.run(0.5)
    loop.set_posture("standing")
    loop.run(2.5)
    loop.end_log()
    moments = read_moments(tmp_path / "run.bag", 0.1)
    assert moments[0].z == 0
    assert moments[-1].z == pytest.approx(0.27, abs=0.02)


def test_what_holds_no_pose_is_refused():
    with pytest.raises(LogError, match="no pose"):
        moments_of(log_of([(1, 0, 0.0)]), 0.04)


def test_keyframes_hold_the_joints_in_the_models_order_and_the_pose_by_the_start():
    columns = COLUMNS + ",left_position"
    rows = [(1, 0, 0.0, 2.0, 0.0, 0.0, 0.0, 0, 0, 0, 0, 0.3)]
    moments = moments_of(log_of(rows, columns), 0.04)
    model = ET.fromstring(Scene(MJCF, {}).written(moments, 640, 360))
    (key,) = model.findall("keyframe/key")
    half = math.sqrt(0.5)
    expected = [0.0, 1.0, 2.0, 0.1, half, 0.0, 0.0, half, 0.3]  # door; 2 m ahead of a start towards y; wheel
    assert [float(number) for number in key.get("qpos").split()] == pytest.approx(expected, abs=1e-5)
    wheel = model.find(".//geom[@name='robot_control/wheel/0']")
    assert (wheel.get("type"), wheel.get("size")) == ("cylinder", "0.1 0.02")


def test_a_robot_has_the_colours_of_its_urdf():
    urdf = """<robot name="r"><material name="red"><color rgba="1 0 0 1"/></material>
    <link name="base"><visual><material name="red"/></visual></link>
    <link name="top"><visual><material name="own"><color rgba="0 1 0 1"/></material></visual></link>
    <link name="wheel"><visual><material name="red"><color rgba="0 0 1 1"/></material></visual></link>
    <link name="bare"><visual/></link></robot>"""
    shapes = "".join(
        f'<geom name="robot_control/shape/{i}/{link}" size="0.2"/>' for i, link in enumerate(("top", "bare"))
    )
    moments = moments_of(log_of(straight(0.1)), 0.04)
    text = Scene(MJCF.replace('<geom size="0.2"/>', f'<geom size="0.2"/>{shapes}'), colours_of(urdf)).written(
        moments, 640, 360
    )
    found = {geom.get("name"): geom.get("rgba") for geom in ET.fromstring(text).iter("geom")}
    assert found["robot_control/shape/0/top"] == "0 1 0 1"
    assert found["robot_control/shape/1/bare"] == UNCOLOURED
    assert found["robot_control/wheel/0"] == "0 0 1 1"


@pytest.mark.parametrize(("robot", "links"), [("diffbot", 3), ("quadbot", 17)])
def test_each_link_that_the_simulation_collides_has_the_colour_of_its_urdf(tmp_path, robot, links):
    loop = ClosedLoop(urdf=str(ROOT / "urdf" / f"{robot}.urdf"))
    loop.log_into(tmp_path)
    loop.run(0.2)
    loop.end_log()
    options = arguments([str(tmp_path / "run.bag"), "--urdf", str(ROOT / "urdf" / f"{robot}.urdf")])
    text = scene_of(options).written(read_moments(options.run, 0.1), 640, 360)
    shapes = [
        geom for geom in ET.fromstring(text).iter("geom") if (geom.get("name") or "").startswith("robot_control/")
    ]
    assert len(shapes) >= links
    assert all(geom.get("rgba") != UNCOLOURED for geom in shapes)
    assert len({geom.get("rgba") for geom in shapes}) >= 2


def test_an_unknown_scene_and_a_wrong_size_end_with_a_message(tmp_path, capsys):
    run = str(driven(tmp_path, 0.1))
    with pytest.raises(SystemExit, match="nowhere"):
        main([run, "--scene", "nowhere"])
    with pytest.raises(SystemExit):
        main([run, "--size", "3x3"])
    assert "WIDTHxHEIGHT" in capsys.readouterr().err


@needs_egl
def test_pictures_show_the_robot_in_the_middle_and_its_path(tmp_path):
    run = driven(tmp_path, 4.0)
    main([str(run), "--pictures", "2", "--size", "320x180", "--out", str(tmp_path / "out")])
    for number in (1, 2):
        picture = (255 * matplotlib.image.imread(tmp_path / "out" / f"render_{number}.png")[..., :3]).astype(int)
        assert picture.shape == (180, 320, 3)
        middle = picture[70:110, 130:190].reshape(-1, 3)
        assert (middle[:, 0] > middle[:, 2] + 60).mean() > 0.3  # the amber body
        assert (np.abs(picture - BLUE).max(axis=2) < 80).sum() > 30
    video = tmp_path / "out" / "render.mp4"
    if shutil.which("ffmpeg") is None:
        assert not MUST_RUN
        pytest.skip("ffmpeg is not installed: scripts/setup --render")
    frames = ["-count_frames", "-show_entries", "stream=width,height,nb_read_frames", "-of", "csv=p=0"]
    listed = subprocess.run(["ffprobe", "-v", "error", *frames, str(video)], check=True, capture_output=True, text=True)
    assert listed.stdout.strip() == "320,180,100"
