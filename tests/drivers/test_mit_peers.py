"""The codecs of motors in MIT mode equal those of packages of PyPI to the bit.

Damiao: damiao-motor. CyberGear: python-cybergear. AK: mini-cheetah-motor-driver-socketcan.
"""

import random
import struct
import subprocess
from pathlib import Path
from types import SimpleNamespace

import pytest
from support.pypi_package import imported

PROGRAM = Path(__file__).parents[2] / "build/robot_control/tests/drivers/mit_codec_lines"
FRAMES = 100_000
PACKED = 1_000
"""frames of an AK that the peer packs or unpacks itself, in some ms each; its raw numbers of all others are compared"""


@pytest.fixture(scope="module")
def damiao():
    return imported("damiao_motor.core.motor", "can", "damiao-motor")


@pytest.fixture(scope="module")
def cybergear():
    return imported("cybergear.cybergear", "can", "python-cybergear")


@pytest.fixture(scope="module")
def mini_cheetah():
    return imported("motor_driver.canmotorlib", "can", "mini-cheetah-motor-driver-socketcan")


class KeptFrames:
    """The bus of python-can, as far as the peers use it."""

    def __init__(self):
        self.sent = []

    def send(self, message, **_):
        self.sent.append((message.arbitration_id, bytes(message.data)))


def answers(lines):
    run = subprocess.run([PROGRAM], input="\n".join(lines) + "\n", capture_output=True, text=True, check=True)
    return run.stdout.splitlines()


def frames(lines):
    """The identifiers and data of the program's answers."""
    read = (line.split() for line in answers(lines))
    return [(int(identifier), bytes.fromhex(data)) for identifier, data in read]


def numbers(lines):
    return [tuple(map(float, line.split())) for line in answers(lines)]


def order_line(dialect, ranges, order):
    return f"{dialect} order " + " ".join(map(repr, (*ranges, *order)))


def feedback_line(dialect, ranges, identifier, data):
    return f"{dialect} feedback " + " ".join(map(repr, ranges)) + f" {identifier} {data.hex()}"


def drawn_order(chance, ranges):
    """Position, velocity, stiffness, damping and torque, some of them beyond their ranges."""
    position, velocity, torque = (1.1 * chance.uniform(-limit, limit) for limit in ranges)
    return position, velocity, chance.uniform(0, 550), chance.uniform(0, 5.5), torque


def damiao_motors(peer, chance):
    """A random type of motor each time, with its ranges."""
    made = {}
    while True:
        kind = chance.choice(sorted(peer.MOTOR_TYPE_PRESETS))
        if kind not in made:
            made[kind] = peer.DaMiaoMotor(motor_id=1, feedback_id=17, bus=KeptFrames(), motor_type=kind)
        limits = peer.MOTOR_TYPE_PRESETS[kind]
        yield made[kind], (limits["p_max"], limits["v_max"], limits["t_max"])


def test_orders_of_a_damiao_are_equal(damiao):
    chance = random.Random(1)
    lines, expected = [], []
    for _, (motor, ranges) in zip(range(FRAMES), damiao_motors(damiao, chance), strict=False):
        position, velocity, stiffness, damping, torque = order = drawn_order(chance, ranges)
        lines.append(order_line("damiao", ranges, order))
        expected.append((1, motor.encode_cmd_msg(position, velocity, torque, stiffness, damping)))
    assert frames(lines) == expected


def test_feedback_of_a_damiao_is_equal(damiao):
    chance = random.Random(2)
    lines, expected = [], []
    for _, (motor, ranges) in zip(range(FRAMES), damiao_motors(damiao, chance), strict=False):
        data = chance.randbytes(8)
        lines.append(feedback_line("damiao", ranges, 17, data))
        read = motor.decode_sensor_feedback(data)
        values = [read[key] for key in ("pos", "vel", "torq", "t_mos", "t_rotor")]
        expected.append((read["status_code"], read["can_id"], *values))
    assert numbers(lines) == expected


def test_registers_of_a_damiao_are_equal(damiao):
    bus = KeptFrames()
    motor = damiao.DaMiaoMotor(motor_id=5, feedback_id=21, bus=bus, motor_type="8009")
    motor.write_register(9, 2000)
    motor.write_register(21, 12.5)
    motor.request_register_reading(10)
    bits = struct.unpack("<I", struct.pack("<f", 12.5))[0]
    read, write = 0x33, 0x55
    lines = [f"5 {write} 9 2000", f"5 {write} 21 {bits}", f"5 {read} 10 0"]
    assert frames(f"damiao access {line}" for line in lines) == bus.sent


def cybergear_motor(peer):
    """Its motor without the threads and the first exchange of its constructor, and its ranges."""
    motor = object.__new__(peer.CyberGearMotor)
    motor.can_id, motor.host_can_id, motor._send_timeout, motor._bus = 1, 0xFD, 0, KeptFrames()
    motor._commanded, motor._feedback = {}, peer.MotorFeedback()
    motor._feedback_listeners = motor._fault_listeners = []
    return motor, (motor.P_MAX, motor.V_MAX, motor.T_MAX)


def test_orders_of_a_cybergear_are_equal(cybergear):
    chance = random.Random(3)
    motor, ranges = cybergear_motor(cybergear)
    lines = []
    for _ in range(FRAMES):
        position, velocity, stiffness, damping, torque = order = drawn_order(chance, ranges)
        lines.append(order_line("cybergear", ranges, order))
        motor.motor_control(torque, position, velocity, stiffness, damping)
    assert frames(lines) == motor._bus.sent


def test_feedback_of_a_cybergear_is_equal(cybergear):
    chance = random.Random(4)
    motor, ranges = cybergear_motor(cybergear)
    lines, expected = [], []
    for _ in range(FRAMES):
        identifier, data = 2 << 24 | chance.getrandbits(24), chance.randbytes(8)
        lines.append(feedback_line("cybergear", ranges, identifier, data))
        motor._parse_motor_feedback_message(SimpleNamespace(arbitration_id=identifier, data=data))
        read, node = motor.feedback, identifier >> 8 & 0xFF
        names = ("undervoltage", "over_current", "over_temperature", "magnetic_encoding_failure")
        bits = [getattr(read.faults, name) for name in names]
        bits += [read.faults.hall_encoding_failure, not read.faults.calibrated]
        faults = sum(bit << place for place, bit in enumerate(bits))
        expected.append((read.mode, faults, node, read.position, read.velocity, read.torque, read.temperature))
    assert numbers(lines) == expected


def test_parameters_of_a_cybergear_are_equal(cybergear):
    motor, _ = cybergear_motor(cybergear)
    mode, timeout = SimpleNamespace(value=0x7005, name="run_mode"), SimpleNamespace(value=0x7028, name="can_timeout")
    motor._write_parameter(timeout, "I", 600)
    motor._write_parameter(mode, "4B", 0, 0, 0, 0)
    motor._send_message(cybergear.CommunicationTypeCan.parameter_reading, struct.pack("4H", 0x700B, 0, 0, 0))
    lines = [f"1 18 {0x7028} 600", f"1 18 {0x7005} 0", f"1 17 {0x700B} 0"]
    assert frames(f"cybergear access {line}" for line in lines) == motor._bus.sent


def ak_motors(peer, chance):
    """A random type of motor each time, with its ranges and its direction."""
    kinds = [value for name, value in sorted(vars(peer).items()) if name.lower().endswith("_params")]
    lengths = {"p_des": 16, "v_des": 12, "kp": 12, "kd": 12, "tau": 12}
    arrays = {f"_{name}_BitArray": peer.BitArray(uint=0, length=bits) for name, bits in lengths.items()}
    arrays |= {"_cmd_bytes": peer.BitArray(uint=0, length=64), "_recv_bytes": peer.BitArray(uint=0, length=48)}
    while True:
        motor = object.__new__(peer.CanMotorController)
        motor.motorParams = limits = chance.choice(kinds)
        vars(motor).update(arrays)
        yield motor, (limits["P_MAX"], limits["V_MAX"], limits["T_MAX"]), limits["AXIS_DIRECTION"]


def packed(raw):
    """The data of an order, of its raw numbers."""
    word = 0
    for value, bits in zip(raw, (16, 12, 12, 12, 12), strict=True):
        word = word << bits | value
    return word.to_bytes(8, "big")


def test_orders_of_an_ak_are_equal(mini_cheetah, capsys):
    chance = random.Random(5)
    lines, expected = [], []
    for number, (motor, ranges, direction) in zip(range(FRAMES), ak_motors(mini_cheetah, chance), strict=False):
        position, velocity, stiffness, damping, torque = order = drawn_order(chance, ranges)
        lines.append(order_line("ak", ranges, order))
        if number >= PACKED:
            motor._send_raw_command = lambda *raw: expected.append((1, packed(raw))) or bytes(6)
            motor.decode_motor_status = lambda _: (0, 0, 0)
        motor._send_can_frame = lambda data: expected.append((1, data))
        motor._recv_can_frame = lambda: (0, 6, bytes(6))
        motor.send_rad_command(direction * position, direction * velocity, stiffness, damping, direction * torque)
    capsys.readouterr()  # It prints what it clips.
    assert frames(lines) == expected


def unpacked(data):
    """The raw position, velocity and torque of a reply."""
    word = int.from_bytes(data, "big")
    return word >> 24 & 0xFFFF, word >> 12 & 0xFFF, word & 0xFFF


def test_replies_of_an_ak_are_equal(mini_cheetah):
    chance = random.Random(6)
    lines, expected = [], []
    for number, (motor, ranges, direction) in zip(range(FRAMES), ak_motors(mini_cheetah, chance), strict=False):
        data = chance.randbytes(6)
        lines.append(feedback_line("ak", ranges, 0, data))
        raw = motor.decode_motor_status(data) if number < PACKED else unpacked(data)
        read = motor.convert_raw_to_physical_rad(*raw)
        expected.append((data[0], *(direction * value for value in read)))
    assert numbers(lines) == expected
