#pragma once
/// These functions derive the parameters of the estimator's parts from the user's parameters and the robot.

#include "estimation/common/tilt/tilt.h"
#include "estimation/wheeled/estimator_parameters.h"
#include "estimation/wheeled/planar/planar_core.h"
#include "estimation/wheeled/rest/rest_watch.h"
#include "estimation/wheeled/slip/slip_watch.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

/// Returns `parameters`. Throws std::invalid_argument if a parameter or a measure of the robot is out of range. A side
/// without a wheel and an IMU orientation of norm 0 are refused, too.
const EstimatorParameters& checked(const EstimatorParameters& parameters, const DriveTrain& robot, double period);

/// Returns the standard deviation of one side's reading, in m.
double encoder_deviation(const EstimatorParameters& parameters, const DriveTrain& robot);

/// Returns the standard deviation of the x of the centre of rotation, in m. The load puts that centre anywhere between
/// the first and the last axle. If the places of the wheels are not known, the wheel base's multiplier gives the length
/// between the axles (DriveTrain::wheel_base_multiplier): B_eff = B + L²/B. Of a robot that is given as radius and
/// effective base alone, L is at most B_eff/2.
double icr_deviation(const DriveTrain& robot);
/// Returns true if a turn drags wheels over the floor: wheels behind each other, tracks, or bodies that are unknown.
bool drags_wheels(const DriveTrain& robot);

/// Without self_calibration the radius ratio and the wheel base are held.
PlanarCoreParams core_params(const EstimatorParameters& parameters, const DriveTrain& robot);
TiltParams tilt_params(const EstimatorParameters& parameters);
RestWatchParams rest_params(const EstimatorParameters& parameters, const DriveTrain& robot);
SlipParams slip_params(const EstimatorParameters& parameters, const DriveTrain& robot);

}  // namespace robot_control
