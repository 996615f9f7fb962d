"""Checks the address of a Dask scheduler."""

from __future__ import annotations

from urllib.parse import urlsplit

from robot_control.settings.addresses import is_loopback


def check_address(address: str, *, insecure: bool) -> None:
    """Accepts tls://HOST:PORT, and tcp://HOST:PORT on the loopback or if `insecure` allows it.

    Raises:
        ValueError: any other address.
    """
    parts = urlsplit(address)
    if parts.scheme not in ("tls", "tcp") or not parts.hostname:
        raise ValueError(f"{address} is no address of a scheduler: tls://HOST:8786")
    if parts.scheme == "tls" or insecure or is_loopback(parts.hostname):
        return
    raise ValueError(
        f"{address} is plain text: anyone who reaches that port can run programs as the users of all workers. "
        "Use tls://, or --insecure in a network that you trust"
    )
