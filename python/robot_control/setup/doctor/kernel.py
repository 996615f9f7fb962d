"""Checks of the kernel: preemption, limits of real-time threads, boot arguments."""

import re

from robot_control.setup.doctor.finding import Check, Finding, fault, note, ok, unseen, warning
from robot_control.setup.doctor.system import System

MIN_SHARE = 0.3
"""Share of a core that real-time threads need: the loop takes 0.13 of it at 1 kHz, and twice that at 2 kHz."""


def preemption(system: System) -> Finding:
    """PREEMPT_RT is best; a kernel without preemption delays every wake-up."""
    version = system.seen(system.text("proc/version"), "proc/version")
    chosen = re.search(r"\bpreempt=(\w+)", system.text("proc/cmdline") or "")
    if "PREEMPT_RT" in version or system.number("sys/kernel/realtime") == 1:
        return ok("PREEMPT_RT")
    if (chosen and chosen[1] == "none") or "PREEMPT" not in version:
        value = "no preemption" + (" (preempt=none in the boot arguments)" if chosen else "")
        remedy = "remove preempt=none from GRUB_CMDLINE_LINUX in /etc/default/grub, or install PREEMPT_RT"
        return warning(value, remedy, "sudo apt-get install linux-image-rt-amd64")
    model = chosen[1] if chosen else "the kernel's default"
    remedy = "Debian's linux-image-rt-amd64, if a bare machine misses deadlines (docs/realtime.md)"
    return note(f"PREEMPT_DYNAMIC, {model}" if "PREEMPT_DYNAMIC" in version else "PREEMPT", remedy)


def throttling(system: System) -> Finding:
    """The kernel limits the time of all real-time threads together."""
    runtime, period = (system.number(f"proc/sys/kernel/sched_rt_{name}_us") for name in ("runtime", "period"))
    if runtime is None or not period:
        return unseen(system.hidden("proc/sys/kernel/sched_rt_runtime_us"))
    if runtime < 0:
        return ok("not limited")
    share = runtime / period
    value = f"{runtime} of {period} µs"
    repair = ("sudo sysctl kernel.sched_rt_runtime_us=950000 kernel.sched_rt_period_us=1000000",)
    if runtime == 0:
        return fault(f"{value}: no real-time thread may run", "give real-time threads their time back", *repair)
    if share < MIN_SHARE:
        return warning(f"{value}: less than the loop may need", "give real-time threads their time back", *repair)
    return ok(value)


def _own_group(system: System) -> tuple[str, str]:
    """The path of this terminal's control group in the hierarchy `cpu` (version 1) and in version 2."""
    first = second = ""
    for line in (system.text("proc/self/cgroup") or "").splitlines():
        _, controllers, path = (*line.split(":", 2), "", "")[:3]
        if "cpu" in controllers.split(","):
            first = path
        elif not controllers:
            second = path
    return first, second


def group_budget(system: System) -> Finding:
    """With CONFIG_RT_GROUP_SCHED, SCHED_FIFO fails in a control group without a budget, whatever the privileges are."""
    first, second = _own_group(system)
    for folder in (f"sys/fs/cgroup/cpu{first}", f"sys/fs/cgroup/cpu,cpuacct{first}"):
        budget = system.number(f"{folder}/cpu.rt_runtime_us")
        if budget == 0:
            return fault(
                f"0 µs in the control group {first}: SCHED_FIFO is refused here",
                "give the group a budget (docker run --cpu-rt-runtime=950000, or write cpu.rt_runtime_us), or use a "
                "kernel without CONFIG_RT_GROUP_SCHED",
                f"echo 950000 | sudo tee /{folder}/cpu.rt_runtime_us",
            )
        if budget is not None:
            return ok(f"{budget} µs in the control group {first}")
    release = system.text("proc/sys/kernel/osrelease")
    settings = system.seen(system.text(f"boot/config-{release}"), f"boot/config-{release}")
    if "CONFIG_RT_GROUP_SCHED=y" not in settings:
        return ok("no budgets in this kernel (CONFIG_RT_GROUP_SCHED is not set)")
    if second not in ("", "/") and "rt_group_sched=0" not in (system.text("proc/cmdline") or ""):
        return fault(
            f"CONFIG_RT_GROUP_SCHED with control groups of version 2: SCHED_FIFO is refused in {second}",
            "add rt_group_sched=0 to the boot arguments (Linux 6.16 or later), or use a kernel without "
            "CONFIG_RT_GROUP_SCHED, such as Debian's",
        )
    return ok("CONFIG_RT_GROUP_SCHED, in the root group")


def timers(system: System) -> Finding:
    """Without high-resolution timers a sleep ends at a tick of 1 … 10 ms."""
    if re.search(r"\bhighres=off\b", system.text("proc/cmdline") or ""):
        return fault("highres=off in the boot arguments", "remove it from GRUB_CMDLINE_LINUX in /etc/default/grub")
    return ok("high-resolution timers are not switched off")


def pressure(system: System) -> Finding:
    """The kernel's own figure for the time that runnable threads waited for a processor."""
    shown = re.search(r"^some avg10=([\d.]+)", system.text("proc/pressure/cpu") or "", re.MULTILINE)
    found = system.seen(shown, "proc/pressure/cpu")
    share = float(found[1])
    value = f"threads wait for a processor {share:.0f} % of the time (last 10 s)"
    return ok(value) if share < 50 else note(value, "end other work, or use a faster machine")


CHECKS = (
    Check("preemption", "the kernel decides how soon a woken thread runs", preemption),
    Check("rt_throttling", "the kernel stops all real-time threads beyond this share of a core", throttling),
    Check("rt_group_budget", "a control group may forbid SCHED_FIFO despite every privilege", group_budget),
    Check("timers", "the driver sleeps until its next cycle", timers),
    Check("cpu_pressure", "threads without real-time priority wait for a processor", pressure),
)
