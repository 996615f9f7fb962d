"""The codec of a Damiao motor equals that of PyPI's damiao-motor to the bit."""

import random
import struct
import subprocess
from pathlib import Path

import pytest
from support.pypi_package import imported

PROGRAM = Path(__file__).parents[2] / "build/robot_control/tests/drivers/damiao_codec_lines"
FRAMES = 100_000


@pytest.fixture(scope="module")
def peer():
    return imported("damiao_motor.core.motor", "can", "damiao-motor")


class KeptFrames:
    """The bus of python-can, as far as the peer uses it."""

    def __init__(self):
        self.sent = []

    def send(self, message):
        self.sent.append((message.arbitration_id, bytes(message.data)))


def answers(lines):
    run = subprocess.run([PROGRAM], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
    return run.stdout.splitlines()


def motors(peer, chance):
    """A random type of motor each time, with its ranges."""
    made = {}
    while True:
        kind = chance.choice(sorted(peer.MOTOR_TYPE_PRESETS))
        if kind not in made:
            made[kind] = peer.DaMiaoMotor(motor_id=1, feedback_id=17, bus=KeptFrames(), motor_type=kind)
        limits = peer.MOTOR_TYPE_PRESETS[kind]
        yield made[kind], (limits["p_max"], limits["v_max"], limits["t_max"])


def test_orders_are_equal(peer):
    chance = random.Random(1)
    lines, expected = [], []
    for _, (motor, ranges) in zip(range(FRAMES), motors(peer, chance), strict=False):
        position, velocity, torque = (1.1 * chance.uniform(-limit, limit) for limit in ranges)
        stiffness, damping = chance.uniform(0, 550), chance.uniform(0, 5.5)
        values = (position, velocity, stiffness, damping, torque)
        lines.append("order " + " ".join(repr(value) for value in (*ranges, *values)))
        expected.append(motor.encode_cmd_msg(position, velocity, torque, stiffness, damping).hex())
    assert answers(lines) == expected


def test_feedback_is_equal(peer):
    chance = random.Random(2)
    lines, expected = [], []
    for _, (motor, ranges) in zip(range(FRAMES), motors(peer, chance), strict=False):
        data = chance.randbytes(8)
        lines.append("feedback " + " ".join(map(repr, ranges)) + " " + data.hex())
        read = motor.decode_sensor_feedback(data)
        numbers = [read[key] for key in ("pos", "vel", "torq", "t_mos", "t_rotor")]
        expected.append((read["status_code"], read["can_id"], *numbers))
    found = [tuple(map(float, line.split())) for line in answers(lines)]
    assert found == expected


def test_registers_are_equal(peer):
    bus = KeptFrames()
    motor = peer.DaMiaoMotor(motor_id=5, feedback_id=21, bus=bus, motor_type="8009")
    motor.write_register(9, 2000)
    motor.write_register(21, 12.5)
    motor.request_register_reading(10)
    bits = struct.unpack("<I", struct.pack("<f", 12.5))[0]
    lines = [f"register 5 {0x55} 9 2000", f"register 5 {0x55} 21 {bits}", f"register 5 {0x33} 10 0"]
    assert [(0x7FF, bytes.fromhex(line)) for line in answers(lines)] == bus.sent
