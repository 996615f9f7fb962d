"""The codecs of motors in MIT mode equal those of packages of PyPI to the bit.

Damiao: damiao-motor. CyberGear: python-cybergear. AK: mini-cheetah-motor-driver-socketcan. moteus: moteus.
"""

import io
import math
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


@pytest.fixture(scope="module")
def moteus():
    return imported("moteus", "can", "moteus")


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


class MoteusPeer:
    """The client of moteus, for controllers of all numbers."""

    def __init__(self, peer):
        self.peer, self.multiplex, self.made = peer, peer.multiplex, {}
        self.transport = object.__new__(peer.transport.Transport)
        self.device = object.__new__(peer.transport_device.TransportDevice)
        self.formats = peer.PositionResolution()
        for name in ("position", "velocity", "feedforward_torque", "kp_scale", "kd_scale", "maximum_torque"):
            setattr(self.formats, name, peer.F32)
        self.formats.watchdog_timeout = peer.F32
        self.formats.velocity_limit = self.formats.accel_limit = peer.INT8

    def controller(self, node):
        if node not in self.made:
            self.made[node] = self.peer.Controller(id=node, position_resolution=self.formats)
        return self.made[node]

    def sent(self, command):
        """Identifier and data, as the client's transport sends them."""
        frame = self.transport._command_to_frame(command)
        padding = self.device._round_up_dlc(len(frame.data)) - len(frame.data)
        return frame.arbitration_id, frame.data + bytes([self.multiplex.NOP]) * padding


def test_orders_of_a_moteus_are_equal(moteus):
    peer, chance = MoteusPeer(moteus), random.Random(7)
    lines, expected = [], []
    for _ in range(FRAMES):
        node = chance.randint(1, 126)
        position, velocity, torque = (chance.uniform(-limit, limit) for limit in (100, 300, 60))
        kp, kd = chance.uniform(1, 1000), chance.uniform(0.1, 20)
        stiffness, damping = chance.uniform(0, kp), chance.uniform(0, kd)
        timeout, limit = chance.uniform(0.01, 1), chance.uniform(0, 60)
        values = (node, 0, position, velocity, stiffness, damping, torque, timeout, kp, kd, limit)
        lines.append("moteus order " + " ".join(map(repr, values)))
        command = peer.controller(node).make_position(
            position=position / math.tau,
            velocity=velocity / math.tau,
            feedforward_torque=torque,
            kp_scale=stiffness / kp,
            kd_scale=damping / kd,
            maximum_torque=limit,
            watchdog_timeout=timeout,
            velocity_limit=-0.1,
            accel_limit=-0.05,
            query=True,
        )
        expected.append(peer.sent(command))
    assert frames(lines) == expected


def test_stops_of_a_moteus_are_equal(moteus):
    peer = MoteusPeer(moteus)
    stops = [peer.controller(node).make_stop(query=True) for node in range(1, 127)]
    assert frames(f"moteus stop {node} 0" for node in range(1, 127)) == [peer.sent(stop) for stop in stops]


def test_the_details_of_a_moteus_are_requested_as_its_client_reads_them(moteus):
    peer = MoteusPeer(moteus)
    data = frames(["moteus stop 5 1"])[0][1]
    subframes = [(each.type.name, each.register, each.resolution) for each in peer.multiplex.parse_frame(data)]
    asked = [
        (0x000, 0),
        *((number, 3) for number in (1, 2, 3)),
        *((number, 0) for number in (13, 14, 15, 12)),
        (0x102, 2),
        *((number, 3) for number in (0x30, 0x31, 0x32)),
    ]
    assert subframes == [("WRITE", 0x000, 0), *(("READ", *each) for each in asked)]


def moteus_reply(peer, chance):
    """The data of a random reply with or without its details, whose values are any but the lowest mode and fault."""
    mp = peer.multiplex

    def real():
        return struct.pack("<I", chance.randrange(0x7F800000) | chance.choice((0, 1 << 31)))

    def subframe(kind, first, *values):
        buffer = io.BytesIO()
        writer = mp.WriteFrame(buffer)
        writer.write_int8(mp.REPLY_BASE | kind << 2 | len(values))
        writer.write_varuint(first)
        return buffer.getvalue() + b"".join(values)

    mode, fault = (struct.pack("<b", chance.randint(-127, 127)) for _ in range(2))
    state = subframe(mp.INT8, 0x00, mode) + subframe(mp.F32, 0x01, real(), real(), real())
    state += subframe(mp.INT8, 0x0D, chance.randbytes(1), chance.randbytes(1), fault)
    details = subframe(mp.INT8, 0x0C, chance.randbytes(1)) + subframe(mp.INT32, 0x102, chance.randbytes(4))
    details += subframe(mp.F32, 0x30, real(), real(), real())
    data = state + chance.choice((b"", details))
    return data + bytes([mp.NOP]) * (peer.device._round_up_dlc(len(data)) - len(data))


def test_replies_of_a_moteus_are_equal(moteus):
    peer, chance = MoteusPeer(moteus), random.Random(8)
    registers = (0x00, 0x01, 0x02, 0x03, 0x0D, 0x0E, 0x0F, 0x0C, 0x102, 0x30, 0x31, 0x32)
    lines, expected = [], []
    for _ in range(FRAMES):
        node, data = chance.randint(1, 126), moteus_reply(peer, chance)
        lines.append(f"moteus feedback {node} {node << 8} {data.hex()}")
        read = moteus.parse_registers(data).response
        read |= {each: math.nan for each in (0x0C, 0x102) if read.get(each) in (-128, -(1 << 31))}
        expected.append([math.tau * read[each] if each in (1, 2) else read.get(each, 0) for each in registers])
    read = [[float(number) for number in line.split()] for line in answers(lines)]
    assert repr(read) == repr([[float(number) for number in numbers] for numbers in expected])


def test_a_reply_of_a_moteus_that_is_cut_or_for_another_is_none(moteus):
    peer, chance = MoteusPeer(moteus), random.Random(9)
    lines = []
    for _ in range(1000):
        data = moteus_reply(peer, chance)
        lines += [f"moteus feedback 5 {identifier} {data.hex()}" for identifier in (0x501, 0x600, 0x10500, 0x8500)]
        lines += [f"moteus feedback 5 {0x500} {data[:length].hex()}" for length in (5, 9)]
    assert set(answers(lines)) == {"-"}
