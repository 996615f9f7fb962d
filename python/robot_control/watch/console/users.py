"""The file of users: names, roles, and scrypt hashes of passwords and of links for the first login.

The file has mode 0600. A file that others may read, or that belongs to another account, is refused. A link works once,
within a day. No file holds the text of a link or a password.
"""

import hashlib
import hmac
import json
import os
import re
import secrets
import stat
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from robot_control.data.black_box import LOGS
from robot_control.files.files import NewFiles, given_path, printable
from robot_control.watch.console.authority import Role
from robot_control.watch.console.sessions import digest

FOLDER = given_path(str(LOGS))
"""The folder of the console's own files."""
FILE = FOLDER / "console_users.json"
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,31}")
LINK_LIFE = 24 * 3600.0
"""s"""
MIN_PASSWORD, MAX_PASSWORD = 10, 256
"""characters"""
SCRYPT = {"n": 1 << 14, "r": 8, "p": 1, "maxmem": 64 << 20}
"""RFC 7914; each try takes 16 MiB and about 50 ms"""


class UsersError(ValueError):
    """The file, a name, a password or a link cannot be used; the message says why."""


@dataclass(frozen=True)
class User:
    """One entry."""

    name: str
    role: Role
    salt: str = ""  # hexadecimal, of the password; empty: there is none yet
    password: str = ""  # its hash, hexadecimal
    link: str = ""  # hash of the link, hexadecimal
    link_ends: float = 0.0  # s, time of day


class Users:
    """The users of a file, which is read again for each call and written as a whole."""

    def __init__(self, path: Path = FILE) -> None:
        self.path = path

    def all(self) -> dict[str, User]:
        """By name. Raises UsersError, OSError."""
        if not self.path.exists():
            return {}
        status = self.path.stat()
        if status.st_uid != os.getuid() or status.st_mode & (stat.S_IRWXG | stat.S_IRWXO):
            raise UsersError(f"{self.path}: must be readable only for this account: chmod 600 {self.path}")
        try:
            rows = json.loads(self.path.read_text(encoding="utf-8"))
            users = [_checked(User(**{**row, "role": Role[row["role"].upper()]})) for row in rows]
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
            why = f"{self.path}: is not a file of console_users.py; remove it and add the users again"
            raise UsersError(why) from None
        return {user.name: user for user in users}

    def add(self, name: str, role: Role, now: float) -> str:
        """Adds a user, or gives an old one this role; the text of a link with which a password is set."""
        if not NAME.fullmatch(name):
            raise UsersError(f"{printable(name)}: a name has 1 to 32 letters, digits, dots, hyphens and underscores")
        users, link = self.all(), secrets.token_urlsafe(24)
        old = users.get(name, User(name, role))
        self._write(users | {name: replace(old, role=role, link=digest(link), link_ends=now + LINK_LIFE)})
        return link

    def remove(self, name: str) -> None:
        """Removes a user. Raises UsersError."""
        users = self.all()
        if users.pop(name, None) is None:
            raise UsersError(f"{printable(name)}: there is no such user in {self.path}")
        self._write(users)

    def check(self, name: str, password: str) -> User:
        """The user; takes as long for a name that is unknown. Raises UsersError: name or password is wrong."""
        user = self.all().get(name, User("", Role.WATCH))
        right = hmac.compare_digest(_hash(password, user.salt), user.password)
        if not (right and user.password):
            raise UsersError("name or password is wrong")
        return user

    def set_password(self, link: str, password: str, now: float) -> User:
        """Sets the password of the user to whom the link belongs, and ends the link. Raises UsersError."""
        if not MIN_PASSWORD <= len(password) <= MAX_PASSWORD:
            raise UsersError(f"a password has {MIN_PASSWORD} to {MAX_PASSWORD} characters")
        users = self.all()
        found = [each for each in users.values() if each.link and hmac.compare_digest(each.link, digest(link))]
        if not found or now >= found[0].link_ends:
            raise UsersError("this link is wrong, used, or older than a day: request another one")
        salt = secrets.token_hex(16)
        user = replace(found[0], salt=salt, password=_hash(password, salt), link="", link_ends=0.0)
        self._write(users | {user.name: user})
        return user

    def _write(self, users: dict[str, User]) -> None:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        rows = [{**asdict(user), "role": str(user.role)} for user in users.values()]
        with NewFiles() as files:
            partial = files.name(self.path)
            partial.touch(mode=0o600)
            partial.chmod(0o600)
            partial.write_text(json.dumps(rows, indent=1), encoding="utf-8")


def _checked(user: User) -> User:
    """Raises ValueError or TypeError for an entry that this module has not written."""
    for text in (user.salt, user.password, user.link):
        bytes.fromhex(text)
    if not NAME.fullmatch(user.name) or float(user.link_ends) < 0:
        raise ValueError
    return user


def _hash(password: str, salt: str) -> str:
    return hashlib.scrypt(password.encode(errors="replace"), salt=bytes.fromhex(salt or "00" * 16), **SCRYPT).hex()
