"""robot_status and state_publisher.py: from the nodes' reports to one status, without ROS."""

import math
import xml.etree.ElementTree as ET
from dataclasses import replace

import pytest
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from robot_control.loop.roles import Kind
from robot_control.msg import RobotStatus, SafetyStatus
from robot_control.watch.status.report import Reports, changed, status_of
from robot_control.watch.view.state_publisher import for_transforms


def report(level=DiagnosticStatus.OK, message="", **values):
    return DiagnosticStatus(level=level, message=message, values=[KeyValue(k, v) for k, v in values.items()])


REQUIRED = Kind().loop[1:]
ESTIMATOR = {"flags": "valid standstill", "degraded": "", "odometry_confidence": "1"}


def reports(state="READY", commander="", senders="", **changes):
    """Reports of a healthy robot; `changes`: diagnostics of nodes, None: silent."""
    diagnostics = {name: report() for name in (*REQUIRED, "mujoco_plant")}
    diagnostics["state_estimator"] = report(**ESTIMATOR)
    diagnostics["diff_drive_controller"] = report(senders=senders)
    diagnostics = {name: value for name, value in (diagnostics | changes).items() if value is not None}
    safety = SafetyStatus(state_name=state) if state else None
    return Reports(safety, diagnostics, commander=commander)


def test_a_healthy_robot_without_commands_is_idle_and_ok():
    status = status_of(reports())
    assert (status.mode, status.health, status.problems) == ("idle", RobotStatus.OK, [])
    assert (status.safety_state, status.odometry_confidence, status.odometry_degraded) == ("READY", 1.0, False)


def test_no_report_is_offline_with_the_names_of_the_silent_nodes():
    status = status_of(Reports())
    assert (status.mode, status.health) == ("offline", RobotStatus.ERROR)
    assert status.problems == [f"{name} is silent" for name in REQUIRED]
    assert math.isnan(status.odometry_confidence)


def test_a_robot_on_legs_has_a_posture():
    assert status_of(replace(reports(), posture="standing")).posture == "standing"


def test_the_controller_of_another_kind_is_the_one_that_is_missed():
    status = status_of(replace(Reports(), kind=Kind("quadruped", controller="leg_controller")))
    assert status.problems == ["state_estimator is silent", "leg_controller is silent", "safety_monitor is silent"]


def test_a_stop_of_a_busy_machine_is_the_first_problem():
    late = SafetyStatus(state_name="STOPPED", first_cause="monitor_late", causes=["monitor_late"])
    status = status_of(replace(reports(mujoco_plant=report(DiagnosticStatus.WARN, "late")), safety=late, busy=True))
    assert status.problems[0].startswith("the loop was late, because other programs used the CPU: load ")
    assert status.problems[1] == "mujoco_plant: late"


@pytest.mark.parametrize(
    ("state", "mode"), [("INIT", "starting"), ("STOPPING", "stopped"), ("STOPPED", "stopped"), ("FAULT", "stopped")]
)
def test_who_may_not_drive_is_starting_or_stopped_whoever_commands(state, mode):
    assert status_of(reports(state, commander="key_vel", senders="/teleop")).mode == mode


@pytest.mark.parametrize(
    ("commander", "senders", "mode"),
    [
        ("", "/robot2/teleop_12_34", "manual"),
        ("", "/pad", "manual"),
        ("", "/move_base", "automatic"),
        ("", "/pad, /move_base", "automatic"),
        ("key_vel", "/teleop_1, /move_base", "manual"),
        ("path_vel", "/follow_path, /pad", "automatic"),
    ],
)
def test_who_commands_decides_between_manual_and_automatic(commander, senders, mode):
    status = status_of(reports("DRIVE", commander, senders))
    assert (status.mode, status.commander, status.senders) == (mode, commander, senders.split(", "))


def test_health_is_the_worst_report_and_every_bad_one_is_named():
    status = status_of(
        reports(
            state_estimator=report(DiagnosticStatus.WARN, "slip", **ESTIMATOR),
            mujoco_plant=report(DiagnosticStatus.ERROR, "no torque"),
        )
    )
    assert status.health == RobotStatus.ERROR
    assert status.problems == ["mujoco_plant: no torque", "state_estimator: slip"]
    assert status_of(reports(mujoco_plant=report(DiagnosticStatus.WARN, "hot"))).health == RobotStatus.WARN
    assert status_of(reports(state_estimator=None)).health == RobotStatus.ERROR


def test_the_confidence_is_that_of_the_estimator_and_zero_without_a_valid_pose():
    doubted = report(**ESTIMATOR | {"odometry_confidence": "0.4"})
    assert status_of(reports(state_estimator=doubted)).odometry_confidence == 0.4
    assert status_of(reports(state_estimator=report(**ESTIMATOR | {"flags": ""}))).odometry_confidence == 0.0
    assert status_of(reports(state_estimator=report(**ESTIMATOR | {"degraded": "slip"}))).odometry_degraded


def test_what_the_drives_do_on_silence_is_repeated():
    words = "odrive on can0; on silence left_wheel_joint coasts (stated in the drive file)"
    assert status_of(reports(mujoco_plant=None, driver=report(machine=words))).machine == words
    assert status_of(reports()).machine == ""


def test_the_return_of_data_is_repeated_and_a_failure_of_it_is_a_problem():
    said = report(DiagnosticStatus.WARN, "it does not answer", progress="run.7.bag 40 %")
    status = status_of(reports(data_return=said))
    assert status.data_return == "run.7.bag 40 %"
    assert status.problems == ["data_return: it does not answer"]
    assert status_of(reports()).data_return == ""


def test_numbers_that_always_change_are_no_change_and_a_cause_is_one():
    before, after = status_of(reports()), status_of(reports())
    after.uptime, after.odometry_confidence = 3.0, 0.9
    assert not changed(after, before)
    after.causes = ["e_stop"]
    assert changed(after, before)


URDF = """<robot name="r"><link name="base"><inertial><mass value="1"/></inertial></link>
<link name="wheel"><inertial><mass value="2"/></inertial></link>
<joint name="j" type="continuous"><parent link="base"/><child link="wheel"/></joint></robot>"""


def test_state_publisher_takes_the_root_links_inertia_away_and_nothing_else():
    robot = ET.fromstring(for_transforms(URDF))
    assert [link.get("name") for link in robot.findall("link") if link.find("inertial") is not None] == ["wheel"]
    assert robot.find("joint/child").get("link") == "wheel"
    assert for_transforms("no URDF") == "no URDF"


@pytest.mark.parametrize("kind", ["floating", "planar"])
def test_state_publisher_takes_the_world_of_a_free_robot_away(kind):
    world = f'<link name="world"/><joint name="free" type="{kind}"><parent link="world"/><child link="base"/></joint>'
    assert for_transforms(URDF.replace("</robot>", world + "</robot>")) == for_transforms(URDF)
