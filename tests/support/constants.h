#pragma once
/// Numbers that the tests of several folders share.

#include <limits>

namespace robot_control {

inline constexpr double kPeriod = 1e-3;  ///< s, of a robot.rate of 1000
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace robot_control
