"""The closed loop in one process, in virtual time: the same C++ classes as the four nodes run.

loop = ClosedLoop()
log = loop.run(seconds=10.0, command=(0.5, 0.2))
log["truth_linear"]  # numpy, one value per cycle
"""

from __future__ import annotations  # help() shows the names of the types

import re
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robot_control._robot_control import ClosedLoop as _ClosedLoop
from robot_control._robot_control import Columns, end_log, log_into
from robot_control.files.files import utf8
from robot_control.loop.roles import DRIVER
from robot_control.settings.parameter_layers import flow_text, layered

File = str | PathLike[str]
Params = File | Mapping[str, Any] | None
Log = dict[str, NDArray[np.float64]]
Twist = tuple[float, float] | tuple[float, float, float]
"""(linear, angular) or (linear, lateral, angular): m/s to the front, m/s to the left, rad/s"""
Command = Callable[[float], Twist] | Twist | None

FEET = ("front_left", "front_right", "rear_left", "rear_right")
_STAY, _LIE, _STAND, _LIFT, _MOVE_JOINTS, _GAIT = range(6)
"""ModeKind of src/signals/velocity_command.h"""
_POSE = (0.0,) * 6
_JOINTS = (0.0,) * 12
_KEPT = ("_path", "_values", "_seed", "_paused", "_running")
"""Attributes that a copy shares and a pickle holds."""


def given_layers(params: Params, urdf: File | None, scene: File | None, drives: File | None) -> tuple[str, list[Any]]:
    """The parameter file and the values laid over it."""
    path, values = layered(params, urdf)
    if scene is not None:
        values.append((f"{DRIVER}.scene", utf8(scene)))
    if drives is not None:
        values.append(("robot.drives", utf8(drives)))
    return path, values


def _index(word: str, words: Sequence[str], what: str) -> int:
    if word not in words:
        raise ValueError(f"unknown {what} {word!r}; set one of {', '.join(words)}")
    return words.index(word)


class ClosedLoop:
    """A robot with its control loop in one process, in virtual time: plant, estimator, controller and safety monitor.

        loop = ClosedLoop(seed=0)
        log = loop.run(seconds=10.0, command=(0.5, 0.2))     # m/s, rad/s
        log["time"], log["truth_linear"], log["estimate_x"]  # numpy arrays, one value per cycle
        loop.units                                           # every column of the log with its unit

    drive it        run, step, command, record
    stop it         e_stop, e_stop_reset, heartbeat, clearance, set_pause, reset
    change it       set_parameters, inject_fault
    move its legs   set_posture, set_gait, body_pose, foot_target, joint_targets
    keep a log      log_into, end_log
    copy it         clone
    read it         scan, robot, units, time, cycle, period, paused, stop_distance, smooth_speed, warning

    The same arguments and calls give the same bits, and the four nodes in lockstep give them, too. A pickle holds the
    arguments and the seed: it makes the same loop again, in any process. `ClosedLoops` runs many at once.

    Args:
        params: path of a YAML file, or a nested dict laid over the installed `config/robot_params.yaml`,
            lists for `left_wheel_joints` and its like; None takes that file as it is.
        seed: of every random number in the plant.
        urdf: path of the robot description; overrides `robot.urdf`.
        scene: path of the MJCF world; overrides `mujoco_plant.scene`.
        drives: path of a drive file (docs/drivers.md): the motors stand behind its drives on a simulated CAN bus;
            overrides `robot.drives`.

    Raises:
        ParameterError: every missing, unknown, mistyped or out-of-range value at once.
        ValueError: a path or another text is not UTF-8.
        RobotError: the robot description cannot be driven.
        DriverError: the scene does not compile.
    """

    def __init__(
        self,
        params: File | Mapping[str, Any] | None = None,
        seed: int = 0,
        urdf: File | None = None,
        scene: File | None = None,
        drives: File | None = None,
    ) -> None:
        """Takes the arguments above."""
        self._running = False
        self._path, self._values = given_layers(params, urdf, scene, drives)
        self._paused = False
        self._seed = seed
        self._columns: dict[tuple[str, ...] | None, Columns] = {}
        self._loop = self._new_loop(seed)

    def clone(self) -> ClosedLoop:
        """Another loop in the same state, which from now on gives the same bits. It writes no log.

        Raises:
            DriverError: simulated drives (`drives`) cannot be copied.
        """
        self._refuse_inside_a_run("clone")
        copy = ClosedLoop.__new__(ClosedLoop)
        copy.__dict__.update({name: self.__dict__[name] for name in (*_KEPT, "_columns")}, _loop=self._loop.clone())
        return copy

    def __copy__(self) -> ClosedLoop:
        return self.clone()

    def __deepcopy__(self, _memo: dict[int, Any]) -> ClosedLoop:
        return self.clone()

    def __getstate__(self) -> dict[str, Any]:
        """The arguments and the seed.

        Raises:
            TypeError: the loop was used since its start.
        """
        if not self._loop.fresh:
            raise TypeError(
                "a ClosedLoop that has run cannot be pickled: a pickle contains only its arguments and its seed. "
                "Pickle it before its first call or after reset(seed); within this process copy it by clone()"
            )
        return {name: self.__dict__[name] for name in _KEPT}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._columns = {}
        self._loop = self._new_loop(self._seed)

    def reset(self, seed: int | None = None) -> None:
        """Puts the robot back to its start, without injected faults; the next cycle is 0.

        Args:
            seed: None: as `mujoco_plant/reset`, a new run with the same random numbers. The other nodes follow:
                estimator, controller and counters restart, commands given before are dropped, a latched stop
                stays, and so does a pause. A number: everything is as after `ClosedLoop(seed=...)`.
        """
        self._refuse_inside_a_run("reset")
        if seed is None:
            self._loop.reset()
            return
        self._paused = False
        self._seed = seed
        self._loop = self._new_loop(seed)

    def _new_loop(self, seed: int) -> _ClosedLoop:
        return _ClosedLoop(self._path, [*self._values, (f"{DRIVER}.seed", str(seed))])

    def set_pause(self, pause: bool) -> None:  # noqa: FBT001 (the service's own form)
        """Pauses as `mujoco_plant/set_pause` does: while paused `step` runs, `run` refuses."""
        self._paused = pause

    def inject_fault(self, component: str, kind: str) -> None:
        """Injects a fault of the machine, as `mujoco_plant/inject_fault` does, or of a node's output, from the next
        cycle on.

        Args:
            component: left_encoder right_encoder left_motor right_motor, of one driven or held joint <joint>_encoder
                <joint>_motor; gyro accelerometer battery e_stop_button controller estimator monitor; with `drives`
                also bus or the address of one, and the joints by name
            kind: ok (ends the fault) off stuck garbage wrong slow delayed intermittent; bus: ok off lossy disturbed; a
                joint's drive: ok off unplugged reset other_zero slipped encoder released hot under_voltage not_finite

        Raises:
            ValueError: an unknown word, with the list of those there are.
        """
        self._loop.inject_fault(utf8(component), utf8(kind))

    def set_parameters(self, values: Mapping[str, Any]) -> None:
        """Sets limits and gains from the next cycle on, as `diff_drive_controller/set_parameter_map`; `reset()` keeps
        them.

        Args:
            values: keys of the block `diff_drive_controller` in SI units, such as
                `{"max_linear_speed": 0.5, "pid_kp": 1.5, "feed_forward": {"mass": 13}}`.

        Raises:
            ParameterError: with every reason; then nothing has changed.
        """
        self._loop.set_parameters(flow_text(values))

    def command(self, linear: float = 0.0, angular: float = 0.0, *, lateral: float = 0.0) -> None:
        """Acts as a message on cmd_vel: linear [m/s], angular [rad/s], of a robot on legs also lateral [m/s], to the
        left. It times out like cmd_vel. A robot that lies stands up first.
        """
        self._loop.command(linear, angular, lateral)

    def set_gait(self, gait: str) -> None:
        """Acts as a call of `set_gait` of a robot on legs, for the commands that follow, until a stop or a reset.

        Args:
            gait: "auto" (the speed chooses), or a gait of docs/legs.md or of the parameters gait_1 … gait_4

        Raises:
            ValueError: another word, with the list of those there are.
        """
        index = _index(gait, self._loop.gaits, "gait")
        self._loop.choose_mode((_GAIT if index else _STAY, index))

    def set_posture(self, posture: str) -> None:
        """Acts as a call of `set_posture` of a robot on legs.

        Args:
            posture: "standing" or "lying"

        Raises:
            ValueError: another word.
        """
        kind = (_LIE, _STAND)[_index(posture, ("lying", "standing"), "posture")]
        self._loop.request(_POSE, (kind, 0), _JOINTS)

    def body_pose(
        self,
        *,
        x: float = 0.0,
        y: float = 0.0,
        height: float = 0.0,
        roll: float = 0.0,
        pitch: float = 0.0,
        yaw: float = 0.0,
    ) -> None:
        """Acts as a message on body_pose of a robot on legs: m and rad from the nominal pose. It times out like one."""
        self._loop.request((x, y, height, roll, pitch, yaw), (_STAY, 0), _JOINTS)

    def foot_target(self, foot: str, *, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> None:
        """Acts as a message on foot_target of a robot on legs.

        Args:
            foot: front_left, front_right, rear_left or rear_right
            x: m, to the front of where it stood
            y: m, to the left
            z: m, above the ground

        Raises:
            ValueError: another foot.
        """
        self._loop.request((x, y, z, 0.0, 0.0, 0.0), (_LIFT, _index(foot, FEET, "foot")), _JOINTS)

    def joint_targets(self, positions: ArrayLike) -> None:
        """Moves the joints of a robot on legs that lies, as `joint_trajectory` does.

        They are there 0.1 s later, as far as range, speed and acceleration allow. To follow a path, call it every few
        cycles with the place 0.1 s ahead.

        Args:
            positions: rad, shape (12,), in the order of `robot["joints"]`

        Raises:
            ValueError: another shape.
        """
        angles = np.asarray(positions, dtype=float)
        if angles.shape != (len(_JOINTS),):
            raise ValueError(f"positions must have the shape ({len(_JOINTS)},), not {angles.shape}")
        self._loop.request(_POSE, (_MOVE_JOINTS, 0), angles.tolist())

    def e_stop(self) -> None:
        """Acts as a call of `e_stop_trigger`: the robot brakes, and the stop is latched."""
        self._loop.e_stop()

    def e_stop_reset(self) -> None:
        """Acts as a call of `e_stop_reset`; it is accepted only at standstill with zero command."""
        self._loop.e_stop_reset()

    def heartbeat(self) -> None:
        """Acts as a message on `heartbeat`."""
        self._loop.heartbeat()

    def clearance(self, metres: float) -> None:
        """Acts as a message on `clearance`: the free distance ahead, m."""
        self._loop.clearance(metres)

    def step(self, cycles: int = 1, columns: Sequence[str] | None = None) -> Log:
        """Runs `cycles` cycles; returns their log, arrays of shape (cycles,), or these columns of it."""
        return self._run(cycles, None, columns)

    def run(self, seconds: float, command: Command = None, columns: Sequence[str] | None = None) -> Log:
        """Runs for `seconds` of simulated time. Other Python threads run meanwhile unless `command` is a function.

        Args:
            seconds: s, rounded to whole cycles.
            command: called with the time [s] of each cycle, gives (linear [m/s], angular [rad/s]), each as
                if just received; of a robot on legs also (linear, lateral [m/s], angular); or one such tuple for
                every cycle; or None: the last `command`, which times out like cmd_vel.
            columns: names of the columns that are returned; None: all. A few are much faster than all in runs of a
                few cycles.

        Returns:
            Column name → float array of shape (cycles,); NaN where a node published nothing. Units: `units`.

        Raises:
            RuntimeError: the loop is paused.
            ValueError: an unknown column.
        """
        if self._paused:
            raise RuntimeError("paused: call set_pause(False), or step(cycles)")
        return self._run(round(seconds / self.period), command, columns)

    def _run(self, cycles: int, command: Command, columns: Sequence[str] | None) -> Log:
        self._refuse_inside_a_run("step and run")
        self._running = True
        try:
            return self._loop.run(cycles, command, self._chosen(columns))
        finally:
            self._running = False

    def _chosen(self, names: Sequence[str] | None) -> Columns:
        key = None if names is None else tuple(names)
        if key not in self._columns:
            self._columns[key] = self._loop.choose(key)
        return self._columns[key]

    def record(self, commands: NDArray[np.float64]) -> Log:
        """Drives one cycle per row of `commands`, shape (cycles, 2): linear m/s, angular rad/s, as if received in it;
        NaN sends nothing.

        Returns:
            Arrays of one row per cycle, wheels left to right. Measured: `time` s, `wheel_position` (·, wheels) rad,
            `gyro` (·, 3) rad/s and `accel` (·, 3) m/s² in IMU axes. Truth: `position` (·, 3) m and `orientation`
            (·, 4) x y z w of the base from where it was at cycle 0, z the ground's normal; `linear` m/s and `angular`
            rad/s (·, 3) in base axes; `wheel_speed` (·, wheels) rad/s; `slip` (·, wheels) m/s of the contact patch over
            the ground; `load` (·, wheels) N. `stopped`: 1 where the safety monitor brakes, else 0.
        """
        self._refuse_inside_a_run("record")
        return self._loop.record(commands)

    def log_into(self, folder: File) -> None:
        """Writes every cycle from the next one on to `folder`/run.bag, as the node `telemetry` does, until `end_log`.

        An earlier run.bag is kept as run.1.bag, ...

        Raises:
            RunLogError: it cannot be written.
        """
        self._refuse_inside_a_run("log_into")
        log_into(self._loop, utf8(folder))

    def end_log(self) -> None:
        """Completes run.bag.

        Raises:
            RunLogError: the disk did not take every cycle.
        """
        self._refuse_inside_a_run("end_log")
        end_log(self._loop)

    def _refuse_inside_a_run(self, what: str) -> None:
        if self._running:
            raise RuntimeError(f"{what} cannot be called from the command function of a run")

    def scan(self) -> dict[str, Any]:
        """Measures with the laser (`mujoco_plant.laser`) in the last cycle, with the bits that the plant publishes.

        Returns:
            `ranges`, float32 array of shape (rays,), m: +inf where nothing came back, -inf nearer than `range_min`.
            Ray i points along `angle_min` + i * `angle_increment` [rad] in the axes of the link `link`. `range_min` and
            `range_max` m, `cycle`, `stamp_ns` ns.

        Raises:
            ValueError: there is no laser.
            RuntimeError: it is called from the command function of a run.
        """
        self._refuse_inside_a_run("scan")
        return self._loop.scan()

    def stop_distance(self, speed: float, *, emergency: bool = False) -> float:
        """Distance [m] to rest that the limits predict, straight on from a steady `speed` [m/s]. It counts from the
        cycle that takes the command and includes the delay until its torque acts
        (control/common/limits/stop_distance.h). With `emergency` the deceleration is that after a timeout.
        """
        return self._loop.stop_distance(speed, emergency)

    @property
    def smooth_speed(self) -> float:
        """Speed [m/s] of a rim below which wheels may start with a jerk, behind encoders of
        `state_estimator.encoder_noise` (control/wheeled/smooth_speed.h).
        """
        return self._loop.smooth_speed

    @property
    def warning(self) -> str:
        """The machine's own warning, as in `/diagnostics`, such as a drive in fault with its remedy; "" without one."""
        return self._loop.warning

    @property
    def paused(self) -> bool:
        """The last value that `set_pause` set."""
        return self._paused

    @property
    def time(self) -> float:
        """Time [s] of the next sample."""
        return self._loop.time

    @property
    def cycle(self) -> int:
        """Number of the next cycle."""
        return self._loop.cycle

    @property
    def period(self) -> float:
        """Duration [s] of a cycle."""
        return self._loop.period

    @property
    def robot(self) -> dict[str, Any]:
        """The robot as it was understood, SI units, base axes: `wheels`, `casters`, `joints`, `mass`,
        `centre_of_gravity`, `wheel_base`, `wheel_base_multiplier`, `imu`, `shapes` and `notes`. The notes name what was
        assumed, repaired or ignored. `inspect_robot.py` prints it.
        """
        return self._loop.robot

    @property
    def units(self) -> dict[str, str]:
        """Column name → unit, or the name of the enum or the bits that an integer column holds."""
        return {name: re.split("[,;]", meaning)[0] for name, meaning in self._loop.columns}
