"""A skid steer that starts slowly in a curve, from rest, does not surge when its treads break loose."""

import numpy as np
import pytest
from robot_control import ClosedLoop

RADIUS, HALF_TRACK, HALF_LENGTH = 0.1, 0.19, 0.13  # m
WHEEL = """
  <link name="{name}"><inertial><mass value="0.5"/>
    <inertia ixx="0.0014" ixy="0" ixz="0" iyy="0.0024" iyz="0" izz="0.0014"/></inertial>
    <collision><origin rpy="1.5707963 0 0"/><geometry><cylinder radius="{radius}" length="0.04"/></geometry></collision>
  </link>
  <joint name="{name}_wheel" type="continuous"><parent link="base_link"/><child link="{name}"/>
    <origin xyz="{x} {y} 0"/><axis xyz="0 1 0"/><limit effort="4.5" velocity="20"/></joint>"""
BODY = """<robot name="skid_steer"><link name="base_link">
  <inertial><mass value="15"/><inertia ixx="0.3" ixy="0" ixz="0" iyy="0.4" iyz="0" izz="0.45"/></inertial>
  <collision><geometry><box size="0.4 0.3 0.1"/></geometry></collision></link>"""


@pytest.fixture(scope="module")
def skid_steer(tmp_path_factory) -> str:
    """Path of the description: 17 kg on four wheels."""
    places = [(side, end, x, y) for side, y in (("left", 1), ("right", -1)) for end, x in (("front", 1), ("rear", -1))]
    wheels = [
        WHEEL.format(name=f"{end}_{side}", radius=RADIUS, x=x * HALF_LENGTH, y=y * HALF_TRACK)
        for side, end, x, y in places
    ]
    path = tmp_path_factory.mktemp("robot") / "skid_steer.urdf"
    path.write_text(BODY + "".join(wheels) + "</robot>")
    return str(path)


@pytest.mark.parametrize("command", [(0.05, 0.1), (0.03, -0.05), (-0.1, 0.3)])
def test_starts_in_a_curve_without_a_surge(skid_steer, command):
    loop = ClosedLoop({"mujoco_plant": {"sensor_errors": "data_sheet"}}, urdf=skid_steer)
    assert len(loop.robot["wheels"]) == 4
    loop.run(1.0, (0.0, 0.0))
    cycles = round(0.05 / loop.period)
    for _ in range(2):
        log = loop.run(2.0, command)
        speed = np.convolve(np.sign(command[0]) * log["truth_linear"], np.full(cycles, 1 / cycles), mode="valid")
        assert speed.max() <= 1.05 * abs(command[0]) + 0.005
        assert speed[-1] == pytest.approx(abs(command[0]), rel=0.1)
        loop.run(1.2, (0.0, 0.0))
