"""Triangles as a shaded picture: parallel projection, depth buffer, dark outlines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

OVERSAMPLING = 2  # samples per pixel and axis
LIGHT = np.array([-0.25, 0.62, 0.74])  # from above and the left of the viewer: right, up, towards
CREASE = 0.8  # cosine between neighbouring normals below which an outline is drawn: 37°


@dataclass(frozen=True)
class View:
    """The orientation of a viewer: unit vectors to the right, up and towards the viewer."""

    axes: Array

    @staticmethod
    def towards(direction: tuple[float, float, float]) -> View:
        """A viewer in this direction with z up in the picture; from above, y is up."""
        towards = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
        right = np.cross((0.0, 0.0, 1.0), towards)
        right = right / np.linalg.norm(right) if np.linalg.norm(right) > 1e-9 else np.array([1.0, 0.0, 0.0])
        return View(np.stack((right, np.cross(towards, right), towards)))

    def project(self, points: Array) -> Array:
        """Right, up and towards of points of shape (…, 3)."""
        return np.asarray(points @ self.axes.T)


@dataclass(frozen=True)
class Part:
    """Triangles of shape (n, 3, 3) of one colour (red, green, blue in 0 … 1)."""

    triangles: Array
    colour: tuple[float, float, float]


@dataclass(frozen=True)
class Window:
    """The visible part of the picture plane, m."""

    left: float
    right: float
    bottom: float
    top: float


def render(parts: list[Part], view: View, window: Window, width: int) -> NDArray[np.uint8]:
    """RGBA picture of shape (height, width, 4), transparent where there is nothing."""
    scale = width * OVERSAMPLING / (window.right - window.left)
    height = max(1, round(width * (window.top - window.bottom) / (window.right - window.left)))
    canvas = _Canvas(height * OVERSAMPLING, width * OVERSAMPLING)
    for number, part in enumerate(parts):
        corners = view.project(part.triangles)
        screen = np.stack(
            ((corners[..., 0] - window.left) * scale, (window.top - corners[..., 1]) * scale, corners[..., 2]), axis=-1
        )
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        lengths = np.linalg.norm(normals, axis=1)
        for triangle, normal, length in zip(screen, normals, lengths, strict=True):
            if length > 0:
                facing = normal / length if normal[2] >= 0 else -normal / length
                canvas.draw(triangle, number, facing)
    return canvas.picture(np.array([part.colour for part in parts]))


class _Canvas:
    def __init__(self, height: int, width: int) -> None:
        # Single precision: the arrays of a picture of 2000 × 2000 samples take half of the memory, and of the time.
        self.depth = np.full((height, width), -np.inf, dtype=np.float32)
        self.part = np.full((height, width), -1, dtype=np.int32)
        self.normal = np.zeros((height, width, 3), dtype=np.float32)

    def draw(self, triangle: Array, part: int, normal: Array) -> None:
        height, width = self.depth.shape
        (x0, y0, z0), (x1, y1, z1), (x2, y2, z2) = triangle
        left, right = max(0, int(min(x0, x1, x2))), min(width, int(max(x0, x1, x2)) + 2)
        top, bottom = max(0, int(min(y0, y1, y2))), min(height, int(max(y0, y1, y2)) + 2)
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        if left >= right or top >= bottom or abs(area) < 1e-9:
            return
        x = np.arange(left, right)[None, :] + 0.5
        y = np.arange(top, bottom)[:, None] + 0.5
        first = ((x - x0) * (y2 - y0) - (x2 - x0) * (y - y0)) / area
        second = ((x1 - x0) * (y - y0) - (x - x0) * (y1 - y0)) / area
        depth = z0 + first * (z1 - z0) + second * (z2 - z0)
        here = (slice(top, bottom), slice(left, right))
        seen = (first >= -1e-9) & (second >= -1e-9) & (first + second <= 1 + 1e-9) & (depth > self.depth[here])
        self.depth[here][seen] = depth[seen]
        self.part[here][seen] = part
        self.normal[here][seen] = normal

    def picture(self, colours: Array) -> NDArray[np.uint8]:
        covered = self.part >= 0
        shade = 0.50 + 0.54 * np.clip(self.normal @ (LIGHT / np.linalg.norm(LIGHT)).astype(np.float32), 0, 1)
        shade[self._outlines()] *= 0.45
        image = np.zeros((*self.part.shape, 4), dtype=np.float32)
        if colours.size:
            image[..., :3] = np.clip(colours.astype(np.float32)[self.part] * shade[..., None], 0, 1)
        image[..., 3] = covered
        image[..., :3] *= image[..., 3:]
        rows, columns = (size // OVERSAMPLING for size in self.part.shape)
        small = image.reshape(rows, OVERSAMPLING, columns, OVERSAMPLING, 4).mean(axis=(1, 3))
        small[..., :3] /= np.maximum(small[..., 3:], 1e-9)
        return np.asarray(np.round(np.clip(small, 0, 1) * 255), dtype=np.uint8)

    def _outlines(self) -> NDArray[np.bool_]:
        edge = np.zeros(self.part.shape, dtype=bool)
        for before, after in ((np.s_[:-1], np.s_[1:]), (np.s_[:, :-1], np.s_[:, 1:])):
            creased = np.einsum("ijk,ijk->ij", self.normal[before], self.normal[after]) < CREASE
            found = (self.part[before] != self.part[after]) | (creased & (self.part[before] >= 0))
            edge[before] |= found
            edge[after] |= found
        return edge & (self.part >= 0)
