#pragma once
/// The estimator computes the state of a cycle from the sensors of that cycle (REP 103, REP 105).
///
///   encoders ─► travel of either side ─┬─► planar core ─► pose, calibration, covariance
///   gyro ──────────────────────────────┤        ▲ variance
///   accelerometer, tilt filter ────────┴─► slip watch
///
/// The wheels give the distance. Gyro and wheels give the heading, weighed by their deviations from the first metre on
/// (planar/planar_core.h). The accelerometer shortens the distance by parts of a percent: it shows the tilt and the
/// creep of tyres. Slip, and a robot that is blocked, are named and widen the covariance (slip/slip_watch.h). They move
/// no path.
///
/// At rest (rest/rest_watch.h) nothing is integrated: pose and covariance stay. The gyro's bias and the tilt
/// (tilt/tilt.h) are learned. The first rest also corrects the pose. A run begins at rest. A window that turns out not
/// to be quiet is integrated at once, together with the one before. No slip is named before the first rest,
/// because the accelerometer's bias is not known then. Neither is that of wheels with readings more than kSlowWheels
/// apart.
///
/// Samples may come at any rate. A sample that is not finite or impossible is not used and sets kStateBadSample. A
/// sensor that is lost sets its flag (inertial/imu_samples.h, wheels/wheel_sides.h):
///   gyro            the wheels turn the robot, by the calibration learned so far
///   accelerometer   tilt and slip of all wheels together are not noticed
///   one encoder     gyro and the other side continue
///   both encoders, or one and the gyro: kStateValid is cleared. A lost side counts as standing in twist and pose, whose
///                   deviations are its last speed and its way. The next good reading brings the whole travel.
/// A drive that had a fault and then no position may have another zero. If the other side did not replace its travel,
/// the deviation of the position grows by the last speed times that time.
///
/// kStateDegraded has two possible reasons. In kDegradedPosition wheels slip. In kDegradedHeading the deviation of the
/// gyro's bias exceeds kUnknownBias, or wheels and gyro contradict each other (planar/planar_core.h). The confidence of
/// a sensor is 0 while it is not used, else min(1, 1/nis), with nis smoothed over kBlock.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "estimation/common/inertial/bias_estimate.h"
#include "estimation/common/inertial/gyro_turn.h"
#include "estimation/common/inertial/imu_samples.h"
#include "estimation/common/inertial/rate_tracker.h"
#include "estimation/common/tilt/tilt.h"
#include "estimation/wheeled/estimator_parameters.h"
#include "estimation/wheeled/planar/planar_core.h"
#include "estimation/wheeled/planar/turn_comparison.h"
#include "estimation/wheeled/rest/robot_rest.h"
#include "estimation/wheeled/slip/slip_watch.h"
#include "estimation/wheeled/wheels/middle_travel.h"
#include "estimation/wheeled/wheels/wheel_geometry.h"
#include "estimation/wheeled/wheels/wheel_sides.h"
#include "machine/wheeled/drive_train.h"
#include "machine/wheeled/wheels/wheel_slip.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

class Estimator {
 public:
  /// Holds all that changes from cycle to cycle. Each part has its own state and one step; Estimator::advance hands the
  /// values on from part to part. It is trivially copyable.
  struct State {
    State(const EstimatorParameters& parameters, const DriveTrain& robot, double period);

    // These parts read the samples. Beside them are the readings of this step.
    ImuSamples imu_samples;
    WheelSides wheel_sides;
    ImuReading imu;
    WheelReading wheels;

    // These parts hold the estimates.
    GyroTurn gyro_turn;
    MiddleTravel middle_travel;
    PlanarCore core;  ///< pose of the middle of the wheels, calibration, bias of the gyro about z
    TurnComparison comparison;
    Tilt tilt;                              ///< tilt and the accelerometer's bias
    std::array<BiasEstimate, 2> gyro_bias;  ///< rad/s, about x and y
    RestNoise gyro_noise;
    SlipWatch slip;
    RobotRest rest;
    double yaw_rate = 0;  ///< rad/s, in this step
    double height = 0;    ///< m
    double distance = 0;  ///< m, always growing

    // These are published beside the estimates.
    RateTracker rate;
    WheelOdometry wheel_odometry;
    std::array<double, kWheeledSensors> nis{};
    std::array<std::uint64_t, kWheeledSensors> rejected{};

    // These members describe the run.
    bool began = false;                   ///< A cycle was seen.
    bool restarted = false;               ///< The run continues an earlier process.
    bool restart_pending = false;         ///< The next cycle is the first one of that.
    std::optional<Vector3> pose_request;  ///< set at the end of this cycle
    std::optional<Vector3> pose_set;      ///< set in this cycle
    std::uint64_t cycle = 0;
    std::uint64_t skipped = 0;
    std::uint64_t flags = 0;  ///< flags of this cycle
  };

  /// `period` is in s and > 0. Throws std::invalid_argument for a value out of range, and for a side without a wheel.
  Estimator(const EstimatorParameters& parameters, const DriveTrain& robot, double period);

  /// Give and replace the state, for snapshots (signals/law_snapshot.h).
  const State& state() const noexcept { return state_; }
  void set_state(const State& state) noexcept { state_ = state; }

  /// Begins a new run: the first sample is the offset of the encoders, and the pose is zero.
  void enter_run() noexcept { state_ = fresh_; }

  /// Continues from the last published frame after a restart within a run. The covariance grows by the restart
  /// constants and by the last twist's way in the missed cycles. A frame that is not finite or not valid is ignored.
  void resume(const StateFrame& last) noexcept;

  /// Requests the pose (x [m], y [m], yaw [rad]) for the services set_odometry and reset_odometry. The next frame has
  /// exactly this pose, with a covariance of zero. All else stays.
  void set_pose(const Vector3& pose) noexcept { state_.pose_request = pose; }

  /// Fills everything but `out.head`. The time step is (cycle − last cycle) · period.
  void step(const SensorFrame& sensors, StateFrame& out) noexcept;

  /// Does the same for samples at any time, `dt` [s] > 0 after the last one. The cycle of the head is ignored.
  void step(const SensorFrame& sensors, double dt, StateFrame& out) noexcept;

 private:
  static constexpr std::size_t kLeft = 0, kRight = 1;

  /// Holds the motion from the core's pose, which is that of the sensor that is late, to the present pose.
  struct Prediction {
    double distance = 0, turn = 0;  ///< m, rad
  };

  void advance(const SensorFrame& sensors, double dt) noexcept;
  void read(const SensorFrame& sensors, double dt) noexcept;
  void lose_travel(double time) noexcept;  ///< s
  void integrate_wheels() noexcept;
  void move(double dt) noexcept;
  void turn_tilt(const Vector3& gyro, double dt) noexcept;
  void roll(const MiddleTravel::Travel& travel) noexcept;
  void watch_slip(double dt, double travel) noexcept;
  void compare_turns(double dt, bool by_gyro) noexcept;
  void watch_rest(double dt) noexcept;
  void integrate(const HeldMotion& held, bool stood) noexcept;
  void learn_at_rest(const RestWatch::Means& means, bool bias_changed) noexcept;
  void place(const Vector3& pose) noexcept;
  void smooth_nis(SensorIndex sensor, double nis, double dt) noexcept;

  Prediction prediction() const noexcept;
  double forward_speed() const noexcept;  ///< m/s, of the middle of the wheels
  double wheel_rate() const noexcept;     ///< rad/s, by the wheels
  Planar tyres_creep(double distance) const noexcept;
  Eigen::Vector3d gyro_bias() const noexcept;
  Eigen::Vector3d gyro_bias_variance() const noexcept;

  // These functions are in estimator_output.cpp.
  void fill(const SensorFrame& sensors, StateFrame& out) const noexcept;
  void fill_pose(BaseState& base) const noexcept;
  double late_wheels() const noexcept;
  void fill_pose_covariance(const Turn& yaw, const Planar& lever, BaseState& base) const noexcept;
  void fill_attitude_covariance(const Turn& yaw, double yaw_variance, BaseState& base) const noexcept;
  void fill_twist(BaseState& base) const noexcept;
  void fill_twist_covariance(double yaw_rate, BaseState& base) const noexcept;
  void fill_learned(StateFrame& out) const noexcept;
  void fill_health(StateFrame& out) const noexcept;
  Planar axle(const Turn& yaw) const noexcept;

  EstimatorParameters parameters_;
  double period_;
  WheelGeometry geometry_;
  WheelSlip wheel_slip_;
  Eigen::Matrix3d base_from_imu_;
  double encoder_;  ///< m, deviation of one side's reading
  State state_;
  State fresh_;  ///< state at the beginning of a run
};

}  // namespace robot_control
