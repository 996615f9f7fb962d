"""console.py: its command line, and the loop that HTTP and ROS share."""

import argparse
import asyncio
import contextlib
import logging
import logging.handlers
import os
import resource
import socket
import ssl
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import rospy
from aiohttp import web

from robot_control.data.run_log import LogError
from robot_control.files.files import fit_for_message, given_path, in_words
from robot_control.installed_files import share_file
from robot_control.robot.boundary import boundary
from robot_control.robot.ros_node import running_node
from robot_control.robot.topic_sender import Signals
from robot_control.settings.addresses import (
    AddressError,
    Origins,
    bracketed,
    interface_of,
    origins_of,
    require_protection,
)
from robot_control.settings.files import SettingsError
from robot_control.watch.console.backend import Backend
from robot_control.watch.console.client import FRAME
from robot_control.watch.console.replay.replay import Replay
from robot_control.watch.console.server import Server
from robot_control.watch.console.settings import Settings, read_settings
from robot_control.watch.console.tls import TlsError, context_of, fingerprint, self_made
from robot_control.watch.console.users import FOLDER, Users, UsersError

PASS = 0.02
"""s between two passes"""
CHECK = 100
"""Frames between two checks of the file of users"""
HANDSHAKE, KEPT = 10.0, 15.0
"""s that a TLS handshake may take; s for which an idle connection stays open"""
JOURNAL, JOURNAL_SIZE, JOURNALS_KEPT = "console.log", 1_000_000, 5
"""Name of the file, its size in bytes, and the number of older ones that are kept"""


@dataclass(frozen=True)
class Setup:
    """The meaning of the command line."""

    settings: Settings
    users: Users | None
    origins: Origins
    context: ssl.SSLContext | None


def arguments(given: list[str]) -> argparse.Namespace:
    """The command line, without the program's name; ends the program on a wrong one."""
    parser = argparse.ArgumentParser(
        prog="console.py",
        description="A page in the browser that shows and drives the robot. Commands go to console_vel where the robot "
        "has a list of command sources, else to cmd_vel_stamped. Users: console_users.py.",
        epilog="Another robot's: __ns:=robot2 and a --port of its own. docs/console.md explains it.",
    )
    add = parser.add_argument
    add("--address", default="127.0.0.1", help="to listen on; another one than the loopback needs users and TLS")
    add("--port", type=int, default=8080)
    add("--tls", action="store_true", help="HTTPS, with a certificate of its own where none is given")
    add("--cert", type=given_path, help="certificate, PEM; implies --tls")
    add("--key", type=given_path, help="its key, PEM; default: it is in the same file")
    add("--origin", action="append", default=[], help="further address of the page, as https://console.example")
    add("--config", type=given_path, help="YAML, overrides config/console.yaml")
    add("--runs", type=given_path, default=FOLDER, help="folder of recorded runs (default %(default)s)")
    add("--bag", type=given_path, help="run.bag to play instead of a robot; nothing can be commanded")
    add("--read-only", action="store_true", help="only the emergency stop works")
    return parser.parse_args(given)


def setup_of(given: argparse.Namespace) -> Setup:
    """Raises AddressError, SettingsError, TlsError, UsersError or OSError if the console must not start."""
    overlay = [given.config] if given.config else []
    settings = read_settings(Path(share_file("config/console.yaml")), *overlay)
    users, context = Users(), None
    has_users, tls = not given.bag and bool(users.all()), bool(given.tls or given.cert)
    require_protection(given.address, users=has_users, tls=tls)
    if tls:
        names = ["localhost", "127.0.0.1", socket.gethostname(), given.address]
        certificate, key = (given.cert, given.key or given.cert) if given.cert else self_made(FOLDER, names)
        context = context_of(certificate, key)
        print(f"fingerprint of the certificate (SHA-256): {fingerprint(certificate)}")
    origins = origins_of(given.address, given.port, [socket.gethostname()], tls=tls, further=given.origin)
    return Setup(settings, users if has_users else None, origins, context)


def open_journal(path: Path) -> None:
    """Opens the record of logins and commands, which this account alone may read and which is rotated by size."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch(mode=0o600, exist_ok=True)
    handler = logging.handlers.RotatingFileHandler(
        path, maxBytes=JOURNAL_SIZE, backupCount=JOURNALS_KEPT, encoding="utf-8"
    )
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    journal = logging.getLogger("console")
    journal.addHandler(handler)
    journal.setLevel(logging.INFO)
    journal.propagate = False


async def serve(given: argparse.Namespace, setup: Setup, signals: Signals) -> None:
    """Serves until a signal arrives."""
    backend = Replay(given.bag, setup.settings) if given.bag else Backend(setup.settings)
    server = Server(backend, setup.origins, setup.users, given.runs, port=given.port, read_only=given.read_only)
    runner = web.AppRunner(server.app, access_log=None, keepalive_timeout=KEPT, handle_signals=False)
    await runner.setup()
    handler = runner.server
    assert handler is not None  # noqa: S101 (after setup)
    listening = await asyncio.get_running_loop().create_server(
        handler,
        interface_of(given.address, os.environ),
        given.port,
        ssl=setup.context,
        ssl_handshake_timeout=HANDSHAKE if setup.context else None,
        reuse_address=True,
    )
    secret = "" if setup.users else f"?token={server.sessions.token}"
    print(f"open {'https' if setup.context else 'http'}://{bracketed(given.address)}:{given.port}/{secret}")
    frames = asyncio.create_task(_frames(server, backend))
    while signals.going_on():
        with boundary.crossing("the console"):
            backend.step()
        with boundary.crossing("the pages"):
            server.pass_on()
            server.pending.check(handler.connections, time.monotonic())
        await asyncio.sleep(PASS)
    frames.cancel()
    server.close()
    listening.close()
    await asyncio.sleep(2 * FRAME)  # the pages receive the reason
    with contextlib.suppress(asyncio.TimeoutError):
        await asyncio.wait_for(runner.cleanup(), 2.0)


async def _frames(server: Server, backend: Backend | Replay) -> None:
    while True:
        with boundary.crossing("the frames of the pages"):
            server.frames.make(backend)
            if server.frames.number % CHECK == 0:
                server.check_users()
        await asyncio.sleep(FRAME)


def main() -> int:
    """Entry point of scripts/console.py."""
    given = arguments(rospy.myargv()[1:])
    try:
        setup = setup_of(given)
        open_journal(FOLDER / JOURNAL)
    except (AddressError, SettingsError, TlsError, UsersError, OSError) as error:
        print(f"console.py: {fit_for_message(in_words(error))}", file=sys.stderr)
        return 2
    hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, 65536) if hard > 0 else 65536, hard))
    with contextlib.nullcontext(Signals()) if given.bag else running_node("console") as signals:
        try:
            asyncio.run(serve(given, setup, signals))
        except LogError as error:
            print(f"console.py: {error}", file=sys.stderr)
            return 2
        except OSError as error:  # the port is in use, or the address is not this machine's
            print(f"console.py: {given.address}:{given.port}: {error.strerror or error}", file=sys.stderr)
            return 2
    return 0
