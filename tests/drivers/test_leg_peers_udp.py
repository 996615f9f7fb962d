"""Our messages to and from a Go1 against the maker's own library (PyPI unitree-legged-sdk), on the loopback."""

import random
import socket
import struct
import subprocess
import time
from pathlib import Path

import pytest
from support.pypi_package import imported

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "build/robot_control/tests/drivers/legged_peer"
LOW_LEVEL = 0xFF
MOTORS = 20
COMMANDS = 300
STATES = 300


@pytest.fixture(scope="module")
def sdk():
    return imported("unitree_legged_sdk.robot_interface", "legs", "unitree-legged-sdk")


@pytest.fixture
def robot():
    """The socket of the robot; the maker's library sends to it."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as end:
        end.bind(("127.0.0.1", 0))
        end.settimeout(5)
        yield end


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as end:
        end.bind(("127.0.0.1", 0))
        return end.getsockname()[1]


@pytest.fixture
def client(sdk, robot):
    return sdk.UDP(LOW_LEVEL, free_port(), "127.0.0.1", robot.getsockname()[1])


def numbers(value):
    """The numbers of a list, or the number itself."""
    return [number for each in value for number in numbers(each)] if hasattr(value, "__iter__") else [float(value)]


def members(thing, names):
    return [number for name in names.split() for number in numbers(getattr(thing, name))]


HEAD = "levelFlag frameReserve SN version bandWidth"


def numbers_of_command(command):
    motors = [number for m in command.motorCmd for number in members(m, "mode q dq tau Kp Kd reserve")]
    rest = members(command.bms, "off reserve") + members(command, "wirelessRemote reserve")
    return members(command, HEAD) + motors + rest


def numbers_of_state(state):
    words = "mode q dq ddq tauEst q_raw dq_raw ddq_raw temperature reserve"
    motors = [number for motor in state.motorState for number in members(motor, words)]
    imu = members(state.imu, "quaternion gyroscope accelerometer rpy temperature")
    bms = members(state.bms, "version_h version_l bms_status SOC current cycle BQ_NTC MCU_NTC cell_vol")
    rest = members(state, "footForce footForceEst tick wirelessRemote reserve")
    return members(state, HEAD) + imu + motors + bms + rest


def as_float(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def random_command(sdk, client, chance):
    """A command whose numbers the messages can state exactly."""
    command = sdk.LowCmd()
    client.InitCmdData(command)
    for motor in list(command.motorCmd)[:MOTORS]:
        motor.mode = chance.choice((0x00, 0x0A))
        motor.q = as_float(chance.uniform(-10, 10))
        motor.dq = as_float(chance.uniform(-30, 30))
        motor.tau = chance.randrange(-32768, 32768) / 256
        motor.Kp = chance.randrange(-32768, 32768) / 32
        motor.Kd = chance.randrange(-32768, 32768) / 16
    command.wirelessRemote = [chance.randrange(256) for _ in range(40)]
    return command


def decoded(lines):
    answer = subprocess.run(
        [PROGRAM, "commands"], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True
    )
    return answer.stdout.splitlines()


def test_every_number_of_a_command_of_the_maker_is_read_equal(sdk, robot, client):
    chance = random.Random(74)
    expected, datagrams = [], []
    for _ in range(COMMANDS):
        command = random_command(sdk, client, chance)
        client.SetSend(command)
        client.Send()
        datagrams.append(robot.recv(2000))
        expected.append(numbers_of_command(command))
    for line, wanted in zip(decoded([data.hex() for data in datagrams]), expected, strict=True):
        assert [float(word) for word in line.split()] == wanted
    damaged = [data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :] for data in datagrams[:1] for at in range(3, 608)]
    assert set(decoded([data.hex() for data in damaged])) == {"refused"}


def received(sdk, robot, client, datagram, before):
    """The state that the maker's library holds once it has taken this datagram, or `before` if it stays that."""
    state = sdk.LowState()
    deadline = time.monotonic() + 0.2
    robot.sendto(datagram, client.address)
    while time.monotonic() < deadline:
        client.Recv()
        client.GetRecv(state)
        if numbers_of_state(state) != before:
            break
    return numbers_of_state(state)


def test_every_number_of_our_state_is_read_equal_by_the_maker_and_a_wrong_check_is_refused(sdk, robot):
    address = ("127.0.0.1", free_port())
    client = Addressed(sdk.UDP(LOW_LEVEL, address[1], "127.0.0.1", robot.getsockname()[1]), address)
    answer = subprocess.run([PROGRAM, "states", str(STATES)], capture_output=True, text=True, check=True)
    lines = answer.stdout.splitlines()
    held = numbers_of_state(sdk.LowState())
    for i in range(STATES):
        datagram = bytes.fromhex(lines[2 * i])
        wrong = datagram[:-1] + bytes([datagram[-1] ^ 0x40])
        if i < 3:
            assert received(sdk, robot, client, wrong, held) == held, "a wrong check sum"
        held = received(sdk, robot, client, datagram, held)
        assert held == [float(word) for word in lines[2 * i + 1].split()]


class Addressed:
    """The maker's client and the address to which it listens."""

    def __init__(self, client, address):
        self.Recv, self.GetRecv, self.address = client.Recv, client.GetRecv, address
        self._client = client
