from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Map: TypeAlias = tuple[float, float, float, NDArray[np.int8]]
_Pose: TypeAlias = Sequence[float] | NDArray[np.float64]
_Scan: TypeAlias = Mapping[str, Any]

class Mapper:
    def __init__(self, map: _Map = ...) -> None: ...  # noqa: A002 (the name that C++ gives)
    @staticmethod
    def load(path: str) -> Mapper: ...
    def save(self, path: str) -> None: ...
    def set_pose(self, pose: _Pose) -> None: ...
    def update(self, scan: _Scan, sensor: _Pose, odometry: _Pose, covariance: ArrayLike) -> None: ...
    pose: tuple[float, float, float]
    anchor: tuple[int, tuple[float, float, float]]
    nodes: list[tuple[float, float, float]]
    closed: int
    matched: float
    reason: str
    map: _Map

class Localizer:
    def __init__(self, map: _Map, seed: int) -> None: ...  # noqa: A002 (likewise)
    def set_pose(self, pose: _Pose, covariance: ArrayLike) -> None: ...
    def search(self) -> None: ...
    def update(self, scan: _Scan, sensor: _Pose, odometry: _Pose, covariance: ArrayLike) -> bool: ...
    state: str
    reason: str
    explained: float
    pose: tuple[tuple[float, float, float], NDArray[np.float64]]
