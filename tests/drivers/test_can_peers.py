"""Our drives and devices on CAN against programs of PyPI: canopen's LocalNode and BaseNode402, odrive_can's mock and
master."""

import asyncio
import subprocess
import threading
import time
from pathlib import Path

import pytest
from support.can_wire import Wire
from support.pypi_package import imported

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "build/robot_control/tests/drivers/can_peer"
NODE = 5
REMOTE = "R"


class Peer:
    """can_peer: frames in, frames out."""

    def __init__(self, *arguments):
        self.program = subprocess.Popen([PROGRAM, *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.values, self.words = [], ""

    def exchange(self, *fields, frames=()):
        """Frames are pairs of identifier and data; data of a remote request are REMOTE."""
        given = [f"{identifier}#{data if data == REMOTE else bytes(data).hex()}" for identifier, data in frames]
        self.program.stdin.write(" ".join(map(str, [*fields, *given])) + "\n")
        self.program.stdin.flush()
        sent, values, self.words = (part.strip() for part in self.program.stdout.readline().split("|", 2))
        self.values = [float(value) for value in values.split()]
        pairs = (frame.split("#") for frame in sent.split())
        return [(int(identifier), data if data == REMOTE else bytes.fromhex(data)) for identifier, data in pairs]

    def close(self):
        self.program.stdin.close()
        self.program.wait()


@pytest.fixture
def peer():
    opened = []

    def start(*arguments):
        opened.append(Peer(*arguments))
        return opened[-1]

    yield start
    for each in opened:
        each.close()


def drive_file(tmp_path, dialect, **values):
    path = tmp_path / "drives.yaml"
    lines = "".join(f"  {key}: {value}\n" for key, value in values.items())
    path.write_text(f"bus: {{dialect: {dialect}}}\nwheel:\n  node: {NODE}\n{lines}")
    return path


POWER_STEPS = {(0x40, 0x06): 0x21, (0x21, 0x07): 0x23, (0x23, 0x0F): 0x27}
"""statusword and controlword → next statusword"""


class TorqueDrive:
    """canopen's LocalNode with a power state machine on top, which every SYNC runs."""

    def __init__(self, canopen, eds):
        self.network, self.wire = canopen.Network(), Wire()
        self.network.bus = self.wire
        self.node = canopen.LocalNode(NODE, str(ROOT / "tests/fixtures" / eds))
        self.network.add_node(self.node)
        self.status, self.position, self.torque = 0x40, 1000, 0
        self.mapped = False

    def exchange(self, frames):
        """Delivers the frames; what the drive sends thereupon."""
        self.wire.sent = []
        for identifier, data in frames:
            self.network.notify(identifier, bytearray(data), 0.0)
            if identifier == 0x80 and self.node.nmt.state == "OPERATIONAL":
                self.answer_sync()
        return self.wire.sent

    def answer_sync(self):
        received, sent = self.node.rpdo[1], self.node.tpdo[1]
        if not self.mapped:
            received.read()
            received.subscribe()
            sent.read()
            self.mapped = True
            return
        control, self.torque = (each.raw for each in received.map)
        self.status = POWER_STEPS.get((self.status, control), self.status)
        self.position += 10
        for each, value in zip(sent.map, (self.status, self.position, self.torque), strict=True):
            each.raw = value
        sent.transmit()


CIA402 = {"mode": "tq", "torque_limit": 0.3, "velocity_limit": 100, "on_silence": "coasts"}


def run_cia402(ours, drive, cycles, torque=0.0, period_ns=10_000_000):
    frames = []
    for cycle in range(cycles):
        frames = drive.exchange(ours.exchange(cycle * period_ns, 1, 0, torque, frames=frames))
    return frames


def test_our_driver_brings_canopens_drive_to_operation_enabled(peer, tmp_path):
    canopen = imported("canopen", "can")
    drive = TorqueDrive(canopen, "cia402_example_e35.eds")
    ours = peer("drives", drive_file(tmp_path, "cia402", **CIA402), "100", "wheel")
    run_cia402(ours, drive, 300, torque=0.155)
    assert ours.words == f"wheel (node {NODE}): running"
    assert drive.status == 0x27
    assert drive.torque == 500, "‰ of 0.31 N·m, which is in 6076"
    before = drive.position
    run_cia402(ours, drive, 100)
    assert drive.position == before + 1000, "one answer per SYNC"
    turn = 2 * 3.141592653589793
    assert ours.values[0] == pytest.approx((drive.position - 10) / 2000 * turn), "counts of 608F"
    assert ours.values[1] == pytest.approx(10 / 2000 * turn * 100), "at 100 Hz"


def test_our_driver_names_what_a_position_drive_lacks(peer, tmp_path):
    canopen = imported("canopen", "can")
    drive = TorqueDrive(canopen, "cia402_ros_industrial_slave.eds")
    ours = peer("drives", drive_file(tmp_path, "cia402", **CIA402), "100", "wheel")
    run_cia402(ours, drive, 300)
    assert "fault; the drive lacks rated torque (6076)" in ours.words
    assert drive.status == 0x40


class Pump:
    """Carries frames between python-can's virtual bus and a Peer, on the wall clock."""

    def __init__(self, can, ours, channel, *command):
        self.can, self.ours, self.command = can, ours, list(command)
        self.bus = can.Bus(interface="virtual", channel=channel)
        self.started, self.done = time.monotonic_ns(), threading.Event()
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def run(self):
        while not self.done.wait(0.005):
            frames = []
            while (message := self.bus.recv(0)) is not None:
                frames.append((message.arbitration_id, REMOTE if message.is_remote_frame else message.data))
            now = time.monotonic_ns() - self.started
            for identifier, data in self.ours.exchange(now, *self.command, frames=frames):
                remote = data == REMOTE
                self.bus.send(
                    self.can.Message(
                        arbitration_id=identifier,
                        is_extended_id=False,
                        is_remote_frame=remote,
                        data=None if remote else data,
                    )
                )

    def wait_for(self, condition, seconds=15):
        end = time.monotonic() + seconds
        while not condition() and time.monotonic() < end:
            time.sleep(0.02)
        return condition()

    def close(self):
        self.done.set()
        self.thread.join()
        self.bus.shutdown()


@pytest.fixture
def pump():
    opened = []

    def start(*arguments):
        opened.append(Pump(imported("can", "can"), *arguments))
        return opened[-1]

    yield start
    for each in opened:
        each.close()


def test_our_driver_brings_odrive_cans_mock_to_closed_loop_and_follows_it(peer, pump, tmp_path):
    imported("odrive_can", "can")
    from odrive_can.mock import ODriveCANMock

    can = imported("can", "can")
    mock = ODriveCANMock(axis_id=NODE, can_bus=can.Bus(interface="virtual", channel="mock"))
    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever)
    thread.start()
    running = asyncio.run_coroutine_threadsafe(mock.main(), loop)
    values = {
        "torque_constant": 0.1,
        "torque_limit": 1,
        "velocity_limit": 100,
        "on_silence": "coasts",
        "heartbeat_period": 0.2,
        "estimates_period": 0.1,
        "effort_rate": 1,
    }
    ours = peer("drives", drive_file(tmp_path, "odrive", **values), "100", "wheel")
    carried = pump(ours, "mock", 1, 0, 0.5)
    try:
        assert carried.wait_for(lambda: ours.words.endswith("running")), ours.words
        assert mock.odrive.axis_state == "CLOSED_LOOP_CONTROL"
        assert (mock.odrive.control_mode, mock.odrive.input_mode) == ("TORQUE_CONTROL", "PASSTHROUGH")
        mock.odrive.model.setpoint = 0.5
        mock.odrive.control_mode = "VELOCITY_CONTROL"
        assert carried.wait_for(lambda: ours.values[1] == pytest.approx(0.5 * 2 * 3.141592653589793))
        position = ours.values[0]
        assert carried.wait_for(lambda: ours.values[0] > position + 2)
        assert ours.words.endswith("running")
    finally:
        running.cancel()
        loop.call_soon_threadsafe(loop.stop)
        thread.join()


def test_odrive_cans_master_drives_our_device(peer, pump):
    imported("odrive_can", "can")
    from odrive_can.odrive import ODriveCAN

    can = imported("can", "can")
    ours = peer("odrive", str(NODE), "0.5")
    pump(ours, "master")

    async def drive():
        master = ODriveCAN(axis_id=NODE, can_bus=can.Bus(interface="virtual", channel="master"))
        await master.start()
        try:
            master.clear_errors()
            await master.set_axis_state("CLOSED_LOOP_CONTROL")
            master.set_controller_mode("TORQUE_CONTROL", "PASSTHROUGH")
            master.set_input_torque(0.02)
            await asyncio.sleep(0.5)
            estimates = await master.get_encoder_estimates()
            return master.axis_state, estimates, ours.values[2]
        finally:
            master.stop()

    state, estimates, torque = asyncio.run(drive())
    assert state == "CLOSED_LOOP_CONTROL"
    assert torque == pytest.approx(0.02)
    assert estimates["Vel_Estimate"] > 0.05


def test_canopens_master_drives_our_device(peer, pump):
    canopen = imported("canopen", "can")
    imported("canopen.profiles.p402", "can")
    can = imported("can", "can")
    ours = peer("cia402", str(NODE))
    pump(ours, "p402")
    network = canopen.Network(can.Bus(interface="virtual", channel="p402"))
    network.connect()
    try:
        node = canopen.BaseNode402(NODE, str(ROOT / "tests/fixtures/cia402_example_e35.eds"))
        network.add_node(node)
        node.sdo.RESPONSE_TIMEOUT = 2
        assert node.sdo[0x6076].raw == 2000
        node.sdo[0x6060].raw = 4
        node.state = "OPERATION ENABLED"
        node.sdo[0x6071].raw = 100
        time.sleep(0.3)
        assert ours.values[2] == pytest.approx(0.2)
        assert node.sdo[0x6064].raw > 0
    finally:
        network.disconnect()
