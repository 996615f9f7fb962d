"""Runs nodes as processes and observes the robot through ROS, for the system tests.

The tests judge wiring, not timing: every wait has a limit far beyond the need of a busy machine.
"""

import contextlib
import functools
import math
import os
import signal
import subprocess
import tempfile
import time
import unittest
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import roslib.packages
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from robot_control.msg import DriveState, SafetyStatus
from robot_control.robot.pose import Pose, pose_of
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from std_srvs.srv import Trigger, TriggerResponse
from system import rosunit_results
from system.stall_witness import StallWitness

rosunit_results.record()

Case = TypeVar("Case", bound=Callable[..., None])

DRIVER, ESTIMATOR, CONTROLLER, MONITOR = "mujoco_plant", "state_estimator", "diff_drive_controller", "safety_monitor"
LOOP = (DRIVER, ESTIMATOR, CONTROLLER, MONITOR)
LIMIT = 30.0
"""s; an event that takes longer has not happened. On an idle machine nothing here takes longer than 3 s."""
ATTEMPTS = 4
SEND_PERIOD = 0.1
"""s; a twelfth of cmd_vel_timeout."""
STANDING = 0.01
"""m/s"""
SETTLING = 0.5
"""s; for 0.3 s after a ramp the estimate still shows single counts of an encoder as 1 cm/s."""
STALL_CAUSES = {"driver_lost", "controller_lost", "estimator_lost", "monitor_late", "command_stale", "gate_refuses"}
"""Causes that a machine may latch by itself after it stood still for loss_cycles, 20 ms."""
LISTED_SOURCES = (
    "/diff_drive_controller/command_sources",
    str(Path(roslib.packages.get_pkg_dir("robot_control"), "config/command_sources.yaml")),
)
"""The parameter of a robot that knows the shipped command sources"""
LOOP_STALL = 0.016
"""s; of these 20, command and permit may have survived the first 4 (kPermitLife)."""
LOOP_WITNESS = StallWitness(LOOP_STALL, 85, [0])  # robot.core of robot_params.yaml, above LoopPriority::kDriver
PROGRAM_STALL = 0.1
"""s; silences of 0.5 s end what an operator's program does, and a message passes several programs."""
GAP_KNOWN = 2.0
"""s; a witness knows of a gap at its end"""
PROGRAM_WITNESS = StallWitness(PROGRAM_STALL)  # scheduled as such a program is


def nightly(case: Case) -> Case | None:
    """Decorates a slow case. Without `scripts/test --nightly` it is no test method: neither run nor skipped."""
    return case if os.environ.get("ROBOT_CONTROL_NIGHTLY") else None


def again_after_a_stall(case: Callable[[Any], None]) -> Callable[[Any], None]:
    """Decorates a case of RobotTestCase: it is judged in an attempt during which no witness measured a stall, or in its
    last one. Without a stall a failure stands, because a fault of our own scheduling looks the same.
    """

    @functools.wraps(case)
    def repeated(test: Any) -> None:
        for _ in range(ATTEMPTS - 1):
            began = time.monotonic()
            try:
                return case(test)
            except AssertionError as error:
                ended = time.monotonic()
                time.sleep(GAP_KNOWN)
                if not (test.robot.stalled or PROGRAM_WITNESS.saw(began, ended)):
                    raise
                print(f"once more after a stall: {error}")
                test.doCleanups()
                test.setUp()
        return case(test)

    return repeated


def wait_for(
    what: str, condition: Callable[[], bool], limit: float = LIMIT, every: Callable[[], object] | None = None
) -> None:
    """Polls until the condition holds; `every` is called in each pass. Fails naming `what`."""
    end = time.monotonic() + limit
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"not within {limit:g} s: {what}")
        if every is not None:
            every()
        time.sleep(0.02)


class Process:
    """A process with its output in a file. `environment` lies over that of the test."""

    def __init__(
        self,
        name: str,
        command: Sequence[str],
        environment: Mapping[str, str] | None = None,
        folder: Path | None = None,
    ) -> None:
        self.name = name
        self._output = tempfile.NamedTemporaryFile(prefix=f"{name}-", suffix=".log")
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=self._output,
            stderr=subprocess.STDOUT,
            cwd=folder,
            env={**os.environ, **(environment or {})},
        )

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def running(self) -> bool:
        return self._process.poll() is None

    @property
    def output(self) -> str:
        return Path(self._output.name).read_text(errors="replace")

    def send_signal(self, number: int) -> None:
        self._process.send_signal(number)

    def wait(self, limit: float = LIMIT) -> int:
        """The exit code; negative after a signal. Fails with the program's output."""
        try:
            return self._process.wait(limit)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"{self.name} has not ended within {limit:g} s:\n{self.output}") from None

    def end(self) -> int:
        """Sends SIGINT, then SIGKILL if that does not help; returns the exit code."""
        if self.running:
            self.send_signal(signal.SIGINT)
            try:
                return self._process.wait(10.0)
            except subprocess.TimeoutExpired:
                self.send_signal(signal.SIGKILL)
        return self.wait()

    def kill(self) -> None:
        """Kills with -9 and waits for the end."""
        self.send_signal(signal.SIGKILL)
        self.wait()

    def shared_memory(self) -> set[Path]:
        """The shared-memory objects that it has mapped."""
        with contextlib.suppress(OSError):
            lines = Path(f"/proc/{self.pid}/maps").read_text().splitlines()
            paths = (Path(line.split(maxsplit=5)[5]) for line in lines if "/dev/shm/robot_control." in line)
            return {path for path in paths if path.exists()}
        return set()


class Program(Process):
    """A program of the package. `prefix`: a command that runs it."""

    def __init__(
        self,
        name: str,
        *arguments: str,
        namespace: str = "",
        prefix: Sequence[str] = (),
        environment: Mapping[str, str] = {},
    ) -> None:
        found = roslib.packages.find_node("robot_control", name)
        if not found:
            raise AssertionError(f"robot_control has no program {name}")
        ns = [f"__ns:={namespace}"] if namespace else []
        super().__init__(name, [*prefix, found[0], *arguments, *ns], environment)


def refusal(name: str, *arguments: str, prefix: Sequence[str] = (), environment: Mapping[str, str] = {}) -> str:
    """Starts a node that must refuse; returns its output."""
    program = Program(name, *arguments, prefix=prefix, environment=environment)
    try:
        code = program.wait()
    finally:
        program.end()
    assert code == 1, f"{name} ended with {code}, not 1:\n{program.output}"
    return program.output


class NoBool(Bool):
    """A Bool without any content."""

    def serialize(self, buff: BytesIO) -> None:
        buff.write(b"")


def truncated(kind: type) -> type:
    """The type, whose messages end after three bytes, as a publisher with a fault sends them."""
    return type(kind.__name__, (kind,), {"__slots__": [], "serialize": lambda _, buff: buff.write(b"\x01\x00\x00")})


@contextlib.contextmanager
def truncated_messages(topics: Mapping[str, type]) -> Iterator[None]:
    """A block before which each of these topics has brought truncated messages of its type."""
    publishers = {topic: rospy.Publisher(topic, truncated(kind), queue_size=1) for topic, kind in topics.items()}
    for topic, publisher in publishers.items():
        wait_for(f"a subscriber of {topic}", lambda: publisher.get_num_connections() > 0)  # noqa: B023 (called at once)
        for _ in range(3):
            publisher.publish(publisher.data_class())
            time.sleep(0.1)
    try:
        yield
    finally:
        for publisher in publishers.values():
            publisher.unregister()


class Latest:
    """The newest message of a topic."""

    def __init__(self, topic: str, kind: type) -> None:
        self.message: Any = None
        self.count = 0
        self._subscriber = rospy.Subscriber(topic, kind, self._receive)

    def _receive(self, message: object) -> None:
        self.message, self.count = message, self.count + 1


class Report(NamedTuple):
    """A node's newest status on /diagnostics."""

    message: str = ""
    values: Mapping[str, str] = {}


class Robot:
    """Four nodes in a namespace, and their messages.

    `prefix`: a command that runs each of them.
    """

    def __init__(self, namespace: str = "", prefix: Sequence[str] = ()) -> None:
        self.namespace = namespace
        self.prefix = prefix
        self.stall_causes = frozenset(STALL_CAUSES)
        self.stall_witness = LOOP_WITNESS
        self.nodes: dict[str, Program] = {}
        self.odom: Odometry | None = None
        self._joints: Latest | None = None
        self.status: SafetyStatus | None = None
        self.revoked: tuple[str, ...] = ()
        """Senders whose motion is refused until they send zero."""
        self.reports: defaultdict[str, Report] = defaultdict(Report)
        """By node."""
        self.odom_count = 0
        self._moved_at = -math.inf  # s, monotonic
        self._stopped_at = -math.inf  # s, monotonic
        self._subscribers = [
            rospy.Subscriber(self.name("odom"), Odometry, self._receive_odom),
            rospy.Subscriber(self.name("safety_status"), SafetyStatus, self._receive_status),
            rospy.Subscriber(self.name("drive_state"), DriveState, self._receive_drive_state),
            rospy.Subscriber("/diagnostics", DiagnosticArray, self._receive_diagnostics),
        ]
        self._cmd_vel = rospy.Publisher(self.name("cmd_vel"), Twist, queue_size=1, tcp_nodelay=True)
        self._e_stop = rospy.Publisher(self.name("e_stop"), Bool, queue_size=1, tcp_nodelay=True)
        self._last_send = 0.0

    def name(self, topic: str) -> str:
        """Absolute."""
        return f"/{self.namespace}/{topic}" if self.namespace else f"/{topic}"

    def start(self, *names: str) -> None:
        """Starts these nodes, or all four."""
        for name in names or LOOP:
            self.nodes[name] = Program(name, namespace=self.namespace, prefix=self.prefix)

    def end(self) -> None:
        """Ends all nodes and removes their shared memory: a master's port is never seen again."""
        objects = {path for node in self.nodes.values() for path in node.shared_memory()}
        for node in self.nodes.values():
            node.end()
        for path in objects:
            path.unlink(missing_ok=True)
        self.status = self.odom = None

    def restart(self, name: str) -> None:
        """Kills a node with -9 and starts it again."""
        self.nodes[name].kill()
        self.start(name)

    # what to ask of it

    def send(self, linear: float, angular: float) -> None:
        """Sends on cmd_vel, at most every SEND_PERIOD."""
        if time.monotonic() - self._last_send < SEND_PERIOD:
            return
        self._last_send = time.monotonic()
        message = Twist()
        message.linear.x, message.angular.z = linear, angular
        self._cmd_vel.publish(message)

    @contextlib.contextmanager
    def silence(self) -> Iterator[None]:
        """A block in which this node is no sender on cmd_vel."""
        self._cmd_vel.unregister()
        try:
            yield
        finally:
            self._cmd_vel = rospy.Publisher(self.name("cmd_vel"), Twist, queue_size=1, tcp_nodelay=True)

    def send_e_stop(self, stop: bool) -> None:
        """Publishes once, to a monitor that is connected: earlier messages would be lost."""
        wait_for("a subscriber of e_stop", lambda: self._e_stop.get_num_connections() > 0)
        self._e_stop.publish(Bool(stop))

    def call(self, service: str) -> TriggerResponse:
        rospy.wait_for_service(self.name(service), LIMIT)
        return rospy.ServiceProxy(self.name(service), Trigger)()

    def release(self) -> None:
        """Comes to rest under zero commands and resets until that is accepted."""
        self.await_rest()
        answer = [TriggerResponse()]

        def accepted() -> bool:
            answer[0] = self.call("e_stop_reset")
            return bool(answer[0].success)

        wait_for("an accepted reset", accepted, every=lambda: self.send(0, 0))

    def await_ready(self) -> None:
        """Waits for all nodes and the permit to drive; stops that a stalling machine latched are released."""
        wait_for("safety_status", lambda: self.status is not None)
        wait_for("the end of INIT", lambda: self.state != SafetyStatus.INIT, every=lambda: self.send(0, 0))
        wait_for("odometry", lambda: self.odom is not None)
        if self.state == SafetyStatus.STOPPED:
            self.release()

    def drive_until(self, what: str, condition: Callable[[], bool], linear: float = 0.5, angular: float = 0.2) -> None:
        """Sends until the condition holds, and zeros while the robot waits for one or this sender owes one. Stops that
        a stalling machine may latch are released on the way.
        """
        end = time.monotonic() + LIMIT
        while not condition():
            if time.monotonic() > end:
                details = "" if self.status is None else "; ".join(self.status.details)
                raise AssertionError(f"not within {LIMIT:g} s of driving: {what}; causes: {self.causes} ({details})")
            waits = self.status is not None and self.status.awaiting_zero_request
            self.send(*((0.0, 0.0) if waits or rospy.get_name() in self.revoked else (linear, angular)))
            self.release_after_a_stall()
            time.sleep(0.02)

    def release_after_a_stall(self) -> bool:
        """Releases a robot that is `stalled`; returns whether it was."""
        if self.state not in (SafetyStatus.STOPPED, SafetyStatus.FAULT) or not self.stalled:
            return False
        self.release()
        return True

    def await_rest(self) -> None:
        """Sends zero until the wheels stand."""
        wait_for("standstill", self.rests, every=lambda: self.send(0, 0))

    # what it says

    @property
    def state(self) -> int:
        return SafetyStatus.INIT if self.status is None else self.status.state

    @property
    def causes(self) -> set[str]:
        return set() if self.status is None else set(self.status.causes)

    @property
    def stalled(self) -> bool:
        """True if only causes of a stall stopped the robot, within a second of a stall that the witness measured."""
        near = (self._stopped_at - 1.0, self._stopped_at + 1.0)
        return bool(self.causes) and self.causes <= self.stall_causes and self.stall_witness.saw(*near)

    @property
    def speed(self) -> float:
        """m/s, estimated."""
        return math.nan if self.odom is None else self.odom.twist.twist.linear.x

    def rests(self) -> bool:
        """True if the speed is zero for SETTLING, instead of passing through zero."""
        return self.odom is not None and time.monotonic() - self._moved_at > SETTLING

    @property
    def joints(self) -> JointState:
        """The newest joint_states; few tests need the 100 messages of each second."""
        latest = self._joints = self._joints or Latest(self.name("joint_states"), JointState)
        wait_for("joint_states", lambda: latest.message is not None)
        return latest.message

    @property
    def pose(self) -> Pose:
        """Estimated, in odom."""
        assert self.odom is not None
        return pose_of(self.odom)

    @property
    def distance(self) -> float:
        """m from the origin of odom, estimated."""
        if self.odom is None:
            return math.nan
        position = self.odom.pose.pose.position
        return math.hypot(position.x, position.y)

    def driving(self) -> bool:
        return self.speed > 0.4

    def _receive_odom(self, message: Odometry) -> None:
        self.odom = message
        self.odom_count += 1
        if not abs(self.speed) < STANDING:
            self._moved_at = time.monotonic()

    def _receive_drive_state(self, message: DriveState) -> None:
        self.revoked = tuple(message.revoked)

    def _receive_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            self.reports[status.name] = Report(status.message, {pair.key: pair.value for pair in status.values})

    def _receive_status(self, message: SafetyStatus) -> None:
        if message.causes and not self.causes:
            self._stopped_at = time.monotonic()
        self.status = message


@contextlib.contextmanager
def running_robot(namespace: str = "") -> Iterator[Robot]:
    """Four nodes, ready; they end whatever happens."""
    robot = Robot(namespace)
    try:
        robot.start()
        robot.await_ready()
        yield robot
    finally:
        robot.end()


class RobotTestCase(unittest.TestCase):
    """Tests that share one robot in the root namespace, a `shared` one with the other classes of this process."""

    robot: Robot
    prefix: Sequence[str] = ()
    parameters: Sequence[tuple[str, object]] = ()
    """of the server, from the start of the robot on"""
    shared: Robot | None = None
    """set by run_cases.py, which ends it"""

    @classmethod
    def setUpClass(cls) -> None:
        for name, value in cls.parameters:
            rospy.set_param(name, value)
        cls.robot = cls.shared or Robot(prefix=cls.prefix)
        if not cls.robot.nodes:
            cls.robot.start()

    @classmethod
    def tearDownClass(cls) -> None:
        if cls.shared is None:
            cls.robot.end()

    def setUp(self) -> None:
        self.robot.await_ready()
        self.robot.await_rest()


def repository() -> Path:
    return Path(roslib.packages.get_pkg_dir("robot_control"))


def schedule_of(task: Path) -> tuple[int, set[int], str]:
    """Scheduling class, cores and name of one thread of /proc."""
    number = int(task.name)
    return os.sched_getscheduler(number), os.sched_getaffinity(number), (task / "comm").read_text().strip()
