#pragma once
/// The estimator's state holds all that changes from cycle to cycle and is reset at the beginning of a run.

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

  /// Compares the turn by the wheels with the turn by the gyro over one block.
  struct TurnComparison {
    bool open = false;
    double time = 0, left = 0, right = 0;  ///< s, m
    bool stuck = false;                    ///< The gyro has repeated one sample for longer than kMaxHoldTime.
  };

  // These members read the samples.
  ImuSamples imu_;
  WheelSides wheels_;
  GyroTurn gyro_turn_;

  // These members hold the estimates.
  PlanarCore core_;                        ///< pose of the middle of the wheels, calibration, bias of the gyro about z
  Tilt tilt_;                              ///< tilt and the accelerometer's bias
  std::array<BiasEstimate, 2> gyro_bias_;  ///< rad/s, about x and y
  GyroNoise gyro_noise_;
  double yaw_rate_ = 0;  ///< rad/s, in this step
  double height_ = 0;    ///< m
  double distance_ = 0;  ///< m, always growing
  TurnComparison comparison_;

  // These are published beside the estimates.
  RateTracker rate_;
  WheelVelocities wheel_velocities_;
  WheelOdometry wheel_odometry_;
  std::array<double, kMaxConfidences> nis_{};
  std::array<std::uint64_t, kMaxConfidences> rejected_{};

  // Slip: these axes are those of odom without the corrections of the yaw, which would bend the integrated path.
  SlipDetector slip_detector_;
  WheelSlide slide_;
  double uncorrected_yaw_ = 0;  ///< rad
  Planar uncorrected_step_;     ///< m, path of this step

  // These members describe the rest.
  RestWatch watch_;
  bool resting_ = true;         ///< Nothing is integrated until a window is not quiet.
  HeldMotion open_window_;      ///< the window that is not over yet
  HeldMotion last_window_;      ///< the window before
  bool bias_measured_ = false;  ///< A rest was seen in this run.
  bool rested_ = false;         ///< A rest was seen in this run and is over.
  bool moved_ = false;          ///< The robot moved in this run.

  // These members describe the run.
  bool began_ = false;                   ///< A cycle was seen.
  bool restart_pending_ = false;         ///< The next cycle continues an earlier process.
  std::optional<Vector3> pose_request_;  ///< set at the end of this cycle
  std::optional<Vector3> pose_set_;      ///< set in this cycle
  std::uint64_t cycle_ = 0;
  std::uint64_t skipped_ = 0;
  std::uint64_t flags_ = 0;  ///< flags of this cycle
  std::uint64_t lasting_flags_ = 0;
};

}  // namespace robot_control
