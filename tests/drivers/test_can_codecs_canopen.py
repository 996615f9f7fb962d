"""The CANopen codecs exchange frames with a drive whose CANopen is that of PyPI's canopen."""

import random
import struct
import subprocess
from pathlib import Path

import pytest
from support.can_wire import Wire
from support.pypi_package import imported

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "build/robot_control/tests/drivers/canopen_codec_lines"
NODE = 5
DOWNLOAD, DOWNLOAD_SEGMENT, UPLOAD, UPLOAD_SEGMENT, ABORT = "01234"
"""SdoCommand"""
INTEGERS = range(2, 8)
"""data types of 8, 16 and 32 bits"""


def line_of(frame):
    """The frame as the program reads it."""
    identifier, data = frame
    return f"{identifier} {data.hex() or '-'}"


class Exchange:
    """Our codecs as the master, canopen's LocalNode as the drive."""

    def __init__(self, canopen, eds):
        self.wire, self.network = Wire(), canopen.Network()
        self.network.bus = self.wire
        self.drive = canopen.LocalNode(NODE, str(ROOT / "tests/fixtures" / eds))
        self.network.add_node(self.drive)
        self.program = subprocess.Popen([PROGRAM], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def codec(self, line):
        self.program.stdin.write(line + "\n")
        self.program.stdin.flush()
        return self.program.stdout.readline().strip()

    def deliver(self, line):
        """Sends the frame of this line; what the drive sends thereupon."""
        identifier, data = self.codec(line).split()
        self.wire.sent.clear()
        self.network.notify(int(identifier), bytearray.fromhex(data.strip("-")), 0.0)
        return [line_of(frame) for frame in self.wire.sent]

    def request(self, line):
        """The drive's response: command, expedited, toggle, last, size, data, words of an abort."""
        (frame,) = (each for each in self.deliver(line) if each.startswith(f"{0x580 + NODE} "))
        return self.codec(f"response {NODE} {frame}").split(maxsplit=6)

    def upload(self, index, sub):
        command, expedited, _, _, size, data, *words = self.request(f"upload {NODE} {index} {sub}")
        if command == ABORT:
            return words[0]
        assert command == UPLOAD
        value, toggle, last = bytes.fromhex(data.strip("-")), 0, expedited
        while last == "0":
            command, _, toggled, last, _, data, *_ = self.request(f"get {NODE} {toggle}")
            assert (command, toggled) == (UPLOAD_SEGMENT, str(toggle))
            value, toggle = value + bytes.fromhex(data.strip("-")), 1 - toggle
        assert expedited == "1" or len(value) == int(size)
        return value

    def download(self, index, sub, value):
        command, *_ = self.request(f"begin {NODE} {index} {sub} {len(value)}")
        assert command == DOWNLOAD
        for at in range(0, len(value), 7):
            part, toggle = value[at : at + 7], at // 7 % 2
            last = int(at + 7 >= len(value))
            command, _, toggled, *_ = self.request(f"put {NODE} {toggle} {last} {part.hex()}")
            assert (command, toggled) == (DOWNLOAD_SEGMENT, str(toggle))

    def close(self):
        self.program.stdin.close()
        self.program.wait()


@pytest.fixture(params=["cia402_example_e35.eds", "cia402_ros_industrial_slave.eds"])
def exchange(request):
    opened = Exchange(imported("canopen", "can"), request.param)
    yield opened
    opened.close()


def variables(dictionary):
    for entry in dictionary.values():
        yield from entry.values() if hasattr(entry, "values") else [entry]


def test_every_object_is_read_as_it_is(exchange):
    read = 0
    for variable in variables(exchange.drive.object_dictionary):
        if not variable.readable or variable.default in (None, ""):
            continue
        expected = exchange.drive.get_data(variable.index, variable.subindex)
        assert exchange.upload(variable.index, variable.subindex) == expected, variable.name
        read += 1
    assert read > 50


def test_numbers_are_written_expedited(exchange):
    random_numbers = random.Random(1)
    written = 0
    for variable in variables(exchange.drive.object_dictionary):
        if not variable.writable or variable.data_type not in INTEGERS:
            continue
        value, size = random_numbers.getrandbits(len(variable)), len(variable) // 8
        command, *_ = exchange.request(f"download {NODE} {variable.index} {variable.subindex} {value} {size}")
        assert command == DOWNLOAD, variable.name
        assert exchange.drive.get_data(variable.index, variable.subindex) == value.to_bytes(size, "little")
        written += 1
    assert written > 20


@pytest.mark.parametrize("length", [1, 4, 5, 7, 8, 14, 15, 100])
def test_texts_go_in_segments_both_ways(exchange, length):
    text = bytes(range(48, 48 + min(length, 70))) * 2
    exchange.drive.object_dictionary[0x1008].access_type = "rw"
    exchange.download(0x1008, 0, text[:length])
    assert exchange.upload(0x1008, 0) == text[:length]


def test_an_abort_has_words(exchange):
    assert exchange.upload(0x5FFF, 0) == "object does not exist in the object dictionary"
    assert exchange.upload(0x1018, 77) == "sub-index does not exist"
    words = exchange.request(f"download {NODE} {0x6041} 0 1 2")[-1]
    assert words == "attempt to write a read-only object"


@pytest.mark.parametrize(("command", "state"), [(1, "OPERATIONAL"), (2, "STOPPED"), (128, "PRE-OPERATIONAL")])
def test_network_management_moves_the_drive(exchange, command, state):
    exchange.deliver(f"nmt {command} {NODE}")
    assert exchange.drive.nmt.state == state
    exchange.deliver(f"nmt 129 {NODE + 1}")
    assert exchange.drive.nmt.state == state, "another node is meant"


def test_heartbeat_and_emergency_are_read(exchange):
    exchange.deliver(f"nmt 1 {NODE}")
    exchange.drive.nmt.start_heartbeat(100)
    assert exchange.codec(f"heartbeat {line_of(exchange.wire.sent[0])}") == f"{NODE} 5"
    exchange.wire.sent.clear()
    exchange.drive.emcy.send(0x8130, 0x11, b"12345")
    assert exchange.codec(f"emergency {line_of(exchange.wire.sent[0])}") == f"{NODE} {0x8130} {0x11} {b'12345'.hex()}"
    assert exchange.codec("sync") == "128 -"


@pytest.mark.parametrize("exchange", ["cia402_example_e35.eds"], indirect=True)
def test_process_data_are_mapped_and_exchanged(exchange):
    """The set-up by SDO is read back by canopen, which then packs and unpacks the same frames."""
    for pdo in ("command", "state"):
        for write in exchange.codec(f"setup {pdo} {NODE}").rstrip(";").split(";"):
            command, *_ = exchange.request(f"download {NODE} {write}")
            assert command == DOWNLOAD, write
    received, sent = exchange.drive.rpdo[1], exchange.drive.tpdo[1]
    for pdo, names in ((received, [0x6040, 0x6071]), (sent, [0x6041, 0x6064, 0x6077])):
        pdo.read()
        assert (pdo.enabled, pdo.trans_type, [each.index for each in pdo.map]) == (True, 1, names)
    received.subscribe()
    random_numbers = random.Random(2)
    for _ in range(100):
        controlword, torque = random_numbers.getrandbits(16), random_numbers.randrange(-32768, 32768)
        exchange.deliver(f"command {NODE} {controlword} {torque}")
        assert [each.raw for each in received.map] == [controlword, torque]
        values = struct.unpack("<Hih", random_numbers.randbytes(8))
        for each, value in zip(sent.map, values, strict=True):
            each.raw = value
        exchange.wire.sent.clear()
        sent.transmit()
        assert exchange.codec(f"state {NODE} {line_of(exchange.wire.sent[0])}") == " ".join(map(str, values))
