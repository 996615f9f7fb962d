"""Gymnasium environments on `ClosedLoops`: a robot is commanded to a goal, through the same loop as any other command.

import gymnasium
import robot_control.loop.gym  # registers robot_control/Drive-v0 and robot_control/Walk-v0
env = gymnasium.make("robot_control/Drive-v0")
many = gymnasium.make_vec("robot_control/Drive-v0", num_envs=64)

`Drive-v0` is a robot on wheels, `Walk-v0` one on legs. Limits, gate and safety monitor act as ever: an action is a
message on cmd_vel. Gymnasium comes from PyPI: `scripts/setup --gym` installs it into build/gym.

A step is `cycles` cycles of the loop, 50 ms by default. An episode begins with a robot at rest, which lies on its legs
and stands up for the first action that is not zero. The goal is 1 … 3 m away, in any direction.

    action         part of `FULL_SPEED`, −1 … 1: linear, (on legs lateral,) angular
    observation    goal_x, goal_y [m], the goal in base axes by the robot's odometry.
                   linear, (lateral,) angular [m/s, m/s, rad/s], by the state estimator.
                   On legs roll, pitch [rad] and height above the start [m].
                   permitted: 1 while the safety monitor permits motion, else 0.
    reward         m by which the true distance to the goal has become smaller
    terminated     the true distance is less than `REACHED`, or a stop is latched
    info           distance [m], reached, causes: StopCause bits of a latched stop
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from numpy.typing import NDArray

from robot_control.installed_files import share_file
from robot_control.loop.closed_loop import ClosedLoop, File, Params
from robot_control.loop.closed_loops import ClosedLoops

Floats = NDArray[np.float64]

CYCLES = 50  # of a step
REACHED = 0.2  # m
NEAREST, FARTHEST = 1.0, 3.0  # m, of goals
MAX_STEPS = 400  # of an episode, 20 s
FULL_SPEED = {"drive": (1.0, 2.0), "walk": (0.5, 0.3, 1.0)}
"""m/s, (m/s,) rad/s of an action of 1"""
FARTHEST_SEEN = 20.0  # m; farther goals are observed there
OBSERVED = {
    "drive": (("estimate_linear", 3.0), ("estimate_angular", 10.0)),
    "walk": (
        *(("estimate_linear", 3.0), ("estimate_lateral", 3.0), ("estimate_angular", 10.0)),
        *(("estimate_roll", math.pi), ("estimate_pitch", math.pi), ("estimate_z", 1.0)),
    ),
}
"""Columns behind the goal, and the bound of each"""
_POSES = ("truth_x", "truth_y", "estimate_x", "estimate_y", "estimate_yaw", "permit_action", "permit_causes")
_DRIVE = 2  # PermitAction
_SEEDS = 2**31


class GoalVectorEnv(VectorEnv):
    """Many robots, each with its goal and its episode; one whose episode has ended begins another in the next step."""

    metadata: ClassVar[dict[str, Any]] = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        way: str,
        num_envs: int = 1,
        max_episode_steps: int | None = None,
        *,
        threads: int | None = None,
        cycles: int = CYCLES,
        params: Params = None,
        urdf: File | None = None,
        scene: File | None = None,
    ) -> None:
        """The robot of `urdf` drives or walks; `params`, `scene` and `threads` are those of `ClosedLoops`."""
        if urdf is None and way == "walk":
            urdf = share_file("urdf/quadbot.urdf")
        self.num_envs = num_envs
        self.loops = ClosedLoops(num_envs, threads, params=params, urdf=urdf, scene=scene)
        self._cycles = cycles
        self._max_steps = max_episode_steps
        self._full = np.array(FULL_SPEED[way])
        self._columns = (*_POSES, *(name for name, _ in OBSERVED[way]))
        bounds = np.array([FARTHEST_SEEN, FARTHEST_SEEN, *(bound for _, bound in OBSERVED[way]), 1.0], np.float32)
        self._low, self._high = np.append(-bounds[:-1], np.float32(0)), bounds
        self.single_observation_space = gymnasium.spaces.Box(self._low, self._high, dtype=np.float32)
        self.single_action_space = gymnasium.spaces.Box(-1, 1, self._full.shape, np.float32)
        self.observation_space = gymnasium.vector.utils.batch_space(self.single_observation_space, num_envs)
        self.action_space = gymnasium.vector.utils.batch_space(self.single_action_space, num_envs)
        self.randoms = [np.random.default_rng() for _ in range(num_envs)]
        """Source of the goals and seeds of each robot"""
        self.ended = np.zeros(num_envs, bool)
        """whose episode has ended"""
        self._goals = np.zeros((num_envs, 2))
        self._distances = np.zeros(num_envs)
        self._steps = np.zeros(num_envs, int)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begins an episode of every robot; robot i has the seed `seed + i`."""
        if seed is None or isinstance(seed, int | np.integer):
            seed = [None if seed is None else int(seed) + i for i in range(self.num_envs)]
        for i, one in enumerate(seed):
            if one is not None:
                self.randoms[i], _ = seeding.np_random(one)
        self._begin(np.ones(self.num_envs, bool))
        values = self._advance(np.zeros((self.num_envs, len(self._full))))
        self._distances = self._distance(values)
        return self._observed(values), self._info(values)

    def step(
        self, actions: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], Floats, NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Runs `cycles` cycles."""
        begins = self.ended.copy()
        if begins.any():
            self._begin(begins)
        commands = np.clip(np.asarray(actions, float), -1, 1) * self._full
        values = self._advance(np.where(begins[:, None], 0.0, commands))
        distances = self._distance(values)
        rewards = np.where(begins, 0.0, self._distances - distances)
        self._distances = distances
        self._steps += ~begins
        info = self._info(values)
        terminated = ~begins & (info["reached"] | (info["causes"] != 0))
        truncated = np.zeros(self.num_envs, bool)
        if self._max_steps is not None:
            truncated = ~begins & (self._steps >= self._max_steps)
        self.ended = terminated | truncated
        return self._observed(values), rewards, terminated, truncated, info

    def _begin(self, which: NDArray[np.bool_]) -> None:
        chosen = np.flatnonzero(which)
        self.loops.reset([int(self.randoms[i].integers(_SEEDS)) for i in chosen], chosen.tolist())
        for i in chosen:
            distance, angle = self.randoms[i].uniform((NEAREST, -math.pi), (FARTHEST, math.pi))
            self._goals[i] = distance * math.cos(angle), distance * math.sin(angle)
        self.ended[chosen] = False
        self._steps[chosen] = 0

    def _advance(self, commands: Floats) -> Floats:
        return self.loops.step(self._cycles, commands, self._columns)

    def _distance(self, values: Floats) -> Floats:
        return np.hypot(self._goals[:, 0] - values[:, 0], self._goals[:, 1] - values[:, 1])

    def _observed(self, values: Floats) -> NDArray[np.float32]:
        ahead, aside = (self._goals - values[:, 2:4]).T
        cos, sin = np.cos(values[:, 4]), np.sin(values[:, 4])
        permitted = values[:, 5] == _DRIVE
        parts = (cos * ahead + sin * aside, cos * aside - sin * ahead, *values[:, len(_POSES) :].T, permitted)
        return np.clip(np.nan_to_num(np.column_stack(parts)), self._low, self._high).astype(np.float32)

    def _info(self, values: Floats) -> dict[str, Any]:
        distances = self._distance(values)
        causes = np.nan_to_num(values[:, 6]).astype(np.int64)
        return {"distance": distances, "reached": distances < REACHED, "causes": causes}


class GoalEnv(gymnasium.Env):
    """One robot with its goal: the first of a GoalVectorEnv of one."""

    metadata: ClassVar[dict[str, Any]] = {"render_modes": []}

    def __init__(
        self,
        way: str,
        cycles: int = CYCLES,
        params: Params = None,
        urdf: File | None = None,
        scene: File | None = None,
    ) -> None:
        """As GoalVectorEnv."""
        self._many = GoalVectorEnv(way, threads=1, cycles=cycles, params=params, urdf=urdf, scene=scene)
        self.observation_space = self._many.single_observation_space
        self.action_space = self._many.single_action_space

    @property
    def loop(self) -> ClosedLoop:
        """The robot, to be broken or read."""
        return self._many.loops[0]

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Begins an episode."""
        super().reset(seed=seed)
        self._many.randoms[0] = self.np_random
        observations, info = self._many.reset()
        return observations[0], _first(info)

    def step(self, action: NDArray[np.float32]) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Runs `cycles` cycles."""
        observations, rewards, terminated, _, info = self._many.step(np.asarray(action)[None])
        self._many.ended[:] = False  # the caller resets
        return observations[0], float(rewards[0]), bool(terminated[0]), False, _first(info)


def _first(info: dict[str, Any]) -> dict[str, Any]:
    return {name: values[0].item() for name, values in info.items()}


for _id, _way in (("robot_control/Drive-v0", "drive"), ("robot_control/Walk-v0", "walk")):
    gymnasium.register(
        _id,
        entry_point=GoalEnv,
        vector_entry_point=GoalVectorEnv,
        max_episode_steps=MAX_STEPS,
        kwargs={"way": _way},
    )
