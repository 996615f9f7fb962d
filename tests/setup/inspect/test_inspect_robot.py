"""inspect_robot.py reports and draws robots. Cases that read one are skipped without the built package."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from robot_control.setup.inspect import picture
from robot_control.setup.inspect.picture import draw_robot
from robot_control.setup.inspect.rendering import Part, View, Window, render
from robot_control.setup.inspect.report import WIDTH, report
from robot_control.setup.shapes import ground_height, triangles_in_base

ROOT = Path(__file__).parents[3]
DIFFBOT = ROOT / "urdf/diffbot.urdf"
IDENTITY = np.eye(4).tolist()


def shape(**given):
    healthy = {"link": "link", "joint": "", "type": "box", "in_base": IDENTITY, "radius": 0.0, "length": 0.0}
    return healthy | {"size": [0.4, 0.3, 0.1], "points": [], "triangles": []} | given


def wheel(joint, side, y):
    place = {"joint": joint, "side": side, "centre": [0.0, y, 0.0], "radius": 0.1, "width": 0.04, "sign": 1.0}
    return place | {"inertia": 0.005, "rotor_inertia": 0.0}


def joint(name, **given):
    healthy = {"name": name, "link": f"{name}_link", "role": "wheel", "type": "continuous", "driven": True}
    return healthy | {"effort_limit": 3.5, "velocity_limit": 30.0, "lower": 0.0, "upper": 0.0, "mimicked": ""} | given


@pytest.fixture
def robot():
    return {
        "kind": "wheels",
        "name": "bot",
        "source": "bot.urdf",
        "base_link": "base_link",
        "mass": 12.0,
        "yaw_inertia": 0.5,
        "centre_of_gravity": [-0.06, 0.0, -0.01],
        "wheel_base": 0.5,
        "wheel_base_multiplier": 1.0,
        "effective_wheel_base": 0.5,
        "imu": {"link": "imu_link", "position": [0.05, 0.02, 0.06], "orientation": [0.0, 0.0, 0.0, 1.0]},
        "wheels": [wheel("left", "left", 0.25), wheel("right", "right", -0.25)],
        "casters": [],
        "joints": [joint("left"), joint("right")],
        "shapes": [shape(), shape(type="cylinder", joint="left", radius=0.1, length=0.04)],
        "notes": [],
    }


def volume(triangles):
    return abs(np.einsum("ij,ij->i", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum()) / 6


def test_the_floor_is_under_the_lowest_wheel(robot):
    robot["wheels"][1]["centre"][2] = -0.05
    assert ground_height(robot) == pytest.approx(-0.15)


def test_shapes_have_their_extent():
    box = triangles_in_base(shape())
    assert np.ptp(box.reshape(-1, 3), axis=0) == pytest.approx([0.4, 0.3, 0.1])
    cylinder = triangles_in_base(shape(type="cylinder", radius=0.1, length=0.04)).reshape(-1, 3)
    assert np.ptp(cylinder, axis=0) == pytest.approx([0.2, 0.2, 0.04])
    sphere = triangles_in_base(shape(type="sphere", radius=0.1)).reshape(-1, 3)
    assert np.linalg.norm(sphere, axis=1) == pytest.approx(0.1)


def test_shapes_stand_where_the_robot_has_them():
    pose = np.eye(4)
    pose[:3, 3] = (1, 2, 3)
    assert triangles_in_base(shape(in_base=pose.tolist())).reshape(-1, 3).mean(axis=0) == pytest.approx([1, 2, 3])


def test_a_flat_mesh_has_no_triangles():
    flat = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert triangles_in_base(shape(type="mesh", points=flat)).shape == (0, 3, 3)
    assert volume(triangles_in_base(shape(type="mesh", points=flat, triangles=[[0, 1, 2]]))) == 0


def test_what_is_nearer_hides_what_is_behind():
    square = np.array([[[-1, -1, 0], [1, -1, 0], [1, 1, 0]], [[-1, -1, 0], [1, 1, 0], [-1, 1, 0]]], dtype=float)
    red, blue = Part(square, (1, 0, 0)), Part(square - (0, 0, 1), (0, 0, 1))
    window = Window(-2, 2, -2, 2)
    for parts in ([red, blue], [blue, red]):
        picture = render(parts, View.towards((0, 0, 1)), window, 40)
        assert picture[20, 20, 0] > 0
        assert picture[20, 20, 2] == 0
    below = render([red, blue], View.towards((0, 0, -1)), window, 40)
    assert below[20, 20, 2] > 0
    assert picture[0, 0, 3] == 0  # empty area: transparent


def test_views_have_z_up():
    view = View.towards((0, -1, 0))
    assert view.project(np.array([1.0, 0, 0])) == pytest.approx([1, 0, 0])
    assert view.project(np.array([0, 0, 1.0])) == pytest.approx([0, 1, 0])
    assert View.towards((0, 0, 1)).project(np.array([0, 1.0, 0])) == pytest.approx([0, 1, 0])


def test_the_report_names_every_wheel_with_side_and_size(robot):
    row = next(line for line in report(robot).splitlines() if line.startswith("right "))
    assert row.split()[:8] == ["right", "right", "0.0000", "-0.2500", "0.0000", "0.1000", "0.0400", "forward"]
    assert row.split()[8:] == ["3.5", "30", "0.005"]


def test_the_report_says_what_turns_the_other_way_and_what_is_unknown(robot):
    robot["wheels"][0]["sign"] = -1.0
    robot["joints"][0]["velocity_limit"] = 0.0
    row = next(line for line in report(robot).splitlines() if line.startswith("left "))
    assert "reversed" in row
    assert "unknown" in row


def test_the_report_lists_other_joints_casters_and_an_effective_wheel_base(robot):
    robot["joints"] += [
        joint("lift", role="held", type="prismatic", upper=0.2),
        joint("rocker", role="passive", mimicked="lift"),
    ]
    robot["casters"] = [wheel("swivel", "left", 0.0)]
    robot |= {"wheel_base_multiplier": 1.5, "effective_wheel_base": 0.75}
    text = report(robot)
    assert "0 … 0.2 m" in text
    assert "follows lift" in text
    assert "swivel " in text
    assert "0.5 m × 1.5 = 0.75 m" in text


def test_the_report_names_wheels_without_load(robot):
    said = "left bears no load at rest, on the ground stand skid"
    robot["standing"] = {"lean": 0.0, "carried": 0.5, "unloaded": said}
    assert said in report(robot)
    robot["standing"]["unloaded"] = ""
    assert "load" not in report(robot)


@pytest.mark.parametrize("kind", ["assumed", "repaired", "ignored", "overridden", "suspicious"])
def test_notes_stand_under_their_heading(robot, kind):
    title = {"suspicious": "Warnings"}.get(kind, kind.capitalize())
    assert title not in report(robot)
    robot["notes"] = [{"kind": kind, "element": '<link name="a">', "text": "something " * 30}]
    lines = report(robot).splitlines()
    heading = next(i for i, line in enumerate(lines) if line.startswith(title))
    assert '<link name="a">: something' in lines[heading + 1]
    assert max(map(len, lines)) <= WIDTH


@pytest.mark.parametrize("casters", [0, 1])
def test_a_picture_is_drawn_of_any_robot(robot, casters, tmp_path, monkeypatch):
    monkeypatch.setattr(picture, "PIXELS", 100)
    robot["casters"] = [wheel("swivel", "left", 0.0)] * casters
    robot["wheels"].append(robot["wheels"][1] | {"centre": [0.3, -0.25, 0.0]})
    robot["name"] = ""
    draw_robot(robot, tmp_path / "robot.png")
    assert (tmp_path / "robot.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


def inspect(*arguments):
    pytest.importorskip("robot_control._robot_control", reason="robot_control is not built")
    # -P: not the package beside the script, which has no compiled part
    script = [sys.executable, "-P", str(ROOT / "scripts/inspect_robot.py"), *map(str, arguments)]
    return subprocess.run(script, capture_output=True, text=True, check=False, env=os.environ)


def test_our_own_robot_is_understood(tmp_path):
    done = inspect(DIFFBOT, "--json", "--mjcf", tmp_path / "bot.xml", "--picture", tmp_path / "bot.png")
    assert done.returncode == 0, done.stderr
    robot = json.loads(done.stdout)
    assert [(w["joint"], w["side"]) for w in robot["wheels"]] == [
        ("left_wheel_joint", "left"),
        ("right_wheel_joint", "right"),
    ]
    assert robot["mass"] == pytest.approx(12)
    # The centre of gravity is 0.0603 m behind the axle, the caster 0.25 m.
    assert robot["standing"]["carried"] == pytest.approx(1 - 0.06027 / 0.25, abs=1e-3)
    assert robot["standing"]["lean"] == pytest.approx(0, abs=1e-4)
    assert "<mujoco" in (tmp_path / "bot.xml").read_text()
    assert (tmp_path / "bot.png").stat().st_size > 10_000


@pytest.mark.parametrize("name", ["diffbot", "quadbot"])
def test_a_robot_on_a_floating_joint_is_the_same_robot_with_a_note(name, tmp_path):
    shipped = ROOT / f"urdf/{name}.urdf"
    world = '<link name="world"/><joint name="free" type="floating"><parent link="world"/><child link="base_link"/>'
    (tmp_path / "free.urdf").write_text(shipped.read_text().replace("</robot>", world + "</joint></robot>"))
    models, notes = [], []
    for urdf in (shipped, tmp_path / "free.urdf"):
        done = inspect(urdf, "--json", "--mjcf", tmp_path / "model.xml")
        assert done.returncode == 0, done.stderr
        models.append((tmp_path / "model.xml").read_text())
        notes.append(json.loads(done.stdout)["notes"])
    assert models[0] == models[1]
    (note,) = [note for note in notes[1] if note not in notes[0]]
    assert "the robot as free: base_link is its base" in str(note)


def test_a_refused_robot_is_one_message_and_an_exit_code(tmp_path):
    (tmp_path / "torn.urdf").write_text("<robot")
    done = inspect(tmp_path / "torn.urdf")
    assert done.returncode == 1
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    assert "torn.urdf" in done.stderr


def test_a_robot_that_does_not_stand_is_reported_all_the_same(tmp_path):
    sled = """<link name="sled"><collision><origin xyz="0 0 -0.12"/><geometry><box size="0.6 0.6 0.04"/></geometry>
      </collision></link><joint name="sled" type="fixed"><parent link="base_link"/><child link="sled"/></joint>"""
    (tmp_path / "sled.urdf").write_text(DIFFBOT.read_text().replace("</robot>", sled + "</robot>"))
    done = inspect(tmp_path / "sled.urdf")
    assert done.returncode == 1
    assert "left_wheel_joint" in done.stdout
    assert "refused: " in done.stderr
    assert "wheels carry no load" in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_a_wheel_that_hangs_in_the_air_is_named_with_what_stands_instead(tmp_path):
    # Two of four skids end 2 mm below the wheels, on a diagonal: the robot stands on them and one wheel.
    text = DIFFBOT.read_text()
    skids = ""
    for number, (x, y) in enumerate(((0.2, 0.2), (-0.3, -0.2), (-0.3, 0.2), (0.2, -0.2))):
        skids += f"""<link name="skid_{number}"><collision><geometry><sphere radius="0.02"/></geometry></collision>
          </link><joint name="skid_{number}" type="fixed"><parent link="base_link"/><child link="skid_{number}"/>
          <origin xyz="{x} {y} {-0.082 if number < 2 else -0.08}"/></joint>"""
    (tmp_path / "rocks.urdf").write_text(text.replace("</robot>", skids + "</robot>"))
    done = inspect(tmp_path / "rocks.urdf")
    said = done.stdout + done.stderr
    assert "no load" in said
    assert "skid_0" in said


def test_a_file_that_cannot_be_written_is_one_message(tmp_path):
    done = inspect(DIFFBOT, "--mjcf", tmp_path / "nowhere/bot.xml")
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1


def test_a_picture_in_no_known_format_is_one_message(tmp_path):
    done = inspect(DIFFBOT, "--picture", tmp_path / "bot.jpgg", "--mjcf", tmp_path / "bot.xml")
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1
    assert not (tmp_path / "bot.xml").exists()
