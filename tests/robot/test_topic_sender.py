"""A node sends its last message, whatever its connections do."""

import threading
import time

from robot_control.robot import topic_sender
from robot_control.robot.topic_sender import publish_last

LATE = 0.15  # s that a connection's thread sleeps before it writes


class Connection:
    """As rospy's QueuedConnection of queue_size 1: its thread takes the newest message, and later writes it."""

    def __init__(self, number: int, late: float = 0.0) -> None:
        self.number, self.late = number, late
        self.open = True
        self.written: list[object] = []
        self._queue: list[object] = []
        self._wanted = threading.Condition()
        self.taken = threading.Event()
        threading.Thread(target=self._run, daemon=True).start()

    def put(self, message: object) -> None:
        with self._wanted:
            self._queue = [message]
            self._wanted.notify()

    def _run(self) -> None:
        while True:
            with self._wanted:
                self._wanted.wait_for(lambda: bool(self._queue))
                message = self._queue.pop()
            self.taken.set()
            time.sleep(self.late)
            self.written.append(message)


class FakePublisher:
    """`impl` is itself, and reports the connections as rospy's does."""

    def __init__(self, *connections: Connection) -> None:
        self.connections = connections
        self.impl = self

    def publish(self, message: object) -> None:
        for connection in self.connections:
            connection.put(message)

    def get_stats(self) -> tuple[str, int, list[tuple[int, int, int, bool]]]:
        return "/topic", 0, [(c.number, 0, len(c.written), c.open) for c in self.connections]


def test_waits_until_a_late_thread_has_written_it() -> None:
    connection = Connection(1, LATE)
    assert publish_last(FakePublisher(connection), "zero") == 0
    assert connection.written[-1] == "zero"


def test_does_not_take_a_message_on_its_way_for_the_last() -> None:
    connection = Connection(1, LATE)
    publisher = FakePublisher(connection)
    publisher.publish("forward")
    connection.taken.wait()
    assert publish_last(publisher, "zero") == 0
    assert connection.written[0] == "forward"
    assert connection.written[-1] == "zero"


def test_waits_for_each_connection() -> None:
    quick, slow = Connection(1), Connection(2, LATE)
    assert publish_last(FakePublisher(quick, slow), "zero") == 0
    assert quick.written[-1] == slow.written[-1] == "zero"


def test_counts_those_that_take_nothing_in_time() -> None:
    begin = time.monotonic()
    assert publish_last(FakePublisher(Connection(1, 1e3), Connection(2)), "zero", limit=0.1) == 1
    assert time.monotonic() - begin >= 0.1


def test_does_not_wait_for_a_connection_that_is_closed() -> None:
    connection = Connection(1, 1e3)
    threading.Timer(0.1, lambda: setattr(connection, "open", False)).start()
    begin = time.monotonic()
    assert publish_last(FakePublisher(connection), "zero", limit=1e3) == 0
    assert time.monotonic() - begin >= 0.1


def test_does_not_wait_without_a_subscriber() -> None:
    begin = time.monotonic()
    assert publish_last(FakePublisher(), "zero") == 0
    assert time.monotonic() - begin < topic_sender.LIMIT
