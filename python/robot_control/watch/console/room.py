"""Which page gives way to a new one where there is no room: a user's pages cost that user's own first. Pure."""

from collections import Counter
from collections.abc import Sequence

from robot_control.watch.console.authority import Role
from robot_control.watch.console.client import Client


def gives_way(pages: Sequence[Client], user: str, role: Role) -> Client | None:
    """The page whose place a new one of this user takes; None if the new one is refused.

    It is the user's own oldest one, else the oldest of the user who holds most. Such a user has a lower role, or the
    same role and several pages.

    Args:
        pages: those whose places may be taken, the oldest first
        user: of the new one
        role: of that user
    """
    own = [each for each in pages if each.user == user]
    counts = Counter(each.user for each in pages)
    others = [each for each in pages if each.role < role or (each.role == role and counts[each.user] > 1)]
    return max(own or others, key=lambda each: counts[each.user], default=None)
