#pragma once
/// What state_estimator learned of wheels and gyro, kept over the end of its process.
///
///   calibration:
///     robot: "diffbot"
///     wheel_radius: 0.1          # m, of the model: what the factors below are relative to
///     wheel_base: 0.5            # m, effective
///     initial_radius_ratio: 1    # what the parameters said when this began
///     initial_wheel_base_factor: 1
///     radius_ratio: 1.0062       # and its standard deviation; 0: not estimated, so the parameter holds
///     radius_ratio_deviation: 0.0002
///     …                          # wheel_base_factor, wheel_base_deviation; gyro_bias, gyro_bias_deviation: rad/s, IMU
///
/// A file that is of another robot or other parameters, broken or beyond calibration_bounds.h is refused, with all that
/// is wrong with it: an estimator that silently restarted its calibration would be as inaccurate as on the first day,
/// without a message.

#include <optional>
#include <string>

#include "estimation/estimator_parameters.h"
#include "robot/robot_model.h"
#include "signals/state_frame.h"

namespace robot_control {

struct LearnedCalibration {
  WheelCalibration wheels;
  Vector3 gyro_bias{};            ///< rad/s, IMU axes
  Vector3 gyro_bias_deviation{};  ///< rad/s; 0: not estimated
};

/// Of this state.
LearnedCalibration learned(const StateFrame& state);

/// Something of it was estimated, and all of it is within the bounds that the reader holds it to. What stands at a
/// bound was stopped there, not learned.
bool may_be_kept(const LearnedCalibration& calibration);

/// Takes over, quantity by quantity, what `now` says better than `kept`: with a deviation smaller by a tenth, or moved
/// by a fifth of one that is at most half as large again. The rest stays: a new run begins with the deviations of its
/// parameters and must not wipe out what was known. False: nothing was taken over.
bool improve(LearnedCalibration& kept, const LearnedCalibration& now);

/// Nothing when there is no file yet. Throws ParameterError, see above; also where it could never be written.
std::optional<LearnedCalibration> read_calibration(const std::string& path, const RobotModel& robot,
                                                   const EstimatorParameters& parameters);

/// Whole or not at all, also if the machine loses power: a new file beside it takes its name. Throws std::system_error.
void write_calibration(const std::string& path, const LearnedCalibration& calibration, const RobotModel& robot,
                       const EstimatorParameters& parameters);

/// What a night adds, as standard deviations. Tyres: 0.05 % of the ratio, 0.1 mm of compression of a wheel of 0.2 m
/// under another load; 0.3 % of the base, 1.5 mm of where a tyre touches at 0.5 m. Gyro: 0.3 °/s, 20 K at the 0.015
/// °/s/K of a Bosch BMI088 (data sheet BST-BMI088-DS001, section 1).
inline constexpr double kRatioWear = 0.0005;
inline constexpr double kBaseWear = 0.003;
inline constexpr double kBiasSwitchOn = 0.0052;  ///< rad/s

/// The parameters with what was learned in place of the initial values. Deviations grow by what a night adds, never
/// beyond the parameters' own; what these hold for ever (deviation 0) stays.
EstimatorParameters continued(const EstimatorParameters& parameters, const LearnedCalibration& calibration);

}  // namespace robot_control
