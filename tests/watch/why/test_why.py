"""Tests the answers of why.py, without ROS. The fixture drives; each test breaks one thing."""

import re
from dataclasses import replace

import pytest
from robot_control.loop.roles import CONTROLLER, DRIVER, ESTIMATOR, LEGGED, LOOP, MONITOR, Kind
from robot_control.robot.diagnosis.answer import Verdict
from robot_control.robot.diagnosis.diagnosis import judge
from robot_control.robot.diagnosis.state import Cause, Facts, Report, Safety
from robot_control.watch.why.screen import Layout, render

E_STOP = Cause(
    "e_stop_topic",
    "an emergency stop is requested on the topic e_stop",
    "publish false on e_stop",
    "operator",
    first=True,
    active=True,
)
FAST = Cause(
    "wheel_speed",
    "a wheel is faster than allowed",
    "check load, slope, encoder and motor of that wheel",
    "technician",
    "17.3 rad/s, limit 15 rad/s, left_wheel_joint",
)
PAUSED = {"driver_state": "paused"}
ZERO = {"requested_m_s": "0", "requested_rad_s": "0"}
NO_COMMAND = ("nothing was received on cmd_vel in this run", "publish on cmd_vel")
TIMED_OUT = ("the last cmd_vel is older than cmd_vel_timeout", "publish more often")
STALE = ("the last cmd_vel_stamped was older than cmd_vel_timeout", "check the sender's clock")
MANY = ("more than one node sends commands (one_sender: true)", "stop all senders but one")
REVOKED = ("a node must send zero velocity once before its commands are accepted again", "let it send a zero")


@pytest.fixture
def driving() -> Facts:
    return Facts(
        master="http://127.0.0.1:11311",
        safety=Safety("DRIVE", "drive", held=12.0),
        reports={
            DRIVER: Report("running", {"driver_state": "running", "gate_verdict": "passed", "injected": "none"}),
            ESTIMATOR: Report("running", {"flags": "valid"}),
            CONTROLLER: Report("running", {"requested_m_s": "0.5", "requested_rad_s": "0.2"}),
            MONITOR: Report("running"),
        },
        registered=frozenset(LOOP),
        senders=("/send_cmd",),
        limited=(0.5, 0.2),
        measured=(0.5, 0.2),
    )


def test_text_of_other_programs_is_shown_without_control_characters(driving: Facts) -> None:
    hostile = replace(driving, senders=("/a\x1b[2J\nMoving.",), safety=Safety("DRIVE\x9b", "drive", held=12.0))
    lines = render(hostile)
    assert all(line.isprintable() for line in lines)
    assert "Moving." not in lines[1:]


def test_a_real_time_thread_that_blocked_is_named(driving: Facts) -> None:
    blocked = Report("not real-time in the last 10 s: 2 waits outside of its loop (docs/timing.md)")
    lines = render(replace(driving, reports={**driving.reports, ESTIMATOR: blocked}), Layout(width=200))
    assert f"real time  {ESTIMATOR}: {blocked.message}" in lines
    assert not any("real time" in line for line in render(driving))


def without(facts: Facts, *nodes: str) -> Facts:
    """Removes these nodes; the monitor, if it is there, reports that."""
    reports = {name: report for name, report in facts.reports.items() if name not in nodes}
    safety = None if MONITOR in nodes else replace(facts.safety, missing=nodes)
    return replace(facts, reports=reports, safety=safety, measured=None)


def saying(facts: Facts, node: str, **values: str | tuple[str, str]) -> Facts:
    """A node reports these values, too; `gate__x="sentence"` and `gate__x=("sentence", "remedy")`: reason "gate: x"."""
    old = facts.reports[node]
    keys = {}
    for key, value in values.items():
        sentence, remedy = value if isinstance(value, tuple) else (value, "")
        keys[key.replace("__", ": ")] = sentence
        if remedy:
            keys[key.replace("__", " remedy: ")] = remedy
    return replace(facts, reports={**facts.reports, node: replace(old, values={**old.values, **keys})})


def stopped(facts: Facts, *causes: Cause, state: str = "STOPPED") -> Facts:
    return replace(
        facts, safety=Safety(state, "brake", held=3.0, causes=causes), measured=(0.0, 0.0), limited=(0.0, 0.0)
    )


def text(facts: Facts, **layout) -> str:
    return "\n".join(render(facts, Layout(**layout)))


@pytest.mark.parametrize(("timeout", "silence"), [(1.25, " for 1.25 s"), (0.6, " for 0.6 s"), (0.0, "")])
def test_a_robot_that_waits_for_a_zero_request_says_so_and_names_the_sender(driving, timeout, silence):
    safety = Safety("INIT", "brake", awaiting_zero=True)
    waiting = replace(driving, safety=safety, measured=(0.0, 0.0), command_timeout=timeout)
    answer = judge(waiting)
    assert answer.verdict is Verdict.STOPPED
    assert answer.headline.startswith("Not ready: waiting for a zero velocity command.")
    assert answer.headline.endswith(f" Stop publishing on cmd_vel or cmd_vel_stamped{silence}, or publish zero.")
    assert "/send_cmd" in answer.actions[0][1]
    assert judge(replace(waiting, senders=())).actions == ()


def test_a_latched_stop_or_a_missing_node_goes_before_the_wait_for_a_zero(driving):
    waiting = Safety("INIT", "brake", awaiting_zero=True)
    assert "zero" not in judge(stopped(driving, E_STOP)).headline
    assert ESTIMATOR in judge(replace(driving, safety=replace(waiting, missing=(ESTIMATOR,)))).headline


def test_a_moving_robot_moves(driving):
    answer = judge(driving)
    assert answer.verdict is Verdict.MOVING
    assert answer.headline == "Moving: 0.50 m/s, 0.20 rad/s."
    assert not answer.actions


def test_what_the_driver_suspects_is_named_while_the_robot_is_to_move(driving):
    said = "left bears no load at rest, on the ground stand skid"
    for measured in ((0.5, 0.2), (0.0, 0.0)):
        answer = judge(replace(saying(driving, DRIVER, suspicious=said), measured=measured))
        assert said in answer.headline
        assert answer.actions
    standing = replace(saying(driving, DRIVER, suspicious=said), limited=(0.0, 0.0), measured=(0.0, 0.0))
    assert said in text(standing)


def test_without_a_master_it_says_what_to_start():
    answer = judge(Facts(master="http://127.0.0.1:11311", master_answers=False))
    assert answer.verdict is Verdict.STOPPED
    assert answer.headline == "No ROS master answers at http://127.0.0.1:11311."
    assert answer.commands == ("roslaunch robot_control sim.launch",)


def test_a_master_alone_is_no_robot():
    answer = judge(Facts(master="http://127.0.0.1:11311"))
    assert answer.headline == "No node of the robot runs."
    assert answer.commands == ("roslaunch robot_control sim.launch",)


def test_a_robot_that_was_refused_is_named_with_the_reason():
    refused = "robot.urdf: <robot>: 2 legs found.\n  /robot/rate = 500 overrides robot.rate"
    answer = judge(Facts(master="http://127.0.0.1:11311", refused=refused))
    assert answer.headline.endswith("Its start was refused: robot.urdf: <robot>: 2 legs found.")
    assert answer.actions == (("integrator", "/robot/rate = 500 overrides robot.rate"),)
    three = (
        "robot.urdf: <robot>: it is not clear which wheels drive.\nFound: there is only one.\nFix: Add the other one."
    )
    assert judge(replace(Facts(master=""), refused=three)).actions == (
        ("", "Found: there is only one."),
        ("integrator", "Fix: Add the other one."),
    )


def test_it_names_the_namespace_in_which_a_robot_runs():
    facts = Facts(master="http://127.0.0.1:11311", elsewhere=("/robot2",))
    assert "rosrun robot_control why.py __ns:=/robot2" in judge(facts).commands


def test_it_asks_for_a_robot_in_its_own_namespace():
    answer = judge(Facts(master="http://127.0.0.1:11311", namespace="/robot2"))
    assert answer.headline == "No node of the robot runs in /robot2."
    assert answer.commands == ("roslaunch robot_control sim.launch __ns:=/robot2",)


def test_without_a_monitor_the_gate_brakes(driving):
    answer = judge(without(driving, MONITOR))
    assert "safety_monitor does not run" in answer.headline
    assert answer.commands == ("rosrun robot_control safety_monitor",)


def test_what_the_monitor_said_long_ago_does_not_count(driving):
    late = replace(driving, safety=replace(driving.safety, age=10.0))
    assert "safety_monitor" in judge(late).headline


def test_before_every_node_was_seen_it_names_the_missing_ones(driving):
    waiting = without(driving, DRIVER)
    waiting = replace(waiting, safety=replace(waiting.safety, state="INIT", permit="brake"))
    answer = judge(waiting)
    assert answer.headline == "Not ready: the safety monitor waits for: mujoco_plant."
    assert answer.commands == ("rosrun robot_control mujoco_plant",)
    assert "mujoco_plant MISSING" in text(waiting)


def test_a_stop_is_reported_by_its_first_cause_with_value_and_limit(driving):
    facts = stopped(driving, replace(E_STOP, first=False), replace(FAST, first=True))
    said = "Stopped: a wheel is faster than allowed (17.3 rad/s, limit 15 rad/s, left_wheel_joint)."
    assert judge(facts).headline == said
    lines = text(facts)
    assert lines.index("wheel_speed:") < lines.index("e_stop_topic:")
    assert "[first]" in lines
    assert "[still true]" in lines


def test_the_actor_stands_before_the_action(driving):
    answer = judge(stopped(saying(driving, CONTROLLER, **ZERO), E_STOP, FAST))
    assert answer.actions == (
        ("operator", "publish false on e_stop"),
        ("technician", "check load, slope, encoder and motor of that wheel"),
        ("operator", "then call e_stop_reset"),
    )
    assert answer.commands == ("rostopic pub -1 /e_stop std_msgs/Bool false", "rosservice call /e_stop_reset")


def test_a_node_that_still_requests_motion_is_named_before_the_reset(driving):
    actions = judge(stopped(driving, E_STOP)).actions
    assert actions[-2] == ("operator", "stop /send_cmd: a reset is refused while motion is requested")
    assert actions[-1] == ("operator", "then call e_stop_reset")


LATE = Cause("estimator_lost", "no state from the estimator", "look", "integrator", "7 cycles", first=True)


def test_a_stop_of_a_busy_machine_names_lateness_load_and_remedy_first(driving):
    answer = judge(replace(stopped(driving, FAST, LATE), busy=True, load="load 40 on 2 cores"))
    assert answer.headline == (
        "Stopped: the loop was late, because other programs used the CPU: "
        "estimator_lost (7 cycles), load 40 on 2 cores."
    )
    assert "stop other programs" in answer.actions[0][1]


def test_simulated_time_that_slipped_shows_lateness_as_the_load_does(driving):
    assert "was late" in judge(stopped(saying(driving, DRIVER, slipped_s="0.2"), LATE)).headline


def test_neither_an_idle_machine_nor_a_node_that_died_nor_another_cause_is_late(driving):
    idle = saying(driving, DRIVER, slipped_s="0.000000")
    dead = replace(without(stopped(driving, LATE), ESTIMATOR), busy=True)
    for facts in (stopped(idle, LATE), dead, replace(stopped(driving, FAST), busy=True)):
        assert "was late" not in judge(facts).headline


def test_a_ramp_is_reported_as_stopping(driving):
    assert judge(stopped(driving, FAST, state="STOPPING")).headline.startswith("Stopping: ")


def test_a_lost_node_is_started_first(driving):
    cause = Cause("controller_lost", "no command from the controller", "check that it runs")
    facts = stopped(without(driving, CONTROLLER), cause)
    facts = replace(facts, safety=replace(facts.safety, missing=(CONTROLLER,)))
    assert judge(facts).commands[0] == "rosrun robot_control diff_drive_controller"


def test_the_lost_controller_of_another_kind_is_named_and_started(driving):
    legs = Kind("quadruped", controller="leg_controller")
    facts = replace(without(driving, CONTROLLER), kind=legs)
    facts = replace(facts, safety=replace(facts.safety, missing=("leg_controller",)))
    assert judge(facts).headline == "leg_controller does not run."
    assert judge(facts).commands == ("rosrun robot_control leg_controller",)
    walking = replace(facts, reports={**facts.reports, "leg_controller": driving.reports[CONTROLLER]})
    walking = saying(walking, "leg_controller", command__out_of_reach="the pose is beyond what the legs reach")
    assert "controller the pose is beyond what the legs reach" in " ".join(text(walking).split())


@pytest.fixture
def legged(driving) -> Facts:
    """It stands, and a node requests poses; an estimate at rest is not exactly zero."""
    own = Report("running", {"posture": "standing", "senders": "/poser", **ZERO})
    return replace(
        driving,
        kind=Kind(LEGGED, controller="leg_controller"),
        safety=Safety("DRIVE", "drive"),
        reports={**{name: driving.reports[name] for name in (DRIVER, ESTIMATOR, MONITOR)}, "leg_controller": own},
        senders=("/poser",),
        limited=None,
        measured=(-0.004, 0.02),
    )


def test_a_clearance_of_zero_stops_a_robot_on_legs_that_would_move(legged):
    near = replace(legged, safety=Safety("DRIVE", "drive", speed_limit=0.0))
    assert judge(near).headline == "Ready: standing; the robot follows /poser."
    held = saying(near, "leg_controller", command__permit_slow="the safety monitor limits the speed")
    assert judge(held).headline == "Blocked: the free distance (clearance) is 0."
    assert "at most 0 m/s, by clearance" in text(held)
    slow = replace(held, safety=Safety("DRIVE", "drive", speed_limit=0.1))
    assert judge(slow).headline.endswith("the robot follows /poser; the safety monitor limits the speed.")


def test_a_robot_on_legs_that_stands_has_no_speeds(legged):
    assert judge(legged).headline == "Ready: standing; the robot follows /poser."
    idle = saying(legged, "leg_controller", senders="", command__timed_out="the last body_pose is too old")
    assert judge(idle).headline == "Ready: standing; no motion is requested."
    assert judge(idle).commands == ()
    for facts in (legged, idle):
        assert not re.search("m/s|cmd_vel|rim", text(facts))


def test_a_robot_that_lies_has_to_stand_up(legged):
    lying = saying(legged, "leg_controller", posture="lying", command__holding="the brake holds the position")
    answer = judge(lying)
    assert (answer.verdict, answer.headline) == (Verdict.IDLE, "Ready: the robot lies.")
    assert answer.commands == ("rosservice call /set_posture standing",)
    said = ("a pose is requested, and the robot does not stand", "call set_posture with 'standing'")
    answer = judge(saying(lying, "leg_controller", command__not_standing=said))
    assert answer.headline == f"Ready: {said[0]}."
    assert answer.actions == (("operator", said[1]),)
    assert answer.commands == ("rosservice call /set_posture standing",)


def test_a_change_of_posture_is_motion(legged):
    rising = saying(legged, "leg_controller", posture="rising", command__not_standing="it does not stand")
    assert judge(rising).verdict is Verdict.MOVING
    assert judge(rising).headline == "Moving: standing up."


def test_a_sender_of_poses_is_stopped_before_the_reset(legged):
    answer = judge(stopped(legged, E_STOP))
    assert ("operator", "stop /poser: a reset is refused while motion is requested") in answer.actions
    waiting = judge(replace(legged, safety=Safety("INIT", "brake", awaiting_zero=True)))
    topics = "cmd_vel or cmd_vel_stamped or body_pose or foot_target or joint_trajectory"
    assert waiting.actions == (("operator", f"check the senders on {topics}: /poser"),)


def test_a_walk_is_motion_with_its_speeds_and_what_limits_them(legged):
    walking = saying(legged, "leg_controller", posture="walking", gait="trot")
    walking = replace(walking, limited=(0.5, 0.2, 0.1), measured=(0.49, 0.2, 0.1))
    assert judge(walking).verdict is Verdict.MOVING
    assert judge(walking).headline == "Walking: 0.49 m/s, 0.10 m/s to the left, 0.20 rad/s."
    said = ("the joint speed limits or the reach of the legs limit the speed", "reduce the requested speed")
    limited = judge(saying(walking, "leg_controller", command__leg_speed=said))
    assert limited.headline.endswith(f"0.20 rad/s; {said[0]}.")
    assert limited.actions == (("operator", said[1]),)
    sloping = judge(saying(walking, "leg_controller", ground="rises 10.2 deg to the front"))
    assert sloping.headline.endswith("0.20 rad/s. The ground rises 10.2 deg to the front.")
    assert "after limits 0.50 m/s, 0.10 m/s to the left, 0.20 rad/s" in " ".join(text(walking).split())


def test_a_walk_that_ended_because_its_sender_is_silent_says_so(legged):
    said = ("the last cmd_vel or body_pose is older than request_timeout", "publish more often")
    silent = saying(legged, "leg_controller", senders="", posture="walking", command__timed_out=said)
    ending = judge(replace(silent, limited=(0.0, 0.0, 0.0)))
    assert ending.headline == f"Walking in place until its feet are in position, then standing; {said[0]}."
    stands = judge(saying(silent, "leg_controller", posture="standing"))
    assert stands.headline == "Ready: standing; no motion is requested."
    assert stands.actions == (("operator", said[1]),)


def test_commands_are_for_the_robots_own_namespace(driving):
    facts = replace(stopped(driving, E_STOP), namespace="/robot2")
    assert "rosservice call /robot2/e_stop_reset" in judge(facts).commands


def test_a_paused_simulation_is_reported_before_a_stop(driving):
    facts = saying(stopped(driving, E_STOP), DRIVER, **PAUSED)
    answer = judge(facts)
    assert answer.headline == "The simulation is paused."
    assert answer.commands == ("rosservice call /mujoco_plant/set_pause false",)
    assert "e_stop_topic" in text(facts)


def test_no_sender_is_no_fault(driving):
    facts = saying(driving, CONTROLLER, command__no_command=NO_COMMAND)
    answer = judge(replace(facts, senders=(), limited=(0.0, 0.0), measured=(0.0, 0.0)))
    assert answer.verdict is Verdict.IDLE
    assert answer.headline == f"Ready: no velocity command is received: {NO_COMMAND[0]}."
    assert answer.commands == ("rosrun robot_control send_cmd.py",)


def test_a_silent_sender_is_named(driving):
    facts = saying(driving, CONTROLLER, command__timed_out=TIMED_OUT)
    answer = judge(replace(facts, measured=(0.0, 0.0)))
    assert "older than cmd_vel_timeout" in answer.headline
    assert answer.actions == (("operator", "publish more often (sender: /send_cmd)"),)


def test_many_senders_are_named_where_one_sender_forbids_them(driving):
    facts = saying(driving, CONTROLLER, senders="/teleop, /navigation", **ZERO, command__many_senders=MANY)
    answer = judge(replace(facts, measured=(0.0, 0.0)))
    assert answer.verdict is Verdict.STOPPED
    assert answer.headline == f"Commands are refused: {MANY[0]}."
    assert answer.actions == (("operator", "stop all senders but one of /teleop, /navigation"),)
    assert "(2 senders: all are refused)" in text(facts)


def test_a_revoked_sender_is_named(driving):
    facts = saying(driving, CONTROLLER, revoked_senders="/planner", **ZERO, command__revoked=REVOKED)
    answer = judge(replace(facts, measured=(0.0, 0.0)))
    assert answer.verdict is Verdict.STOPPED
    assert answer.headline == f"Commands are refused: {REVOKED[0]}."
    assert answer.actions == (("operator", "/planner: let it send a zero"),)


def test_where_the_revoked_sender_is_gone_the_silence_is_the_answer(driving):
    facts = saying(driving, CONTROLLER, revoked_senders="", command__revoked=REVOKED, command__timed_out=TIMED_OUT)
    assert "older than cmd_vel_timeout" in judge(replace(facts, measured=(0.0, 0.0))).headline


def test_received_senders_count_and_registered_ones_do_not(driving):
    facts = saying(replace(driving, senders=("/idle", "/send_cmd")), CONTROLLER, senders="/send_cmd")
    assert "published by /send_cmd\n" in text(facts)


def test_a_sender_with_a_wrong_clock_is_reported(driving):
    facts = saying(driving, CONTROLLER, command__no_command=NO_COMMAND, command__stale=STALE)
    answer = judge(replace(facts, measured=(0.0, 0.0)))
    assert answer.verdict is Verdict.IDLE
    assert "the last cmd_vel_stamped was older" in answer.headline
    assert answer.actions == (("operator", f"{STALE[1]} (sender: /send_cmd)"),)


def test_one_stale_message_does_not_hide_that_it_moves(driving):
    facts = saying(driving, CONTROLLER, command__stale=STALE[0])
    assert judge(facts).verdict is Verdict.MOVING
    assert "the last cmd_vel_stamped was older" in text(facts)


def test_zero_on_cmd_vel_is_reported(driving):
    facts = saying(driving, CONTROLLER, command__holding="the command is zero: the brake holds the position")
    answer = judge(replace(facts, limited=(0.0, 0.0), measured=(0.0, 0.0)))
    assert answer.headline == "Ready: standstill is commanded; cmd_vel is zero."


def test_several_senders_are_all_named(driving):
    lines = " ".join(text(replace(driving, senders=("/send_cmd", "/teleop"))).split())
    assert "published by /send_cmd, /teleop (2 senders: each message overrides the previous one)" in lines


def test_a_gate_that_brakes_by_itself_is_reported(driving):
    facts = saying(
        driving,
        DRIVER,
        gate_verdict="brake",
        gate__no_command=("there is no command from the last 4 cycles", "look whether diff_drive_controller runs"),
    )
    answer = judge(facts)
    assert answer.headline == "The driver brakes: there is no command from the last 4 cycles."
    assert answer.actions == (("integrator", "look whether diff_drive_controller runs"),)


def test_a_gate_that_applied_a_permit_of_a_second_ago_is_no_answer(driving):
    facts = saying(driving, DRIVER, gate_verdict="brake", gate__permit_brake="the permit orders the brake")
    assert judge(facts).verdict is Verdict.MOVING


def test_a_controller_without_state_is_reported(driving):
    facts = saying(
        driving, CONTROLLER, command__no_state=("the state of this cycle is missing", "start state_estimator")
    )
    assert judge(facts).headline == "The controller brakes: the state of this cycle is missing."


def test_commanded_to_move_and_standing_is_not_called_moving(driving):
    assert "does not move yet" in judge(replace(driving, measured=(0.0, 0.0))).headline


def test_warnings_and_the_speed_limit_they_bring_are_shown(driving):
    warning = "the battery is low: 20.9 V, limit 21 V (charge the battery soon)"
    facts = replace(driving, safety=replace(driving.safety, warnings=(warning,), speed_limit=0.3))
    assert "at most 0.3 m/s" in judge(facts).headline
    assert warning in text(facts)
    assert "at most 0.3 m/s at each rim" in text(facts)


def test_without_a_free_path_clearance_is_reported_and_not_a_zero_on_cmd_vel(driving):
    facts = saying(driving, CONTROLLER, command__holding="the command is zero")
    facts = replace(facts, safety=replace(facts.safety, speed_limit=0.0), limited=(0.0, 0.0), measured=(0.0, 0.0))
    assert judge(facts).verdict is Verdict.STOPPED
    assert judge(facts).headline == "Blocked: the free distance (clearance) is 0."
    assert judge(facts).commands == ("rostopic pub -1 /clearance std_msgs/Float64 inf",)
    assert "/lidar does" in text(replace(facts, clearance_senders=("/lidar",)))


@pytest.mark.parametrize(
    ("goal", "headline", "verdict"),
    [
        ("waiting", "The goal waits: no scan for 3.0 s.", Verdict.STOPPED),
        ("failed", "The goal failed: no scan for 3.0 s.", Verdict.IDLE),
    ],
)
def test_a_goal_that_waits_or_was_given_up_is_reported_with_its_reason(driving, goal, headline, verdict):
    report = Report("no scan for 3.0 s", {"goal": goal})
    answer = judge(replace(driving, reports={**driving.reports, "navigate": report}, limited=(0.0, 0.0)))
    assert (answer.headline, answer.verdict) == (headline, verdict)
    assert judge(replace(driving, reports={**driving.reports, "navigate": report})).verdict is Verdict.MOVING


def test_without_a_warning_a_limit_is_that_of_clearance(driving):
    facts = replace(driving, safety=replace(driving.safety, speed_limit=0.288))
    assert "at most 0.288 m/s at each rim, by clearance" in text(facts)


def test_a_refused_reset_says_why(driving):
    facts = stopped(driving, E_STOP)
    facts = replace(facts, safety=replace(facts.safety, refusal=("motion is still requested (stop the sender)",)))
    assert "refused: motion is still requested" in text(facts)


def test_a_master_that_died_is_reported_while_the_robot_drives_on(driving):
    facts = replace(driving, master_answers=False)
    assert judge(facts).verdict is Verdict.MOVING
    assert "does not answer" in text(facts)


def test_injected_faults_and_slip_are_shown(driving):
    facts = saying(saying(driving, DRIVER, injected="gyro stuck"), ESTIMATOR, flags="valid slip")
    assert "gyro stuck" in text(facts)
    assert "wheels and inertial sensors disagree" in text(facts)


def test_slip_is_shown_with_the_wheel_and_lost_sensors_by_what_is_left(driving):
    facts = saying(
        driving,
        ESTIMATOR,
        flags="valid slip no_gyro",
        slip__left="the left wheels do not roll",
        slip__spinning=("the wheels turn faster than the ground passes", "reduce the acceleration"),
        estimate__no_gyro=("yaw is computed from the wheels only", "check the IMU"),
    )
    shown = text(facts)
    assert "the left wheels do not roll; the wheels turn faster than the ground passes" in " ".join(shown.split())
    assert "yaw is computed from the wheels only" in shown
    assert "disagree" not in shown


def test_slip_detection_is_shown_where_the_floor_makes_it_slow(driving):
    assert "slip detection" not in text(saying(driving, ESTIMATOR, slip_detection="on"))
    slow = "slow: residuals 12 x the sensors' noise"
    assert f"slip detection is {slow}" in " ".join(text(saying(driving, ESTIMATOR, slip_detection=slow)).split())


@pytest.mark.parametrize("width", [40, 80, 132])
def test_no_line_is_wider_than_the_screen(driving, width):
    facts = stopped(replace(driving, senders=("/send_cmd", "/teleop")), E_STOP, FAST)
    assert max(map(len, render(facts, Layout(width=width)))) <= width


def test_a_stop_with_two_causes_fits_one_screen(driving):
    assert len(render(stopped(driving, E_STOP, FAST), Layout(width=80))) <= 23


def test_colours_are_for_terminals_and_change_no_word(driving):
    plain, coloured = text(driving), text(driving, colour=True)
    assert "\x1b" not in plain
    assert "\x1b[32;1m" in coloured
    assert re.sub(r"\x1b\[[0-9;]*m", "", coloured) == plain


def test_without_times_the_same_answer_looks_the_same(driving):
    later = replace(
        driving, safety=replace(driving.safety, held=60.0, age=0.5), measured=(0.4, 0.1), limited=(0.4, 0.1)
    )
    assert text(driving, times=False) == text(later, times=False)
    assert text(driving) != text(later)


def test_the_command_sources_and_who_commands_are_shown(driving):
    sources = "joy_vel: silent, key_vel: commands, path_vel: masked by key_vel"
    facts = saying(driving, CONTROLLER, sources=sources, senders="/a, /b")
    lines = "\n".join(render(facts))
    assert f"sources    {sources}" in lines
    assert "published by /a, /b\n" in lines


def test_a_lock_is_what_stands_against_motion(driving):
    answer = judge(saying(driving, CONTROLLER, sources="key_vel: locked by pause, cmd_vel: silent"))
    assert answer.verdict is Verdict.STOPPED
    assert answer.headline == "Blocked: the commands are locked by pause; the result is zero."


def test_a_lock_that_lets_the_commander_pass_stands_against_nothing(driving):
    facts = saying(driving, CONTROLLER, sources="key_vel: commands, cmd_vel: locked by no_programs")
    assert judge(facts).verdict is Verdict.MOVING


def test_a_machine_that_is_starting_is_named_with_what_it_waits_for():
    words = "left (node 0): starting; the drive waits for a first frame. right (node 1): starting; the drive waits"
    reports = {"driver": Report("", {"driver_state": "starting", "suspicious": words})}
    answer = judge(Facts("uri", safety=Safety("INIT", "brake", missing=("the hardware is starting",)), reports=reports))
    assert answer.headline == "Not ready: the hardware is starting."
    assert [text.split(";")[0] for _, text in answer.actions] == ["left (node 0): starting", "right (node 1): starting"]
