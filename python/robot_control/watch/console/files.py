"""The files that make the page, by the path of their address, and the headers with which everything is served."""

import gzip
from functools import lru_cache
from pathlib import Path

from aiohttp import web

OWN, SHARED = Path(__file__).parent / "page", Path("/usr/share/javascript")
LIBRARIES = (
    "three/build/three.module.js",
    "three/examples/jsm/controls/OrbitControls.js",
    "three/examples/jsm/loaders/STLLoader.js",
    "three/examples/jsm/loaders/ColladaLoader.js",
    "three/examples/jsm/loaders/TGALoader.js",
)
"""Files of Debian's package libjs-three"""
FILES = {path.name: path for path in OWN.glob("*.*")} | {f"lib/{name}": SHARED / name for name in LIBRARIES}
"""Path of the address → file; nothing else is served as a file"""
TYPES = {".html": "text/html", ".css": "text/css", ".svg": "image/svg+xml"}
"""Type by suffix; every other file is a script."""
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'self'"
)
REPORT_POLICY = (
    "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; font-src data:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
)
"""A report holds scripts of its own; in the sandbox they belong to no origin, and reach neither page nor cookie."""
HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
    "Cache-Control": "no-store",
}
"""Headers of every answer that does not set them itself"""


def page_file(name: str, *, packed: bool) -> web.Response:
    """The file with this path, or 404. `packed`: the browser takes gzip."""
    path = FILES.get(name)
    if path is None or not path.is_file():
        raise web.HTTPNotFound(text="file not found; scripts/setup --console installs the libraries")
    headers = {"Content-Type": f"{TYPES.get(path.suffix, 'text/javascript')}; charset=utf-8", "Vary": "Accept-Encoding"}
    headers |= {"Cache-Control": "max-age=3600"} if "/" in name else {}
    if packed:
        return web.Response(body=_packed(path, path.stat().st_mtime_ns), headers=headers | {"Content-Encoding": "gzip"})
    return web.Response(body=path.read_bytes(), headers=headers)


@lru_cache(maxsize=len(FILES))
def _packed(path: Path, _changed: int) -> bytes:
    """The file as it crosses the wire: half a megabyte instead of two, over a radio link a second."""
    return gzip.compress(path.read_bytes(), mtime=0)


def protect(response: web.StreamResponse) -> None:
    """Sets the headers of an answer."""
    for name, value in HEADERS.items():
        response.headers.setdefault(name, value)
