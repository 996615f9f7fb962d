"""The pace at which teleop.py and pad.py send."""

from robot_control.robot.command import SEND_PERIOD, Command, Pace


def test_a_change_is_sent_at_once_the_same_every_period_and_nothing_never():
    sent = []
    pace = Pace(sent.append)
    pace.step(None, 0.0)
    assert (sent, pace.last, pace.sent_at) == ([], None, None)
    pace.step(Command(0.5, 0.0), 0.01)
    pace.step(Command(0.5, 0.0), 0.02)
    pace.step(Command(), 0.03)
    assert sent == [Command(0.5, 0.0), Command()]
    pace.step(Command(), 0.03 + SEND_PERIOD)
    pace.step(None, 0.2)
    assert (len(sent), pace.last, pace.sent_at) == (3, None, 0.03 + SEND_PERIOD)
