"""doctor.py: finds each planted fault, names its remedy, and stays silent on machines that are well."""

import contextlib
import json
import math
import os
import re
import resource
import shutil
import subprocess
import sys
import time
import xmlrpc.client
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import pytest
import yaml
from robot_control.setup.doctor.finding import Verdict
from robot_control.setup.doctor.measure import (
    MeasureError,
    Pair,
    interval,
    judge,
    measure,
    percentile99,
    require_programs,
)
from robot_control.setup.doctor.report import as_json, commands, exit_code, lines
from robot_control.setup.doctor.system import System
from robot_control.setup.doctor.tasks import SPAN, first_sample, load
from support.recorded_machine import (
    CLOCK,
    CPU,
    DF,
    RT_ROBOT,
    bare_debian,
    can_link,
    container,
    environment,
    limits,
    meminfo,
    preempt_rt,
    rows,
    status,
    task,
    times,
    virtual_machine,
    write,
)

PROGRAM = Path(__file__).parents[3] / "scripts" / "doctor.py"
ALARMS = (Verdict.WARNING, Verdict.FAULT)
HEALTHY = {
    "bare Debian 12": (bare_debian, {}),
    "container without privileges": (container, {}),
    "virtual machine": (virtual_machine, {}),
    "PREEMPT_RT": (preempt_rt, RT_ROBOT),
}
HARDWARE = {"driver": "can", "core": 3}
LINK = "commands/ip_-details_-json_link_show_can0"
USB = "sys/devices/pci0000:00/usb1/1-2"


class Planted(NamedTuple):
    """A fault of a machine that is well without it."""

    check: str  # that finds it
    remedy: str  # a part of it, or of its commands
    changes: Mapping[str, str | None] = MappingProxyType({})  # files
    parameters: Mapping[str, object] = MappingProxyType({})  # that differ
    machine: Callable[[], dict[str, str]] = bare_debian


def on_hardware(check: str, remedy: str, changes: Mapping[str, str | None] = {}, **parameters: object) -> Planted:
    """A fault of a computer with PREEMPT_RT behind a CAN bus."""
    return Planted(check, remedy, changes, HARDWARE | parameters, preempt_rt)


def on_board(check: str, remedy: str, changes: Mapping[str, str | None]) -> Planted:
    """A fault of a computer behind a motor board."""
    return Planted(check, remedy, changes, {"driver": "board"})


FAULTS = {
    "a kernel without preemption": Planted("preemption", "preempt=none", {"proc/cmdline": "ro preempt=none"}),
    "no time for real-time threads": Planted(
        "rt_throttling", "sched_rt_runtime_us=950000", {"proc/sys/kernel/sched_rt_runtime_us": "0"}
    ),
    "a control group without budget": Planted(
        "rt_group_budget",
        "--cpu-rt-runtime=950000",
        {"proc/self/cgroup": "4:cpu,cpuacct:/docker/1", "sys/fs/cgroup/cpu/docker/1/cpu.rt_runtime_us": "0"},
        machine=container,
    ),
    "budgets with control groups of version 2": Planted(
        "rt_group_budget", "rt_group_sched=0", {"boot/config-6.1.0-37-amd64": "CONFIG_RT_GROUP_SCHED=y"}
    ),
    "ticks instead of timers": Planted("timers", "/etc/default/grub", {"proc/cmdline": "ro highres=off"}),
    "required privileges that are not granted": Planted(
        "realtime_priority", "scripts/privileges install", parameters={"realtime": "required"}
    ),
    "a login older than its privileges": Planted(
        "memory_lock", "log in again", {"etc/security/limits.d/robot_control.conf": "robot - memlock unlimited\n"}
    ),
    "too few descriptors": Planted("open_files", "ulimit -n 1024", {"proc/self/limits": limits(files="32")}),
    "a limit on the size of files": Planted(
        "file_size", "ulimit -f unlimited", {"proc/self/limits": limits(size="1000000")}
    ),
    "a machine that swaps": Planted("swap", "swapoff", {"proc/meminfo": meminfo(swap=8_000_000)}),
    "little memory": Planted("free_memory", "memory limit", {"proc/meminfo": meminfo(available=100_000)}),
    "a core that is not there": Planted("core", "set robot.core to one of these", parameters={"core": 6}),
    "a core outside the container's set": Planted(
        "core", "set robot.core to one of these", {"sys/fs/cgroup/cpuset.cpus.effective": "2-3"}, machine=container
    ),
    "the lowest frequency": Planted(
        "governor", "echo performance", {f"{CPU}/cpu0/cpufreq/scaling_driver": "acpi-cpufreq"}
    ),
    "a limited frequency": Planted("governor", "echo 4200000", {f"{CPU}/cpu0/cpufreq/scaling_max_freq": "800000"}),
    "idle states that may not be excluded": Planted(
        "idle_states",
        "scripts/privileges install",
        {"proc/self/status": status(user=54321)},
        parameters={"cpu_dma_latency": 0},
    ),
    "a machine that is too hot": Planted(
        "throttling", "cool the computer", {"sys/class/thermal/thermal_zone0/temp": "96000"}
    ),
    "a machine that was throttled for long": Planted(
        "throttling", "cool the computer", {f"{CPU}/cpu0/thermal_throttle/core_throttle_total_time_ms": "900000"}
    ),
    "another core is isolated": Planted("isolated_cores", "robot.core: 2", {f"{CPU}/isolated": "2"}),
    "half a core is isolated": on_hardware(
        "smt_siblings", "echo off", {f"{CPU}/cpu3/topology/thread_siblings_list": "1,3"}
    ),
    "a quota that stops the nodes": Planted(
        "cpu_quota",
        "docker run --cpus",
        {"sys/fs/cgroup/cpu.max": "50000 100000", "sys/fs/cgroup/cpu.stat": "nr_periods 9\nnr_throttled 4\n"},
        machine=container,
    ),
    "a program on the loop's core": Planted(
        "core_load", "taskset -acp 1,2,3 800", task(800, "blender", ticks=900_000, core=0)
    ),
    "a real-time thread above the loop": Planted("rival_threads", "chrt -f -p 40 801", task(801, "jackd", priority=95)),
    "time that the host takes": Planted(
        "steal_time", "reserve processors", {"proc/stat": times(steal=60_000)}, machine=virtual_machine
    ),
    "an interrupt on the isolated core": on_hardware(
        "interrupts",
        "echo 0,1,2 | sudo tee /proc/irq/24/smp_affinity_list",
        {
            "proc/interrupts": "      CPU0 CPU1 CPU2 CPU3\n 24: 5 0 0 90000 PCI-MSI 1-edge eth0\n",
            "proc/irq/24/effective_affinity_list": "3",
        },
    ),
    "a line that no driver handles": Planted(
        "unhandled_interrupts", "/proc/interrupts", {"proc/irq/24/spurious": "count 99\nunhandled 9000\n"}
    ),
    "a slack of 5 ms": Planted("timer_slack", "TimerSlackNSec", {"proc/self/timerslack_ns": "5000000"}),
    "a slow clock": Planted("clock_source", f"echo tsc | sudo tee /{CLOCK}", {f"{CLOCK}/current_clocksource": "hpet"}),
    "two machines with clocks of their own": Planted(
        "clock_synchronised",
        "chrony",
        {"run/systemd/timesync/synchronized": None, **environment(ROS_MASTER_URI="http://192.0.2.1:1")},
    ),
    "no CAN interface": Planted("can", "connect the adapter", parameters={"driver": "can"}),
    "a CAN interface that is down": on_hardware("can", "ip link set can0 up", {LINK: can_link(flags=())}),
    "another CAN interface": on_hardware("can", "connect the adapter", drive_file={"bus": {"address": "can1"}}),
    "another bit rate than that of the drives": on_hardware(
        "can", "bitrate 500000", drive_file={"bus": {"address": "can0", "bit_rate": 500_000}}
    ),
    "a bus that is off": on_hardware("can", "terminators", {LINK: can_link(state="BUS-OFF")}),
    "errors on the bus": on_hardware("can", "terminators", {LINK: can_link(state="ERROR-PASSIVE", tx=128)}),
    "a bus that stays off": on_hardware("can", "restart-ms 100", {LINK: can_link(restart=0)}),
    "a short queue": on_hardware("can", "txqueuelen", {"sys/class/net/can0/tx_queue_len": "10"}),
    "a serial adapter that waits": on_board(
        "serial_latency", "echo 1 | sudo tee", {"sys/bus/usb-serial/devices/ttyUSB0/latency_timer": "16"}
    ),
    "an adapter that may sleep": on_board(
        "usb_autosuspend",
        "echo on | sudo tee",
        {f"{USB}/power/control": "auto", f"{USB}/idVendor": "0403", f"{USB}/1-2:1.0/ttyUSB0/port": ""},
    ),
    "a port of another group": on_board(
        "device_files", "usermod -aG dialout", {"dev/ttyUSB0": "", "proc/self/status": status(user=54321)}
    ),
    "a terminal without the package": Planted("package", "install/setup.bash", environment(ROS_PACKAGE_PATH="")),
    "another python3": Planted("python", "call /usr/bin/python3", {"usr/local/bin/python3": ""}),
    "a host without address": Planted("host_name", "/etc/hosts", {"etc/hosts": "127.0.0.1 localhost\n"}),
    "the address of another machine": Planted("ros_ip", "unset ROS_IP", environment(ROS_IP="10.0.0.9")),
    "an address that no other machine reaches": Planted(
        "ros_ip", "export ROS_IP=192.168.1.5", environment(ROS_IP="127.0.0.1", ROS_MASTER_URI="http://192.0.2.1:1")
    ),
    "a master without address": Planted(
        "master_address", "/etc/hosts", environment(ROS_MASTER_URI="http://nowhere.invalid:1")
    ),
    "a master without port": Planted(
        "master_address", "export ROS_MASTER_URI=", environment(ROS_MASTER_URI="localhost")
    ),
    "the same node twice": Planted(
        "duplicate_nodes",
        "__ns:=robot2",
        {
            f"proc/{pid}/{name}": text
            for pid in (900, 901)
            for name, text in (
                ("cmdline", "/opt/safety_monitor\0__ns:=a\0"),
                ("environ", "ROS_MASTER_URI=http://b:1\0"),
            )
        },
    ),
    "a robot at another master": Planted(
        "other_master",
        "export ROS_MASTER_URI=http://localhost:11399",
        {"proc/900/cmdline": "/opt/safety_monitor\0", "proc/900/environ": "ROS_MASTER_URI=http://localhost:11399\0"},
    ),
    "a full disk": Planted("log_space", "rosclean", {"commands/df_-Pk__home_robot": DF.format(free=5_000)}),
    "a quota that is exceeded": Planted(
        "quota", "larger quota", {"commands/quota_-w": "Filesystem blocks quota\n/dev/sda1 900* 800\n"}
    ),
    "no room for shared memory": Planted(
        "shared_memory", "--shm-size", {"commands/df_-Pk__dev_shm": DF.format(free=1_000)}, machine=container
    ),
}


def test_an_adapter_that_the_simulation_does_not_use_is_no_alarm(tmp_path):
    write(tmp_path, bare_debian() | {"sys/bus/usb-serial/devices/ttyUSB0/latency_timer": "16"})
    assert rows(tmp_path)["serial_latency"].finding.verdict is Verdict.NOTE


def test_a_bus_of_simulated_drives_needs_no_interface(tmp_path):
    (tmp_path / "drives.yaml").write_text("bus: {dialect: odrive, address: 'unix:/tmp/drives'}\n")
    (tmp_path / "my.yaml").write_text("robot: {driver: can, drives: drives.yaml}\n")
    write(tmp_path / "root", bare_debian())
    done = run("--root", tmp_path / "root", "--params", tmp_path / "my.yaml")
    assert "unix:/tmp/drives: simulated drives" in done.stdout


@pytest.mark.parametrize(
    ("drive", "verdict", "words"),
    [
        ("ak", Verdict.NOTE, "cuts the supply of the motors"),
        ("unitree_legged", Verdict.NOTE, "state it as on_silence"),
        ("unitree_go", Verdict.NOTE, "state it as on_silence"),
        ("odrive", Verdict.OK, "states: coasts"),
        ("vesc", Verdict.OK, "states: coasts"),
        ("board", Verdict.OK, "states: holds"),
        ("roboclaw", Verdict.OK, "states: coasts"),
        ("cia402", Verdict.OK, "no drive file states a reaction"),
        ("damiao", Verdict.OK, "no drive file states a reaction"),
        ("cybergear", Verdict.OK, "no drive file states a reaction"),
        ("moteus", Verdict.OK, "no drive file states a reaction"),
    ],
)
def test_the_reaction_of_every_drive_on_silence_is_that_of_its_file(tmp_path, drive, verdict, words):
    write(tmp_path, preempt_rt())
    tree = yaml.safe_load((Path(__file__).parents[3] / f"config/drives/{drive}.yaml").read_text())
    found = rows(tmp_path, RT_ROBOT | {"drive_file": tree})["silence"].finding
    assert found.verdict is verdict
    assert words in f"{found.value}; {found.remedy}"


def test_one_joint_that_keeps_its_last_order_is_named(tmp_path):
    write(tmp_path, preempt_rt())
    tree = {"bus": {"dialect": "cybergear"}, "every_joint": {"node": 1}, "knee_joint": {"on_silence": "keeps"}}
    assert rows(tmp_path, RT_ROBOT | {"drive_file": tree})["silence"].finding.verdict is Verdict.NOTE


def test_a_reaction_that_the_file_accepts_without_knowing_it_and_an_unreadable_file_are_named(tmp_path):
    write(tmp_path, preempt_rt())
    for on_silence, verdict in (({}, Verdict.NOTE), ({"on_silence": "coasts"}, Verdict.OK)):
        tree = {"every_joint": on_silence, "left_wheel_joint": {"accept_unknown_watchdog": True}}
        assert rows(tmp_path, RT_ROBOT | {"drive_file": tree})["silence"].finding.verdict is verdict
    for broken in ({}, {"drive_file": None}, {"drive_file": [1]}):
        found = rows(tmp_path, RT_ROBOT | {"drives": "my.yaml"} | broken)["silence"].finding
        assert (found.verdict, found.value) == (Verdict.WARNING, "the drive file my.yaml cannot be read")


def test_an_ordinary_program_on_the_core_of_a_loop_with_privileges_is_no_alarm(tmp_path):
    write(tmp_path, preempt_rt() | task(800, "blender", ticks=900_000, core=3))
    assert rows(tmp_path, RT_ROBOT)["core_load"].finding.verdict is Verdict.NOTE


@pytest.mark.parametrize("name", HEALTHY)
def test_a_healthy_machine_raises_no_alarm(tmp_path, name):
    machine, robot = HEALTHY[name]
    write(tmp_path, machine())
    found = rows(tmp_path, robot)
    alarms = {name: row.finding for name, row in found.items() if row.finding.verdict in ALARMS}
    assert alarms == {}
    assert exit_code(list(found.values())) == 0


def test_what_a_virtual_machine_hides_is_not_claimed(tmp_path):
    write(tmp_path, virtual_machine())
    found = rows(tmp_path)
    for name in ("governor", "idle_states", "throttling"):
        assert found[name].finding.verdict is Verdict.UNSEEN
        assert found[name].finding.value == "not visible in this virtual machine"


def test_an_empty_folder_shows_nothing_that_could_be_good_or_bad_of_the_processor(tmp_path):
    found = rows(tmp_path)
    for name in (
        "preemption",
        "rt_throttling",
        "governor",
        "idle_states",
        "isolated_cores",
        "steal_time",
        "clock_source",
    ):
        assert found[name].finding.verdict is Verdict.UNSEEN, name


@pytest.mark.parametrize("name", FAULTS)
def test_a_planted_fault_is_found_with_its_remedy(tmp_path, name):
    planted = FAULTS[name]
    write(tmp_path, planted.machine() | planted.changes)
    if "usb1" in "".join(planted.changes):
        (tmp_path / "sys/class/tty").mkdir(parents=True)
        (tmp_path / "sys/class/tty/ttyUSB0").mkdir()
        (tmp_path / "sys/class/tty/ttyUSB0/device").symlink_to(tmp_path / USB / "1-2:1.0/ttyUSB0")
    for port in tmp_path.glob("dev/*"):
        port.chmod(0o700 if port.is_dir() else 0o600)
    found = rows(tmp_path, dict(planted.parameters))[planted.check].finding
    assert found.verdict in ALARMS, found
    assert planted.remedy in " ".join((found.remedy, *found.commands)), found


def test_most_faults_are_planted():
    assert len({planted.check for planted in FAULTS.values()}) + len(GRAPH) >= 24


@pytest.fixture(scope="module")
def master():
    """A ROS master without nodes, on a port of its own."""
    program = (
        "import rosmaster.master, time\n"
        "master = rosmaster.master.Master(0)\n"
        "master.start()\n"
        "print(master.uri, flush=True)\n"
        "time.sleep(600)"
    )
    values = {**os.environ, "ROS_IP": "127.0.0.1"}
    child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, env=values)
    try:
        port = child.stdout.readline().rstrip("/\n").rsplit(":", 1)[1]
        yield f"http://127.0.0.1:{port}"
    finally:
        child.kill()
        child.wait()


class Registered:
    """Registers and parameters of the case, which are removed after it."""

    def __init__(self, uri):
        self.proxy = xmlrpc.client.ServerProxy(uri)
        self.undo = contextlib.ExitStack()

    def publisher(self, node, topic, uri):
        self.proxy.registerPublisher(node, topic, "geometry_msgs/Twist", uri)
        self.undo.callback(self.proxy.unregisterPublisher, node, topic, uri)

    def parameter(self, name, value):
        self.proxy.setParam("/test", name, value)
        self.undo.callback(self.proxy.deleteParam, "/test", name)


GONE = "http://127.0.0.1:1"
GRAPH = {
    "dead_nodes": (lambda ros: ros.publisher("/camera", "/image", GONE), "rosnode cleanup"),
    "simulated_time": (lambda ros: ros.parameter("/use_sim_time", True), "rosparam set /use_sim_time false"),
    "left_over_parameters": (
        lambda ros: ros.parameter("/robot/rate", 500),
        "rosparam delete /robot/rate",
    ),
    "command_senders": (
        lambda ros: [ros.publisher(f"/sender_{name}", "/cmd_vel", GONE) for name in "ab"],
        "docs/driving.md",
    ),
}


@pytest.mark.parametrize("check", GRAPH)
def test_a_fault_of_the_graph_is_found_with_its_remedy(tmp_path, master, check):
    plant, remedy = GRAPH[check]
    write(tmp_path, bare_debian() | environment(ROS_MASTER_URI=master))
    registered = Registered(master)
    before = rows(tmp_path)
    assert before["master"].finding.verdict is Verdict.OK
    assert before[check].finding.verdict is Verdict.OK, before[check].finding
    with registered.undo:
        plant(registered)
        found = rows(tmp_path)[check].finding
    assert found.verdict in ALARMS
    assert remedy in " ".join((found.remedy, *found.commands))


def test_parameters_that_each_launch_sets_are_not_left_over(tmp_path, master):
    write(tmp_path, bare_debian() | environment(ROS_MASTER_URI=master))
    registered = Registered(master)
    with registered.undo:
        registered.parameter("/robot/clock", "wall")
        registered.parameter("/safety_monitor/config", "a.yaml")
        assert rows(tmp_path)["left_over_parameters"].finding.verdict is Verdict.OK


def test_a_port_that_does_not_answer_as_a_master_is_a_fault(tmp_path):
    import socket

    with socket.create_server(("127.0.0.1", 0)) as server:
        uri = f"http://127.0.0.1:{server.getsockname()[1]}"
        write(tmp_path, bare_debian() | environment(ROS_MASTER_URI=uri))
        found = rows(tmp_path)["master"].finding
    assert found.verdict is Verdict.FAULT
    assert "ss -tlnp" in found.remedy


def test_a_master_that_does_not_run_is_no_alarm(tmp_path):
    write(tmp_path, bare_debian() | environment(ROS_MASTER_URI=GONE))
    assert rows(tmp_path)["master"].finding.verdict is Verdict.NOTE


def test_the_load_of_this_machine_names_a_busy_thread():
    """The share is what other programs leave to the thread, so only its order is claimed."""
    child = subprocess.Popen([sys.executable, "-c", "while True: pass"])
    try:
        end = time.monotonic() + 60.0
        share = 0.0
        while share < 0.02 and time.monotonic() < end:
            system = System()
            assert first_sample(system) is not None
            time.sleep(1.0)
            share = {task.process: each for task, each in load(system).busy()}.get(child.pid, 0.0)
    finally:
        child.kill()
        child.wait()
    assert 0.02 <= share <= 1.1


def run(*arguments):
    """The program where nothing of ROS is sourced."""
    call = [PROGRAM, *arguments]
    return subprocess.run(call, capture_output=True, text=True, check=False, env={"PATH": "/usr/bin:/bin"}, cwd="/")


def test_it_runs_without_ros_on_this_machine_in_time():
    """It takes 3 s at most. Other programs may delay it tenfold, but not its own processor time."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.monotonic()
    done = run("--json")
    spent = time.monotonic() - began
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    report = json.loads(done.stdout)
    assert done.returncode == report["exit_code"], done.stderr
    assert {row["name"]: row["verdict"] for row in report["checks"]}["package"] == "warning"
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime < 3.0 - SPAN
    assert spent < 30.0


def test_a_line_holds_verdict_value_reason_and_remedy(tmp_path):
    write(tmp_path, bare_debian() | {f"{CLOCK}/current_clocksource": "hpet"})
    done = run("--root", tmp_path)
    assert done.returncode == 1
    line = next(line for line in done.stdout.splitlines() if "clock_source" in line)
    assert line.startswith("WARNING  clock_source")
    assert "hpet: a reading takes microseconds [each cycle reads the clock several times]; remedy: use tsc" in line
    assert re.search(r"0 FAULT, 1 WARNING, \d+ unseen, \d+ note, \d+ ok$", done.stdout.strip())


def test_the_exit_code_is_that_of_the_worst_verdict(tmp_path):
    write(tmp_path, bare_debian() | {"proc/sys/kernel/sched_rt_runtime_us": "0", "usr/local/bin/python3": ""})
    assert run("--root", tmp_path).returncode == 2


def test_commands_are_printed_and_not_run(tmp_path):
    write(tmp_path, bare_debian() | {f"{CLOCK}/current_clocksource": "hpet"})
    before = sorted((path, path.stat().st_mtime_ns) for path in tmp_path.rglob("*"))
    done = run("--root", tmp_path, "--fix")
    assert f"echo tsc | sudo tee /{CLOCK}/current_clocksource" in done.stdout
    assert done.stdout.startswith("# WARNING clock_source: hpet")
    assert before == sorted((path, path.stat().st_mtime_ns) for path in tmp_path.rglob("*"))


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("proc/self/status", "CapEff:\tzzzz\n"),
        ("proc/self/limits", "Max realtime priority     abc                  abc\n"),
        ("proc/uptime", "1.2.3"),
        ("proc/1abc/cmdline", "mujoco_plant"),
        ("proc/interrupts", "x"),
        ("proc/stat", "cpu0 a b c d\n"),
        ("sys/devices/system/cpu/online", "0-99999999"),
        ("commands/ip_-details_-statistics_-json_link_show_type_can", '{"a": [null]}'),
    ],
)
def test_a_file_of_another_form_costs_its_checks_alone(tmp_path, name, text):
    write(tmp_path, bare_debian() | {name: text})
    assert len(rows(tmp_path)) == len(rows(tmp_path / "empty"))


def test_foreign_names_are_no_commands(tmp_path):
    write(tmp_path, bare_debian() | task(800, "x\nrm -rf ~", ticks=900_000, core=0))
    done = run("--root", tmp_path, "--fix")
    assert "x?rm -rf ~" in done.stdout
    assert "\nrm" not in done.stdout


def test_the_reports_hold_every_check(tmp_path):
    write(tmp_path, bare_debian())
    found = list(rows(tmp_path).values())
    assert len(lines(found)) == len(found) + 1
    assert [check["name"] for check in json.loads(as_json(found))["checks"]] == [row.name for row in found]
    assert len({row.name for row in found}) == len(found)
    assert commands([]) == ["# nothing to repair"]


def test_parameters_of_the_user_are_read(tmp_path):
    write(tmp_path / "root", bare_debian())
    (tmp_path / "my.yaml").write_text("robot:\n  core: 9\n")
    done = run("--root", tmp_path / "root", "--params", tmp_path / "my.yaml")
    assert "robot.core is 9, available are 0, 1, 2, 3" in done.stdout


@pytest.mark.parametrize(("count", "below"), [(1, 0), (5, 0), (6, 0), (9, 1), (10, 1), (20, 5)])
def test_the_interval_of_a_median_is_that_of_the_binomial_distribution(count, below):
    ordered = [float(value) for value in range(count)]
    assert interval(ordered) == (below, count - 1 - below)
    if count >= 6:  # the coverage, by its definition
        outside = 2 * sum(math.comb(count, each) for each in range(below + 1)) / 2**count
        assert outside <= 0.05
        assert outside + 2 * math.comb(count, below + 1) / 2**count > 0.05


def test_a_percentile_of_a_histogram():
    assert (
        percentile99("# Histogram\n000000 000000\n000003 000980\n000009 000015\n000020 000005\n# Total: 1000\n") == 9.0
    )
    assert percentile99("# nothing\n") is None
    assert percentile99("# Histogram\n000010 000090\n# Histogram Overflows: 00010\n") > 10_000


@pytest.mark.parametrize(
    ("pairs", "verdict"),
    [
        ([Pair(60.0, 55.0)] * 10, Verdict.OK),
        ([Pair(80.0, 55.0)] * 10, Verdict.WARNING),
        ([Pair(80.0, 55.0)] * 5, Verdict.NOTE),
        ([Pair(900.0, 800.0)] * 10, Verdict.WARNING),
        ([Pair(55.0, 55.0)] * 5 + [Pair(90.0, 55.0)] * 5, Verdict.OK),
        ([], Verdict.UNSEEN),
    ],
)
def test_the_nodes_are_judged_beside_cyclictest(pairs, verdict):
    assert judge(pairs, period=1000.0).verdict is verdict


def test_a_program_that_the_measurement_needs_is_named_with_its_package(monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda name, path: None if name == "cyclictest" else name)
    with pytest.raises(MeasureError, match="needs cyclictest: scripts/setup --realtime, or apt-get install rt-tests"):
        require_programs()


@pytest.mark.nightly
def test_the_nodes_are_measured_beside_cyclictest_idle_and_under_load():
    try:
        require_programs()
    except MeasureError as error:
        pytest.skip(str(error))
    found = {row.name: row.finding for row in measure(System(), 1)}
    assert found.keys() == {"wake_up_idle", "wake_up_load"}
    assert all(re.match(r"p99 \d+ µs, cyclictest \d+ µs", finding.value) for finding in found.values())


def test_a_root_that_is_no_folder_is_refused():
    done = run("--root", "/nonexistent")
    assert "--root /nonexistent is not a folder" in done.stderr
