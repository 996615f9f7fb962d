#pragma once
/// The calibration file keeps the calibration of wheels and gyro that the estimator has learned for its next start.
///
///   calibration:
///     robot: "diffbot"
///     wheel_radius: 0.1          # m, of the model; the factors below are relative to model and effective wheel base
///     wheel_base: 0.5            # m, effective
///     initial_radius_ratio: 1    # value of the parameter when the calibration began
///     initial_wheel_base_factor: 1
///     radius_ratio: 1.0062       # and its standard deviation; 0: not estimated, the parameter is used
///     radius_ratio_deviation: 0.0002
///     …                          # wheel_base_factor, wheel_base_deviation; gyro_bias, gyro_bias_deviation: rad/s, IMU
///
/// A file that belongs to another robot or other parameters, is broken or exceeds calibration_bounds.h is refused with
/// all its problems. An estimator that restarted its calibration without a message would be as inaccurate as at its
/// first start.

#include <optional>
#include <string>

#include "estimation/wheeled/estimator_parameters.h"
#include "machine/wheeled/drive_train.h"
#include "signals/state_frame.h"

namespace robot_control {

struct LearnedCalibration {
  WheelCalibration wheels;
  Vector3 gyro_bias{};            ///< rad/s, IMU axes
  Vector3 gyro_bias_deviation{};  ///< rad/s; 0: not estimated
};

/// Returns the calibration in this state.
LearnedCalibration learned(const StateFrame& state);

/// Returns whether any quantity was estimated and all are within the bounds that the reader of the file checks. A
/// wheel's value at its bound is refused, because it was limited, not learned.
bool may_be_kept(const LearnedCalibration& calibration);

/// Copies each quantity of `now` to `kept` that is known better or has moved. Known better: its deviation is smaller by
/// a tenth. Moved: by more than a fifth of its deviation, which is at most 1.5 times that in `kept`. All other
/// quantities stay, because a new run begins with the larger deviations of its parameters. Returns false if nothing was
/// copied.
bool improve(LearnedCalibration& kept, const LearnedCalibration& now);

/// Returns nothing if there is no file yet. Throws ParameterError for a refused file, and if the file could never be
/// written.
std::optional<LearnedCalibration> read_calibration(const std::string& path, const DriveTrain& robot,
                                                   const EstimatorParameters& parameters);

/// Writes the file completely or not at all, also if the machine loses power: a new file takes its name. Throws
/// std::system_error.
void write_calibration(const std::string& path, const LearnedCalibration& calibration, const DriveTrain& robot,
                       const EstimatorParameters& parameters);

/// Standard deviations of the changes between two runs. The radius ratio changes by 0.05 %: another load compresses a
/// wheel of 0.2 m by 0.1 mm. The wheel base changes by 0.3 %: the contact point of a tyre moves by 1.5 mm at 0.5 m. The
/// gyro's bias changes by 0.3 °/s: 20 K at the 0.015 °/s/K of a Bosch BMI088 (data sheet BST-BMI088-DS001, section 1).
inline constexpr double kRadiusRatioChange = 0.0005;
inline constexpr double kWheelBaseChange = 0.003;
inline constexpr double kBiasSwitchOn = 0.0052;  ///< rad/s

/// Returns the parameters with the learned values in place of the initial ones. Deviations grow by the changes between
/// two runs, at most to those of the parameters. A value that the parameters keep constant (deviation 0) stays.
EstimatorParameters continued(const EstimatorParameters& parameters, const LearnedCalibration& calibration);

}  // namespace robot_control
