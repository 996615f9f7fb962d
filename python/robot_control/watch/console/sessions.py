"""Logins, and the limits of their tries. It reads no clock: time is an argument, s of the time of day."""

import contextlib
import hashlib
import secrets
from collections.abc import Mapping
from dataclasses import dataclass

from robot_control.watch.console.authority import Role

LIFE = 12 * 3600.0
"""s from a login until it ends"""
TRIES_OF_USER, TRIES_OF_ADDRESS, PERIOD = 5, 20, 300.0
"""logins within PERIOD s that failed or are not decided yet, after which further ones are refused"""
MAX_SESSIONS = 20
"""of one user"""


@dataclass
class Session:
    """One login."""

    key: str  # digest of the cookie
    user: str
    role: Role
    ends: float


class Sessions:
    """All logins, by the digests of their cookies, and the token of a console without users."""

    def __init__(self) -> None:
        self.token = secrets.token_urlsafe(24)
        self._sessions: dict[str, Session] = {}  # by key, the oldest first

    def begin(self, user: str, role: Role, now: float, kept: Session | None = None) -> str:
        """Begins a session; the text of its cookie. One too many ends the user's own oldest one, but not `kept`."""
        cookie = secrets.token_urlsafe(32)
        own = [each for each in self._sessions.values() if each.user == user and each is not kept]
        for each in own[: max(0, len(own) + 1 - MAX_SESSIONS)]:
            self.end(each)
        session = Session(digest(cookie), user, role, now + LIFE)
        self._sessions[session.key] = session
        return cookie

    def of(self, cookie: str | None, now: float) -> Session | None:
        """The session of a cookie; None if it has ended, or is none."""
        session = self._sessions.get(digest(cookie)) if cookie else None
        return session if session is not None and self.lives(session, now) else None

    def lives(self, session: Session, now: float) -> bool:
        """False after a logout, and after its time."""
        return self._sessions.get(session.key) is session and now < session.ends

    def end(self, session: Session) -> None:
        """Ends a session."""
        self._sessions.pop(session.key, None)

    def check_roles(self, roles: Mapping[str, Role]) -> None:
        """Ends the sessions of users that are gone or have another role now."""
        kept = {key: each for key, each in self._sessions.items() if roles.get(each.user) is each.role}
        self._sessions = kept


class Tries:
    """Tries to log in, by user and by address. A try counts from its admission, until it has succeeded."""

    def __init__(self) -> None:
        self._times: dict[tuple[str, str], list[float]] = {}

    def admit(self, user: str, address: str, now: float) -> float:
        """Counts a try and returns zero; s until the next one is admitted if this one is not."""
        self._times = {key: times for key, times in self._times.items() if times and now - times[-1] < PERIOD}
        keys = (("user", user), ("address", address))
        for key, bound in zip(keys, (TRIES_OF_USER, TRIES_OF_ADDRESS), strict=True):
            lately = [at for at in self._times.get(key, []) if now - at < PERIOD]
            if len(lately) >= bound:
                return lately[-bound] + PERIOD - now
        for key in keys:
            self._times[key] = [*self._times.get(key, [])[-TRIES_OF_ADDRESS:], now]
        return 0.0

    def succeed(self, user: str, address: str, admitted: float) -> None:
        """Takes back the try that was admitted at this time."""
        for key in (("user", user), ("address", address)):
            with contextlib.suppress(KeyError, ValueError):  # it may have expired meanwhile
                self._times[key].remove(admitted)


def digest(secret: str) -> str:
    """The part of a cookie or a link that is kept."""
    return hashlib.sha256(secret.encode(errors="replace")).hexdigest()
