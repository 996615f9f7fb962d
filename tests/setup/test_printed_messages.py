"""Programs print what failed, the place, and the remedy for this case."""

import io
import os
import subprocess
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace
from pathlib import Path

import pytest

pytest.importorskip("robot_control._robot_control", reason="robot_control is not built")
from robot_control.drive.drive_path.main import main as drive_path
from robot_control.loop.roles import LOOP
from robot_control.loop.signal_names import bits
from robot_control.robot.diagnosis.state import Facts, Report, Safety
from robot_control.setup.inspect.main import main as inspect
from robot_control.watch.why.screen import Layout, render

ROOT = Path(__file__).parents[2]
INERTIA = '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/>'


def wheel(name: str, xyz: str, kind: str = "continuous", shape: str = '<cylinder radius="0.1" length="0.04"/>') -> str:
    collision = f'<collision><origin rpy="1.5708 0 0"/><geometry>{shape}</geometry></collision>'
    link = f'<link name="{name}"><inertial><mass value="0.5"/>{INERTIA}</inertial>{collision}</link>\n'
    ends = f'<parent link="base_link"/><child link="{name}"/><origin xyz="{xyz}"/><axis xyz="0 1 0"/>'
    return f'{link}<joint name="{name}_joint" type="{kind}">{ends}</joint>\n'


def robot(*parts: str) -> str:
    base = f'<link name="base_link"><inertial><mass value="5"/>{INERTIA}</inertial>'
    box = '<collision><geometry><box size="0.4 0.2 0.1"/></geometry></collision></link>\n'
    return f'<robot name="cart">\n{base}{box}{"".join(parts)}</robot>\n'


def printed(program, *arguments: str) -> str:
    """The message with which a program ends."""
    errors = io.StringIO()
    with redirect_stdout(io.StringIO()), redirect_stderr(errors), pytest.raises(SystemExit) as end:
        program(list(arguments))
    return end.value.code if isinstance(end.value.code, str) else errors.getvalue()


LEFT, RIGHT = wheel("left", "0 0.2 0"), wheel("right", "0 -0.2 0")
RING = '<link name="a"/><link name="b"/>' + "".join(
    f'<joint name="{one}{other}" type="fixed"><parent link="{one}"/><child link="{other}"/></joint>'
    for one, other in ("ab", "ba")
)
WIDE = "Found: left_joint and right_joint are not on one axle: x is 0.1 and 0 m. Candidates: "
DESCRIPTIONS = {
    "a file that is cut off": (
        robot(LEFT, RIGHT).split("left_joint")[0].removesuffix('"'),
        ["line 4: XML: the element is not closed (end of file inside it). Check with: xmllint --noout FILE."],
    ),
    "wheels that are not on one axle": (
        robot(wheel("left", "0.1 0.2 0"), RIGHT),
        ["<robot>: it is not clear which wheels drive.", WIDE, "Fix: Move both joints to the same x in the URDF."],
    ),
    "wheels that are fixed": (
        robot(wheel("left_wheel", "0 0.2 0", "fixed"), wheel("right_wheel", "0 -0.2 0", "fixed")),
        [
            "<robot>: no drive wheels found.",
            'Found: left_wheel_joint: it is type="fixed", but a drive wheel needs type="continuous"; right_wheel_',
            'Fix: Set type="continuous" on the joint of each drive wheel.',
        ],
    ),
    "one wheel": (
        robot(LEFT),
        ["Fix: Set robot.left_wheel_joints: […] and robot.right_wheel_joints: […] to the joints of the drive wheels."],
    ),
    "a ring of joints": (
        robot(LEFT, RIGHT, RING),
        ["cycle in the joint tree: a → b → a. Set another <parent> for one"],
    ),
    "a mesh of a format that is not read": (
        robot(wheel("left", "0 0.2 0", shape='<mesh filename="part.step"/>'), RIGHT),
        ['unsupported mesh format ".step". Export the mesh again as STL, OBJ or DAE.'],
    ),
}


@pytest.mark.parametrize("case", DESCRIPTIONS)
def test_a_description_is_refused_with_its_place_and_the_fix_for_it(tmp_path, case):
    text, expected = DESCRIPTIONS[case]
    (tmp_path / "cart.urdf").write_text(text)
    (tmp_path / "part.step").touch()
    message = printed(inspect, str(tmp_path / "cart.urdf"))
    assert [part for part in expected if part not in message] == [], message
    if len(expected) == 3:
        starts = [line.split()[0] for line in message.splitlines()[-3:]]
        assert starts[1:] == ["Found:", "Fix:"], message


def test_a_file_that_is_missing_is_named_with_the_operation(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    full = tmp_path / "missing.urdf"
    expected = f"missing.urdf: file not found ({full}). Give the path of an existing URDF file."
    assert printed(inspect, "missing.urdf").endswith(expected)
    monkeypatch.setattr("sys.argv", ["drive_path.py", "missing.csv"])
    with pytest.raises(SystemExit, match=r"missing.csv: file not found \(.*/missing.csv\)"):
        drive_path()


CAUSES = {
    "stall": (
        "a wheel does not turn although motion is commanded",
        "check for a blocked wheel, then motor and encoder",
    ),
    "controller_lost": (
        "no command from the controller",
        "check that the controller runs and gets enough CPU time (scripts/doctor.py)",
    ),
    "command_stale": (
        "the controller's commands are late, or are based on outdated state",
        "check what takes CPU time from the controller and the estimator (scripts/doctor.py)",
    ),
    "torque_oscillation": (
        "a motor's torque oscillates more than the motion requires",
        "reduce pid_kp, pid_ki and tracking_bandwidth, or remove them; check that drive for delay and backlash",
    ),
    "gate_disobeys": (
        "the driver applied a command although the safety monitor ordered a stop",
        "press the hardware emergency stop, then replace the driver program the driver",
    ),
}


@pytest.mark.parametrize("name", CAUSES)
def test_a_cause_names_what_the_part_did_and_the_tool_of_the_remedy(name):
    cause = next(one for one in bits("StopCause") if one.name == name)
    assert (cause.sentence, cause.remedy) == CAUSES[name]


def test_a_reason_says_the_action_first_and_its_time_stamp_in_the_order_of_a_sentence():
    reasons = {one.name: one.sentence for one in bits("CommandReason")}
    assert reasons["revoked"] == (
        "a node must send zero velocity once before its commands are accepted again (after a stop, restart or pause)"
    )
    assert reasons["stale"] == "the last message's time stamp is older than cmd_vel_timeout or lies in the future"


def why(**facts) -> str:
    """The answer of why.py for a robot whose nodes all run."""
    running = {node: Report("running", {}) for node in LOOP}
    known = {"master": "http://localhost:11311", "reports": running, "registered": frozenset(LOOP)}
    return " ".join(" ".join(render(Facts(**{**known, **facts}), Layout(width=1000))).split())


def test_why_begins_with_the_state_word():
    ready = Safety("READY", "drive", held=1)
    assert why(safety=ready).startswith("Ready: no motion is requested.")
    waiting = Safety("INIT", "brake", held=1, awaiting_zero=True)
    assert why(safety=waiting, command_timeout=0.5).startswith(
        "Not ready: waiting for a zero velocity command. "
        "Stop publishing on cmd_vel or cmd_vel_stamped for 0.5 s, or publish zero."
    )
    requested = {node: Report("running", {"requested_m_s": "0.5", "requested_rad_s": "0"}) for node in LOOP}
    assert why(safety=replace(ready, speed_limit=0.0), reports=requested).startswith(
        "Blocked: the free distance (clearance) is 0."
    )


def test_why_without_a_master_names_the_command_that_starts_one():
    pytest.importorskip("rospy", reason="ROS is not installed")
    program = ROOT / "scripts/why.py"
    environment = {**os.environ, "ROS_MASTER_URI": "http://127.0.0.1:9"}
    done = subprocess.run(
        ["/usr/bin/python3", program, "--once"],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert done.returncode == 1
    assert done.stdout.startswith("No ROS master answers at http://127.0.0.1:9.")
    assert "$ roslaunch robot_control sim.launch" in done.stdout
