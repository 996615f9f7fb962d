#pragma once
/// What a user sets and what the robot is → what the estimator's parts start with.

#include "estimation/estimator_parameters.h"
#include "estimation/planar/planar_core.h"
#include "estimation/rest/rest_watch.h"
#include "estimation/slip/motion_difference.h"
#include "estimation/tilt/tilt.h"
#include "estimation/wheels/wheel_geometry.h"
#include "robot/robot_model.h"

namespace robot_control {

/// Throws std::invalid_argument: a parameter or a measure of the robot out of range, a side without a wheel, an
/// orientation of the IMU that is no rotation.
const EstimatorParameters& checked(const EstimatorParameters& parameters, const RobotModel& robot, double period);

/// m, standard deviation of one side's reading.
double encoder_deviation(const EstimatorParameters& parameters, const RobotModel& robot);

/// m, standard deviation of where along x the robot turns: wherever between the first and the last axle its load puts
/// it. Where the wheels' places are not known, the length between the axles is that which the multiplier of the wheel
/// base follows from (RobotModel::wheel_base_multiplier).
double icr_deviation(const RobotModel& robot);
/// A turn drags wheels over the floor: those behind each other, and tracks. Where nothing but wheel radius and base is
/// known (no bodies) there may be such.
bool drags_wheels(const RobotModel& robot);

/// Without self_calibration ratio and wheel base are known for ever.
PlanarCoreParams core_params(const EstimatorParameters& parameters, const RobotModel& robot);
TiltParams tilt_params(const EstimatorParameters& parameters);
RestWatchParams rest_params(const EstimatorParameters& parameters, const RobotModel& robot);
SlipParams slip_params(const EstimatorParameters& parameters, const RobotModel& robot);

}  // namespace robot_control
