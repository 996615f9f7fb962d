"""Checks of what else runs: on the loop's core, above its priority, in other virtual machines."""

from pathlib import Path

from robot_control.setup.doctor.finding import Check, Finding, note, ok, warning
from robot_control.setup.doctor.memory import MAX_PRIORITY
from robot_control.setup.doctor.programs import NODES
from robot_control.setup.doctor.system import CAP_SYS_NICE, System
from robot_control.setup.doctor.tasks import load

LOWEST_PRIORITY = 80
"""The controller's; LoopPriority of loop/processes/process.h"""
HOG_SHARE = 0.5
STEAL_NOTE, STEAL_SHARE = 0.001, 0.02
MAX_SHOWN = 3


def _ours(system: System) -> set[int]:
    return {number for number, arguments in system.processes() if Path(arguments[0]).name in NODES}


def hogs(system: System) -> Finding:
    """Threads that keep the loop's core busy."""
    if system.core is None:
        return ok("robot.core is -1: not pinned")
    ours = _ours(system)
    busy = [
        (task, share)
        for task, share in load(system).busy()
        if share > HOG_SHARE and task.core == system.core and task.process not in ours
    ]
    system.seen(load(system).second.tasks or None, "proc/1/task")
    if not busy:
        return ok(f"no other program takes more than {100 * HOG_SHARE:.0f} % of core {system.core}")
    named = ", ".join(f"{task.name} ({task.process}) {100 * share:.0f} %" for task, share in busy[:MAX_SHOWN])
    finding = note if _precedes(system) and not any(task.priority for task, _ in busy) else warning
    return finding(
        f"on core {system.core}: {named}",
        "move it to another core, or set robot.core to a free one",
        *(f"taskset -acp {_others(system)} {task.process}" for task, _ in busy[:MAX_SHOWN]),
    )


def _precedes(system: System) -> bool:
    """True if the loop gets SCHED_FIFO in this terminal, and so runs before ordinary threads."""
    limit = system.limit("Max realtime priority") or 0
    wanted = system.robot.get("realtime") not in ("off", False)
    return wanted and (system.may(CAP_SYS_NICE) or limit >= MAX_PRIORITY)


def _others(system: System) -> str:
    cores = sorted(set(load(system).second.cores) - {system.core})
    return ",".join(map(str, cores)) or "0"


def rivals(system: System) -> Finding:
    """Real-time threads of other programs at the loop's priorities or above."""
    tasks = system.seen(load(system).second.tasks or None, "proc/1/task")
    ours = _ours(system)
    above = [
        task
        for task in tasks.values()
        if task.priority >= LOWEST_PRIORITY and not task.of_kernel and task.process not in ours
    ]
    if not above:
        return ok(f"no other program runs at priority {LOWEST_PRIORITY} or above")
    named = ", ".join(f"{task.name} ({task.process}) {task.priority}" for task in above[:MAX_SHOWN])
    remedy = f"give it a priority below {LOWEST_PRIORITY}"
    return warning(named, remedy, *(f"sudo chrt -f -p 40 {task.thread}" for task in above[:MAX_SHOWN]))


def steal(system: System) -> Finding:
    """The time in which the hypervisor ran another machine on the loop's core."""
    share = system.seen(load(system).steal(system.core or 0), "proc/stat")
    value = f"{100 * share:.1f} % of core {system.core or 0}" + ("" if system.live else " since its start")
    if share > STEAL_SHARE:
        return warning(value, "reserve processors for this virtual machine on its host, or use a bare machine")
    if share > STEAL_NOTE:
        return note(value, "reserve processors for this virtual machine on its host")
    return ok(value)


CHECKS = (
    Check("core_load", "a program that runs on the loop's core delays it", hogs),
    Check("rival_threads", "a real-time thread of equal or higher priority is not interrupted by the loop", rivals),
    Check("steal_time", "no priority helps while the host runs another machine", steal),
)
