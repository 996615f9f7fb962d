"""Logins, and the limits of failed ones. It reads no clock: time is an argument, s of the time of day."""

from __future__ import annotations

import hashlib
import json
import secrets
from collections.abc import Mapping
from dataclasses import asdict, dataclass

from robot_control.console.authority import Role

LIFE = 12 * 3600.0
"""s from a login until it ends"""
TRIES_OF_USER, TRIES_OF_ADDRESS, PERIOD = 5, 20, 300.0
"""failed logins within PERIOD s, after which further ones are refused"""
MAX_SESSIONS = 200


@dataclass
class Session:
    """One login."""

    key: str  # digest of the cookie
    user: str
    role: Role
    ends: float


class Sessions:
    """All logins, by the digests of their cookies, and the token of a console without users."""

    def __init__(self, saved: str = "") -> None:
        """`saved`: what the process before this one has saved."""
        self.token, rows = json.loads(saved) if saved else (secrets.token_urlsafe(24), [])
        self._sessions = {row["key"]: Session(**{**row, "role": Role(row["role"])}) for row in rows}

    def begin(self, user: str, role: Role, now: float) -> str:
        """Begins a session; the text of its cookie."""
        cookie = secrets.token_urlsafe(32)
        while len(self._sessions) >= MAX_SESSIONS:
            self._sessions.pop(next(iter(self._sessions)))
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

    def save(self) -> str:
        """The token and the logins, for a process that replaces this one. No cookie is in it."""
        return json.dumps([self.token, [asdict(session) for session in self._sessions.values()]])


class Tries:
    """Failed logins, by user and by address."""

    def __init__(self) -> None:
        self._failed: dict[tuple[str, str], list[float]] = {}

    def wait(self, user: str, address: str, now: float) -> float:
        """s until the next try is admitted; zero if it is admitted now."""
        return max(self._wait("user", user, TRIES_OF_USER, now), self._wait("address", address, TRIES_OF_ADDRESS, now))

    def fail(self, user: str, address: str, now: float) -> None:
        """Notes a failed try."""
        self._failed = {key: times for key, times in self._failed.items() if now - times[-1] < PERIOD}
        for key in (("user", user), ("address", address)):
            self._failed[key] = [*self._failed.get(key, [])[-TRIES_OF_ADDRESS:], now]

    def _wait(self, kind: str, name: str, bound: int, now: float) -> float:
        lately = [at for at in self._failed.get((kind, name), []) if now - at < PERIOD]
        return lately[-bound] + PERIOD - now if len(lately) >= bound else 0.0


def digest(secret: str) -> str:
    """The part of a cookie or a link that is kept."""
    return hashlib.sha256(secret.encode(errors="replace")).hexdigest()
