#pragma once
/// state_estimator's law: sensors of one cycle → state of that cycle. REP 103, REP 105.
///
///   encoders ─► travel of either side ─┬─► planar core ─► pose, calibration, covariance
///   gyro ──────────────────────────────┤        ▲ explicit, bounded correction of the path
///   accelerometer, tilt filter ────────┴─► slip detector ─► slide
///
/// The pose is wheels for the distance and gyro for the heading (planar/planar_core.h). The accelerometer enters it by
/// the tilt, which shortens the distance, and the creep of tyres, parts of a percent; else only while slip is proven
/// (slip/slip_detector.h, slip/wheel_slide.h), and then within bounds. Slip widens the covariance.
///
/// At rest (rest/rest_watch.h) nothing is integrated: pose and covariance stay, the gyro's bias and the tilt
/// (tilt/tilt.h) are learned; until the first rest is over the pose is corrected by that bias, too. Every run begins at
/// rest. A window that turns out not to be quiet is integrated at once, with the one before. A run that begins in
/// motion is wheels and gyro until it rests, where a turn drags wheels: no slide is corrected, for the accelerometer's
/// bias is not known, either, and wheels do not show the gyro's (planar/planar_core.h).
///
/// Samples may come at any rate. One that is not finite or impossible is not used (kStateBadSample, which also states
/// that encoders are missing in this cycle), and the last one holds: for three times the gap between the last two,
/// within kShortestHold … kLongestHold. Beyond that the sensor is lost, and its flag is set:
///   gyro            yaw comes from the wheels, by the calibration learned so far
///   accelerometer   tilt and slip of all wheels together are not noticed
///   one encoder     gyro and the other side continue
///   both encoders, or one and the gyro: no longer kStateValid. The next good reading brings the whole travel.
/// A frame of a cycle that is not newer gives the last state again.
///
/// The angular velocity of the twist is the gyro's, less its bias, behind a tracking loop (rate_tracker.h); pose and
/// biases follow every sample.
///
/// kStateDegraded, with a reason: kDegradedHeading, the gyro's bias is known no better than kUnknownBias, which is
/// so before the first rest, or wheels and gyro contradicted each other since the last rest; kDegradedPosition, wheels
/// slip.
///
/// Confidence of a sensor: 0 not used, else min(1, 1/nis), nis smoothed over kBlock.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "estimation/estimator_parameters.h"
#include "estimation/estimator_state.h"
#include "estimation/tuning.h"
#include "estimation/wheels/wheel_geometry.h"
#include "robot/robot_model.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

class Estimator : private EstimatorState {
 public:
  /// `period`: s, > 0. Throws std::invalid_argument: a parameter or a measure of the robot out of range, a
  /// side without a wheel.
  Estimator(const EstimatorParameters& parameters, const RobotModel& robot, double period);

  /// A new run: the first sample is the offset of the encoders, the pose starts at zero.
  void enter_run() noexcept { static_cast<EstimatorState&>(*this) = fresh_; }

  /// After a restart within a run: continue from the last frame published, covariance grown: by the restart
  /// constants and by what the last twist travels in the cycles between. A frame that is not finite or was
  /// never valid is not continued from.
  void resume(const StateFrame& last) noexcept;

  /// set_odometry, reset_odometry: from this cycle on the pose is (x [m], y [m], yaw [rad]), exactly so in the next
  /// frame, with a covariance of zero; all else stays.
  void set_pose(const Vector3& pose) noexcept { pose_request_ = pose; }

  /// Fills everything but `out.head`. dt = (sensors.head.cycle − the last one's) · period.
  void step(const SensorFrame& sensors, StateFrame& out) noexcept;

  /// The same with samples that come at any time: `dt` [s] after the last one, > 0; the head's cycle does not count.
  void step(const SensorFrame& sensors, double dt, StateFrame& out) noexcept;

 private:
  static constexpr std::size_t kLeft = WheelSides::kLeft;
  static constexpr std::size_t kRight = WheelSides::kRight;

  /// From the core's pose, which is that of the sensor that is late by the clock offset, to the present one.
  struct Prediction {
    double distance = 0, turn = 0;  ///< m, rad
  };

  void advance(const SensorFrame& sensors, double dt) noexcept;
  void read(const SensorFrame& sensors, double dt) noexcept;
  void integrate_wheels() noexcept;
  void follow_rate(double dt) noexcept;
  void place(const Vector3& pose) noexcept;
  Prediction prediction() const noexcept;
  double forward_speed() const noexcept;  ///< m/s, of the middle of the wheels
  Eigen::Vector3d gyro_bias() const noexcept;
  Eigen::Vector3d gyro_bias_variance() const noexcept;
  Vector3 in_base(const Vector3& imu) const noexcept;
  Planar axle(double yaw) const noexcept;

  // estimator_rest.cpp
  void rest(double dt) noexcept;
  void begin_rest() noexcept;
  void end_rest() noexcept;
  void learn_at_rest() noexcept;
  void learn_gyro_bias(const Vector3& mean, double window) noexcept;
  RestWindow watch_rest(double dt) noexcept;

  // estimator_motion.cpp
  void move(double dt) noexcept;
  void turn_tilt(const Eigen::Vector3d& gyro, double dt) noexcept;
  double turn(double dt) noexcept;
  void advance_path(const WheelSides::Travel& travel) noexcept;
  std::array<double, 2> tyres_creep(double distance) const noexcept;
  void watch_slip(double dt, double turned) noexcept;
  void end_slide() noexcept;
  void judge_slip() noexcept;
  void correct(const WheelSlide::Correction& correction) noexcept;
  WheelSlide::Input slide_input() const noexcept;
  void compare_turns(double dt) noexcept;
  void begin_comparison() noexcept;
  void note(SensorIndex sensor, double nis, double dt) noexcept;

  // estimator_output.cpp
  void fill(StateFrame& out) const noexcept;
  void fill_pose(StateFrame& out) const noexcept;
  double wheels_late() const noexcept;
  void fill_pose_covariance(double yaw, const Planar& lever, StateFrame& out) const noexcept;
  void fill_attitude_covariance(double yaw, double yaw_variance, StateFrame& out) const noexcept;
  void fill_twist(StateFrame& out) const noexcept;
  void fill_twist_covariance(double yaw_rate, StateFrame& out) const noexcept;
  void fill_learned(StateFrame& out) const noexcept;
  void fill_health(StateFrame& out) const noexcept;
  Eigen::Matrix3d covariance_of_middle(const StateFrame& frame) const noexcept;

  EstimatorParameters parameters_;
  double period_;
  WheelGeometry geometry_;
  Eigen::Matrix3d base_from_imu_;
  double encoder_;          ///< m, deviation of one side's reading
  double rate_noise_gain_;  ///< RateTracker::noise_gain
  bool drags_wheels_;       ///< estimator_setup.h
  EstimatorState fresh_;    ///< at the beginning of a run
};

}  // namespace robot_control
