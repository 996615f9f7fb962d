"""Writes the description of a skid steer into a given folder."""

from pathlib import Path

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


def write_skid_steer(folder: Path) -> str:
    """Path of the description: 17 kg on four wheels."""
    places = [(side, end, x, y) for side, y in (("left", 1), ("right", -1)) for end, x in (("front", 1), ("rear", -1))]
    wheels = [
        WHEEL.format(name=f"{end}_{side}", radius=RADIUS, x=x * HALF_LENGTH, y=y * HALF_TRACK)
        for side, end, x, y in places
    ]
    path = folder / "skid_steer.urdf"
    path.write_text(BODY + "".join(wheels) + "</robot>")
    return str(path)
