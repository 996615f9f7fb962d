"""MuJoCo's own renderer without a display: its C library and EGL, by ctypes.

The poses to be drawn are keyframes of the model, so that none of MuJoCo's large structures has to be described here.
"""

import ctypes
import os
import tempfile
from ctypes import POINTER, byref, c_char_p, c_double, c_float, c_int, c_ubyte, c_void_p
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]
"""height × width × RGB"""

LIBRARY = "libmujoco.so.2.2.2"
ROOM = 1 << 20
"""bytes, more than any of mjvScene, mjvOption, mjvPerturb, mjrContext takes"""
SURFACELESS, OPENGL_API, OPENGL_BIT = 0x31DD, 0x30A2, 0x0008
"""EGL_PLATFORM_SURFACELESS_MESA, EGL_OPENGL_API, EGL_OPENGL_BIT"""
CONFIG = (0x3033, 0x0001, 0x3040, OPENGL_BIT, 0x3024, 8, 0x3023, 8, 0x3022, 8, 0x3025, 24, 0x3026, 8, 0x3038)
"""EGL: a pixel buffer for OpenGL with 8 bits per colour, 24 of depth, 8 of stencil"""
OFFSCREEN, ALL, FONT_SCALE, MAX_SHAPES = 1, 7, 100, 5000
"""mjFB_OFFSCREEN, mjCAT_ALL, mjFONTSCALE_100"""


class RenderError(RuntimeError):
    """Nothing can be drawn here; the message names the reason."""


@dataclass(frozen=True)
class Camera:
    """The point at which the camera looks, and its own place."""

    lookat: tuple[float, float, float]  # m
    distance: float  # m
    azimuth: float  # degrees, of its view; 0: along x
    elevation: float  # degrees, of its view; negative: down


class _Camera(ctypes.Structure):
    _fields_ = (
        *((name, c_int) for name in ("type", "fixedcamid", "trackbodyid")),
        *(("lookat", c_double * 3), ("distance", c_double), ("azimuth", c_double), ("elevation", c_double)),
        ("room", c_double * 8),
    )


class _Rectangle(ctypes.Structure):
    _fields_ = (("left", c_int), ("bottom", c_int), ("width", c_int), ("height", c_int))


def _library(name: str) -> ctypes.CDLL:
    try:
        return ctypes.CDLL(name, mode=ctypes.RTLD_GLOBAL)
    except OSError as error:
        raise RenderError(f"{name} cannot be loaded ({error}): scripts/setup --render") from None


def make_current() -> None:
    """An OpenGL context of EGL, without a window. Raises RenderError."""
    os.environ.setdefault("LIBGL_ALWAYS_SOFTWARE", "1")
    egl = _library("libEGL.so.1")
    for name in ("eglGetPlatformDisplay", "eglCreateContext"):
        getattr(egl, name).restype = c_void_p
    display = c_void_p(egl.eglGetPlatformDisplay(SURFACELESS, None, None))
    config, count = c_void_p(), c_int()
    attributes = (c_int * len(CONFIG))(*CONFIG)
    ready = egl.eglInitialize(display, None, None) and egl.eglBindAPI(OPENGL_API)
    if not ready or not egl.eglChooseConfig(display, attributes, byref(config), 1, byref(count)) or count.value < 1:
        raise RenderError("EGL offers no OpenGL without a display: scripts/setup --render installs Mesa's")
    context = c_void_p(egl.eglCreateContext(display, config, None, None))
    if not egl.eglMakeCurrent(display, None, None, context):
        raise RenderError(f"EGL made no OpenGL context: error {egl.eglGetError():#x}")


class Renderer:
    """A model and its keyframes; after make_current."""

    def __init__(self, mjcf: str, width: int, height: int) -> None:
        """`mjcf`: with `offwidth` and `offheight` of at least this size, in pixels. Raises RenderError."""
        self._rectangle = _Rectangle(0, 0, width, height)
        self._mj = mj = _library(LIBRARY)
        mj.mj_loadXML.restype = mj.mj_makeData.restype = c_void_p
        with tempfile.NamedTemporaryFile(suffix=".xml") as file:
            Path(file.name).write_text(mjcf)
            said = ctypes.create_string_buffer(1000)
            self._model = c_void_p(mj.mj_loadXML(c_char_p(file.name.encode()), None, said, len(said)))
        if not self._model:
            raise RenderError(f"MuJoCo: {said.value.decode(errors='replace')}")
        self._data = c_void_p(mj.mj_makeData(self._model))
        self._scene, self._option, self._perturbation, self._context = (
            ctypes.create_string_buffer(ROOM) for _ in range(4)
        )
        mj.mjv_defaultOption(self._option)
        mj.mjv_defaultPerturb(self._perturbation)
        mj.mjv_defaultScene(self._scene)
        mj.mjv_makeScene(self._model, self._scene, MAX_SHAPES)
        mj.mjr_defaultContext(self._context)
        mj.mjr_makeContext(self._model, self._context, FONT_SCALE)
        mj.mjr_setBuffer(OFFSCREEN, self._context)
        mj.mjr_render.argtypes = [_Rectangle, c_void_p, c_void_p]
        mj.mjr_readPixels.argtypes = [POINTER(c_ubyte), POINTER(c_float), _Rectangle, c_void_p]

    def draw(self, keyframe: int, camera: Camera) -> Picture:
        """The model at this keyframe."""
        mj, rectangle = self._mj, self._rectangle
        mj.mj_resetDataKeyframe(self._model, self._data, keyframe)
        mj.mj_fwdPosition(self._model, self._data)
        view = _Camera()
        mj.mjv_defaultCamera(byref(view))
        view.lookat[:] = camera.lookat
        view.distance, view.azimuth, view.elevation = camera.distance, camera.azimuth, camera.elevation
        mj.mjv_updateScene(self._model, self._data, self._option, self._perturbation, byref(view), ALL, self._scene)
        mj.mjr_render(rectangle, self._scene, self._context)
        pixels = np.empty((rectangle.height, rectangle.width, 3), np.uint8)
        mj.mjr_readPixels(pixels.ctypes.data_as(POINTER(c_ubyte)), None, rectangle, self._context)
        return pixels[::-1]
