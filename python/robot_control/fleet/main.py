"""vda5050.py's main loop: the broker's messages in, the client's out, what was accepted in a file."""

import argparse
import math
import sys
import time
from pathlib import Path
from typing import Any

import rospy

from robot_control._robot_control import ParameterError, RobotError
from robot_control.files.files import InputFileError, fit_for_message, given_path, in_words, one_message
from robot_control.fleet.client import DRIVING, Client
from robot_control.fleet.machine import machine_of, running_description
from robot_control.fleet.memory import Memory
from robot_control.fleet.robot import RosRobot
from robot_control.fleet.settings import Settings, read_settings
from robot_control.fleet.v2.messages import Error
from robot_control.fleet.v2.vehicle import Vehicle
from robot_control.installed_files import share_file
from robot_control.robot.boundary import boundary
from robot_control.robot.ros_node import running_node, serve
from robot_control.robot.server_values import ServerValueError
from robot_control.robot.topic_sender import Signals
from robot_control.settings.files import SettingsError

REFUSALS = (InputFileError, OSError, RobotError, ParameterError, ServerValueError)
PERIOD = 0.02
"""s of one pass; odometry comes as often"""
RECEIVING = 0.01
"""s of a pass for the messages of the master; what waits then is for the next pass"""
SAVE_AGAIN = 1.0
"""s after which a file that could not be written is tried again"""
END = 3.0
"""s for the robot to stop when the program is ended"""
MISSING = "needs Debian's python3-paho-mqtt and python3-jsonschema: scripts/setup --fleet"


class Node:
    """The client with its robot, its link and its file."""

    def __init__(self, settings: Settings) -> None:
        """Raises OSError, InputFileError, and what `running_description` raises."""
        from robot_control.fleet.link import Link

        self._memory = Memory(settings.memory)
        vehicle, position = recalled(self._memory)
        self.robot = RosRobot(settings, position)
        machine = machine_of(running_description(), settings)
        self.client = Client(self.robot, settings, machine, vehicle, keep=self._keep, boundary=boundary)
        self.link = Link(settings, self._memory)
        self._saved: object = None
        self._save_at = -math.inf
        self._reason = ""
        serve("~pause", self.client.pause, "paused; call ~resume to continue or stopPause")
        serve("~resume", self.client.resume, "goes on")
        serve("~trigger", self.robot.actions.trigger)
        self.robot.stop_all()

    def run(self, signals: Signals) -> None:
        """Until a signal; the robot then stops on its way, and the order stays in the file."""
        self.link.begin()
        due = time.monotonic()
        while signals.going_on():
            with boundary.crossing("vda5050"):
                self.step()
            due = max(due + PERIOD, time.monotonic())
            time.sleep(max(0.0, due - time.monotonic()))
        self.robot.stop()
        end = time.monotonic() + END
        while self.robot.progress.status == DRIVING and time.monotonic() < end:
            time.sleep(PERIOD)
        self.client.vehicle.paused = bool(self.client.vehicle.nodes)
        with boundary.crossing("vda5050"):
            self.step()
        self.link.end()
        self.robot.actions.close()

    def step(self) -> None:
        """One pass. An accepted order is in the file before the master knows of it."""
        if self.link.came_up:
            self.link.came_up = False
            rospy.loginfo("connected to the broker")
            self.client.connected()
        end = time.monotonic() + RECEIVING
        while not self.link.received.empty() and time.monotonic() < end:
            topic, payload, retained = self.link.received.get()
            self.client.receive(topic, payload, time.monotonic(), retained=retained)
        outbox = self.client.step(time.monotonic())
        if (self.client.vehicle.revision, self.robot.position) != self._saved and time.monotonic() > self._save_at:
            self._keep(self.client.vehicle)
        for topic, message in outbox:
            self.link.publish(topic, message)
        if self.link.reason != self._reason:
            self._reason = self.link.reason
            if self._reason:
                rospy.logwarn(f"broker: {self._reason}; the robot continues to the end of its base")

    def _keep(self, vehicle: Vehicle) -> str:
        """Why it is not in the file; empty if it is."""
        position = self.robot.position
        why = self.client.file_problem = self._memory.save(vehicle=vehicle.dump(), position=position)
        if why:
            boundary.drop("memory_file", why)
            self._save_at = time.monotonic() + SAVE_AGAIN
        else:
            self._saved = vehicle.revision, position
        return why


def recalled(memory: Memory) -> tuple[Vehicle, list[Any] | None]:
    """The vehicle and the position of the program before; new ones where the file holds no such. Raises OSError."""
    vehicle, position = Vehicle(), memory["position"]
    try:
        if memory["vehicle"]:
            vehicle.load(memory["vehicle"])
    except Exception as error:  # of another version, say
        memory.move_aside(f"{type(error).__name__}: {error}")
        vehicle, position = Vehicle(), None
    if memory.problem:
        vehicle.refuse(Error("fileError", memory.problem, (), "send the order again"))
    return vehicle, position


def arguments(given: list[str]) -> argparse.Namespace:
    """The command line, without the program's name; ends the program on a wrong one."""
    parser = argparse.ArgumentParser(
        prog="vda5050.py",
        description="Lets the master of a fleet command the robot: VDA 5050 over MQTT. It needs the robot's nodes and "
        "follow_path.py; fleet.launch starts all but the robot. Services: vda5050/pause, vda5050/resume, "
        "vda5050/trigger.",
    )
    parser.add_argument("--config", type=given_path, help="YAML file, overrides the installed config/fleet.yaml")
    return parser.parse_args(given)


def main() -> None:
    """Entry point of scripts/vda5050.py."""
    given = arguments([each for each in rospy.myargv()[1:] if each])
    try:
        import jsonschema  # noqa: F401 (a missing module is one message, before anything runs)
        import paho.mqtt.client  # noqa: F401

        shipped = Path(share_file("config/fleet.yaml"))
        settings = read_settings(shipped, *([given.config] if given.config else []))
    except ImportError:
        sys.exit(f"vda5050.py: {MISSING}")
    except (SettingsError, OSError) as error:
        sys.exit(f"vda5050.py: {fit_for_message(in_words(error))}")
    with one_message("vda5050.py", *REFUSALS), running_node("vda5050") as signals:
        Node(settings).run(signals)
