"""Checks of the core on which the loop runs."""

from robot_control.setup.doctor.finding import Check, Finding, fault, note, ok, warning
from robot_control.setup.doctor.memory import GRANT, INSTALL
from robot_control.setup.doctor.system import System, cores_of

CPU = "sys/devices/system/cpu"
NO_DEVICE = "remove robot.cpu_dma_latency from your parameters"
DEEP_STATE = 50
"""µs, exit latency of an idle state that a 1 kHz loop notices"""
THROTTLED_SHARE = 0.01
"""Share of the time since the start of the computer"""


def _core(system: System) -> int:
    return system.core if system.core is not None else 0


def _available(system: System) -> set[int]:
    """The cores to which a thread may pin itself.

    They are those of the processor set of the control group. The kernel takes isolated cores out of the affinity of
    ordinary programs only, so they count as well.
    """
    group = (system.text("proc/self/cgroup") or "").rpartition("::")[2].strip("/")
    for folder in (f"sys/fs/cgroup/{group}", "sys/fs/cgroup"):
        if (listed := system.text(f"{folder}/cpuset.cpus.effective")) is not None:
            return cores_of(listed)
    allowed = cores_of(system.status("Cpus_allowed_list"))
    return allowed | cores_of(system.text(f"{CPU}/isolated")) if allowed else set()


def granted(system: System) -> Finding:
    """The nodes pin their loop to robot.core."""
    if system.core is None:
        return note("robot.core is -1: not pinned", "set robot.core, so that the chain wakes up on one core")
    available = system.seen(_available(system) or None, "proc/self/status")
    online = cores_of(system.text(f"{CPU}/online"))
    if system.core in available and (not online or system.core in online):
        return ok(f"core {system.core}")
    listed = ", ".join(map(str, sorted(available & online if online else available)))
    remedy = "set robot.core to one of these, or extend the processor set of the container or service"
    return fault(f"robot.core is {system.core}, available are {listed}", remedy)


def governor(system: System) -> Finding:
    """The governor of the loop's core, and the limit of its frequency."""
    folder = f"{CPU}/cpu{_core(system)}/cpufreq"
    name, driver = (system.text(f"{folder}/scaling_{key}") for key in ("governor", "driver"))
    name = system.seen(name, f"{folder}/scaling_governor")
    limit, highest = system.number(f"{folder}/scaling_max_freq"), system.number(f"{folder}/cpuinfo_max_freq")
    repair = f"echo performance | sudo tee /{CPU}/cpu*/cpufreq/scaling_governor"
    if limit and highest and limit < 0.8 * highest:
        value = f"at most {limit / 1e6:.2f} of {highest / 1e6:.2f} GHz"
        return warning(value, "remove the limit", f"echo {highest} | sudo tee /{folder}/scaling_max_freq")
    # With these drivers the governor of this name changes the frequency as schedutil does.
    adaptive = driver in ("intel_pstate", "amd-pstate-epp")
    if name == "powersave" and not adaptive:
        return warning(f"powersave ({driver}): the lowest frequency", "use the governor performance", repair)
    if name == "performance":
        return ok("performance")
    return note(f"{name} ({driver}): the frequency follows the load", "use the governor performance", repair)


def idle_states(system: System) -> Finding:
    """The deepest idle state that is enabled, and whether the loop may exclude it."""
    wanted = system.robot.get("cpu_dma_latency")
    device = system.path("dev/cpu_dma_latency")
    if wanted is not None and not device.exists():
        return warning(f"robot.cpu_dma_latency is {wanted}, and /dev/cpu_dma_latency is absent", NO_DEVICE)
    if wanted is not None and not writable(system, "dev/cpu_dma_latency"):
        shown = f"robot.cpu_dma_latency is {wanted}, and this user may not open /dev/cpu_dma_latency"
        return warning(shown, GRANT, INSTALL)
    what = [name.rsplit("/", 1)[0] for name in system.names(f"{CPU}/cpu{_core(system)}/cpuidle/state*/latency")] or None
    states = system.seen(what, f"{CPU}/cpu{_core(system)}/cpuidle")
    enabled = [state for state in states if system.number(f"{state}/disable") != 1]
    deepest = max(enabled or states[:1], key=lambda state: system.number(f"{state}/latency") or 0)
    latency = system.number(f"{deepest}/latency") or 0
    value = f"{system.text(f'{deepest}/name')} with {latency} µs to wake up"
    if wanted is not None:
        return ok(f"at most {wanted} µs while the robot runs (robot.cpu_dma_latency)")
    if latency <= DEEP_STATE:
        return ok(value)
    return note(value, "robot.cpu_dma_latency: 0, granted by scripts/privileges install")


def writable(system: System, name: str) -> bool:
    """True if the user of this terminal may write the file, by owner, group and mode."""
    try:
        status = system.path(name).stat()
    except OSError:
        return False
    user = (system.status("Uid").split() or [""])[0]
    groups = {*system.status("Groups").split(), *system.status("Gid").split()[:1]}
    if user == "0":
        return True
    if str(status.st_uid) == user:
        return bool(status.st_mode & 0o200)
    return bool(status.st_mode & (0o020 if str(status.st_gid) in groups else 0o002))


def throttled(system: System) -> Finding:
    """The heat limit of the loop's core since the start of the computer, and the temperature now."""
    hot = []
    for zone in system.names("sys/class/thermal/thermal_zone*"):
        temperature = system.number(f"{zone}/temp")
        trips = [
            system.number(f"{zone}/trip_point_{index}_temp")
            for index in range(8)
            if system.text(f"{zone}/trip_point_{index}_type") == "passive"
        ]
        if temperature is not None and any(trip and temperature >= trip for trip in trips):
            hot.append(f"{system.text(f'{zone}/type')} {temperature / 1000:.0f} °C")
    count = system.number(f"{CPU}/cpu{_core(system)}/thermal_throttle/core_throttle_count")
    spent = system.number(f"{CPU}/cpu{_core(system)}/thermal_throttle/core_throttle_total_time_ms")
    remedy = "cool the computer: clean the fan, lower the load, or limit the frequency yourself"
    if hot:
        return warning(f"too hot now: {', '.join(hot)}", remedy)
    count = system.seen(count, f"{CPU}/cpu{_core(system)}/thermal_throttle")
    if count and spent and system.uptime and spent / 1000 > THROTTLED_SHARE * system.uptime:
        return warning(f"throttled {count} times, {spent / 1000:.0f} s since the start of the computer", remedy)
    return ok(f"throttled {count} times since the start of the computer")


def isolation(system: System) -> Finding:
    """Isolated cores carry no other ordinary threads."""
    isolated = cores_of(system.seen(system.text(f"{CPU}/isolated"), f"{CPU}/isolated"))
    if not isolated:
        return note("no core is isolated", "isolcpus=N nohz_full=N rcu_nocbs=N and robot.core: N (docs/realtime.md)")
    if system.core not in isolated:
        listed = system.text(f"{CPU}/isolated")
        core = -1 if system.core is None else system.core
        return warning(f"isolated are {listed}, robot.core is {core}", f"robot.core: {min(isolated)}")
    return ok(f"core {system.core} is isolated")


def siblings(system: System) -> Finding:
    """Two threads of one core share its arithmetic units and caches."""
    shown = system.text(f"{CPU}/cpu{_core(system)}/topology/thread_siblings_list")
    listed = system.seen(shown, f"{CPU}/cpu{_core(system)}/topology")
    others = cores_of(listed) - {_core(system)}
    if not others:
        return ok("the loop's core has no SMT sibling")
    isolated = cores_of(system.text(f"{CPU}/isolated"))
    value = f"core {_core(system)} shares its units with {', '.join(map(str, sorted(others)))}"
    if _core(system) in isolated and not others <= isolated:
        command = f"echo off | sudo tee /{CPU}/smt/control"
        return warning(f"{value}, which is not isolated", "also isolate it, or switch SMT off", command)
    return note(value, "keep it free of work, or switch SMT off") if not system.kind else ok(value)


def quota(system: System) -> Finding:
    """A control group with a quota is stopped for the rest of each period once it is spent."""
    folder = "sys/fs/cgroup"
    limit = system.text(f"{folder}/cpu.max")
    if limit is None or limit.startswith("max"):
        return ok("no quota")
    stopped = [
        line for line in (system.text(f"{folder}/cpu.stat") or "").splitlines() if line.startswith("nr_throttled")
    ]
    if stopped and int(stopped[0].split()[1]) > 0:
        value = f"{limit.replace(' ', ' of ')} µs, stopped {stopped[0].split()[1]} times"
        return warning(value, "set a larger quota (docker run --cpus), or grant SCHED_FIFO, which has no quota")
    return ok(f"{limit.replace(' ', ' of ')} µs, never spent")


CHECKS = (
    Check("core", "the chain is pinned to one core, where a wake-up costs 6 instead of 31 µs", granted),
    Check("governor", "at a lower frequency every step takes longer", governor),
    Check("idle_states", "a sleeping core needs this time before the woken thread runs", idle_states),
    Check("throttling", "a hot core lowers its frequency with any governor", throttled),
    Check("isolated_cores", "the scheduler puts ordinary threads on every other core", isolation),
    Check("smt_siblings", "the other half of the core slows each step down", siblings),
    Check("cpu_quota", "a spent quota stops the nodes for up to a period of 100 ms", quota),
)
