"""The HTTP side: origins, logins and limits of all requests, and their answers."""

import asyncio
import contextlib
import hmac
import logging
import time
from collections.abc import Awaitable, Callable, Iterator
from pathlib import Path
from typing import Any

from aiohttp import hdrs, web

from robot_control.files.files import printable
from robot_control.robot.boundary import boundary
from robot_control.settings.addresses import Origins
from robot_control.watch.console.authority import Role
from robot_control.watch.console.backend import Backend
from robot_control.watch.console.client import GIVES_WAY, GOING_AWAY, Client, Frames
from robot_control.watch.console.doctor_run import DoctorRun
from robot_control.watch.console.files import HEADERS, REPORT_POLICY, page_file, protect
from robot_control.watch.console.messages import MAX_SIZE
from robot_control.watch.console.model import Model, ModelError
from robot_control.watch.console.navigation import NoGridError
from robot_control.watch.console.pending_connections import PendingConnections
from robot_control.watch.console.replay.replay import REFUSAL, Replay
from robot_control.watch.console.room import gives_way
from robot_control.watch.console.runs import Runs, RunsError
from robot_control.watch.console.sessions import Session, Sessions, Tries, digest
from robot_control.watch.console.users import Users, UsersError
from robot_control.watch.words.words import LANGUAGES, pairs_in

MAX_PAGES = 20
BODY_TIME = 10.0
"""s within which the body of a request has to arrive"""
PUBLIC = frozenset({"/login", "/api/login", "/tokens.css", "/style.css", "/login.js", "/icon.svg", "/words.js"})
"""Paths that are served without a login"""
LOCAL_USER = "local"
"""Name of the user who has opened the page with the token"""
journal = logging.getLogger("console")
Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class Server:
    """All routes."""

    def __init__(
        self,
        backend: Backend | Replay,
        origins: Origins,
        users: Users | None,
        runs: Path,
        *,
        port: int,
        read_only: bool,
    ) -> None:
        """`users`: None where the token alone opens."""
        self._backend, self._origins, self._users, self._read_only = backend, origins, users, read_only
        self.sessions, self._tries = Sessions(), Tries()
        self._runs, self._model, self._doctor_run = Runs(runs), Model(backend.description), DoctorRun()
        self.pending, self.frames = PendingConnections(), Frames()
        self._clients: list[Client] = []
        self._hashing = asyncio.Semaphore(1)
        self._cookie = f"console_{port}"  # cookies of one host count for all its ports
        self.app = web.Application(middlewares=[self._guard], client_max_size=MAX_SIZE)
        get, post = self.app.router.add_get, self.app.router.add_post
        get("/ws", self._socket)
        get("/api/model", self._urdf)
        get("/api/mesh/{id}", self._mesh)
        get("/api/grids/{name}", self._grid)
        get("/api/runs", self._run_list)
        get("/api/runs/{id}/file", self._run_file)
        get("/api/runs/{id}/report", self._report)
        get("/api/doctor", self._doctor)
        get("/words/{language}", self._words)
        get("/{path:.*}", self._file)
        post("/api/login", self._login)
        post("/api/logout", self._logout)
        post("/api/e_stop", self._e_stop)

    def pass_on(self) -> None:
        """Sends the robot's answers to all pages."""
        for text in self._backend.said:
            journal.info("robot: %s", printable(text, 500))
            for client in self._clients:
                client.say(text)
        self._backend.said.clear()

    def check_users(self) -> None:
        """Ends the logins of users that were removed or have another role."""
        if self._users is not None:
            try:
                self.sessions.check_roles({name: user.role for name, user in self._users.all().items()})
            except (UsersError, OSError) as error:
                journal.warning("%s", error)
                self.sessions.check_roles({})

    def close(self) -> None:
        """Ends all pages."""
        for client in self._clients:
            client.end(GOING_AWAY)

    # every request

    @web.middleware
    async def _guard(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        try:
            response = await self._guarded(request, handler)
        except web.HTTPException as error:
            protect(error)
            raise
        except Exception as error:  # all that the checks did not foresee; no request moves the robot
            boundary.drop("a request", f"{type(error).__name__}: {error}")
            raise web.HTTPInternalServerError(headers=HEADERS) from None
        if not response.prepared:
            protect(response)
        return response

    async def _guarded(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        host, origin = request.headers.get(hdrs.HOST), request.headers.get(hdrs.ORIGIN)
        if not self._origins.host_is_own(host):
            raise self._refusal(request, web.HTTPMisdirectedRequest, "this host is not the console's")
        if (request.method != hdrs.METH_GET or request.path == "/ws") and not self._origins.origin_is_own(origin, host):
            raise self._refusal(request, web.HTTPForbidden, "this origin is not the console's")
        if request.method != hdrs.METH_GET and not self._backend.live:
            raise self._refusal(request, web.HTTPForbidden, REFUSAL)
        session = self.sessions.of(request.cookies.get(self._cookie), time.time())
        request["session"] = session
        if session is not None:
            self.pending.admit(request.protocol)
        elif request.path == "/" and self._users is None and "token" in request.query:
            return self._with_token(request)
        elif request.path == "/":
            raise web.HTTPFound("/login")
        elif request.path not in PUBLIC and request.match_info.handler != self._words:
            raise web.HTTPUnauthorized(text="log in first")
        return await handler(request)

    def _refusal(self, request: web.Request, kind: type[web.HTTPException], why: str) -> web.HTTPException:
        journal.warning("%s: refused: %s %s: %s", request.remote, request.method, printable(request.path), why)
        return kind(text=why)

    # logins

    def _with_token(self, request: web.Request) -> web.StreamResponse:
        if not hmac.compare_digest(request.query["token"].encode(), self.sessions.token.encode()):
            raise self._refusal(request, web.HTTPForbidden, "this token is wrong: open the address that was printed")
        return self._begin(request, web.Response(status=303, headers={"Location": "/"}), LOCAL_USER, Role.MAINTAIN)

    def _begin(self, request: web.Request, response: web.Response, user: str, role: Role) -> web.Response:
        secure = request.secure or f"https://{request.headers[hdrs.HOST]}" in self._origins.own
        commander = self._commander()
        kept = None if commander is None else commander.session
        cookie = self.sessions.begin(user, role, time.time(), kept)
        response.set_cookie(self._cookie, cookie, httponly=True, samesite="Strict", secure=secure, path="/")
        journal.info("%s: %s has logged in as %s", request.remote, user, role)
        return response

    async def _login(self, request: web.Request) -> web.StreamResponse:
        """Logs in with `name` and `password`, or with `link` and a new password. No form of another site sends JSON."""
        if request.content_type != "application/json":
            raise web.HTTPUnsupportedMediaType(text="application/json is needed")
        try:
            body = await asyncio.wait_for(request.json(), BODY_TIME)
            name, link, password = (str(body.get(key, ""))[:1000] for key in ("name", "link", "password"))
        except (TimeoutError, ValueError, RecursionError, AttributeError):
            raise web.HTTPBadRequest(text="an object of JSON is needed") from None
        users, remote = self._users, request.remote or ""
        if users is None:
            raise web.HTTPForbidden(text="this console has no users: open the address that console.py printed")
        now, tried = time.time(), digest(link) if link else name  # wrong links block no other link
        wait = self._tries.admit(tried, remote, now)
        if wait > 0:
            raise self._refusal(request, web.HTTPTooManyRequests, f"too many attempts: wait {wait:.0f} s")
        try:
            async with self._hashing:
                check = (users.set_password, link, password, time.time()) if link else (users.check, name, password)
                user = await asyncio.to_thread(*check)
        except UsersError as error:
            raise self._refusal(request, web.HTTPForbidden, f"{printable(name, 32)}: {error}".lstrip(": ")) from None
        self._tries.succeed(tried, remote, now)
        return self._begin(request, web.json_response({}), user.name, user.role)

    async def _logout(self, request: web.Request) -> web.StreamResponse:
        session: Session = request["session"]
        self.sessions.end(session)
        journal.info("%s: %s has logged out", request.remote, session.user)
        response = web.json_response({})
        response.del_cookie(self._cookie, path="/")
        return response

    # what a page does

    async def _e_stop(self, request: web.Request) -> web.StreamResponse:
        journal.warning("%s: %s: EMERGENCY STOP", request.remote, request["session"].user)
        answer = await self._backend.e_stop()
        return web.json_response({"confirmed": answer.accepted, "text": answer.text})

    async def _socket(self, request: web.Request) -> web.StreamResponse:
        if not web.WebSocketResponse().can_prepare(request):
            raise web.HTTPBadRequest(text="this address accepts only WebSockets")
        with self._page(request) as client:
            return await client.serve(request)

    @contextlib.contextmanager
    def _page(self, request: web.Request) -> Iterator[Client]:
        """A page that is registered as long as the block lives, however that ends."""
        session: Session = request["session"]
        self._make_room(request, session)
        authority = self._backend.authority
        page = authority.join(session.user, session.role if self._backend.live and not self._read_only else Role.WATCH)
        who = f"{request.remote}: {session.user}"
        journal.info("%s: page %d begins as %s", who, page.number, page.role)
        client = Client(self._backend, self.frames, page, session, self.sessions)
        self._clients.append(client)
        try:
            yield client
        finally:
            self._clients.remove(client)
            authority.leave(page, time.monotonic())
            self._backend.calls.forget(page)
            journal.info("%s: page %d ended", who, page.number)

    def _make_room(self, request: web.Request, session: Session) -> None:
        """Ends a page where there are too many, but never the one that commands. Raises HTTPServiceUnavailable."""
        present = [each for each in self._clients if not each.closing]
        if len(present) < MAX_PAGES:
            return
        commander = self._commander()
        client = gives_way([each for each in present if each is not commander], session.user, session.role)
        if client is None:
            raise self._refusal(request, web.HTTPServiceUnavailable, f"{MAX_PAGES} pages are open already")
        client.end(GIVES_WAY)

    def _commander(self) -> Client | None:
        page = self._backend.authority.commander
        return next((each for each in self._clients if each.page is page), None)

    # files

    async def _file(self, request: web.Request) -> web.StreamResponse:
        name = {"": "index.html", "login": "login.html"}.get(path := request.match_info["path"], path)
        packed = "gzip" in request.headers.get(hdrs.ACCEPT_ENCODING, "")
        return await asyncio.to_thread(page_file, name, packed=packed)

    async def _words(self, request: web.Request) -> web.StreamResponse:
        language = request.match_info["language"]
        if language not in LANGUAGES:
            raise web.HTTPNotFound(text="the page is not written in this language")
        return web.json_response(pairs_in(language))

    async def _urdf(self, _: web.Request) -> web.StreamResponse:
        return web.json_response(await _found(self._model.read))

    async def _mesh(self, request: web.Request) -> web.StreamResponse:
        return web.Response(body=await _found(self._model.mesh, request.match_info["id"]))

    async def _grid(self, request: web.Request) -> web.StreamResponse:
        return web.json_response(await _found(self._backend.view.navigation.grid, request.match_info["name"]))

    async def _run_list(self, _: web.Request) -> web.StreamResponse:
        return web.json_response(await _found(self._runs.list))

    async def _run_file(self, request: web.Request) -> web.StreamResponse:
        path = await _found(self._runs.file, request.match_info["id"])
        name = "".join(sign if sign.isascii() and (sign.isalnum() or sign in ".-_") else "_" for sign in path.name)
        headers = {"Content-Disposition": f'attachment; filename="{name}"', "Content-Type": "application/octet-stream"}
        return web.FileResponse(path, headers=headers)

    async def _report(self, request: web.Request) -> web.StreamResponse:
        path = await _found(self._runs.report, request.match_info["id"])
        headers = {"Content-Security-Policy": REPORT_POLICY, "Content-Type": "text/html; charset=utf-8"}
        return web.FileResponse(path, headers=headers)

    async def _doctor(self, request: web.Request) -> web.StreamResponse:
        if request["session"].role < Role.MAINTAIN:
            raise web.HTTPForbidden(text=f"needs the role {Role.MAINTAIN}: it names programs and users of the computer")
        return web.json_response(await _found(self._doctor_run.result))


async def _found(find: Callable[..., Any], *arguments: str) -> Any:  # noqa: ANN401 (of the function)
    """The result of a function that may take long; 404 where it finds nothing."""
    try:
        return await asyncio.to_thread(find, *arguments)
    except (ModelError, NoGridError, RunsError, OSError) as error:
        raise web.HTTPNotFound(text=printable(str(error), 1000)) from None
