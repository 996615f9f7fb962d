"""The real-time threads of a driven robot are watched from outside, and their latencies are measured thrice.

In the nightly run the kernel's tracepoints watch them, too, which see every system call and page fault of a thread.

Each node runs with the tripwire (tests/realtime/tripwire.cpp). It must find nothing while the robot is driven, tuned,
disturbed, stopped and reset. Afterwards it must find each violation that is planted. The latencies of /diagnostics and
of the log's trace_summary must be those of the log's rows.
"""

import os
import signal
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np
import rosbag
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from robot_control.data.run_log import FloatArray, Log, read_log
from robot_control.msg import SafetyStatus
from robot_control.srv import InjectFault, SetParameters
from robot_control.watch.latency.figures import Figures, figures_of
from sensor_msgs.msg import Imu
from system.realtime.tracepoints import EVENTS, Tracepoints, absent
from system.realtime.tripwire_report import PLANTED, read_report
from system.system_support import (
    CONTROLLER,
    DRIVER,
    ESTIMATOR,
    LOOP,
    MONITOR,
    Program,
    Robot,
    nightly,
    wait_for,
)

ERROR = 0.02
"""relative, of a quantile"""
NIGHTLY = bool(os.environ.get("ROBOT_CONTROL_NIGHTLY"))
DRIVE = float(os.environ.get("ROBOT_CONTROL_REALTIME_SECONDS", "60" if NIGHTLY else "12"))
"""s"""
WATCHED_FROM = 3000
"""cycles; the tripwire begins to watch in cycle 2000, with system calls of its own"""
QUANTILES = {"p50": 50, "p99": 99, "p999": 99.9}


class RealtimeLatencyTest(unittest.TestCase):
    tracepoints: "Tracepoints | None" = None

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(tempfile.mkdtemp())
        cls.diagnostics: dict[str, dict[str, str]] = {}
        cls.warnings: list[str] = []
        rospy.Subscriber("/diagnostics", DiagnosticArray, cls._receive)
        prefix = (
            "env",
            f"LD_PRELOAD={os.environ['TRIPWIRE_LIBRARY']}",
            f"ROBOT_CONTROL_TRIPWIRE={cls.folder}/tripwire",
        )
        cls.telemetry = Program("telemetry", f"_directory:={cls.folder}", "_record:=always")
        cls.robot = Robot(prefix=prefix)
        rospy.set_param("/robot", {"wait_for_telemetry": True, "wait_for_nodes": True})
        cls.robot.start()
        pids = {name: node.pid for name, node in cls.robot.nodes.items()}
        try:
            cls.robot.await_ready()
            cls.exercise()
            cls.planted_at = time.monotonic()
            cls.clean = {name: cls.counts(name) for name in LOOP}
            for node in cls.robot.nodes.values():
                node.send_signal(signal.SIGUSR2)
            wait_for("counts of what was planted", lambda: all(cls.counts(name) > (0, 0) for name in LOOP))
        finally:
            cls.robot.end()
            cls.telemetry.end()
            if cls.tracepoints is not None:
                cls.tracepoints.end()
        cls.reports = {name: read_report(cls.folder / f"tripwire.{pid}") for name, pid in pids.items()}
        cls.rows = read_log(cls.folder / "run.bag")

    @classmethod
    def _receive(cls, message: DiagnosticArray) -> None:
        for status in message.status:
            cls.diagnostics[status.name] = {pair.key: pair.value for pair in status.values}
            if "not real-time" in status.message:
                cls.warnings.append(f"{status.name}: {status.message}")

    @classmethod
    def counts(cls, name: str) -> tuple[int, int]:
        """Waits outside of the loop and page faults of a node, as it reports them."""
        values = cls.diagnostics[name]
        return int(values["waits_outside_loop"]), int(values["page_faults"])

    @classmethod
    def exercise(cls) -> None:
        """Drives with everything that ordinary threads may do meanwhile."""
        robot, end = cls.robot, time.monotonic() + DRIVE
        tune = rospy.ServiceProxy(f"/{CONTROLLER}/set_parameter_map", SetParameters)
        inject = rospy.ServiceProxy(f"/{DRIVER}/inject_fault", InjectFault)
        robot.drive_until("0.5 m/s", robot.driving)
        if NIGHTLY and not absent():
            robot.drive_until("3000 cycles", lambda: int(cls.diagnostics[DRIVER]["cycle"]) > WATCHED_FROM)
            cls.tracepoints = Tracepoints(robot, cls.folder / "perf.data")
        while time.monotonic() < end:
            guests = [rospy.Subscriber("odom", Odometry), rospy.Subscriber("imu/data", Imu)]
            tune(f"{{max_linear_speed: {0.8 + 0.1 * (time.monotonic() % 1):.3f}}}")
            inject("accelerometer", "slow")
            until = time.monotonic() + 1.5
            robot.drive_until("1.5 s", lambda until=until: time.monotonic() > until)
            inject("accelerometer", "ok")
            for guest in guests:
                guest.unregister()
        robot.call("e_stop_trigger")
        wait_for("the stop", lambda: robot.state == SafetyStatus.STOPPED)
        robot.release()

    def test_no_real_time_thread_does_anything_but_wait_wake_and_read_the_clock(self) -> None:
        found = [f"{name}: {each.in_words()}" for name, report in self.reports.items() for each in report.own()]
        self.assertEqual(found, [], "\n".join(found))
        self.assertEqual({name: report.watched for name, report in self.reports.items()}, dict.fromkeys(LOOP, 1))

    @nightly
    def test_the_tracepoints_see_no_system_call_and_no_page_fault_but_those_planted(self) -> None:
        if absent():
            self.skipTest(absent())
        before = [line for at, line in self.tracepoints.seen if at < self.planted_at]
        after = " ".join(line for at, line in self.tracepoints.seen if at >= self.planted_at)
        self.assertEqual(before, [], f"before {self.planted_at:.3f}:\n" + "\n".join(before))
        for event in EVENTS:
            self.assertIn(event, after, "the tracepoint sees what was planted")

    def test_each_planted_violation_is_found_with_its_function(self) -> None:
        for name, report in self.reports.items():
            if report.unwatched:
                self.skipTest(f"{'; '.join(report.unwatched)} (remedy: kernel.perf_event_paranoid ≤ 2)")
            self.assertGreaterEqual(report.found(), set(PLANTED.items()), name)

    def test_the_counts_of_proc_find_the_planted_violations_alone(self) -> None:
        self.assertEqual(self.clean, dict.fromkeys(LOOP, (0, 0)))
        warned = {warning.split(":")[0] for warning in self.warnings}
        self.assertEqual(warned, set(LOOP), self.warnings)

    def test_the_figures_of_the_log_are_those_of_its_rows(self) -> None:
        with rosbag.Bag(str(self.folder / "run.bag")) as bag:
            summaries = [message for _, message, _ in bag.read_messages(["trace_summary"])]
        self.assertGreaterEqual(len(summaries), 1 + int(DRIVE) // 10)
        last = summaries[-1]
        expected = durations(self.rows)
        for name, values in expected.items():
            place = last.names.index(name)
            self.assertEqual(last.samples[place], values.size, name)
            self.assertEqual(last.max[place], int(values.max()), name)
            self.assertEqual(last.min[place], int(values.min()), name)
            for quantile, share in QUANTILES.items():
                exact = float(np.percentile(values, share, method="inverted_cdf"))
                measured = getattr(last, quantile)[place]
                self.assertLessEqual(abs(measured - exact), ERROR * abs(exact) + 1, f"{name} {quantile}: {exact}")

    def test_the_live_figures_are_those_of_the_first_rows(self) -> None:
        for name, values in durations(self.rows).items():
            node, quantity = name.split(".")
            live = figures_of(self.diagnostics[node], "_us").get(quantity)
            self.assertIsInstance(live, Figures, name)
            # Its last report is up to a second older than the end; the first rows may precede its first look.
            rows = values[: live.samples] / 1000
            exact = float(np.percentile(rows, 50, method="inverted_cdf"))
            self.assertGreater(live.samples, 0.5 * values.size, name)
            self.assertLessEqual(abs(live.p50 - exact), ERROR * exact + 0.5, name)


def durations(rows: Log) -> dict[str, FloatArray]:
    """Name in a trace_summary → the same durations of the rows, ns."""
    woke = {name: rows[f"{column}_woke_ns"] for name, column in WOKE.items()}
    published = {name: rows[f"{column}_published_ns"] for name, column in PUBLISHED.items()}
    slipped = np.diff(rows["slipped_ns"], prepend=rows["slipped_ns"][0])
    waker = {DRIVER: None, ESTIMATOR: DRIVER, CONTROLLER: ESTIMATOR, MONITOR: DRIVER}
    found = {}
    for name in LOOP:
        begin = woke[name] + slipped if waker[name] is None else woke[name] - published[waker[name]]
        # A frame that was published later has not caused the wake-up.
        found[f"{name}.wake_up"] = known(begin) if waker[name] is None else known(begin[~(begin < 0)])
        found[f"{name}.execution"] = known(published[name] - woke[name])
        due = rows["stamp_ns"] + rows["slipped_ns"]
        follows = np.diff(rows["cycle"]) == 1
        found[f"{name}.period"] = known(np.diff(due + woke[name])[follows])
    found[f"{CONTROLLER}.sensor_to_command"] = known(published[CONTROLLER] - woke[DRIVER])
    return found


WOKE = {DRIVER: "driver", ESTIMATOR: "estimator", CONTROLLER: "controller", MONITOR: "monitor"}
PUBLISHED = {DRIVER: "sensors", ESTIMATOR: "state", CONTROLLER: "command", MONITOR: "permit"}


def known(values: FloatArray) -> FloatArray:
    return values[~np.isnan(values)]
