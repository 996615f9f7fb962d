#pragma once
/// Rules on parameters and robot together, checked by every composition of the loop before it starts.

#include <string>

#include "configuration/parameters.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// Throws ParameterError with every problem: whatever control_problems.h refuses.
void require_drivable(const Parameters& parameters, const DriveTrain& robot);

/// rad, the count of a wheel's encoder that `encoder_noise` stands for, uniform over it.
double encoder_count(const EstimatorParameters& estimator) noexcept;

/// One sentence on the speed of smooth_speed.h behind these encoders, below which the robot does not drive smoothly.
/// Empty if that speed is at most kSlowRim.
std::string note_on_slow_driving(const Parameters& parameters, const DriveTrain& robot);
inline constexpr double kSlowRim = 0.05;  ///< m/s, hardly ever commanded

}  // namespace robot_control
