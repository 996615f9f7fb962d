"""The HTTP side: who may ask for what, and the answers. Origins, logins and limits of all requests stand here."""

from __future__ import annotations

import asyncio
import hmac
import logging
import time
from collections.abc import Awaitable, Callable
from pathlib import Path

from aiohttp import hdrs, web

from robot_control.common.files import printable
from robot_control.console.addresses import Doors
from robot_control.console.backend import Backend
from robot_control.console.client import Client, Frames
from robot_control.console.desk import Role
from robot_control.console.door import Strangers
from robot_control.console.files import LIBRARIES, PAGE, REPORT_POLICY, content_type, protect
from robot_control.console.messages import MAX_SIZE
from robot_control.console.model import ModelError
from robot_control.console.models import Models
from robot_control.console.runs import Runs, RunsError
from robot_control.console.sessions import Session, Sessions, Tries
from robot_control.console.users import Users, UsersError

MAX_PAGES = 20
BODY_TIME = 10.0
"""s in which the body of a request has to come"""
PUBLIC = frozenset({"/login", "/api/login", "/api/first", "/style.css", "/login.js", "/icon.svg"})
"""what is served without a login"""
LOCAL_USER = "local"
"""who came with the token"""
journal = logging.getLogger("console")
Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


class Server:
    """All routes."""

    def __init__(
        self, backend: Backend, doors: Doors, users: Users | None, token: str, runs: Path, *, read_only: bool
    ) -> None:
        """`users`: None where the token alone opens."""
        self._backend, self._doors, self._users, self._token = backend, doors, users, token
        self._read_only = read_only
        self.sessions, self._tries = Sessions(), Tries()
        self._runs, self._models = Runs(runs), Models()
        self.strangers, self.frames = Strangers(), Frames()
        self._clients: list[Client] = []
        self._hashing = asyncio.Semaphore(1)
        self.cookie = "console"
        self.app = web.Application(middlewares=[self._guard], client_max_size=MAX_SIZE)
        get, post = self.app.router.add_get, self.app.router.add_post
        get("/", self._index)
        get("/login", self._login_page)
        get("/ws", self._socket)
        get("/api/model", self._model)
        get("/api/mesh/{id}", self._mesh)
        get("/api/runs", self._run_list)
        get("/api/runs/{id}/file", self._run_file)
        get("/api/runs/{id}/report", self._report)
        get("/lib/{path:.+}", self._library)
        get("/{file}", self._page_file)
        post("/api/login", self._login)
        post("/api/first", self._first)
        post("/api/logout", self._logout)
        post("/api/e_stop", self._e_stop)

    def look(self) -> None:
        """Hands what the robot answered to all pages."""
        for text in self._backend.said:
            journal.info("robot: %s", printable(text, 500))
            for client in self._clients:
                client.say(text)
        self._backend.said.clear()

    def check_users(self) -> None:
        """Ends the logins of users that were removed or have another role."""
        if self._users is not None:
            try:
                self.sessions.check_roles({name: _role(user.role) for name, user in self._users.all().items()})
            except (UsersError, OSError) as error:
                journal.warning("%s", error)
                self.sessions.check_roles({})

    def close(self) -> None:
        """Ends all pages."""
        for client in self._clients:
            client.close()

    # every request

    @web.middleware
    async def _guard(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        try:
            response = await self._guarded(request, handler)
        except web.HTTPException as error:
            protect(error)
            raise
        if not response.prepared:
            protect(response)
        return response

    async def _guarded(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        host, origin = request.headers.get(hdrs.HOST), request.headers.get(hdrs.ORIGIN)
        if not self._doors.host_is_own(host):
            raise self._refusal(request, web.HTTPMisdirectedRequest, "this host is not the console's")
        if (request.method != hdrs.METH_GET or request.path == "/ws") and not self._doors.origin_is_own(origin, host):
            raise self._refusal(request, web.HTTPForbidden, "this origin is not the console's")
        session = self.sessions.of(request.cookies.get(self.cookie), time.time())
        request["session"] = session
        if session is not None:
            self.strangers.admit(request.transport)
        elif request.path == "/" and self._users is None and "token" in request.query:
            return self._with_token(request)
        elif request.path == "/":
            raise web.HTTPFound("/login")
        elif request.path not in PUBLIC:
            raise web.HTTPUnauthorized(text="log in first")
        return await handler(request)

    def _refusal(self, request: web.Request, kind: type[web.HTTPException], why: str) -> web.HTTPException:
        journal.warning("%s: refused: %s %s: %s", request.remote, request.method, printable(request.path), why)
        return kind(text=why)

    # logins

    def _with_token(self, request: web.Request) -> web.StreamResponse:
        if not hmac.compare_digest(request.query["token"].encode(), self._token.encode()):
            raise self._refusal(request, web.HTTPForbidden, "this token is wrong: open the address that was printed")
        response = web.Response(status=303, headers={"Location": "/"})
        self._begin(request, response, LOCAL_USER, Role.MAINTAIN)
        return response

    def _begin(self, request: web.Request, response: web.StreamResponse, user: str, role: Role) -> None:
        cookie = self.sessions.begin(user, role, time.time())
        secure = request.secure or any(
            origin == f"https://{request.headers.get(hdrs.HOST)}" for origin in self._doors.origins
        )
        response.set_cookie(self.cookie, cookie, httponly=True, samesite="Strict", secure=secure, path="/")
        journal.info("%s: %s has logged in as %s", request.remote, user, role.name.lower())

    async def _body(self, request: web.Request, *names: str) -> list[str]:
        """Texts of a JSON object: no form of another page can send one."""
        if request.content_type != "application/json":
            raise web.HTTPUnsupportedMediaType(text="application/json is needed")
        try:
            body = await asyncio.wait_for(request.json(), BODY_TIME)
        except (TimeoutError, ValueError, RecursionError):
            raise web.HTTPBadRequest(text="no JSON") from None
        if not isinstance(body, dict) or not all(isinstance(body.get(name), str) for name in names):
            raise web.HTTPBadRequest(text=f"an object with {', '.join(names)} is needed")
        return [body[name][:1000] for name in names]

    async def _login(self, request: web.Request) -> web.StreamResponse:
        name, password = await self._body(request, "name", "password")
        users, remote = self._known_users(), request.remote or ""
        wait = self._tries.wait(name, remote, time.time())
        if wait > 0:
            raise self._refusal(request, web.HTTPTooManyRequests, f"too many tries: wait {wait:.0f} s")
        async with self._hashing:
            user = await asyncio.to_thread(users.check, name, password)
        if user is None:
            self._tries.fail(name, remote, time.time())
            raise self._refusal(request, web.HTTPForbidden, f"name or password is wrong ({printable(name, 32)})")
        response = web.json_response({})
        self._begin(request, response, user.name, _role(user.role))
        return response

    async def _first(self, request: web.Request) -> web.StreamResponse:
        link, password = await self._body(request, "link", "password")
        users, remote = self._known_users(), request.remote or ""
        wait = self._tries.wait("", remote, time.time())
        if wait > 0:
            raise self._refusal(request, web.HTTPTooManyRequests, f"too many tries: wait {wait:.0f} s")
        try:
            async with self._hashing:
                user = await asyncio.to_thread(users.set_password, link, password, time.time())
        except UsersError as error:
            self._tries.fail("", remote, time.time())
            raise self._refusal(request, web.HTTPForbidden, str(error)) from None
        response = web.json_response({})
        self._begin(request, response, user.name, _role(user.role))
        return response

    def _known_users(self) -> Users:
        if self._users is None:
            raise web.HTTPForbidden(text="this console has no users: open the address that console.py printed")
        return self._users

    async def _logout(self, request: web.Request) -> web.StreamResponse:
        session: Session = request["session"]
        self.sessions.end(session)
        journal.info("%s: %s has logged out", request.remote, session.user)
        response = web.json_response({})
        response.del_cookie(self.cookie, path="/")
        return response

    # what a page does

    async def _e_stop(self, request: web.Request) -> web.StreamResponse:
        journal.warning("%s: %s: EMERGENCY STOP", request.remote, request["session"].user)
        self._backend.e_stop()
        return web.json_response({})

    async def _socket(self, request: web.Request) -> web.StreamResponse:
        if len(self._clients) >= MAX_PAGES:
            raise self._refusal(request, web.HTTPServiceUnavailable, f"{MAX_PAGES} pages are open already")
        session: Session = request["session"]
        role = Role.WATCH if self._read_only else session.role
        page = self._backend.desk.join(session.user, role)
        who = f"{request.remote}: {session.user}"
        journal.info("%s: page %d begins as %s", who, page.number, role.name.lower())
        client = Client(self._backend, self.frames, page, who, lambda: self.sessions.lives(session, time.time()))
        self._clients.append(client)
        try:
            return await client.serve(request)
        finally:
            self._clients.remove(client)

    # files

    async def _index(self, _: web.Request) -> web.StreamResponse:
        return _file("index.html")

    async def _login_page(self, _: web.Request) -> web.StreamResponse:
        return _file("login.html")

    async def _page_file(self, request: web.Request) -> web.StreamResponse:
        return _file(request.match_info["file"])

    async def _library(self, request: web.Request) -> web.StreamResponse:
        path = LIBRARIES.get(request.match_info["path"])
        if path is None or not path.is_file():
            raise web.HTTPNotFound(text="there is no such library: scripts/setup --console")
        return web.FileResponse(
            path, headers={"Content-Type": content_type(path.name), "Cache-Control": "max-age=3600"}
        )

    async def _model(self, _: web.Request) -> web.StreamResponse:
        try:
            return web.json_response(await asyncio.to_thread(self._models.tree))
        except ModelError as error:
            raise web.HTTPNotFound(text=str(error)) from None

    async def _mesh(self, request: web.Request) -> web.StreamResponse:
        try:
            return web.Response(body=await asyncio.to_thread(self._models.mesh, request.match_info["id"]))
        except (KeyError, ModelError, OSError) as error:
            raise web.HTTPNotFound(text=printable(str(error), 500)) from None

    async def _run_list(self, _: web.Request) -> web.StreamResponse:
        return web.json_response(await asyncio.to_thread(self._runs.list))

    async def _run_file(self, request: web.Request) -> web.StreamResponse:
        try:
            path = await asyncio.to_thread(self._runs.file, request.match_info["id"])
        except RunsError as error:
            raise web.HTTPNotFound(text=str(error)) from None
        name = "".join(sign if sign.isascii() and (sign.isalnum() or sign in ".-_") else "_" for sign in path.name)
        headers = {"Content-Disposition": f'attachment; filename="{name}"', "Content-Type": "application/octet-stream"}
        return web.FileResponse(path, headers=headers)

    async def _report(self, request: web.Request) -> web.StreamResponse:
        try:
            path = await asyncio.to_thread(self._runs.report, request.match_info["id"])
        except (RunsError, OSError) as error:
            raise web.HTTPNotFound(text=printable(str(error), 1000)) from None
        headers = {"Content-Security-Policy": REPORT_POLICY, "Content-Type": "text/html; charset=utf-8"}
        return web.Response(body=await asyncio.to_thread(path.read_bytes), headers=headers)


def _file(name: str) -> web.StreamResponse:
    if name not in PAGE:
        raise web.HTTPNotFound(text="there is no such file")
    return web.Response(body=PAGE[name].read_bytes(), headers={"Content-Type": content_type(name)})


def _role(name: str) -> Role:
    return Role[name.upper()]
