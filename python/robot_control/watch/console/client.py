"""One page's WebSocket: what it sends, and what it is sent. A page that reads slowly is skipped, not buffered."""

import asyncio
import json
import logging
import secrets
import time
from collections import deque
from typing import Any

from aiohttp import WSMsgType, web

from robot_control.files.files import escaped
from robot_control.robot.boundary import boundary
from robot_control.robot.command import Command
from robot_control.robot.robot_kind import running_kind
from robot_control.watch.console.authority import Page, RefusedError
from robot_control.watch.console.backend import Backend
from robot_control.watch.console.calls import RESET_WINDOW, against, check_call
from robot_control.watch.console.dead_man import Drive
from robot_control.watch.console.messages import MAX_SIZE, MessageError, Rate, parse
from robot_control.watch.console.replay.replay import REFUSAL, Replay
from robot_control.watch.console.sessions import Session, Sessions

FRAME, SLOW = 0.05, 5
"""s between two frames; number of frames between two states"""
PING_PERIOD, WATCHER_PERIOD = 0.1, 0.5
"""s between two pings of the page that commands, and of others"""
SKIP, LOST = 2.0, 15.0
"""s without the answer to a ping, after which frames are skipped; after which the connection is ended"""
CLOSING = 2.0
"""s within which a page receives the reason why it is closed"""
GOING_AWAY, POLICY_VIOLATION, LOGIN_ENDED, GIVES_WAY = 1001, 1008, 4401, 4409
"""Codes with which a page is closed (RFC 6455, 7.4)"""
MAX_MISTAKES, MAX_ANSWERS = 20, 64
MAX_CALLS = 3
"""calls of one page at the same time"""
LOGGED = {"take", "hand_over", "give_back", "heartbeat"}
journal = logging.getLogger("console")


class Frames:
    """The newest frame and state as text, made once for all pages."""

    def __init__(self) -> None:
        self.fast = self.slow = ""
        self.number = self.slow_number = 0
        self.writers: set[asyncio.Event] = set()  # of the pages; set whenever there is something to send

    def make(self, backend: Backend | Replay) -> None:
        """Makes the next frame."""
        self.fast = json.dumps(backend.fast())
        if self.number % SLOW == 0:
            self.slow, self.slow_number = json.dumps(backend.slow()), self.slow_number + 1
        self.number += 1
        for writer in self.writers:
            writer.set()


class Client:
    """One page."""

    def __init__(
        self, backend: Backend | Replay, frames: Frames, page: Page, session: Session, sessions: Sessions
    ) -> None:
        """`session`: the login of the page, one of `sessions`."""
        self._backend, self._frames, self._sessions, self._who = backend, frames, sessions, session.user
        self.page, self.session = page, session
        self.user, self.role = session.user, session.role
        self._transport: asyncio.Transport | None = None
        self._socket = web.WebSocketResponse(max_msg_size=MAX_SIZE, timeout=1.0, compress=False)
        self._outbox: deque[dict[str, Any]] = deque()
        self._to_send = asyncio.Event()
        self._calls: set[asyncio.Task[None]] = set()
        self.closing = 0  # code with which the page is to be closed
        self._pinged_at = self._wanted_at = float("-inf")
        self._seen = self._seen_slow = 0  # numbers of the last frame and state that were sent
        self._unanswered: float | None = None  # s, when the first ping without an answer was sent

    async def serve(self, request: web.Request) -> web.WebSocketResponse:
        """Serves the page until it ends."""
        await self._socket.prepare(request)
        self._transport, self._who = request.transport, f"{request.remote}: {self.user}"
        writer = asyncio.create_task(self._write())
        self._frames.writers.add(self._to_send)
        try:
            await self._read()
        finally:
            for call in self._calls:
                call.cancel()
            if self.closing:
                await asyncio.wait({writer}, timeout=CLOSING)
            writer.cancel()
            self._frames.writers.discard(self._to_send)
        return self._socket

    def end(self, code: int) -> None:
        """Ends the command of the page, and closes it with this code; one that does not read that is cut off."""
        self._backend.authority.leave(self.page, time.monotonic())
        self.closing = self.closing or code
        self._to_send.set()
        asyncio.get_running_loop().call_later(CLOSING, self._cut_off)

    def _cut_off(self) -> None:
        if self._transport is not None:
            self._transport.abort()

    def say(self, text: str) -> None:
        """Sends a line for the operator."""
        self._post({"type": "said", "text": text})

    def _post(self, message: dict[str, Any]) -> None:
        if len(self._outbox) < MAX_ANSWERS:
            self._outbox.append(message)
            self._to_send.set()

    async def _read(self) -> None:
        rate, mistakes = Rate(time.monotonic()), 0
        async for message in self._socket:
            if self.closing:
                return
            now = time.monotonic()
            if message.type != WSMsgType.TEXT or not rate.admits(now) or mistakes >= MAX_MISTAKES:
                journal.warning("%s: page %d sends what no page sends: closed", self._who, self.page.number)
                self.end(POLICY_VIOLATION)
                return
            with boundary.crossing("a page"):
                mistakes += self._take(message.data, now)

    def _take(self, data: str, now: float) -> bool:
        """Takes a message; True if no page of this console sends such a one."""
        try:
            self._receive(parse(data), now)
        except (MessageError, RefusedError) as error:
            journal.info("%s: refused: %s", self._who, escaped(str(error)))
            self.say(str(error))
            return isinstance(error, MessageError)
        return False

    def _receive(self, message: dict[str, Any], now: float) -> None:
        kind = message.pop("type")
        authority, page = self._backend.authority, self.page
        if kind == "play":
            self._backend.play(**message)
            return
        if not self._backend.live and kind != "pong":
            raise RefusedError(REFUSAL)
        if kind in LOGGED:
            journal.info("%s: %s %s", self._who, kind, json.dumps(message))
        if kind == "drive":
            authority.receive(page, Drive(**message), now)
        elif kind == "pong":
            page.dead_man.round_trips.pong(message["name"], now)
            self._unanswered = None
        elif kind == "take":
            authority.take(page, now, force=message["force"])
        elif kind == "hand_over":
            authority.hand_over(page, message["to"], now)
        elif kind == "give_back":
            authority.give_back(page, now)
        elif kind == "speeds":
            authority.require(page)
            page.chosen = Command(**message)
        elif kind == "heartbeat":
            authority.require(page)
            page.heartbeat = message["on"]
        else:
            check_call(message["name"], message["arguments"])
            if len(self._calls) >= MAX_CALLS:
                raise RefusedError("wait for the answers to your other requests")
            task = asyncio.create_task(self._call(**message))
            self._calls.add(task)
            task.add_done_callback(self._calls.discard)

    async def _call(self, number: int, name: str, arguments: dict[str, Any]) -> None:
        backend, accepted, text = self._backend, False, f"{name} has failed: check the log of console.py"
        with boundary.crossing(f"the call {name}"):
            try:
                why = against(name, self.page, backend.authority, backend.available, running_kind())
                if why:
                    raise RefusedError(why)
                if name == "reset":
                    backend.calls.confirm_reset(self.page, arguments["key"])
                    backend.reset()
                    text = "the reset was requested"
                else:
                    if name == "reset_asked":
                        backend.authority.rest(time.monotonic() + RESET_WINDOW)
                    text = await asyncio.to_thread(backend.calls.make, self.page, name, arguments)
                accepted = True
            except RefusedError as error:
                text = str(error)
        done = "done" if accepted else "refused"
        journal.info("%s: %s %s: %s: %s", self._who, name, json.dumps(arguments)[:500], done, escaped(text)[:500])
        self._post({"type": "answer", "number": number, "accepted": accepted, "text": text})

    async def _write(self) -> None:
        """Sends until the page is closed, or reads no more, or its login has ended."""
        self._post({"type": "trail", "points": [point[:2] for point in self._backend.view.trail.points]})
        try:
            while not self._socket.closed:
                now = time.monotonic()
                silent = 0.0 if self._unanswered is None else now - self._unanswered
                if not self.closing and not self._sessions.lives(self.session, time.time()):
                    self.end(LOGIN_ENDED)
                if self.closing:
                    await self._socket.close(code=self.closing)
                elif silent > LOST:
                    self._cut_off()
                else:
                    await self._ping(now)
                    while self._outbox:
                        await self._socket.send_str(json.dumps(self._outbox.popleft()))
                    if silent <= SKIP:
                        await self._frame()
                await self._to_send.wait()
                self._to_send.clear()
        except (ConnectionError, RuntimeError):
            pass  # the page has ended

    async def _ping(self, now: float) -> None:
        commands = self._backend.authority.commander is self.page
        if now - self._pinged_at < (PING_PERIOD if commands else WATCHER_PERIOD):
            return
        name = secrets.token_hex(8)
        self._pinged_at = now
        self._unanswered = self._unanswered or now
        self.page.dead_man.round_trips.ping(name, now)
        await self._socket.send_str(json.dumps({"type": "ping", "name": name}))

    async def _frame(self) -> None:
        frames = self._frames
        if frames.number != self._seen:
            self._seen = frames.number
            await self._socket.send_str(frames.fast)
        if frames.slow_number != self._seen_slow:
            self._seen_slow = frames.slow_number
            await self._socket.send_str(frames.slow)
            await self._socket.send_str(json.dumps(self._backend.authority_of(self.page)))
            at, wanted = self._backend.view.wanted
            if at != self._wanted_at:
                self._wanted_at = at
                await self._socket.send_str(json.dumps(wanted))
