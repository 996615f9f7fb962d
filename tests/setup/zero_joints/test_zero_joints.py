"""zero_joints.py without ROS: zeros that are off by a turn of the rotor, a wrong sign and exchanged motors are found.

A robot of each kind of drive is seen through a wrong drive file. The check of `start_angle` refuses it before any
torque, or the dialogue finds the error. tests/robots/start_angles_test.cpp makes that check with the drivers.
"""

import math
from dataclasses import dataclass, replace
from pathlib import Path

import pytest
import yaml
from robot_control.installed_files import share_file
from robot_control.robot.running_robot import RefusedError
from robot_control.setup.foot_motions import foot_motions
from robot_control.setup.zero_joints.dialog import NotFoundError, Zeroed, find_zeros
from robot_control.setup.zero_joints.drive_file import DriveFileError, read_joints, robot_of, with_values
from robot_control.setup.zero_joints.main import known_angles, parse_options

GEARS = {"damiao": 9.0, "cybergear": 9.0, "ak": 9.0, "moteus": 9.0, "unitree_legged": 6.33}
"""turns of the rotor per turn of the joint"""
LEGS = ("front_left", "front_right", "rear_left", "rear_right")
NAMES = [f"{leg}_{joint}_joint" for leg in LEGS for joint in ("hip", "thigh", "knee")]
LYING = [angle for side in (1, -1, 1, -1) for angle in (side * 0.56, 1.13, -2.7)]
TURN = 0.3


def text_of(drives):
    return Path(share_file(f"config/drives/{drives}.yaml")).read_text()


@dataclass
class Hand:
    """A robot whose joints a user turns as the tool requests, seen through its drives. Motors, signs and offsets are
    the true ones; the file states others.
    """

    joints: list[Zeroed]
    motors: list[int]
    signs: list[int]
    offsets: list[float]

    def __post_init__(self):
        self.true, self.answers = list(LYING), iter([])

    def angles(self):
        """rad, as the driver reports them by the file."""
        motors = [
            sign * (angle - offset) for sign, angle, offset in zip(self.signs, self.true, self.offsets, strict=True)
        ]
        read = (motors[self.motors[index]] for index in range(len(self.joints)))
        return [
            joint.given.direction * motor + joint.given.offset for joint, motor in zip(self.joints, read, strict=True)
        ]

    def line(self, question):
        """Turns the joint that the question names; puts the robot down at the end."""
        self.true = list(LYING)
        for index, joint in enumerate(self.joints):
            self.true[index] += TURN * (f"Turn only {joint.name} " in question)
        return ""

    def yes(self, question):
        return True


def robot_of_kind(drives):
    given = read_joints(text_of(drives), NAMES)
    joints = [Zeroed(*each) for each in zip(NAMES, given, LYING, strict=True)]
    return Hand(joints, list(range(12)), [each.direction for each in given], [each.offset for each in given])


def is_refused_at_start(robot, drives):
    """The verdict of a driver with `start_angle`, before any torque."""
    if drives == "unitree_legged":
        return False
    half = math.pi / GEARS[drives]
    return any(abs(angle - known) > half for angle, known in zip(robot.angles(), LYING, strict=True))


@pytest.mark.parametrize("drives", GEARS)
def test_right_zeros_stay_as_they_are(drives):
    robot = robot_of_kind(drives)
    assert not is_refused_at_start(robot, drives)
    found = find_zeros(robot.joints, robot, robot)
    assert all(found[joint.name]["offset"] == pytest.approx(joint.given.offset) for joint in robot.joints)
    assert not any("direction" in each for each in found.values())


@pytest.mark.parametrize("index", range(12))
@pytest.mark.parametrize("drives", GEARS)
def test_a_zero_that_is_off_by_a_turn_of_the_rotor_is_found(drives, index, capsys):
    robot = robot_of_kind(drives)
    turn = 2 * math.pi / GEARS[drives]
    robot.offsets[index] += turn
    assert is_refused_at_start(robot, drives) or drives == "unitree_legged"
    found = find_zeros(robot.joints, robot, robot)
    assert found[NAMES[index]]["offset"] == pytest.approx(robot.joints[index].given.offset + turn)
    assert ("+1 turn(s) of the rotor" in capsys.readouterr().out) == (drives in ("cybergear", "ak", "moteus"))


@pytest.mark.parametrize("found_by_angle", [True, False], ids=["zero of the motor", "zero in this posture"])
@pytest.mark.parametrize("index", range(12))
@pytest.mark.parametrize("drives", GEARS)
def test_a_wrong_sign_is_found(drives, index, found_by_angle):
    """An offset that was found in the posture with a wrong sign hides it from the angle, but not from the hand."""
    robot = robot_of_kind(drives)
    robot.signs[index] *= -1
    if not found_by_angle:
        given = replace(robot.joints[index].given, offset=2 * LYING[index])
        robot.joints[index] = replace(robot.joints[index], given=given)
    assert is_refused_at_start(robot, drives) == (found_by_angle and drives != "unitree_legged")
    found = find_zeros(robot.joints, robot, robot)[NAMES[index]]
    assert found["direction"] == robot.signs[index]
    assert found["offset"] == pytest.approx(robot.offsets[index], abs=1e-9)


@pytest.mark.parametrize("index", range(12))
@pytest.mark.parametrize("drives", GEARS)
def test_motors_of_exchanged_legs_are_found(drives, index):
    """Left and right hips differ in the angle; all other joints lie alike, which only the hand distinguishes."""
    robot = robot_of_kind(drives)
    other = (index + 3) % 12
    robot.motors[index], robot.motors[other] = other, index
    by_angle = index % 3 == 0 and drives != "unitree_legged"
    assert is_refused_at_start(robot, drives) == by_angle
    with pytest.raises(NotFoundError, match=rf"{NAMES[index]} was turned, and {NAMES[other]} moved") as refused:
        find_zeros(robot.joints, robot, robot)
    assert "exchange their keys bus and node (or motor)" in str(refused.value)


def test_a_joint_that_is_not_confirmed_ends_it():
    robot = robot_of_kind("ak")
    robot.yes = lambda question: "rear_right_knee" not in question
    with pytest.raises(NotFoundError, match="rear_right_knee_joint was not confirmed"):
        find_zeros(robot.joints, robot, robot)


def test_a_joint_is_asked_for_again_until_it_alone_was_turned(capsys):
    robot = robot_of_kind("ak")
    clumsy, ask = iter([0.05, None, TURN]), robot.line

    def line(question):
        ask(question)
        if "front_left_hip" in question:
            share = next(clumsy)
            robot.true = [*LYING] if share is None else [LYING[0] + share, *LYING[1:]]
            robot.true[1] += TURN if share is None else 0
            robot.true[0] += 0.7 * TURN if share is None else 0
        return ""

    robot.line = line
    find_zeros(robot.joints, robot, robot)
    assert capsys.readouterr().out.count("turn only front_left_hip_joint, and further") == 2


@pytest.mark.parametrize("drives", GEARS)
def test_the_file_keeps_its_comments(drives):
    text = text_of(drives)
    values = {name: {"offset": 0.1 * at - 0.5} for at, name in enumerate(NAMES)}
    values[NAMES[3]]["direction"] = -1
    once = with_values(text, values, "dog 7", "2026-12-01")
    assert robot_of(once) == "dog 7"
    tree = yaml.safe_load(once)
    assert all(tree[name]["offset"] == pytest.approx(values[name]["offset"]) for name in NAMES)
    assert tree[NAMES[3]]["direction"] == -1
    assert once.count("#") >= text.count("#") - 1
    again = with_values(once, values, "dog 7", "2026-12-01")
    assert again == once
    changed = set(text.splitlines()) - set(once.splitlines())
    assert all("offset:" in line or "direction:" in line for line in changed), changed


def test_a_block_in_one_line_is_refused():
    with pytest.raises(DriveFileError, match="must be written one per line"):
        with_values("left_joint: {node: 1}\n", {"left_joint": {"offset": 1.0}})


def test_a_file_of_other_joints_is_refused():
    with pytest.raises(DriveFileError, match="no block front_left_hip_joint"):
        read_joints("left_wheel_joint: {node: 1}", NAMES)


def test_angles_come_from_the_drive_file_or_from_a_file_of_their_own(tmp_path):
    given = read_joints(text_of("ak"), NAMES)
    assert known_angles(given, NAMES, None) == LYING
    path = tmp_path / "posture.yaml"
    path.write_text(yaml.safe_dump(dict.fromkeys(NAMES, 0.25)))
    assert known_angles(given, NAMES, path) == [0.25] * 12
    path.write_text(yaml.safe_dump(dict.fromkeys(NAMES[1:], 0.25)))
    with pytest.raises(RefusedError, match="no angle in rad of front_left_hip_joint"):
        known_angles(given, NAMES, path)
    with pytest.raises(RefusedError, match="start_angle of the drive file"):
        known_angles(read_joints(text_of("unitree_legged"), NAMES), NAMES, None)


def test_the_words_follow_from_the_urdf():
    words = foot_motions(share_file("urdf/quadbot.urdf"), LYING, NAMES)
    assert len(words) == 12
    assert all(word.startswith("so that its foot goes ") for word in words)
    assert "axis in the URDF" in foot_motions("no.urdf", LYING, NAMES)[0]


def test_the_command_line():
    assert parse_options(["--robot", "dog 7"]).robot == "dog 7"
    with pytest.raises(SystemExit):
        parse_options(["--unknown"])
