#pragma once
/// record returns the measured samples of a drive and the true motion, for the offline evaluation of estimators.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "simulation/closed_loop.h"

namespace robot_control {

/// Drives `loop` for one cycle per row (linear m/s, angular rad/s) of `commands`, as if the command arrived in this
/// cycle. A row of NaN sends nothing. Returns arrays with one row per cycle. Wheels are in the order of the robot's
/// (left ones first), base and IMU in their own axes, the pose in the frame of TruthFrame:
///   time s
///   measured:  wheel_position (N, wheels) rad   gyro (N, 3) rad/s   accel (N, 3) m/s²
///   truth:     position (N, 3) m   orientation (N, 4) x y z w   linear (N, 3) m/s   angular (N, 3) rad/s
///              wheel_speed (N, wheels) rad/s   slip (N, wheels) m/s, of TruthFrame   load (N, wheels) N
///   stopped    1 while the safety monitor permits no motion, else 0
/// Throws std::invalid_argument if the shape of `commands` is not (N, 2).
pybind11::dict record(ClosedLoop& loop, const pybind11::array_t<double>& commands);

}  // namespace robot_control
