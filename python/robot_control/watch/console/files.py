"""The files that make the page, by the path of their address, and the headers with which everything is served."""

from pathlib import Path

from aiohttp import web

OWN, SHARED = Path(__file__).parent / "page", Path("/usr/share/javascript")
LIBRARIES = (
    "three/build/three.module.js",
    "three/examples/jsm/controls/OrbitControls.js",
    "three/examples/jsm/loaders/STLLoader.js",
    "three/examples/jsm/loaders/ColladaLoader.js",
    "three/examples/jsm/loaders/TGALoader.js",
    "chart.js/chart.mjs",
    "chart.js/chunks/helpers.segment.mjs",
)
"""Files of Debian's packages libjs-three and libjs-chart.js"""
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


def page_file(name: str) -> web.StreamResponse:
    """The file with this path, or 404."""
    path = FILES.get(name)
    if path is None or not path.is_file():
        raise web.HTTPNotFound(text="file not found; scripts/setup --console installs the libraries")
    headers = {"Content-Type": f"{TYPES.get(path.suffix, 'text/javascript')}; charset=utf-8"}
    return web.FileResponse(path, headers=headers | ({"Cache-Control": "max-age=3600"} if "/" in name else {}))


def protect(response: web.StreamResponse) -> None:
    """Sets the headers of an answer."""
    for name, value in HEADERS.items():
        response.headers.setdefault(name, value)
