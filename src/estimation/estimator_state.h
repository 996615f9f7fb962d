#pragma once
/// All that the estimator knows: what changes from cycle to cycle and begins afresh with every run.

#include <array>
#include <cstdint>
#include <optional>

#include "estimation/estimator_parameters.h"
#include "estimation/inertial/gyro_turn.h"
#include "estimation/inertial/imu_samples.h"
#include "estimation/inertial/rate_tracker.h"
#include "estimation/planar/planar_core.h"
#include "estimation/rest/bias_estimate.h"
#include "estimation/rest/gyro_noise.h"
#include "estimation/rest/held_motion.h"
#include "estimation/rest/rest_watch.h"
#include "estimation/slip/slip_detector.h"
#include "estimation/slip/wheel_slide.h"
#include "estimation/tilt/tilt.h"
#include "estimation/wheels/wheel_sides.h"
#include "estimation/wheels/wheel_velocities.h"
#include "robot/robot_model.h"
#include "signals/state_frame.h"

namespace robot_control {

class EstimatorState {
 protected:
  EstimatorState(const EstimatorParameters& parameters, const RobotModel& robot, double period);

  /// Wheels' turn against the gyro's, over one block.
  struct TurnComparison {
    bool open = false;
    double time = 0, left = 0, right = 0;  ///< s, m
    bool stuck = false;                    ///< The gyro repeated one sample for longer than kLongestHold.
  };

  // Samples.
  ImuSamples imu_;
  WheelSides wheels_;
  GyroTurn gyro_turn_;

  // Estimates.
  PlanarCore core_;                        ///< pose of the middle of the wheels, calibration, bias of the gyro about z
  Tilt tilt_;                              ///< and the accelerometer's bias
  std::array<BiasEstimate, 2> gyro_bias_;  ///< rad/s, about x and y
  GyroNoise gyro_noise_;
  double yaw_rate_ = 0;  ///< rad/s, of this step
  double height_ = 0;    ///< m
  double distance_ = 0;  ///< m, always growing
  TurnComparison comparison_;

  // What is published beside them.
  RateTracker rate_;
  WheelVelocities wheel_velocities_;
  WheelOdometry wheel_odometry_;
  std::array<double, kMaxConfidences> nis_{};
  std::array<std::uint64_t, kMaxConfidences> rejected_{};

  // Slip. Its axes are odom's but for the corrections of the yaw, which would bend a path that is integrated twice.
  SlipDetector slip_detector_;
  WheelSlide slide_;
  double uncorrected_yaw_ = 0;  ///< rad
  Planar uncorrected_step_;     ///< m, path of this step

  // Rest.
  RestWatch watch_;
  bool resting_ = true;         ///< nothing is integrated until a window is not quiet
  HeldMotion open_window_;      ///< not over yet
  HeldMotion last_window_;      ///< the one before
  bool bias_measured_ = false;  ///< a rest was seen in this run
  bool rested_ = false;         ///< likewise, and it was over
  bool moved_ = false;          ///< in this run

  // The run.
  bool began_ = false;                   ///< a cycle was seen
  bool restart_pending_ = false;         ///< the next cycle continues an earlier process
  std::optional<Vector3> pose_request_;  ///< to be set at the end of this cycle
  std::optional<Vector3> pose_set_;      ///< was set in this cycle
  std::uint64_t cycle_ = 0;
  std::uint64_t skipped_ = 0;
  std::uint64_t flags_ = 0;  ///< of this cycle
  std::uint64_t lasting_flags_ = 0;
};

}  // namespace robot_control
