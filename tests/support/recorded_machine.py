"""Machines as doctor.py reads them: small folders of /proc, /sys, /etc and /dev, and of what programs print."""

import json

from robot_control.setup.doctor.main import examine
from robot_control.setup.doctor.system import DEFAULTS, System

CPU = "sys/devices/system/cpu"
CLOCK = "sys/devices/system/clocksource/clocksource0"
DF = "Filesystem 1024-blocks Used Available Capacity Mounted on\n/dev/sda1 100000000 1 {free} 1% /\n"
FREE = DF.format(free=50_000_000)
INSTALLED = "/opt/robot_control/share"
ENVIRONMENT = {"PATH": "/usr/local/bin:/usr/bin:/bin", "HOME": "/home/robot", "ROS_PACKAGE_PATH": INSTALLED}


def limits(rtprio="0", memlock="8388608", files="1024 1048576", size="unlimited"):
    def row(name, values, unit):
        soft, _, hard = values.partition(" ")
        return f"{name:<26}{soft:<21}{hard or soft:<21}{unit}\n"

    return (
        "Limit                     Soft Limit           Hard Limit           Units\n"
        + row("Max file size", size, "bytes")
        + row("Max open files", files, "files")
        + row("Max locked memory", memlock, "bytes")
        + row("Max realtime priority", rtprio, "")
    )


def status(capabilities="0000000000000000", cores="0-3", user=1000):
    ids = "\t".join([str(user)] * 4)
    return f"Uid:\t{ids}\nGid:\t{ids}\nGroups:\t{user} \nCapEff:\t{capabilities}\nCpus_allowed_list:\t{cores}\n"


def meminfo(total=16_000_000, available=12_000_000, swap=1_000_000, swap_free=1_000_000):
    return f"MemTotal: {total} kB\nMemAvailable: {available} kB\nSwapTotal: {swap} kB\nSwapFree: {swap_free} kB\n"


def task(pid, name, *, ticks=0, core=0, priority=0, start=100):
    """Path and text of a thread's line; `ticks` of its processor time are hundredths of a second."""
    fields = ["S", "1", *["0"] * 9, str(ticks), "0", *["0"] * 6, str(start), *["0"] * 16, str(core), str(priority), "1"]
    return {f"proc/{pid}/task/{pid}/stat": f"{pid} ({name}) {' '.join(fields)} 0 0 0 0 0\n"}


def environment(**changes):
    return {"proc/self/environ": "".join(f"{key}={value}\0" for key, value in {**ENVIRONMENT, **changes}.items())}


def times(steal=0, user=40_000):
    row = f"{user} 0 20000 940000 0 0 0 {steal}"
    return f"cpu  {row} 0 0\n" + "".join(f"cpu{core} {row} 0 0\n" for core in range(4))


def bare_debian():
    """A computer with Debian 12 as it is after its installation, and this package sourced."""
    files = {
        "proc/version": "Linux version 6.1.0-37-amd64 (gcc-12 (Debian 12.2.0)) #1 SMP PREEMPT_DYNAMIC Debian 6.1.140-1",
        "proc/cmdline": "BOOT_IMAGE=/boot/vmlinuz-6.1.0-37-amd64 root=UUID=1 ro quiet",
        "proc/sys/kernel/osrelease": "6.1.0-37-amd64",
        "proc/sys/kernel/hostname": "debian",
        "proc/sys/kernel/sched_rt_runtime_us": "950000",
        "proc/sys/kernel/sched_rt_period_us": "1000000",
        "boot/config-6.1.0-37-amd64": "CONFIG_PREEMPT_DYNAMIC=y\n# CONFIG_RT_GROUP_SCHED is not set\n",
        "proc/self/cgroup": "0::/user.slice/user-1000.slice/session-2.scope",
        "proc/self/status": status(),
        "proc/self/limits": limits(),
        "proc/self/timerslack_ns": "50000",
        "proc/meminfo": meminfo(),
        "proc/cpuinfo": "processor : 0\nflags : fpu sse2 constant_tsc nonstop_tsc\n",
        "proc/pressure/cpu": "some avg10=0.21 avg60=0.20 avg300=0.10 total=1\n",
        "proc/uptime": "10000.0 39000.0",
        "proc/stat": times(),
        "proc/interrupts": "   CPU0 CPU1 CPU2 CPU3\n 24: 90000 0 0 0 PCI-MSI eth0\n LOC: 9 9 9 9 timer\n",
        "proc/irq/24/effective_affinity_list": "0",
        "proc/irq/24/spurious": "count 3\nunhandled 0\nlast_unhandled 0 ms\n",
        "proc/net/fib_trie": "Local:\n  |-- 127.0.0.1\n     /32 host LOCAL\n  |-- 192.168.1.5\n     /32 host LOCAL\n",
        f"{CPU}/online": "0-3",
        f"{CPU}/isolated": "",
        f"{CLOCK}/current_clocksource": "tsc",
        f"{CLOCK}/available_clocksource": "tsc hpet acpi_pm",
        "sys/class/thermal/thermal_zone0/type": "x86_pkg_temp",
        "sys/class/thermal/thermal_zone0/temp": "47000",
        "sys/class/thermal/thermal_zone0/trip_point_0_type": "passive",
        "sys/class/thermal/thermal_zone0/trip_point_0_temp": "95000",
        "run/systemd/timesync/synchronized": "",
        "etc/hosts": "127.0.0.1 localhost\n127.0.1.1 debian\n",
        "dev/cpu_dma_latency": "",
        "dev/shm/robot_control.1000.0123456789abcdef.sensors": "x" * 100,
        "usr/bin/python3": "",
        f"{INSTALLED[1:]}/robot_control/package.xml": "<package><name>robot_control</name></package>",
        "commands/df_-Pk__home_robot": FREE,
        "commands/df_-Pk__home": FREE,
        "commands/df_-Pk__dev_shm": FREE,
        "home/robot/.profile": "",
        **task(700, "Xorg", ticks=20_000, core=2),
        **environment(),
    }
    for core in range(4):
        folder = f"{CPU}/cpu{core}"
        files |= {
            f"{folder}/cpufreq/scaling_governor": "powersave",
            f"{folder}/cpufreq/scaling_driver": "intel_pstate",
            f"{folder}/cpufreq/scaling_max_freq": "4200000",
            f"{folder}/cpufreq/cpuinfo_max_freq": "4200000",
            f"{folder}/topology/thread_siblings_list": f"{core % 2},{core % 2 + 2}",
            f"{folder}/thermal_throttle/core_throttle_count": "2",
            f"{folder}/thermal_throttle/core_throttle_total_time_ms": "35",
        }
        for index, (name, latency) in enumerate((("POLL", 0), ("C1", 2), ("C6", 133))):
            state = f"{folder}/cpuidle/state{index}"
            files |= {f"{state}/name": name, f"{state}/latency": str(latency), f"{state}/disable": "0"}
    return files


def _without(files, *prefixes):
    return {name: text for name, text in files.items() if not name.startswith(prefixes)}


def container():
    """Docker on that computer, without any privilege; its /sys is read-only, and its /boot is empty."""
    return _without(bare_debian(), "boot/", "run/systemd", "dev/cpu_dma_latency", "home/") | {
        ".dockerenv": "",
        "proc/self/cgroup": "0::/",
        "proc/self/status": status(capabilities="00000000a80425fb", user=0),
        "proc/sys/kernel/hostname": "3f2b1c9d8e7a",
        "etc/hosts": "127.0.0.1 localhost\n172.17.0.2 3f2b1c9d8e7a\n",
        "sys/fs/cgroup/cpu.max": "max 100000",
        "sys/fs/cgroup/memory.max": "max",
        "commands/df_-Pk__": FREE,
        "commands/df_-Pk__dev_shm": DF.format(free=65_536),
        **environment(HOME="/root"),
    }


def virtual_machine():
    """KVM with two processors; it shows neither frequencies nor idle states nor temperatures."""
    hidden = [f"{CPU}/cpu{core}/{name}" for core in range(4) for name in ("cpufreq", "cpuidle", "thermal_throttle")]
    return _without(bare_debian(), *hidden, "sys/class/thermal") | {
        "proc/cpuinfo": "processor : 0\nflags : fpu sse2 hypervisor\n",
        "proc/self/status": status(cores="0-1"),
        "proc/stat": times(steal=2_000),
        f"{CPU}/online": "0-1",
        f"{CPU}/cpu0/topology/thread_siblings_list": "0-1",
        f"{CLOCK}/current_clocksource": "kvm-clock",
    }


def preempt_rt():
    """That computer after all steps of docs/realtime.md, with core 3 for the loop and motor drives on can0."""
    files = bare_debian() | {
        "proc/version": "Linux version 6.1.0-37-rt-amd64 (gcc-12 (Debian 12.2.0)) #1 SMP PREEMPT_RT Debian 6.1.140-1",
        "proc/cmdline": "root=UUID=1 ro isolcpus=3 nohz_full=3 rcu_nocbs=3 irqaffinity=0-2 quiet",
        "proc/self/limits": limits(rtprio="99", memlock="unlimited"),
        "proc/self/status": status(cores="0-2"),
        "sys/kernel/realtime": "1",
        f"{CPU}/isolated": "3",
        "etc/security/limits.d/robot_control.conf": "robot - rtprio 99\nrobot - memlock unlimited\n",
        "sys/class/net/can0/type": "280",
        "sys/class/net/can0/operstate": "up",
        "sys/class/net/can0/tx_queue_len": "128",
        "commands/ip_-details_-json_link_show_can0": can_link(),
    }
    for core in range(4):
        files[f"{CPU}/cpu{core}/cpufreq/scaling_governor"] = "performance"
        files[f"{CPU}/cpu{core}/topology/thread_siblings_list"] = str(core)
    return files


def can_link(state="ERROR-ACTIVE", tx=0, restart=100, flags=("UP",)):
    """The output of `ip`."""
    data = {"state": state, "restart_ms": restart, "berr_counter": {"tx": tx, "rx": 0}}
    kind = {"info_kind": "can", "info_data": data | {"bittiming": {"bitrate": 1_000_000}}}
    return json.dumps([{"ifname": "can0", "flags": flags, "linkinfo": kind}])


RT_ROBOT = {"core": 3, "driver": "can"}
"""Parameters of the machine `preempt_rt`; its device of idle states belongs to the user of the test."""


def write(folder, files):
    """A file of None is absent."""
    for name, text in files.items():
        assert not name.startswith("/"), name
        if text is not None:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)


def rows(folder, robot=None):
    """Every finding by name, and the system; `robot` holds the parameters that differ."""
    return {row.name: row for row in examine(System(folder, DEFAULTS | (robot or {})))}
