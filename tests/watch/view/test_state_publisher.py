"""state_publisher.py before it becomes robot_state_publisher."""

import signal

import pytest
import rospy
from robot_control.watch.view import state_publisher


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_that_comes_while_the_node_is_ended_ends_the_program(monkeypatch, number):
    monkeypatch.setattr(state_publisher, "server_description", lambda: "<robot/>")
    monkeypatch.setattr(rospy, "signal_shutdown", lambda _: signal.raise_signal(number))
    before = signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM), signal.getsignal(signal.SIGHUP)
    try:
        assert state_publisher.await_description() == ""
    finally:
        for each, handler in zip((signal.SIGINT, signal.SIGTERM, signal.SIGHUP), before, strict=True):
            signal.signal(each, handler)
