"""The law that drives a robot along a path. It reads no clock and needs no ROS.

It is the regulated pure pursuit of S. Macenski, S. Singh, F. Martín, J. Ginés, Regulated pure pursuit for robot path
tracking, Autonomous Robots 47 (2023), doi:10.1007/s10514-023-10097-6. The lookahead point at the distance L along the
path lies at (x_L, y_L) in the robot's axes, turned by π if it drives backwards. The rest of the piece is d:

    κ = 2·y_L/(x_L² + y_L²)                      curvature of the arc to it
    v = min(speed, √(vᵢ² + 2·a·dᵢ), √(a_lateral/|κ|), ω_max/|κ|, √(2·a·d), limit)
    ω = v·κ

`speed` and ω_max are those of the segment on which the robot is, where the path gives some. A slower segment at the
distance dᵢ is entered at its speed vᵢ.

A path is driven in pieces (pieces.py). Between two of them, and at the end, the robot stands and turns on the spot:
ω = ±min(ω_max, √(2·α·|error|)). A path of one point with a heading is such a turn alone.

Three things end a path of any form:

    jump        the pose moves between two messages by more than the measured speeds allow in that time
    off         the nearest point of the piece, from the farthest one reached to the reach of the lookahead, is too far
    in vain     the robot moves without coming nearer to the end of the piece, or of a turn (headway.py). Of the time
                between two messages PERIOD counts at most: in a gap nothing steered, and a simulated machine that had
                to wait did not move
"""

import math
from dataclasses import dataclass
from enum import Enum, auto

from robot_control.drive.path.headway import Headway
from robot_control.drive.path.pieces import Foot, Route
from robot_control.robot.pose import Pose, turned


@dataclass(frozen=True)
class FollowParameters:
    """Parameters of the law; SI units."""

    speed: float = 0.5  # m/s, where the path says none
    max_angular_speed: float = 1.0  # rad/s
    lateral_acceleration: float = 0.3  # m/s²
    deceleration: float = 0.3  # m/s², towards the end of a piece; lower than the robot's own
    angular_deceleration: float = 1.0  # rad/s², at the end of a turn
    lookahead_time: float = 0.5  # s of driving
    shortest_lookahead: float = 0.15  # m
    slowest: float = 0.02  # m/s, rad/s; speed of the last bit of a piece or a turn
    reaction: float = 0.08  # s from a pose to the wheels' answer
    at_end: float = 0.003  # m
    heading_tolerance: float = 0.008  # rad, after a turn
    start_turn: float = 0.25  # rad; a smaller error of the first heading is driven out
    standing: float = 0.01  # m/s and rad/s
    off_path: float = 0.3  # m; a robot farther aside ends the path
    start_distance: float = 0.5  # m; farther from its first point a path is not begun
    jump: float = 0.1  # m; a localisation corrects a pose by less at once
    heading_jump: float = 0.2  # rad; a localisation corrects a heading by less at once
    in_vain: float = 0.15  # m
    turned_in_vain: float = 0.5  # rad
    speed_error: float = 0.1  # share by which a measured speed may exceed that of the poses
    scale_error: float = 0.01  # share by which a length in the path's frame may be shorter than by odometry


class State(Enum):
    """The state of the follower."""

    TURNING = auto()
    DRIVING = auto()
    PAUSED = auto()
    DONE = auto()
    FAILED = auto()


@dataclass(frozen=True)
class Motion:
    """A measured twist, or a commanded one."""

    linear: float = 0.0  # m/s
    angular: float = 0.0  # rad/s
    lateral: float = 0.0  # m/s

    @property
    def speed(self) -> float:
        """m/s"""
        return math.hypot(self.linear, self.lateral)


STAND = Motion()
PERIOD = 0.02
"""s between two odometry messages"""
JUMPED = "odometry was set, or a localisation corrected it by more than a path can follow; start the path again"


class Follower:
    """Follows one path; `step` once per odometry message."""

    def __init__(self, route: Route, parameters: FollowParameters | None = None) -> None:
        self._route = route
        self._parameters = parameters or FollowParameters()
        self._number = 0  # number of the piece; that of the last + 1: the turn to the end heading
        self.state = State.TURNING
        self._settling = True  # a turn first waits until the robot stands
        self._before_pause = State.TURNING
        self._last: tuple[Pose, Motion] | None = None  # pose and command of the step before
        self._reachable = 0.0  # m off the path that are allowed until the robot reaches it
        given = self._parameters
        self._headway = Headway(given.in_vain, given.scale_error)
        self._turning_headway = Headway(given.turned_in_vain, given.scale_error)
        self._driven = 0.0  # m, length of the pieces that are done
        self._along = 0.0  # m, progress on the present piece
        self._strayed = 0.0  # m, motion since the end of the last piece
        self.reason = ""
        self.cross_track_error = 0.0  # m, to the left
        self.heading_error = 0.0  # rad, the robot's heading minus the path's
        self.worst_cross_track_error = 0.0  # m

    @property
    def over(self) -> bool:
        """True when nothing follows."""
        return self.state in {State.DONE, State.FAILED}

    @property
    def distance(self) -> float:
        """m along the path that the robot has reached."""
        return min(max(0.0, self._driven + self._along), self._route.length)

    @property
    def remaining(self) -> float:
        """m"""
        return self._route.length - self.distance

    @property
    def progress(self) -> float:
        """0 … 1"""
        return 1.0 if self.state is State.DONE else self.distance / (self._route.length or math.inf)

    def pause(self) -> None:
        """Stands until `resume` is called."""
        if not self.over and self.state is not State.PAUSED:
            self._before_pause, self.state = self.state, State.PAUSED

    def resume(self) -> None:
        """Goes on from where the robot is."""
        if self.state is State.PAUSED:
            self.state = self._before_pause

    def fail(self, reason: str) -> None:
        """Ends the path with a zero command."""
        if not self.over:
            self.state, self.reason = State.FAILED, reason

    def step(self, pose: Pose, measured: Motion, limit: float = math.inf, elapsed: float = PERIOD) -> Motion:
        """The command for this pose.

        Args:
            pose: of the robot, by odometry.
            measured: its twist.
            limit: m/s that nothing may exceed (SafetyStatus.speed_limit). Below `slowest`, which the controller then
                limits, the command only says where the path goes: the collision guard watches that way.
            elapsed: s since the pose of the last step.
        """
        if not all(map(math.isfinite, (pose.x, pose.y, pose.yaw, measured.linear, measured.angular))):
            self.fail("the odometry holds a number that is not finite")
        moved = STAND
        if not self.over:
            if self._last is None:
                self._begin(pose)
            else:
                moved = self._moved(*self._last, pose, measured, elapsed)
            self._last = pose, measured
        if self.over or self.state is State.PAUSED:
            return STAND
        return self._follow(pose, measured, limit, moved)

    def _follow(self, pose: Pose, measured: Motion, limit: float, moved: Motion) -> Motion:
        if self.state is State.TURNING:
            return self._turn(pose, measured, moved)
        return self._drive(pose, measured, limit, moved.linear)

    def _moved(self, last: Pose, before: Motion, pose: Pose, measured: Motion, elapsed: float) -> Motion:
        """m, rad since the last message. A jump beyond what the faster speed of both allows ends the path."""
        given = self._parameters
        distance = math.dist((last.x, last.y), (pose.x, pose.y))
        angle = abs(turned(pose.yaw - last.yaw))
        if distance > max(before.speed, measured.speed) * elapsed + given.jump:
            self.fail(f"the pose jumped by {distance:.2f} m in {elapsed:.2f} s: {JUMPED}")
        elif angle > max(abs(before.angular), abs(measured.angular)) * elapsed + given.heading_jump:
            self.fail(f"the pose jumped by {math.degrees(angle):.0f} deg in {elapsed:.2f} s: {JUMPED}")
        steered = min(elapsed, PERIOD)
        driven = abs(measured.linear) * steered
        driven = min(driven, max(distance, (1 - given.speed_error) * driven))
        return Motion(math.copysign(driven, measured.linear), measured.angular * steered)

    def _begin(self, pose: Pose) -> None:
        distance = self._reachable = math.dist(self._route.begin, (pose.x, pose.y))
        if distance > self._parameters.start_distance:
            reason = f"the path begins {distance:.2f} m from the robot, more than {self._parameters.start_distance:g} m"
            self.fail(reason)
        elif self._route.pieces:
            heading = self._route.pieces[0].first_heading
            if abs(turned(heading - pose.yaw)) < self._parameters.start_turn:
                self._begin_piece(pose)

    def _begin_piece(self, pose: Pose) -> None:
        """The way back of what a robot strayed while it turned is no motion in vain; that of a jump is."""
        self.state = State.DRIVING
        piece = self._route.pieces[self._number]
        strayed = min(self._strayed, math.dist(piece.points[0], (pose.x, pose.y)))
        self._headway.begin(piece.length + max(self._reachable, strayed))
        self._strayed = 0.0

    def _turn(self, pose: Pose, measured: Motion, moved: Motion) -> Motion:
        given = self._parameters
        self._strayed += abs(moved.linear)
        at_end = self._number == len(self._route.pieces)
        wanted = self._route.end_heading if at_end else self._route.pieces[self._number].first_heading
        error = turned(wanted - pose.yaw)
        self.heading_error = -error
        if self._settling:
            self._turning_headway.begin(abs(error))
            self._settling = abs(measured.linear) >= given.standing
            if self._settling:
                return STAND
        if abs(error) < given.heading_tolerance:
            if abs(measured.angular) < given.standing:
                if at_end:
                    self.state = State.DONE
                else:
                    self._begin_piece(pose)
            return STAND
        if self._turning_headway.step(abs(moved.angular), abs(error)):
            self.fail(f"turned by {given.turned_in_vain:g} rad without coming nearer to its heading")
            return STAND
        left = abs(error) - abs(measured.angular) * given.reaction
        limit = self._turn_limit()
        speed = min(limit, math.sqrt(2 * given.angular_deceleration * max(left, 0.0)))
        return Motion(0.0, math.copysign(max(speed, min(given.slowest, limit)), error))

    def _turn_limit(self) -> float:
        """rad/s on the spot: that of the segment that follows, at the end that of the last one."""
        pieces = self._route.pieces
        if not pieces:
            return min(self._route.turn_speed, self._parameters.max_angular_speed)
        piece = pieces[min(self._number, len(pieces) - 1)]
        at = piece.length if self._number == len(pieces) else 0.0
        return piece.turn_speed_at(at, self._parameters.max_angular_speed)

    def _drive(self, pose: Pose, measured: Motion, limit: float, moved: float) -> Motion:
        given = self._parameters
        piece = self._route.pieces[self._number]
        lookahead = max(given.shortest_lookahead, given.lookahead_time * abs(measured.linear))
        foot = piece.foot(pose.x, pose.y, reach=2 * lookahead + given.off_path)
        self._along = foot.along
        self._note_errors(foot, pose, piece.heading(foot.tangent))
        if self._goes_wrong(foot, piece.length - foot.along, piece.sign * moved):
            return STAND
        reaction = abs(measured.linear) * given.reaction
        left = piece.length - foot.along - reaction
        if piece.length - foot.along <= given.at_end:
            self._driven += piece.length
            self._along = 0.0
            self._number += 1
            self.state, self._settling = State.TURNING, True
            return STAND
        ahead = piece.at(foot.along + lookahead)
        axes = pose.yaw if piece.sign > 0 else pose.yaw + math.pi
        dx, dy = ahead[0] - pose.x, ahead[1] - pose.y
        aside = dy * math.cos(axes) - dx * math.sin(axes)
        curvature = 2 * aside / (dx * dx + dy * dy)
        turn_limit = piece.turn_speed_at(foot.along, given.max_angular_speed)
        speed = min(
            piece.speed_at(foot.along, foot.along + reaction, given.speed, given.deceleration),
            math.sqrt(given.lateral_acceleration / max(abs(curvature), 1e-9)),
            turn_limit / max(abs(curvature), 1e-9),
            math.sqrt(2 * given.deceleration * max(left, 0.0)),
        )
        speed = max(given.slowest, min(speed, limit))
        return Motion(piece.sign * speed, speed * curvature)

    def _goes_wrong(self, foot: Foot, left: float, driven: float) -> bool:
        """True if the robot is off the path or moves in vain; the path has then ended."""
        given = self._parameters
        allowed = max(given.off_path, self._reachable)
        if foot.distance <= given.off_path:
            self._reachable = 0.0
        if foot.distance > allowed:
            self.fail(f"{foot.distance:.2f} m off the path, more than {allowed:g} m")
        elif self._headway.step(driven, left + foot.distance):
            self.fail(f"driven by {given.in_vain:g} m without coming nearer to its end")
        return self.over

    def _note_errors(self, foot: Foot, pose: Pose, heading: float) -> None:
        self.cross_track_error = foot.aside
        self.heading_error = turned(pose.yaw - heading)
        self.worst_cross_track_error = max(self.worst_cross_track_error, abs(foot.aside))
