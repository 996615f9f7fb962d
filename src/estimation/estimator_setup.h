#pragma once
/// What a user sets and what the robot is → what the estimator's parts start with.

#include "estimation/estimator_parameters.h"
#include "estimation/filter/error_state_filter.h"
#include "estimation/inertial/standstill_window.h"
#include "estimation/simple/simple_part.h"
#include "estimation/wheels/wheel_geometry.h"
#include "robot/robot_model.h"

namespace robot_control {

/// Throws std::invalid_argument: a parameter or a measure of the robot out of range, a side without a wheel, an
/// orientation of the IMU that is no rotation.
const EstimatorParameters& checked(const EstimatorParameters& parameters, const RobotModel& robot, double period);

ContactGeometry contact_geometry(const WheelGeometry& wheels, const RobotModel& robot, double creep);
FilterNoise filter_noise(const EstimatorParameters& parameters, const RobotModel& robot);

/// Without self_calibration ratio and wheel base are known for ever.
FilterPrior filter_prior(const EstimatorParameters& parameters);

StandstillLimits standstill_limits(const EstimatorParameters& parameters, const RobotModel& robot);

SimplePartParams simple_part(const EstimatorParameters& parameters, const RobotModel& robot);

}  // namespace robot_control
