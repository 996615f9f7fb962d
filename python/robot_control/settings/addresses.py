"""The address on which the console listens, and the origins from which it takes requests. Pure."""

import ipaddress
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlsplit

PUBLISHED = "ROBOT_CONTROL_PUBLISHED_ON_LOOPBACK"
"""Set to 1 by the Dockerfile alone: only the loopback of the host reaches the container's ports"""


class AddressError(ValueError):
    """The console would be reachable without protection. The message says what is missing."""


@dataclass(frozen=True)
class Origins:
    """The origins (scheme://host:port) from which requests are taken."""

    own: frozenset[str]

    def host_is_own(self, host: str | None) -> bool:
        """False for another name that a foreign DNS server lets point here."""
        return host is not None and any(urlsplit(origin).netloc == host.lower() for origin in self.own)

    def origin_is_own(self, origin: str | None, host: str | None) -> bool:
        """True for a request that a page of this console has sent, to the name from which it came."""
        return origin in self.own and urlsplit(origin).netloc == (host or "").lower()


def is_loopback(address: str) -> bool:
    """True for 127.0.0.0/8, ::1 and localhost."""
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return address == "localhost"


def bracketed(address: str) -> str:
    """The address as a URL holds it."""
    return f"[{address}]" if ":" in address else address


def interface_of(address: str, environment: Mapping[str, str]) -> str:
    """The address to bind for the console's `address`: that one, or in the image all of the container for a loopback.

    A published port arrives at an interface of the container that is not its loopback. Origins stay those of `address`.
    """
    return "0.0.0.0" if environment.get(PUBLISHED) == "1" and is_loopback(address) else address  # noqa: S104


def require_protection(address: str, *, users: bool, tls: bool) -> None:
    """Raises AddressError for an address that others reach, without users or TLS."""
    missing = [word for word, there in (("users (console_users.py add)", users), ("TLS (--tls)", tls)) if not there]
    if missing and not is_loopback(address):
        what = f"--address {address}: other computers can reach it, so it needs {' and '.join(missing)}"
        raise AddressError(f"{what}; or remove --address, and use ssh -L")


def origins_of(address: str, port: int, names: list[str], *, tls: bool, further: list[str]) -> Origins:
    """`names`: of this machine; `further`: whole origins, for instance of a reverse proxy. Raises AddressError."""
    scheme, standard = ("https", ":443") if tls else ("http", ":80")
    hosts = ["127.0.0.1", "localhost", "[::1]"] if is_loopback(address) else [bracketed(address), *names]
    for origin in further:
        parts = urlsplit(origin)
        if parts.scheme not in {"http", "https"} or not parts.netloc or f"{parts.scheme}://{parts.netloc}" != origin:
            raise AddressError(f"--origin {origin}: must be as https://console.example or http://robot:8080")
    own = [f"{scheme}://{host}:{port}".removesuffix(standard) for host in hosts]
    return Origins(frozenset(origin.lower() for origin in [*own, *further]))
