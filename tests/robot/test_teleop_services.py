"""The e-stop and the reset of teleop.py, with services of this file."""

import time

import pytest
import rospy
from robot_control.msg import SafetyStatus
from robot_control.robot import services as module
from robot_control.robot.diagnosis.state import Cause, Facts, Safety
from robot_control.robot.safety_watch import SafetyWatch
from robot_control.robot.services import Answer, Services, in_words
from std_srvs.srv import TriggerResponse


class Robot:
    """Its services, and what it receives on the topic e_stop, where it is connected."""

    def __init__(self):
        self.calls, self.levels, self.connected, self.watch = [], [], True, None
        self.answers, self.refuses = True, False
        self.ignored = 0  # calls of each service that it refuses at first

    def get_num_connections(self):
        return int(self.connected)

    def publish(self, message):
        if self.connected and self.levels[-1:] != [message.data]:
            self.levels.append(message.data)
        if self.connected and message.data:
            self.watch.receive(SafetyStatus(state_name="STOPPED"))

    def call(self, name):
        self.calls.append(name)
        while not self.answers:
            time.sleep(0.01)
        if self.refuses:
            raise rospy.ServiceException("no master")
        return TriggerResponse(success=self.calls.count(name) > self.ignored)


@pytest.fixture
def robot(monkeypatch):
    robot = Robot()
    monkeypatch.setattr(rospy, "Publisher", lambda *_, **__: robot)
    monkeypatch.setattr(rospy, "Subscriber", lambda *_, **__: None)
    monkeypatch.setattr(module, "CONFIRMED_WITHIN", 0.2)
    robot.watch = SafetyWatch()
    monkeypatch.setattr(rospy, "ServiceProxy", lambda name, _: lambda: robot.call(name))
    yield robot
    robot.answers = True


def wait_for(condition):
    end = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_a_repeated_e_stop_is_one_request_and_one_after_a_reset_is_another(robot):
    services = Services(robot.watch)
    assert services.e_stop()
    assert not services.e_stop()
    services.reset()
    assert services.e_stop()
    wait_for(lambda: len(robot.calls) == 3)
    assert robot.calls == ["e_stop_trigger", "e_stop_reset", "e_stop_trigger"]


def test_where_the_service_does_not_answer_the_topic_says_true_until_the_reset(robot):
    robot.answers = False
    services = Services(robot.watch)
    services.e_stop()
    answers = []
    wait_for(lambda: answers.extend(services.poll()) or answers)
    text = "sent on the topic e_stop (e_stop_trigger does not answer); the robot is STOPPED"
    assert answers == [Answer("e_stop_trigger", True, text)]
    assert robot.levels == [True]
    services.reset()
    assert robot.levels == [True, False]
    robot.answers = True
    wait_for(lambda: len(robot.calls) == 2)  # the thread has ended its work before the next case


def test_an_e_stop_that_the_service_could_not_take_is_sent_on_the_topic_and_not_called_refused(robot):
    robot.refuses = True
    services = Services(robot.watch)
    services.e_stop()
    answers = []
    wait_for(lambda: answers.extend(services.poll()) or answers)
    text = "sent on the topic e_stop (no master); the robot is STOPPED"
    assert answers == [Answer("e_stop_trigger", True, text)]
    assert robot.levels == [True]


def test_an_e_stop_that_reached_nobody_or_that_nothing_confirms_is_never_reported_as_sent(robot):
    robot.refuses, robot.connected = True, False
    services = Services(robot.watch)
    for watch, silence in ((robot.watch, "no node receives the topic e_stop"), (None, "1 nodes receive e_stop, and ")):
        robot.connected, robot.watch = watch is None, watch or SafetyWatch()
        services.e_stop()
        answers = []
        wait_for(lambda: answers.extend(services.poll()) or answers)  # noqa: B023 (called at once)
        assert not answers[0].accepted
        assert in_words(answers[0], stopped_by()).startswith("EMERGENCY STOP NOT CONFIRMED: no master; ")
        assert silence in answers[0].text
        time.sleep(module.AGAIN)


def test_a_stop_before_the_request_confirms_nothing(robot):
    robot.refuses, robot.connected = True, False
    robot.watch.receive(SafetyStatus(state_name="STOPPED"))
    services = Services(robot.watch)
    services.e_stop()
    answers = []
    wait_for(lambda: answers.extend(services.poll()) or answers)
    assert not answers[0].accepted


def test_after_a_reset_that_is_refused_it_says_on_the_topic_that_it_stops_nothing(robot):
    robot.refuses = True
    services = Services(robot.watch)
    services.reset()
    wait_for(services.poll)
    assert robot.levels == [False]


@pytest.mark.parametrize(("raised", "calls"), [(True, 2), (False, 1)])
def test_a_reset_that_overtook_its_own_level_of_the_topic_is_called_once_more(robot, raised, calls):
    robot.ignored = 1
    services = Services(robot.watch)
    if raised:
        services.e_stop()
        wait_for(services.poll)
    services.reset()
    answers = []
    wait_for(lambda: answers.extend(services.poll()) or answers)
    assert [answer.accepted for answer in answers] == [raised]
    assert robot.calls.count("e_stop_reset") == calls


def test_a_stop_that_a_silent_service_does_not_answer_goes_to_the_topic_whatever_reset_follows(robot, monkeypatch):
    monkeypatch.setattr(module, "PATIENCE", 0.05)
    robot.answers = False
    services = Services(robot.watch)
    services.e_stop()
    services.reset()
    wait_for(lambda: services.poll() or robot.levels)
    assert robot.levels[0] is True


def test_a_reset_that_waited_too_long_behind_a_silent_service_is_dropped(robot, monkeypatch):
    monkeypatch.setattr(module, "LATEST", 0.05)
    robot.answers = False
    services = Services(robot.watch)
    services.e_stop()
    services.reset()
    time.sleep(0.1)
    robot.answers = True
    answers = []
    wait_for(lambda: answers.extend(services.poll()) or len(answers) == 2)
    assert robot.calls == ["e_stop_trigger"]
    assert not answers[1].accepted


def test_an_emergency_stop_that_the_topic_has_answered_is_not_answered_again_by_a_late_service(robot, monkeypatch):
    monkeypatch.setattr(module, "PATIENCE", 0.0)
    robot.answers = False
    services, answers = Services(robot.watch), []
    services.e_stop()
    wait_for(lambda: answers.extend(services.poll()) or answers)
    robot.answers = True
    services.reset()
    wait_for(lambda: answers.extend(services.poll()) or answers[-1].service == "e_stop_reset")
    assert [answer.service for answer in answers] == [module.E_STOP, "e_stop_reset"]


def stopped_by(*causes, namespace="/"):
    return Facts(master="http://localhost:11311", namespace=namespace, safety=Safety("STOPPED", "brake", causes=causes))


def test_a_refused_reset_names_the_command_that_takes_back_the_topic_of_an_ended_node():
    answer = Answer("e_stop_reset", accepted=False, text="refused: a cause of the stop persists")
    level = Cause("e_stop_topic", "an emergency stop is requested on the topic e_stop", active=True)
    text = in_words(answer, stopped_by(level, namespace="/robot2"))
    assert "rostopic pub -1 /robot2/e_stop std_msgs/Bool false, then call the reset again" in text
    assert len(text) <= 3 * 70


@pytest.mark.parametrize("cause", ["e_stop_input", "e_stop_service"])
def test_another_refusal_is_the_services_own_text(cause):
    answer = Answer("e_stop_reset", accepted=False, text="refused: the robot still moves")
    robot = stopped_by(
        Cause(cause, "a stop", active=True), Cause("e_stop_topic", "an emergency stop is requested on the topic e_stop")
    )
    assert in_words(answer, robot) == "reset REFUSED: refused: the robot still moves"


def test_what_was_confirmed_and_what_was_not_is_said():
    assert in_words(Answer("e_stop_reset", accepted=True, text="released"), stopped_by()) == "reset accepted: released"
    for accepted, said in ((True, "emergency stop confirmed"), (False, "EMERGENCY STOP NOT CONFIRMED")):
        assert in_words(Answer("e_stop_trigger", accepted, "why"), stopped_by()) == f"{said}: why"
