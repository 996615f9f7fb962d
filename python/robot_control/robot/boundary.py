"""The boundary of a program beside the loop: foreign input becomes checked data here, or it is dropped.

Every program of layer 4 subscribes with `subscribe`. A message stays bytes until it is checked: its size, its
deserialization by the type's own code, and that its numbers are finite. Whatever else comes from outside (a message of
a broker or of a page, an order, a file) is taken inside `crossing`. An input that is dropped is counted by its source
and named in the log; the program goes on. An exception that the checks did not foresee first calls what `stops` has
registered. Such an input may have left the program half way through a motion.
"""

import contextlib
import math
import threading
import time
import traceback
from collections import deque
from collections.abc import Callable, Collection, Iterator
from functools import cache
from typing import Any

import genpy
import numpy as np
import rospy

from robot_control.files.files import fit_for_message

MAX_BYTES = 1 << 18
"""of a message; to read and check a path of 3,500 poses, or 10,000 reports of nodes, takes 0.04 s"""
GRID = "nav_msgs/OccupancyGrid"
"""its cells become an array of numpy, which costs no time per cell"""
LONG = {GRID, "robot_control/FollowPathActionGoal"}
MAX_LONG_BYTES = 1 << 26
"""of a message of these types; a map of 8000 by 8000 cells"""
FLOATS = ("float32", "float64")
MAY_BE_INFINITE = {
    *("speed_limit", "range_max", "wanted", "actual", "error", "effort", "load", "slip", "ranges", "intensities"),
    *("odometry_confidence", "value", "voltage", "temperature", "current", "charge", "capacity", "design_capacity"),
    *("percentage", "cell_voltage", "cell_temperature"),
}
"""Fields of any message in which NaN or an infinity has a meaning, such as no limit, no return or not measured"""
POLL_PERIOD = 0.02
"""s between two looks for a message that is waited for"""


class UnfitError(ValueError):
    """A message that cannot be used, with the reason."""


class Boundary:
    """The inputs that one program dropped, by their source; usable from every thread."""

    def __init__(self, say: Callable[[str], None] = rospy.logwarn) -> None:
        self.dropped: dict[str, int] = {}
        """number of inputs by source; a source is a name of this program's own, never one from outside"""
        self._say, self._lock = say, threading.Lock()
        self._stops: list[Callable[[], None]] = []

    def stops(self, stop: Callable[[], None]) -> None:
        """`stop` ends what this program moves; it is called before an unforeseen exception is reported."""
        self._stops.append(stop)

    def drop(self, source: str, why: str) -> None:
        """Counts an input that is not used; the log names the first, second, fourth, eighth … one of a source."""
        with self._lock:
            count = self.dropped[source] = self.dropped.get(source, 0) + 1
        if count & (count - 1) == 0:
            self._say(fit_for_message(f"{source}: an input is ignored ({count} until now): {why}"))

    @contextlib.contextmanager
    def crossing(self, source: str) -> Iterator[None]:
        """The block takes one input of `source`; an exception drops this input."""
        try:
            yield
        except UnfitError as error:
            self.drop(source, str(error))
        except Exception as error:  # all that the checks did not foresee
            for stop in self._stops:
                with contextlib.suppress(Exception):
                    stop()
            place = traceback.extract_tb(error.__traceback__)[-1]
            why = f"{type(error).__name__}: {error} ({place.name}, line {place.lineno}); all motion is stopped"
            self.drop(source, why)


boundary = Boundary()
"""of this program"""


def subscribe(topic: str, kind: type, receive: Callable[[Any], None], **options: Any) -> rospy.Subscriber:
    """A subscriber whose callback gets checked messages of `kind` only.

    Args:
        topic: name; it is the source of what is dropped
        kind: type of the messages; a publisher of another type is refused, as by any subscriber
        receive: called in rospy's thread
        options: as for `rospy.Subscriber`
    """

    def arrive(sealed: Any) -> None:
        with boundary.crossing(topic):
            receive(opened(sealed))

    return rospy.Subscriber(topic, _sealed(kind), arrive, **options)


class Latest:
    """The newest message of a topic, for a program that polls: it is checked when it is read, as most are not."""

    def __init__(
        self, topic: str, kind: type, longest: int = 0, check: Callable[[Any], object] = lambda _: None
    ) -> None:
        """`longest`: bytes of a message, where they may be more than of another one of its type. `check`: raises
        UnfitError.
        """
        self._topic, self._longest, self._check = topic, longest, check
        self._unread: deque[tuple[Any, float]] = deque(maxlen=1)
        self._newest: tuple[Any, float] = None, -math.inf
        self._subscriber = rospy.Subscriber(topic, _sealed(kind), self._receive, queue_size=1, tcp_nodelay=True)

    @property
    def newest(self) -> tuple[Any, float]:
        """The newest message that passed the checks, and when it was received, s, monotonic; None, minus infinity."""
        with contextlib.suppress(IndexError):
            sealed, at = self._unread.popleft()
            with boundary.crossing(self._topic):
                message = opened(sealed, longest=self._longest)
                self._check(message)
                # another thread may have read a newer one meanwhile
                self._newest = max(self._newest, (message, at), key=lambda each: each[1])
        return self._newest

    @property
    def message(self) -> Any:
        """That message; None without one."""
        return self.newest[0]

    def age(self, now: float) -> float | None:
        """s since that message was received; None without one."""
        message, at = self.newest
        return None if message is None else round(now - at, 2)

    def fresh(self, now: float, silence: float) -> Any:
        """That message if it was received less than `silence` s ago; else None."""
        message, at = self.newest
        return message if now - at < silence else None

    def end(self) -> None:
        """Ends the subscription."""
        self._subscriber.unregister()

    def _receive(self, sealed: Any) -> None:
        self._unread.append((sealed, time.monotonic()))


def next_message(topic: str, kind: type, patience: float, longest: int = 0) -> Any:
    """The next message, or the last one if the topic is latched; None if none came within `patience` s. `longest`: as
    of Latest.
    """
    latest, end = Latest(topic, kind, longest), time.monotonic() + patience
    while latest.message is None and time.monotonic() < end and not rospy.is_shutdown():
        time.sleep(POLL_PERIOD)
    latest.end()
    return latest.message


@cache
def _sealed(kind: type) -> type:
    """The type as it is on the wire, whose messages stay bytes. rospy has one type per topic and process."""
    own = {name: getattr(kind, name) for name in ("_type", "_md5sum", "_has_header", "_full_text")}
    return type(f"Sealed{kind.__name__}", (rospy.AnyMsg,), {**own, "__slots__": [], "_slot_types": [], "kind": kind})


UNREADABLE = (
    *(genpy.DeserializationError, UnicodeError, ValueError, TypeError, MemoryError, OverflowError),
    AttributeError,  # of _Parts
)
"""what genpy raises for bytes that are no message of a type"""


class _Parts:
    """The bytes of a message for genpy, which slices them: a long slice is a view, for a copy costs a page fault per
    4 KB. A text that long raises AttributeError, because a view cannot be decoded.
    """

    def __init__(self, data: bytes) -> None:
        self._data = data

    def __getitem__(self, part: slice) -> bytes | memoryview:
        view = memoryview(self._data)[part]
        return view if len(view) > MAX_BYTES else bytes(view)


def opened(sealed: Any, not_finite: Collection[str] = (), longest: int = 0) -> Any:
    """The checked message of the bytes, at most `longest` or, if that is 0, MAX_BYTES. Raises UnfitError."""
    data: bytes = sealed._buff  # all that AnyMsg has
    bound = longest or (MAX_LONG_BYTES if sealed.kind._type in LONG else MAX_BYTES)
    if len(data) > bound:
        raise UnfitError(f"has {len(data)} bytes, more than {bound}")
    try:
        message = sealed.kind()
        message.deserialize_numpy(_Parts(data), np) if sealed.kind._type == GRID else message.deserialize(data)
    except UNREADABLE as error:
        raise UnfitError(f"is no {sealed.kind._type}: {str(error)[:100]}") from None
    require_fit(message, MAY_BE_INFINITE.union(not_finite) if not_finite else MAY_BE_INFINITE)
    with contextlib.suppress(AttributeError):
        message._connection_header = sealed._connection_header
    return message


def unsealed(kind: type, not_finite: Collection[str] = ()) -> type:
    """The type for actionlib, which subscribes by itself. A message that is not fit arrives empty, for rospy would keep
    it, and read it again with every later one.
    """

    def deserialize(self: Any, data: bytes) -> Any:
        sealed = _sealed(kind)().deserialize(data)
        with boundary.crossing(kind._type):  # type: ignore[attr-defined]
            message = opened(sealed, not_finite)
            for name in kind.__slots__:  # type: ignore[attr-defined]
                setattr(self, name, getattr(message, name))
        return self

    return type(kind.__name__, (kind,), {"__slots__": kind.__slots__, "deserialize": deserialize})  # type: ignore[attr-defined]


def guard_action(name: str, **kinds: type) -> None:
    """The topics of an action arrive as these types, by their last names, at the client or server that is made after
    this. A process may subscribe to one topic with several types; rospy takes the first. A latched message is lost.
    """
    for topic, kind in kinds.items():
        rospy.Subscriber(f"{rospy.remap_name(name)}/{topic}", kind, None)


@cache
def _checked(names: tuple[str, ...], kinds: tuple[str, ...]) -> tuple[tuple[str, str, bool], ...]:
    """Those of these fields that may be unfit: name, type of its elements, whether it is an array."""
    fields = ((name, *of.partition("[")) for name, of in zip(names, kinds, strict=True))
    return tuple(
        (name, element, bool(bracket))
        for name, element, bracket, _ in fields
        if element in (*FLOATS, "string") or "/" in element
    )


def require_fit(message: Any, may_be_infinite: Collection[str] = (), path: str = "") -> None:
    """Raises UnfitError, with the field, where a number of a message is NaN or infinite, or a text has a zero byte."""
    for name, element, is_array in _checked(tuple(message.__slots__), tuple(message._slot_types)):
        value = getattr(message, name)
        if element == "string":
            if "\0" in ("".join(value) if is_array else value):
                raise UnfitError(f"{path}{name} must not contain a zero byte")
        elif name in may_be_infinite:
            continue
        elif element in FLOATS:
            if not (all(map(math.isfinite, value)) if is_array else math.isfinite(value)):
                raise UnfitError(f"{path}{name} must be finite")
        else:
            for each in value if is_array else (value,):
                require_fit(each, may_be_infinite, f"{path}{name}.")
