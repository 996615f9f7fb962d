#pragma once

#include <optional>
#include <string>

#include "parameters/block.h"

namespace robot_control {

/// Variances along x, y, z in m² or m²/s², and about x, y, z in rad² or rad²/s².
using CovarianceDiagonal = NumberList<6>;

/// Rates and frame names of the published topics; they have no effect on the loop. Their keys are in the block of the
/// node that publishes.
struct ReportParameters {
  double joint_states_rate = 100;  ///< Hz
  double odom_rate = 50;           ///< Hz, odom and wheel_odom
  bool publish_tf = true;
  std::string odom_frame = "odom";
  std::string base_frame;  ///< empty: the robot's root link, so that no frame gets two parents (REP 105)
  std::optional<CovarianceDiagonal> pose_covariance_diagonal;   ///< for odom; none: as estimated
  std::optional<CovarianceDiagonal> twist_covariance_diagonal;  ///< for odom; none: as estimated
  double command_rate = 50;    ///< Hz, joint_commands, joint_targets, cmd_vel_out and drive_state
  double leg_state_rate = 50;  ///< Hz, leg_state
  double imu_rate = 100;       ///< Hz, imu/data_raw
  double imu_data_rate = 100;  ///< Hz, imu/data
  double truth_rate = 50;      ///< Hz
};

inline Keys plant_keys(ReportParameters& report) {
  return {
      {"imu_rate", &report.imu_rate, "Hz", 0.1, 2000, kPublishRate},
      {"truth_rate", &report.truth_rate, "Hz", 0.1, 2000, kPublishRate},
  };
}

inline Keys estimator_keys(ReportParameters& report) {
  return {
      {"joint_states_rate", &report.joint_states_rate, "Hz", 0.1, 2000, kPublishRate},
      {"odom_rate", &report.odom_rate, "Hz", 0.1, 2000, kPublishRate},
      {"imu_rate", &report.imu_data_rate, "Hz", 0.1, 2000, kPublishRate},
      {"publish_tf", &report.publish_tf},
      {"odom_frame", &report.odom_frame},
      {"base_frame", &report.base_frame, {}, 0, 0, kMayBeEmpty},
      {"pose_covariance_diagonal", &report.pose_covariance_diagonal, {}, 0, 1e9, kOptional},
      {"twist_covariance_diagonal", &report.twist_covariance_diagonal, {}, 0, 1e9, kOptional},
  };
}

inline Keys leg_control_keys(ReportParameters& report) {
  return {{"state_rate", &report.leg_state_rate, "Hz", 0.1, 2000, kPublishRate}};
}

inline Keys controller_keys(ReportParameters& report) {
  return {{"command_rate", &report.command_rate, "Hz", 0.1, 2000, kPublishRate}};
}

}  // namespace robot_control
