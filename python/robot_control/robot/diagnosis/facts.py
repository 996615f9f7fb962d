"""Messages of ROS → what why.py judges; pure but for the message types."""

from collections.abc import Iterable, Sequence

from robot_control.loop.roles import DRIVER, ESTIMATOR, HARDWARE_DRIVER, MONITOR
from robot_control.msg import SafetyStatus
from robot_control.robot.boundary import UnfitError
from robot_control.robot.diagnosis.state import Cause, Safety


def safety_of(status: SafetyStatus, held: float, age: float) -> Safety:
    """The content of a message; `held` s in its state, `age` s since it was received.

    Raises:
        UnfitError: the causes and what belongs to them are not equally many.
    """
    columns = (status.causes, status.sentences, status.remedies_before_reset, status.actors, status.details)
    if len({len(column) for column in columns}) > 1:
        raise UnfitError("has lists of causes, sentences, remedies, actors and details of different lengths")
    causes = tuple(
        Cause(name, sentence, remedy, actor, detail, name == status.first_cause, name in status.active)
        for name, sentence, remedy, actor, detail in zip(*columns, strict=True)
    )
    texts = tuple(status.warning_sentences), status.speed_limit, tuple(status.missing), tuple(status.reset_refusal)
    return Safety(status.state_name, status.permit_name, held, age, causes, *texts, status.awaiting_zero_request)


def below(namespace: str, name: str) -> str:
    """The last word: "/robot2/x" below "/robot2" → "x"; empty where it lies elsewhere, or deeper."""
    rest = name.removeprefix(namespace.rstrip("/") + "/") if name.startswith(namespace.rstrip("/") + "/") else ""
    return "" if "/" in rest else rest


def other_robots(namespace: str, names: Iterable[str]) -> tuple[str, ...]:
    """Other namespaces in which a node of the loop reports; `names` are absolute."""
    loop = {DRIVER, HARDWARE_DRIVER, ESTIMATOR, MONITOR}  # on robots of every kind
    found = {name.rpartition("/")[0] or "/" for name in names if name.rpartition("/")[2] in loop}
    return tuple(sorted(found - {namespace.rstrip("/") or "/"}))


def nodes_of(state: Sequence[Sequence[tuple[str, Sequence[str]]]]) -> set[str]:
    """Every node that the master knows: publishers, subscribers, servers."""
    return {node for part in state for _, nodes in part for node in nodes}
