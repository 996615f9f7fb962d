"""estimate.py computes the path of a robot from a recording of its wheels and its IMU."""

from __future__ import annotations

import argparse
import contextlib
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import yaml  # type: ignore[import-untyped]

from robot_control._robot_control import read_run_header
from robot_control.data.estimate.bag_input import BagTopics, read_bag
from robot_control.data.estimate.csv_input import ACCEL_UNITS, GYRO_UNITS, NAMES, TIME_UNITS, CsvForm, read_csv
from robot_control.data.estimate.encoder import counts_per_turn
from robot_control.data.estimate.input_check import check, check_angles
from robot_control.data.estimate.log_input import read_run_bag
from robot_control.data.estimate.output import BagSink, CsvSink, Sink
from robot_control.data.estimate.report import Summary
from robot_control.data.estimate.samples import InputError, IntArray, Robot, Samples
from robot_control.data.estimate.trust import Trust
from robot_control.data.run_log import is_run_log, kind_in
from robot_control.files.files import NewFiles, escaped, given_path, one_message, utf8
from robot_control.files.output_files import check_outputs
from robot_control.loop.estimator import Estimate, Estimator
from robot_control.loop.roles import refuse_legs
from robot_control.robot.send_plan import positive
from robot_control.ui.picture_file import check_picture

if TYPE_CHECKING:
    from robot_control.data.estimate.picture import Picture

BLOCK = 20000
"""rows that are in memory with their covariances"""
BAG_RATE = 50.0
"""Hz, of the node's odom by default"""
EPILOG = """
A CSV has one header line and strictly increasing times; a cell is empty where a sample is absent, so that wheels and
IMU may have rates of their own. Its columns, under these names or by --columns:
  time                      s
  left, right               rad, angles of the wheels, as their joints report them
  gyro_x, gyro_y, gyro_z    rad/s, in the IMU's own axes; gyro_z alone will do; may be absent
  accel_x, accel_y, accel_z m/s², likewise, +9.81 upwards at rest; may be absent
A run.bag of this package (telemetry, the demo) is known by its contents: the last run in it is estimated
again.
A bag is read by the stamps of its messages, needs no running ROS, and its topics are found where only one can be meant.

The robot is --urdf, or --wheel-radius with --wheel-base (base_link mid-axle), or what --params says; it must be given,
but for a run.bag.
"""


@one_message("estimate.py", ValueError, RuntimeError, OSError)
def main(arguments: list[str] | None = None) -> None:
    """Estimates, writes, prints; exits with 1 and one message when something is refused."""
    options = _parser().parse_args(_with_negative_lists(sys.argv[1:] if arguments is None else arguments))
    print(estimate(options))
    for path in _outputs(options):
        print(escaped(f"wrote {path}"), file=sys.stderr)


def _with_negative_lists(arguments: list[str]) -> list[str]:
    """`--imu-orientation -1.57,0,0` as `--imu-orientation=-1.57,0,0`: argparse takes a leading minus for an option."""
    joined: list[str] = []
    for argument in arguments:
        if joined and joined[-1] in {"--imu-position", "--imu-orientation"} and argument[:1] == "-":
            joined[-1] += f"={argument}"
        else:
            joined.append(argument)
    return joined


def estimate(options: argparse.Namespace) -> str:
    """Writes the files and returns the report.

    Raises:
        ValueError, OSError: one message.
    """
    _check_options(options)
    _check_paths(options)
    estimator = _estimator(options, options.encoder_counts)
    samples = _read(options, estimator)
    _check_robot(options, samples)
    samples = _checked(options, samples, estimator.robot)
    counts = None if samples.own_log or options.encoder_counts is not None else counts_per_turn(samples)
    if counts is not None and options.params is None:
        samples.notes.append(f"the wheel angles come in steps of 1/{counts:.4g} turn, but --encoder-counts differs")
        estimator = _estimator(options, counts)
    elif counts is not None:
        samples.notes.append(f"the wheel angles come in steps of 1/{counts:.4g} turn: check encoder_noise in --params")

    summary, trust = Summary(), Trust()
    with NewFiles() as files:
        sinks: list[tuple[Sink, float | None]] = [(summary, None), (trust, None)]
        if options.csv is not None:
            sinks.append((CsvSink(files.name(options.csv)), options.rate))
        if options.bag is not None:
            bag = BagSink(files.name(options.bag), estimator.robot["base_link"])
            sinks.append((bag, options.rate or BAG_RATE))
        picture = _picture(options, samples)
        if picture is not None:
            sinks.append((picture, None))
        try:
            for time_ns, rows in _blocks(estimator, samples):
                for sink, rate in sinks:
                    sink.add(*_thinned(time_ns, rows, rate, samples.time_ns))
        finally:
            for sink, _ in sinks:
                if isinstance(sink, CsvSink | BagSink):
                    sink.close()
        if picture is not None:
            picture.draw(files.name(options.plot), f"{options.input.name}: {summary.last['distance']:.1f} m")
        if options.calibration is not None:
            estimator.save_calibration(files.name(options.calibration))
    samples.warnings += trust.doubts(samples)
    return summary.report(samples, estimator.robot)


def _checked(options: argparse.Namespace, samples: Samples, robot: Robot) -> Samples:
    """The samples after all checks, with warnings, notes, and the IMU's stamps on the wheels' clock."""
    if options.counts_per_turn is None and options.input.suffix != ".bag" and not samples.own_log:
        check_angles(samples)
    findings = check(samples, robot)
    samples.warnings += samples.jumps() + findings.warnings
    note = samples.gap_note()
    samples.notes += [] if note is None else [note]
    delay = options.imu_delay
    if delay is None and findings.offset is not None:
        said = f"the IMU's stamps are {findings.offset:+.3f} s after the wheels', by the turning of both"
        if samples.own_log:
            samples.notes.append(f"{said}; left as it is: the node had the same")
        else:
            samples.notes.append(f"{said}: taken out; --imu-delay 0 leaves it in")
            delay = findings.offset
    return samples.with_imu_earlier(delay) if delay else samples


def _check_robot(options: argparse.Namespace, samples: Samples) -> None:
    """Refuses to assume the installed default robot silently; a log of this package names its joints."""
    given = options.urdf is not None or options.wheel_radius is not None or samples.own_log
    if not given and options.params is not None:
        blocks = yaml.safe_load(options.params.read_text(encoding="utf-8")) or {}
        given = bool({"urdf", "wheel_radius", "wheel_base", "wheel_separation"} & set(blocks.get("robot") or {}))
    if not given:
        raise InputError(
            "the robot is unknown: set --wheel-radius and --wheel-base, or --urdf FILE, or --params with a block robot:"
        )


def _estimator(options: argparse.Namespace, encoder_counts: float | None) -> Estimator:
    names = ("wheel_radius", "wheel_base", "imu_position", "imu_orientation", "period")
    given = {name: getattr(options, name) for name in names}
    return Estimator(options.params, options.urdf, encoder_counts=encoder_counts, **given)


def _blocks(estimator: Estimator, samples: Samples) -> Iterator[tuple[IntArray, Estimate]]:
    """Yields a few rows at a time: the covariances of all of them may not fit into memory."""
    seconds = samples.seconds
    for first in range(0, seconds.size, BLOCK):
        some = slice(first, first + BLOCK)
        gyro, accel = (None if table is None else table[some] for table in (samples.gyro, samples.accel))
        rows = estimator.process(seconds[some], samples.left[some], samples.right[some], gyro, accel)
        yield samples.time_ns[some], rows


def _thinned(time_ns: IntArray, rows: Estimate, rate: float | None, all_ns: IntArray) -> tuple[IntArray, Estimate]:
    """The first row of every 1/rate seconds, and the very last one."""
    if rate is None:
        return time_ns, rows
    step = 1e9 / rate
    at = int(np.searchsorted(all_ns, time_ns[0]))
    before = all_ns[at - 1] if at > 0 else all_ns[0] - math.ceil(step)
    ticks = np.floor((np.concatenate([[before], time_ns]) - all_ns[0]) / step)
    chosen = (np.diff(ticks) > 0) | (time_ns == all_ns[-1])
    return time_ns[chosen], {name: values[chosen] for name, values in rows.items()}


def _read(options: argparse.Namespace, estimator: Estimator) -> Samples:
    if options.input.suffix == ".bag" and is_run_log(options.input):
        return read_run_bag(options.input, estimator.robot)
    if options.input.suffix == ".bag":
        topics = BagTopics(options.wheels, options.imu, _joints(options.joints), options.odometry)
        samples = read_bag(options.input, estimator.robot, topics)
        if samples.gyro is not None:
            samples.gyro *= GYRO_UNITS[options.gyro_unit or CsvForm.gyro_unit]
        if samples.accel is not None:
            samples.accel *= ACCEL_UNITS[options.accel_unit or CsvForm.accel_unit]
        return samples
    given = {name: getattr(options, name) for name in (*OF_CSV, "gyro_unit", "accel_unit") if getattr(options, name)}
    return read_csv(options.input, CsvForm(**given))


def _picture(options: argparse.Namespace, samples: Samples) -> Picture | None:
    if options.plot is None:
        return None
    from robot_control.data.estimate.picture import Picture

    return Picture(samples.time_ns.size)


def _outputs(options: argparse.Namespace) -> list[Path]:
    return [path for path in (options.csv, options.bag, options.plot, options.calibration) if path is not None]


OF_CSV = ("columns", "counts_per_turn", "time_unit")
OF_BAG = ("wheels", "imu", "joints", "odometry")


def _check_options(options: argparse.Namespace) -> None:
    is_bag = options.input.suffix == ".bag"
    for name in OF_CSV if is_bag else OF_BAG:
        if getattr(options, name) is not None:
            kind, other = ("bag", "CSV") if is_bag else ("CSV", "bag")
            raise InputError(f"--{name.replace('_', '-')} is for a {other}; {options.input} is read as a {kind}")


def _check_paths(options: argparse.Namespace) -> None:
    """Checks the paths, and the kind of robot in a log, before minutes of work."""
    check_outputs(_outputs(options), [options.input, options.urdf, options.params])
    if options.plot is not None:
        check_picture(options.plot)
    if options.input.suffix in {".db3", ".mcap"}:
        raise InputError(f"{options.input} is a ROS 2 bag; make a ROS 1 bag of it (rosbags-convert), or a CSV")
    if options.input.suffix == ".bag" and is_run_log(options.input):
        refuse_legs(kind_in(read_run_header(utf8(options.input))), "estimate.py")


def _joints(given: dict[str, str] | None) -> tuple[str, str] | None:
    if given is None:
        return None
    if set(given) != {"left", "right"}:
        raise InputError("--joints names one joint of each side: left=NAME,right=NAME")
    return given["left"], given["right"]


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="estimate.py",
        description="Estimates the path of a robot from a recording of its wheels and its IMU, with the algorithm of "
        "the node. Prints a summary, and writes the chosen outputs.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("input", type=given_path, help="CSV, or rosbag (.bag)")
    add("--csv", type=given_path, metavar="OUT.csv", help="write the estimate, a row per row of the input")
    add("--bag", type=given_path, metavar="OUT.bag", help="write nav_msgs/Odometry on /odom, and /tf")
    add("--plot", type=given_path, metavar="OUT.png", help="draw path, yaw, speeds, gyro bias, slip")
    learned = "write what was learned, as the node's calibration_file"
    add("--calibration", type=given_path, metavar="OUT.yaml", help=learned)
    add("--rate", type=positive, metavar="HZ", help=f"rows a second; bag: {BAG_RATE:g} unless given")

    add = parser.add_argument_group("the robot").add_argument
    add("--urdf", type=given_path, metavar="FILE", help="robot description, .xacro too")
    add("--params", type=given_path, metavar="YAML", help="parameter file; installed: robot_params.yaml")
    add("--wheel-radius", type=positive, metavar="M", help="every wheel")
    add("--wheel-base", type=positive, metavar="M", help="between the left and the right wheels")
    add("--imu-position", type=_numbers, metavar="X,Y,Z", help="m, in base_link")
    add("--imu-orientation", type=_numbers, metavar="R,P,Y", help="rad, as in a URDF, or a quaternion x,y,z,w")
    add("--encoder-counts", type=positive, metavar="N", help="a turn, gear included; else found, or 4096")
    add("--gyro-unit", choices=GYRO_UNITS, help="of the recording; rad/s unless given")
    add("--accel-unit", choices=ACCEL_UNITS, help="m/s2 unless given")
    later = "by which the IMU's stamps are later than the wheels'; else found by the turning of both"
    add("--imu-delay", type=_finite, metavar="S", help=later)
    add("--period", type=positive, metavar="S", help="between samples; else their median")

    add = parser.add_argument_group("a CSV").add_argument
    add("--columns", type=_pairs, metavar="time=t,left=…", help="the file's names of our columns")
    unit = "unit of left and right: 360 for degrees, 1 for turns"
    add("--counts-per-turn", type=positive, metavar="N", help=unit)
    add("--time-unit", choices=TIME_UNITS)

    add = parser.add_argument_group("a bag").add_argument
    add("--wheels", metavar="TOPIC", help="of sensor_msgs/JointState or nav_msgs/Odometry")
    add("--imu", metavar="TOPIC", help="of sensor_msgs/Imu; none: wheels only")
    add("--joints", type=_pairs, metavar="left=NAME,right=NAME", help="else those of the robot")
    part = "what wheel odometry is read by; else its pose, where it moves"
    add("--odometry", choices=("pose", "twist"), help=part)
    return parser


def _finite(text: str) -> float:
    with contextlib.suppress(ValueError):
        if math.isfinite(value := float(text)):
            return value
    raise argparse.ArgumentTypeError(f"{text} is not a number")


def _numbers(text: str) -> list[float]:
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text} is not a list of numbers, such as 0.05,0,0.06") from None


def _pairs(text: str) -> dict[str, str]:
    pairs = [part.partition("=") for part in text.split(",")]
    names = [name.strip() for name, _, _ in pairs]
    if any(not equals or not name.strip() or not value.strip() for name, equals, value in pairs):
        raise argparse.ArgumentTypeError(f"{text} is no list of name=name; names: {', '.join(NAMES)}")
    if len(set(names)) < len(names):
        raise argparse.ArgumentTypeError(f"{text} gives a name twice")
    return {name.strip(): value.strip() for name, _, value in pairs}
