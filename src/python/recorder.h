#pragma once
/// What a drive measured, beside what really happened: the data that estimators are judged by, offline.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "simulation/closed_loop.h"

namespace robot_control {

/// Drives `loop`, one cycle per row (linear m/s, angular rad/s) of `commands`, as if received in it; a row of NaN
/// sends nothing. Returns arrays of one row per cycle, in the order of the robot's wheels (left ones first), of the
/// base and the IMU in their own axes, of the pose in the frame of TruthFrame:
///   time s
///   measured:  wheel_position (N, wheels) rad   gyro (N, 3) rad/s   accel (N, 3) m/s²
///   truth:     position (N, 3) m   orientation (N, 4) x y z w   linear (N, 3) m/s   angular (N, 3) rad/s
///              wheel_speed (N, wheels) rad/s   slip (N, wheels) m/s, of TruthFrame   load (N, wheels) N
///   stopped    1 where the safety monitor lets nothing pass, else 0
/// Throws std::invalid_argument: `commands` has another shape than (N, 2).
pybind11::dict record(ClosedLoop& loop, const pybind11::array_t<double>& commands);

}  // namespace robot_control
