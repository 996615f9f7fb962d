"""Our Go2 against its maker's own Python library (PyPI unitree_sdk2py_dimos with cyclonedds), by DDS on the loopback.

The chain is: driver, unitree_bridge, DDS, unitree_bridge --side robot, simulated robot.
"""

import contextlib
import os
import random
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from support.pypi_package import imported

from bench.devices.walk_bridge import KINDS, BridgeLoss, run_bridge_loss

ROOT = Path(__file__).parents[2]
BUILD = ROOT / "build/robot_control"
PEER = BUILD / "tests/drivers/go_peer"
BRIDGE = BUILD / "devel/lib/robot_control/unitree_bridge"
REPORT = 28  # bytes before a state
DOMAIN = 100 + os.getpid() % 100
"""of DDS; other tests on this machine have another one"""
MOTORS = 20
STOPPED = 10 * 0.02
"""s: ten times what docs/drivers.md states, because this machine may be busy; UnitreeGo.EachLossIsNamedInTime… has the
bound itself, in virtual time"""
FEW = 20


@pytest.fixture(scope="module")
def sdk():
    """The maker's library on the loopback."""
    if not BRIDGE.exists():
        pytest.skip("unitree_bridge was not built: scripts/setup --unitree")
    channel = imported("unitree_sdk2py.core.channel", "unitree", "unitree_sdk2py_dimos")
    channel.ChannelFactoryInitialize(DOMAIN, "lo")
    return Sdk(channel)


class Sdk:
    """The parts of the maker's library that are used here."""

    def __init__(self, channel):
        types = imported("unitree_sdk2py.idl.unitree_go.msg.dds_", "unitree")
        self.defaults = imported("unitree_sdk2py.idl.default", "unitree")
        self.crc = imported("unitree_sdk2py.utils.crc", "unitree").CRC()
        self._types = {"rt/lowcmd": types.LowCmd_, "rt/lowstate": types.LowState_}
        self._channel = channel

    @contextlib.contextmanager
    def publisher(self, topic):
        publisher = self._channel.ChannelPublisher(topic, self._types[topic])
        publisher.Init()
        try:
            yield publisher
        finally:
            publisher.Close()

    @contextlib.contextmanager
    def received(self, topic):
        """A list that grows by (monotonic time, message)."""
        messages = []
        subscriber = self._channel.ChannelSubscriber(topic, self._types[topic])
        # Without a queue: the library's thread of a queue may miss the end, and `Close` then waits for ever.
        subscriber.Init(lambda message: messages.append((time.monotonic(), message)))
        try:
            yield messages
        finally:
            subscriber.Close()

    def command(self):
        """A command as the maker's examples begin: each motor in servo mode, and free."""
        command = self.defaults.unitree_go_msg_dds__LowCmd_()
        command.head[0], command.head[1] = 0xFE, 0xEF
        command.level_flag = 0xFF
        for motor in command.motor_cmd:
            motor.mode, motor.q, motor.dq, motor.kp, motor.kd, motor.tau = 1, 2.146e9, 16000.0, 0, 0, 0
        return command


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as end:
        end.bind(("127.0.0.1", 0))
        return end.getsockname()[1]


def drive_file(folder, name, **keys):
    """A drive file with a port of its own; returns its path and the address."""
    address, port = f"127.0.0.1:{free_port()}", free_port()
    line = {"interface": "lo", "domain": DOMAIN, "address": address, "port": port, "on_silence": "unknown", **keys}
    text = "unitree_go:\n  robot: go2\n" + "".join(f"  {key}: {value}\n" for key, value in line.items())
    text += "every_joint:\n  torque_limit: 40\n  velocity_limit: 100\n"
    text += "".join(f"joint_{motor}:\n  motor: {motor}\n" for motor in range(12))
    path = folder / f"{name}.yaml"
    path.write_text(text)
    return path


class Child:
    """A program whose lines are kept with their time."""

    def __init__(self, *words):
        self.lines = []
        self.process = subprocess.Popen(
            list(map(str, words)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.append(line.rstrip())

    def wait_for(self, word, limit=8.0, after=0):
        """The first line with the word, counted from line `after`."""
        deadline = time.monotonic() + limit
        while time.monotonic() < deadline:
            for line in self.lines[after:]:
                if word in line:
                    return line
            time.sleep(0.002)
        raise AssertionError(f"no {word!r} in {limit} s of {self.process.args}: {self.lines[-5:]}")

    def end(self):
        with contextlib.suppress(ProcessLookupError):
            self.process.send_signal(signal.SIGCONT)
            self.process.terminate()
            with contextlib.suppress(subprocess.TimeoutExpired):
                self.process.wait(2)
            self.process.kill()
        self.process.wait()


@pytest.fixture
def start():
    """Starts programs, which end with the test."""
    children = []

    def start_one(*words):
        children.append(Child(*words))
        return children[-1]

    yield start_one
    for child in reversed(children):
        child.end()


def numbers(value):
    """The numbers of a list, or the number itself."""
    return [number for each in value for number in numbers(each)] if hasattr(value, "__iter__") else [float(value)]


def members(thing, names):
    return [number for name in names.split() for number in numbers(getattr(thing, name))]


HEAD = "level_flag frame_reserve sn version bandwidth"


def numbers_of_command(command):
    motors = [number for m in command.motor_cmd for number in members(m, "mode q dq tau kp kd reserve")]
    rest = members(command.bms_cmd, "off reserve") + members(command, "wireless_remote led fan gpio reserve")
    return members(command, HEAD) + motors + rest


def numbers_of_state(state):
    words = "mode q dq ddq tau_est q_raw dq_raw ddq_raw temperature lost reserve"
    motors = [number for motor in state.motor_state for number in members(motor, words)]
    imu = members(state.imu_state, "quaternion gyroscope accelerometer rpy temperature")
    bms = members(state.bms_state, "version_high version_low status soc current cycle bq_ntc mcu_ntc cell_vol")
    words = "foot_force foot_force_est tick wireless_remote bit_flag adc_reel temperature_ntc1 temperature_ntc2 "
    return members(state, HEAD) + imu + motors + bms + members(state, words + "power_v power_a fan_frequency reserve")


def as_float(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


@pytest.fixture
def device(tmp_path, start, sdk):
    """The socket of a simulated robot, with the bridge of its side before it, and the address of that bridge."""
    path = drive_file(tmp_path, "robot")
    address = next(line.split(": ")[1] for line in path.read_text().splitlines() if "address" in line)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as end:
        end.bind(("127.0.0.1", int(address.split(":")[1])))
        end.settimeout(5)
        start(BRIDGE, path, "--side", "robot")
        _, bridge = end.recvfrom(2000)
        yield end, bridge


def next_command(end):
    while len(data := end.recv(2000)) == 1:
        pass
    return data


def test_every_number_of_a_command_of_the_maker_is_read_equal(sdk, device):
    chance, expected, datagrams = random.Random(74), [], []
    with sdk.publisher("rt/lowcmd") as publisher:
        time.sleep(0.5)
        for _ in range(FEW):
            command = sdk.command()
            for motor in command.motor_cmd:
                motor.q, motor.dq = as_float(chance.uniform(-10, 10)), as_float(chance.uniform(-30, 30))
                motor.tau, motor.kp, motor.kd = (as_float(chance.uniform(-100, 100)) for _ in range(3))
            command.wireless_remote = [chance.randrange(256) for _ in range(40)]
            command.gpio = chance.randrange(256)
            command.crc = sdk.crc.Crc(command)
            publisher.Write(command)
            datagrams.append(next_command(device[0]))
            expected.append(numbers_of_command(command))
    wrong = bytes([*datagrams[0][:30], datagrams[0][30] ^ 1, *datagrams[0][31:]])
    lines = "\n".join(data.hex() for data in [*datagrams, wrong]) + "\n"
    answer = subprocess.run([PEER, "commands"], input=lines, capture_output=True, text=True, check=True).stdout
    *read, refused = answer.splitlines()
    assert refused == "refused"
    for line, wanted in zip(read, expected, strict=True):
        assert [float(word) for word in line.split()] == wanted


def test_every_number_of_our_state_is_read_equal_by_the_maker_with_its_check_sum(sdk, device):
    end, bridge = device
    answer = subprocess.run([PEER, "states", str(FEW)], capture_output=True, text=True, check=True)
    lines = answer.stdout.splitlines()
    report = struct.pack("<II", 0x32424755, 1) + bytes(REPORT - 8)
    with sdk.received("rt/lowstate") as states:
        time.sleep(0.5)
        for i in range(FEW):
            end.sendto(report + bytes.fromhex(lines[2 * i]), bridge)
            deadline = time.monotonic() + 2
            while len(states) <= i and time.monotonic() < deadline:
                time.sleep(0.001)
            state = states[i][1]
            assert numbers_of_state(state) == [float(word) for word in lines[2 * i + 1].split()]
            assert sdk.crc.Crc(state) == state.crc


@pytest.fixture
def robot(tmp_path, start, sdk):
    """A simulated robot in the air behind the bridge of its side."""
    path = drive_file(tmp_path, "robot")
    robot = start(PEER, "robot", path)
    start(BRIDGE, path, "--side", "robot")
    return robot


@pytest.fixture
def second_robot(tmp_path, start, sdk):
    """Starts a second robot on the same network. Its serial number is that of the first one."""

    def start_robot():
        path = drive_file(tmp_path, "second_robot")
        robot = start(PEER, "robot", path)
        bridge = start(BRIDGE, path, "--side", "robot")
        return robot, bridge

    return start_robot


CROUCH = [0.0, 1.36, -2.65] * 4
STAND = [0.0, 0.67, -1.3] * 4


def test_the_makers_client_stands_our_robot_up(sdk, robot):
    with sdk.publisher("rt/lowcmd") as publisher, sdk.received("rt/lowstate") as states:
        time.sleep(0.5)
        start = [0.0] * 12
        for target in (CROUCH, STAND):
            for step in range(400):  # the last 150 let the damping settle
                share = min(1, (step + 1) / 250)
                command = sdk.command()
                for motor, first, last in zip(command.motor_cmd, start, target, strict=False):
                    motor.q, motor.dq, motor.kp, motor.kd = first + share * (last - first), 0.0, 60.0, 5.0
                command.crc = sdk.crc.Crc(command)
                publisher.Write(command)
                time.sleep(0.002)
            start = target
        time.sleep(0.01)
        angles = [motor.q for motor in states[-1][1].motor_state[:12]]
        assert angles == pytest.approx(STAND, abs=0.05)
        assert [float(word) for word in robot.lines[-1].split()] == pytest.approx(STAND, abs=0.05)
        assert len(states) > 300, "at 500 Hz for a second"


@pytest.fixture
def chain(tmp_path, start, robot):
    """Starts driver and bridge before the robot, with keys of the drive file; returns both."""

    def start_chain(wanted="running", limit=8.0, **keys):
        path = drive_file(tmp_path, "driver", **{"has_service": "false", **keys})
        driver = start(PEER, "driver", path)
        bridge = start(BRIDGE, path)
        driver.wait_for(wanted, limit)
        return driver, bridge

    return start_chain


def turned(robot):
    """rad, of the first motor within 0.2 s."""
    before = float(robot.lines[-1].split()[0])
    time.sleep(0.2)
    return float(robot.lines[-1].split()[0]) - before


def test_the_driver_turns_the_robot_and_the_makers_client_reads_its_commands(sdk, robot, chain):
    with sdk.received("rt/lowcmd") as commands:
        chain()
        time.sleep(0.5)
        assert turned(robot) == pytest.approx(0.2, abs=0.05)
        command = commands[-1][1]
        assert sdk.crc.Crc(command) == command.crc
        assert command.motor_cmd[0].kd == 1
        assert command.motor_cmd[0].dq == 1


@pytest.mark.parametrize(("end", "words"), [(signal.SIGKILL, "has ended"), (signal.SIGSTOP, "hangs")])
def test_a_bridge_that_ends_or_hangs_is_named_and_the_robot_stops(robot, chain, end, words):
    driver, bridge = chain()
    time.sleep(0.3)
    count, at = len(driver.lines), time.monotonic_ns()
    bridge.process.send_signal(end)
    line = driver.wait_for("has lost its bridge", after=count)
    assert words in line
    late = 1e-9 * (int(line.split()[0]) - at)
    sys.stdout.write(f"{words}: named after {1e3 * late:.1f} ms\n")
    assert late < STOPPED
    time.sleep(0.3)
    assert abs(turned(robot)) < 0.01
    if end == signal.SIGSTOP:
        bridge.process.send_signal(signal.SIGCONT)
        time.sleep(0.3)
        assert abs(turned(robot)) < 0.01, "the fault stays until the reset"


@pytest.mark.parametrize("kind", KINDS)
def test_quadbot_folds_upright_if_its_bridge_ends_or_hangs_while_it_walks(sdk, kind):
    outcome = run_bridge_loss(BUILD, BridgeLoss(kind, seed=7))
    sys.stdout.write(f"{kind}: named after {1e3 * outcome.named:.1f} ms, tilt {outcome.tilt:.2f} rad\n")
    assert outcome.broken == ()
    assert outcome.named < STOPPED


@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGSTOP])
def test_the_bridge_damps_the_legs_of_a_driver_that_ends_or_hangs(sdk, robot, chain, end):
    with sdk.received("rt/lowcmd") as commands:
        driver, _ = chain(damping=4)
        time.sleep(0.3)
        at = time.monotonic()
        driver.process.send_signal(end)
        time.sleep(0.3)
        damping = [when for when, command in commands if when > at and command.motor_cmd[0].kd == 4]
        sys.stdout.write(f"damps after {1e3 * (damping[0] - at):.1f} ms\n")
        assert damping[0] - at < STOPPED
        assert abs(turned(robot)) < 0.01
        time.sleep(4)
        count = len(commands)
        time.sleep(0.2)
        assert len(commands) == count, "a bridge without a driver leaves the motors alone"


def test_a_second_writer_is_named_and_its_command_is_named(sdk, robot, chain):
    driver, bridge = chain()
    with sdk.publisher("rt/lowcmd"):
        assert "number of writers, 1 instead of 0" in driver.wait_for("is commanded by another program")
    driver.end()
    bridge.end()
    other, _ = chain(other_writers=1)
    with sdk.publisher("rt/lowcmd") as publisher:
        time.sleep(0.5)
        count = len(other.lines)
        publisher.Write(sdk.command())
        assert "with frame LowCmd; stop" in other.wait_for("is commanded by another program", after=count)


OTHER_ROBOT = "sends a state of another robot, by a second writer of rt/lowstate"


def test_a_second_robot_on_the_network_is_named_and_the_robot_stops(sdk, robot, chain, second_robot):
    driver, _ = chain()
    time.sleep(0.3)
    assert turned(robot) == pytest.approx(0.2, abs=0.05)
    second_robot()
    line = driver.wait_for(OTHER_ROBOT)
    assert "fault" in line
    assert "connect only one robot" in line
    time.sleep(0.3)
    assert abs(turned(robot)) < 0.01


def test_neither_of_two_robots_is_commanded_before_one_is_alone(sdk, start, robot, chain, second_robot):
    """The bridge follows the robot that DDS finds first. If that one is removed, the driver has no states for a second,
    which is a fault until its reset, here a new driver.
    """
    other, other_bridge = second_robot()
    with sdk.received("rt/lowcmd") as commands:
        driver, bridge = chain(wanted=OTHER_ROBOT)
        bridge.wait_for("a second robot sends states")
        time.sleep(0.5)
        assert not commands
        other_bridge.end()
        other.end()
        bridge.wait_for("one robot sends states")
        driver.end()
        start(*driver.process.args).wait_for("running")
        time.sleep(0.5)
        assert turned(robot) == pytest.approx(0.2, abs=0.05)


class MotionService:
    """The maker's server with an active mode."""

    def __init__(self, mode):
        server = imported("unitree_sdk2py.rpc.server", "unitree")
        self.mode, self.calls = mode, []
        self._server = server.Server("motion_switcher")
        self._server._SetApiVersion("1.0.0.1")
        self._server._RegistHandler(1001, self._check, False)
        self._server._RegistHandler(1003, self._release, False)
        self._server.Start(False)

    def _check(self, _):
        self.calls.append("check")
        return 0, f'{{"form":"0","name":"{self.mode}"}}'

    def _release(self, _):
        self.calls.append("release")
        self.mode = ""
        return 0, ""


@pytest.fixture(scope="module")
def service(sdk):
    return MotionService("")


def test_the_motion_service_is_awaited_and_released_at_the_users_wish_alone(sdk, robot, chain, service):
    with sdk.received("rt/lowcmd") as commands:
        service.mode, service.calls = "mcf", []
        driver, bridge = chain("(mode mcf)", has_service="true")
        time.sleep(1.2)
        assert "release" not in service.calls
        assert not commands, "no command before the release"
        service.mode = ""  # as by the maker's app
        driver.wait_for("running")
        driver.end()
        bridge.end()
        service.mode, service.calls = "mcf", []
        chain(has_service="true", release_service="true")
        assert "release" in service.calls


def test_a_robot_whose_motion_service_does_not_answer_is_refused(sdk, robot, chain, service):
    service._server._Server__apiHandlerMapping.clear()
    driver, _ = chain("set has_service: false", has_service="true", domain=DOMAIN + 1)
    assert "did not answer a request for the mode of its motion service" in driver.lines[-1]


HOSTILE = """
import random, sys, time
from dataclasses import dataclass
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import sequence, uint8, uint64
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from unitree_sdk2py.idl.default import unitree_go_msg_dds__LowState_
from unitree_sdk2py.idl.unitree_go.msg.dds_ import LowState_
from unitree_sdk2py.utils.crc import CRC

@dataclass
class Other(IdlStruct, typename="unitree_go.msg.dds_.LowState_"):
    text: str
    numbers: sequence[uint64]

domain = int(sys.argv[1])
keep = [Domain(domain, "<CycloneDDS><Domain Id='any'><General><Interfaces>"
               "<NetworkInterface name='lo' multicast='true'/></Interfaces></General></Domain></CycloneDDS>")]
participants = [DomainParticipant(domain) for _ in range(8)]
other = DataWriter(participants[0], Topic(participants[0], "rt/lowstate", Other))
for participant in participants[1:]:
    state, command = Topic(participant, "rt/lowstate", LowState_), Topic(participant, "rt/api/x", Other)
    keep += [DataWriter(participant, state) for _ in range(10)] + [DataReader(participant, state) for _ in range(10)]
    keep += [DataWriter(participant, command) for _ in range(10)]
forger = keep[-20 * 7]
chance, crc = random.Random(1), CRC()
writer = DataWriter(participants[1], Topic(participants[1], "rt/lowstate", LowState_))
print("ready", flush=True)
end = time.monotonic() + 3
while time.monotonic() < end:
    other.write(Other("x" * chance.randrange(3000), [chance.randrange(2**64) for _ in range(chance.randrange(300))]))
    state = unitree_go_msg_dds__LowState_()
    state.head[0], state.head[1], state.level_flag = 0xFE, 0xEF, 0xFF
    state.sn[0] = chance.choice((0, 1))
    state.tick = chance.randrange(2**32)
    for motor in state.motor_state:
        motor.q = chance.uniform(-3, 3)
    state.crc = crc.Crc(state) if chance.random() < 0.5 else 7
    writer.write(state)
    time.sleep(0.001)
print("done", flush=True)
"""


def test_a_hostile_participant_ends_no_more_than_the_bridge_and_the_robot_stops(sdk, robot, chain, start, tmp_path):
    driver, bridge = chain()
    time.sleep(0.3)
    script = tmp_path / "hostile.py"
    script.write_text(HOSTILE)
    count = len(driver.lines)
    os.environ["PYTHONPATH"] = os.pathsep.join(sys.path)
    hostile = start(sys.executable, script, DOMAIN)
    hostile.wait_for("ready", 20)
    driver.wait_for("fault", after=count)
    hostile.wait_for("done", 10)
    sys.stdout.write(f"driver: {driver.lines[count:]}\nbridge: {bridge.process.poll()} {bridge.lines[-2:]}\n")
    assert driver.process.poll() is None
    assert abs(turned(robot)) < 0.01
