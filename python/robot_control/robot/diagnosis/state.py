"""The known state of a robot, on which the answer of why.py depends; no ROS in here."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from robot_control.loop.roles import HARDWARE_DRIVER, Kind

SILENCE = 3.0
"""s; every node reports once per second: after three it is absent, or hangs."""


SHOWN = 0.005
"""m/s to the left; slower is not named"""

Speeds = tuple[float, float] | tuple[float, float, float]
"""m/s, rad/s; of a robot on legs also m/s to the left"""


@dataclass(frozen=True)
class Cause:
    """A cause that stopped the robot."""

    name: str
    sentence: str
    remedy: str = ""  # action before the reset
    actor: str = ""  # operator, integrator, technician
    detail: str = ""  # measured value and limit
    first: bool = False  # true if it came first
    active: bool = False  # true if it still holds


@dataclass(frozen=True)
class Safety:
    """The last message of safety_monitor."""

    state: str  # INIT, READY, DRIVE, STOPPING, STOPPED, FAULT
    permit: str  # brake, ramp, drive
    held: float = 0.0  # s in this state
    age: float = 0.0  # s since it was received
    causes: tuple[Cause, ...] = ()
    warnings: tuple[str, ...] = ()
    speed_limit: float = float("inf")  # m/s
    missing: tuple[str, ...] = ()  # missing nodes, or their missing data
    refusal: tuple[str, ...] = ()  # reasons why the last reset was refused
    awaiting_zero: bool = False  # INIT ends with a zero request, or with silence of its senders


@dataclass(frozen=True)
class Report:
    """A node's entry on /diagnostics."""

    message: str = ""
    values: Mapping[str, str] = field(default_factory=dict)
    age: float = 0.0  # s since it was received

    def reasons(self, whose: str) -> dict[str, str]:
        """Name → sentence of the values "whose: name"."""
        start = f"{whose}: "
        return {key.removeprefix(start): text for key, text in self.values.items() if key.startswith(start)}


@dataclass(frozen=True)
class Facts:
    """All facts on which the answer depends."""

    master: str  # URI
    master_answers: bool = True
    namespace: str = "/"
    refused: str = ""  # why the last start was refused, in lines
    kind: Kind = field(default_factory=Kind)
    safety: Safety | None = None
    reports: Mapping[str, Report] = field(default_factory=dict)  # by node, below the namespace
    registered: frozenset[str] = frozenset()  # nodes that the master knows, below the namespace
    elsewhere: tuple[str, ...] = ()  # namespaces of other robots
    senders: tuple[str, ...] = ()  # on the topics of requests
    clearance_senders: tuple[str, ...] = ()  # on clearance
    limited: Speeds | None = None  # the command after limits
    measured: Speeds | None = None  # by odometry
    command_timeout: float = 0.0  # s, cmd_vel_timeout of the running controller; 0: off, or not known
    load: str = ""  # of the robot's machine, in words, where it is this one
    busy: bool = False  # true if more programs want to run there than it has cores

    @property
    def driver(self) -> str:
        """The node of the driver: that of real machines if it is there, else the one that the robot's kind names."""
        here = HARDWARE_DRIVER in self.registered or self.there(HARDWARE_DRIVER)
        return HARDWARE_DRIVER if here else self.kind.driver

    @property
    def controller(self) -> str:
        """The node of the controller."""
        return self.kind.controller

    @property
    def loop(self) -> tuple[str, ...]:
        """The nodes of the loop."""
        return (self.driver, *self.kind.loop[1:])

    def there(self, node: str) -> bool:
        """True if the last report of the node is recent."""
        report = self.reports.get(node)
        return report is not None and report.age < SILENCE

    def received(self) -> Safety | None:
        """The last status of the monitor, unless it is too old to count."""
        fresh = self.safety is not None and self.safety.age < SILENCE
        return self.safety if fresh else None

    @property
    def forgotten(self) -> bool:
        """True if the monitor reports, and the master, which was started again, does not know it."""
        return self.master_answers and self.received() is not None and self.kind.monitor not in self.registered

    @property
    def speed_limit(self) -> float:
        """m/s, of the last status that counts."""
        safety = self.received()
        return float("inf") if safety is None else safety.speed_limit

    def value(self, node: str, key: str) -> str:
        """A value of a node that reports; else empty."""
        return self.reports[node].values.get(key, "") if self.there(node) else ""

    def reasons(self, node: str, whose: str) -> dict[str, str]:
        """The reasons of a node that reports, by name; else empty."""
        return self.reports[node].reasons(whose) if self.there(node) else {}

    def remedies(self, node: str, whose: str) -> dict[str, str]:
        """Name of a reason → its remedy, for those that have one."""
        return self.reasons(node, f"{whose} remedy")

    def commanders(self) -> tuple[str, ...]:
        """Nodes that send commands, as the controller reports; without it, those that are registered."""
        reported = self.value(self.controller, "senders")
        return tuple(reported.split(", ")) if reported else self.senders

    def sources(self) -> dict[str, str]:
        """The state of each command source, by priority; empty if the robot has no list of them."""
        text = self.value(self.controller, "sources")
        parts = [part.partition(": ") for part in text.split(", ")]
        return {name: state for name, colon, state in parts if colon}

    def path(self, name: str) -> str:
        """The absolute name of a topic or service."""
        return f"{self.namespace.rstrip('/')}/{name}"


def speeds(values: Speeds) -> str:
    """All of them with their units; the one to the left where it is not zero."""
    sideways = f"{values[2]:.2f} m/s to the left, " if len(values) > 2 and abs(values[2]) >= SHOWN else ""
    return f"{values[0]:.2f} m/s, {sideways}{values[1]:.2f} rad/s"
