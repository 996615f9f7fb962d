"""inspect_robot.py says what the start of a loop says, and its first line names the mistake."""

import cmath
import io
import math
import os
import re
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

import pytest

pytest.importorskip("robot_control._robot_control", reason="robot_control is not built")
from robot_control import ClosedLoop
from robot_control._robot_control import DriverError
from robot_control.files.files import fit_for_message
from robot_control.installed_files import share_file
from robot_control.setup.inspect.main import REFUSED, main
from robot_control.setup.inspect.report import report

CASES = Path(os.environ.get("ROBOT_CASES", Path(__file__).parents[4] / "shared/cases"))
PARTS = ("hip", "thigh", "calf")
LEGS = ("front_left", "front_right", "rear_left", "rear_right")
BACKWARD, FORWARD = (-2.7, -0.6), (0.6, 2.7)


def link(name: str, mass: float, collision: str) -> str:
    """Without a mass it has no inertial."""
    inertia = 'ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"'
    inertial = f'<inertial><mass value="{mass}"/><inertia {inertia}/></inertial>' if mass else ""
    return f'<link name="{name}">{inertial}{collision}</link>'


def joint(child: str, parent: str, xyz: str, moves: str) -> str:
    """`moves`: type, axis and what else stands in the element."""
    kind, axis, rest = (*moves.split("|"), "", "")[:3]
    ends = f'<parent link="{parent}"/><child link="{child}"/><origin xyz="{xyz}"/>'
    return f'<joint name="{child}_joint" type="{kind}">{ends}<axis xyz="{axis or "1 0 0"}"/>{rest}</joint>'


def shape(geometry: str, origin: str = "") -> str:
    return f"<collision><origin {origin}/><geometry><{geometry}/></geometry></collision>"


@dataclass
class Dog:
    """A quadruped of 12 kg."""

    axes: tuple[str, ...] = ("1 0 0", "0 1 0", "0 1 0")
    knees: tuple[tuple[float, float], ...] = (BACKWARD,) * 4
    hips: float = 0.8  # the range to either side
    effort: float = 40
    body: str = shape('box size="0.4 0.2 0.1"')
    weightless: str | tuple[str, ...] = ()  # ends of the names of links without an inertial
    fixed: str = ""  # end of the names of joints that do not move

    def urdf(self) -> str:
        text = link("trunk", 6, self.body)
        foot = shape('sphere radius="0.02"', 'xyz="0 0 -0.21"')
        for leg, knee in zip(LEGS, self.knees, strict=True):
            x, y = 0.19 if leg.startswith("front") else -0.19, 0.05 if leg.endswith("left") else -0.05
            places = f"{x} {y} 0", f"0 {1.6 * y} 0", "0 0 -0.21"
            ranges = (-self.hips, self.hips), (-1.5, 3.2), knee
            parent = "trunk"
            for part, xyz, (lower, upper), axis in zip(PARTS, places, ranges, self.axes, strict=True):
                name = f"{leg}_{part}"
                weightless = name.endswith(self.weightless)
                text += link(name, 0 if weightless else 0.5, foot if part == "calf" else "")
                kind = "fixed" if self.fixed and name.endswith(self.fixed) else "revolute"
                limit = f'<limit lower="{lower}" upper="{upper}" effort="{self.effort}" velocity="20"/>'
                text += joint(name, parent, xyz, f"{kind}|{axis}|{limit}")
                parent = name
        return f'<robot name="dog">{text}</robot>'


@dataclass
class Cart:
    """A box on two wheels and a ball."""

    rpy: str = "1.5708 0 0"
    rpy_of_right: str = ""  # as that of the left one
    axis: str = "0 1 0"

    def urdf(self) -> str:
        text = link("base_link", 5, shape('box size="0.4 0.2 0.1"'))
        text += link("ball", 0.1, shape('sphere radius="0.05"')) + joint("ball", "base_link", "-0.15 0 -0.05", "fixed")
        for name, y, rpy in (("left", 0.15, self.rpy), ("right", -0.15, self.rpy_of_right or self.rpy)):
            text += link(name, 0.5, shape('cylinder radius="0.1" length="0.04"', f'rpy="{rpy}"'))
            text += joint(name, "base_link", f"0 {y} 0", f"continuous|{self.axis}")
        return f'<robot name="cart">{text}</robot>'


def refusal_of_the_loop(urdf: Path) -> str:
    try:
        ClosedLoop(urdf=str(urdf))
    except (ValueError, DriverError) as error:
        return fit_for_message(str(error))
    return ""


def refusal_of_inspect(urdf: Path) -> str:
    """The message that the program prints when it refuses the robot; "" if it does not."""
    output, errors = io.StringIO(), io.StringIO()
    with redirect_stdout(output), redirect_stderr(errors):
        try:
            main([str(urdf)])
        except SystemExit as end:
            said = end.code if isinstance(end.code, str) else errors.getvalue()
            return said.rstrip("\n").removeprefix(f"{REFUSED}: ")
    return ""


def turned(degrees: float, *axes: str) -> tuple[str, ...]:
    """These axes, turned about z."""
    turn = cmath.exp(1j * math.radians(degrees))
    pairs = (complex(*map(float, axis.split()[:2])) * turn for axis in axes)
    return tuple(f"{pair.real} {pair.imag} 0" for pair in pairs)


@pytest.mark.skipif(not CASES.is_dir(), reason=f"no folder {CASES}")
@pytest.mark.parametrize("case", sorted(path.name for path in CASES.glob("legs_*.urdf")))
def test_both_agree_on_every_case(case: str) -> None:
    assert refusal_of_inspect(CASES / case) == refusal_of_the_loop(CASES / case)


MISTAKES: dict[str, tuple[Dog | Cart, str]] = {
    "degrees": (Dog(hips=45), "its range of -45 to 45 rad looks like degrees"),
    "one knee against three": (
        Dog(knees=(BACKWARD, BACKWARD, BACKWARD, FORWARD)),
        "rear_right_calf_joint.* allows it to point only forward, but the other three point backward",
    ),
    "left knees against right ones": (
        Dog(knees=(BACKWARD, FORWARD, BACKWARD, FORWARD)),
        "front_right_calf_joint.* only forward, but front_left_calf_joint points backward",
    ),
    "a weak knee": (Dog(effort=4), "the knee .* needs .* N·m for half of the weight"),
    "legs that stay folded": (Dog(knees=((-2.7, -2.2),) * 4), "the leg .* does not reach the ground"),
    "hips about z": (
        Dog(axes=("0 0 1", "0 1 0", "0 1 0")),
        "front_left_hip_joint.*: almost a quadruped: the hip's axis is z, .*front_right_hip_joint",
    ),
    "two joints a leg": (Dog(fixed="hip"), "front_left_calf.*: almost a quadruped: the leg .* has 2 moving joints"),
    "one link without inertial": (
        Dog(weightless="rear_left_thigh"),
        "almost a quadruped: these links have no <inertial> and count as fixed: rear_left_thigh",
    ),
    "legs without inertial": (Dog(weightless=("hip", "thigh", "calf")), "these links have no <inertial>"),
    "axes 6 degrees off": (
        Dog(axes=turned(6, "1 0 0", "0 1 0", "0 1 0")),
        r"front_left_hip_joint.*: its axis is 6° off the lengthwise \(x\) axis of trunk(?s:.*)_left_thigh_joint by 6°",
    ),
    "a body without shape": (Dog(body=""), "a robot on legs lies on its body, but this has no shape"),
    "a cylinder without rpy": (
        Cart(rpy="0 0 0"),
        r'left_joint: its cylinder lies across the axle(?s:.*)Fix: Set rpy="1.5708 0 0" in the <origin>',
    ),
    "one cylinder without rpy": (Cart(rpy_of_right="0 0 0"), "right_joint: its cylinder lies across the axle"),
    "axles 6 degrees off": (
        Cart(axis=turned(6, "0 1 0")[0]),
        r"left_joint: its axis is 6° off the lateral \(y\) axis of base_link",
    ),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_both_name_the_mistake_in_the_first_line(mistake: str, tmp_path: Path) -> None:
    robot, words = MISTAKES[mistake]
    urdf = tmp_path / "robot.urdf"
    urdf.write_text(robot.urdf())
    said = refusal_of_inspect(urdf)
    assert re.search(words, said), said
    assert said == refusal_of_the_loop(urdf)


@pytest.mark.parametrize("robot", [Dog(), Cart()])
def test_both_accept_the_robots_without_a_mistake(robot: Dog | Cart, tmp_path: Path) -> None:
    urdf = tmp_path / "robot.urdf"
    urdf.write_text(robot.urdf())
    assert refusal_of_inspect(urdf) == refusal_of_the_loop(urdf) == ""


def test_a_knee_that_bends_both_ways_follows_the_one_beside_it(tmp_path: Path) -> None:
    urdf = tmp_path / "robot.urdf"
    urdf.write_text(Dog(knees=(BACKWARD, BACKWARD, BACKWARD, (-2.7, 2.7))).urdf())
    assert [leg["bends"] for leg in ClosedLoop(urdf=str(urdf)).robot["legs"]] == ["backward"] * 4


def test_the_centre_of_gravity_is_that_of_each_pose() -> None:
    """Both poses are level. The feet carry nothing while it lies; it stands higher than its legs are short."""
    robot = ClosedLoop(urdf=share_file("urdf/quadbot.urdf")).robot
    lying, standing = (re.findall(r"(\S+) m above the floor, (\w+)", line)[0] for line in centres(report(robot)))
    assert (lying[1], standing[1]) == ("lying", "standing")
    assert float(standing[0]) - float(lying[0]) > 0.15
    assert float(lying[0]) == pytest.approx(robot["centre_of_gravity"][2] - robot["belly"], abs=1e-4)
    assert "e-" not in "".join(centres(report(robot)))


def centres(text: str) -> list[str]:
    return [line for line in text.splitlines() if "above the floor" in line]
