"""The ODrive codecs equal cantools, which reads the DBC files, for every message in use and both ways."""

import math
import random
import re
import struct
import subprocess
from pathlib import Path

import pytest
from support.pypi_package import imported

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "build/robot_control/tests/drivers/odrive_codec_lines"
FILES = {"0.5": "odrive-cansimple-0.5.6.dbc", "0.6": "odrive-cansimple-0.6.10.dbc"}
UNUSED_BY_BOTH = {
    *("Reboot", "Set_Input_Pos", "Set_Pos_Gain", "Set_Traj_Accel_Limits", "Set_Traj_Inertia", "Set_Traj_Vel_Limit")
}
UNUSED = {
    "0.5": UNUSED_BY_BOTH
    | {"Get_ADC_Voltage", "Get_Encoder_Count", "Get_Sensorless_Error", "Get_Sensorless_Estimates"}
    | {"Set_Axis_Node_ID", "Start_Anticogging"},
    "0.6": UNUSED_BY_BOTH | {"Enter_DFU_Mode", "Get_Powers"},
}
"""messages that neither the driver nor the simulated drive sends or reads"""
VALUES = 10_000
TURN = 2 * math.pi

SI = {"rev": TURN, "rev/s": TURN, "rev/s^2": TURN, "Nm/(rev/s^2)": 1 / TURN, "Nm/(rev/s)": 1 / TURN, "Nm/rev": 1 / TURN}
SI |= {"(Nm/(rev/s))/s": 1 / TURN, "": 1, "Nm": 1, "A": 1, "V": 1, "W": 1, "degC": 1, "counts": 1, "(rev/s)/rev": 1}
"""SI value of the unit of a DBC file, without blanks"""
WRONG_UNITS = {("0.5", "Input_Vel"): "rev/s", ("0.5", "Input_Torque_FF"): "Nm"}
"""the file of 0.5 says rev and rev/s; the firmware and the file of 0.6 say this"""
LOW_WORD = {("0.5", "Motor_Error"), ("0.5", "Shadow_Count"), ("0.5", "Count_in_CPR")}
"""the file says 32 bits without a sign; the firmware (can_simple.cpp) sends 64 bits, or a sign"""


@pytest.fixture(scope="module")
def databases():
    cantools = imported("cantools", "can")
    return {version: cantools.database.load_file(ROOT / "tests/fixtures" / name) for version, name in FILES.items()}


def answers(lines):
    run = subprocess.run([PROGRAM], input="\n".join(lines), capture_output=True, text=True, check=True)
    return run.stdout.splitlines()


def number(text):
    return int(text) if text.lstrip("-").isdigit() else float(text)


def names(database):
    return {re.sub(r"^Axis\d_", "", message.name) for message in database.messages}


def factor(version, signal):
    return SI[WRONG_UNITS.get((version, signal.name), re.sub(r"\s|\(default\).*", "", signal.unit or ""))]


def random_data(random_numbers, signals, length):
    """Any bytes, but no NaN, whose bits an encoder may choose."""
    while True:
        data = random_numbers.randbytes(length)
        floats = [struct.unpack_from("<f", data, signal.start // 8)[0] for signal in signals if signal.is_float]
        if not any(math.isnan(number) for number in floats):
            return data


def test_the_catalogue_holds_every_message_in_use(databases):
    for version, database in databases.items():
        assert UNUSED[version] < names(database)
        assert set(answers([f"list {version}"])[0].split()) == names(database) - UNUSED[version]


MESSAGE = re.compile(r"^BO_ \d+ Axis0_(\w+):", re.MULTILINE)
MESSAGES = [
    (version, name)
    for version, file in FILES.items()
    for name in MESSAGE.findall((ROOT / "tests/fixtures" / file).read_text())
    if name not in UNUSED[version]
]


@pytest.mark.parametrize(("version", "name"), MESSAGES, ids=[" ".join(each) for each in MESSAGES])
def test_equals_cantools_both_ways(databases, version, name):
    random_numbers = random.Random(f"{version} {name}")
    messages = [databases[version].get_message_by_name(f"Axis{axis}_{name}") for axis in range(8)]
    signals = sorted(messages[0].signals, key=lambda signal: signal.start)
    used = [signal for signal in signals if not signal.name.startswith("Reserved")]
    factors = [factor(version, signal) for signal in used]
    decoding, encoding, expected = [], [], []
    for _ in range(VALUES if signals else 8):
        axis = random_numbers.randrange(8)
        message = messages[axis]
        data = random_data(random_numbers, signals, message.length)
        decoded = message.decode(data, decode_choices=False)
        values = [decoded[signal.name] * by for signal, by in zip(used, factors, strict=True)]
        reserved = {signal.name: 0 for signal in signals if signal not in used}
        decoding.append(f"decode {version} {name} {message.frame_id} {data.hex() or '-'}")
        encoding.append(f"encode {version} {name} {axis} {' '.join(map(repr, values))}")
        expected.append((message, axis, values, message.encode(decoded | reserved, strict=False)))

    for (_, axis, values, _), line in zip(expected, answers(decoding), strict=True):
        node, *numbers = map(number, line.split())
        assert node == axis
        for signal, decoded, value in zip(used, numbers, values, strict=True):
            same = decoded & 0xFFFFFFFF if (version, signal.name) in LOW_WORD else decoded
            assert math.isclose(same, value, rel_tol=1e-15, abs_tol=0), signal.name
    for (message, _, values, data), line in zip(expected, answers(encoding), strict=True):
        identifier, sent = line.split()
        assert int(identifier) == message.frame_id
        sent = bytes.fromhex(sent.strip("-"))
        assert sent.ljust(message.length, b"\0") == data, values
        assert len(sent) == (4 if "Input_Torque" in message.name else message.length)


@pytest.mark.parametrize(
    ("version", "name", "signal", "kind"),
    [
        ("0.5", "Heartbeat", "Axis_Error", 0),
        ("0.5", "Get_Motor_Error", "Motor_Error", 1),
        ("0.5", "Get_Encoder_Error", "Encoder_Error", 2),
        ("0.5", "Get_Controller_Error", "Controller_Error", 3),
        ("0.6", "Heartbeat", "Axis_Error", 4),
        ("0.6", "Get_Error", "Active_Errors", 4),
        ("0.6", "Get_Error", "Disarm_Reason", 4),
    ],
)
def test_errors_have_the_names_of_their_maker(databases, version, name, signal, kind):
    choices = databases[version].get_message_by_name(f"Axis0_{name}").get_signal_by_name(signal).choices
    assert len(choices) > 1
    assert answers([f"errors {kind} {bits}" for bits in choices]) == [str(name) for name in choices.values()]
