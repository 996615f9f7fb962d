"""The files that make the page, and the headers with which everything is served. Pure but for listing a folder."""

from __future__ import annotations

from pathlib import Path

from aiohttp import web

FOLDER = Path(__file__).parent / "page"
PAGE = {path.name: path for path in sorted(FOLDER.glob("*.*"))}
"""Name → file of our own"""

SHARED = Path("/usr/share/javascript")
LIBRARIES = {
    name: SHARED / name
    for name in (
        "three/build/three.module.js",
        "three/examples/jsm/controls/OrbitControls.js",
        "three/examples/jsm/loaders/STLLoader.js",
        "three/examples/jsm/loaders/ColladaLoader.js",
        "three/examples/jsm/loaders/TGALoader.js",
        "three/examples/jsm/loaders/OBJLoader.js",
        "chart.js/chart.mjs",
        "chart.js/chunks/helpers.segment.mjs",
    )
}
"""Name → file of Debian's packages libjs-three and libjs-chart.js"""

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
    "frame-ancestors 'none'; base-uri 'none'; form-action 'self'"
)
REPORT_POLICY = (
    "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; font-src data:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
)
"""A report holds scripts of its own; in the sandbox they belong to no origin, and reach neither page nor cookie."""

TYPES = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".mjs": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
}


def content_type(name: str) -> str:
    """The type of a file, by its name."""
    return TYPES.get(Path(name).suffix, "application/octet-stream")


HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
    "Cache-Control": "no-store",
}
"""of every answer that has no other value"""


def protect(response: web.StreamResponse) -> None:
    """Sets the headers of an answer."""
    for name, value in HEADERS.items():
        response.headers.setdefault(name, value)
