#pragma once
/// state_estimator's law: sensors of one cycle → state of that cycle. REP 103, REP 105.
///
///   encoders ─► travel of either side ─┐
///   gyro, accelerometer ─► base axes ──┼─► error-state filter ─► pose, twist, covariances, biases, calibration
///   contact, standstill ───────────────┘        ▲     │
///                                          slip watch ◄┘
///
/// At rest (standstill_window.h) nothing is integrated: pose and covariance stay, the biases and the tilt are learned.
/// What happens in a window that turns out not to be quiet is made good at once. Every run begins so. Wheels that stand
/// under a gyro that reads the same rate for kSteadyTime are those of a robot at rest whose gyro bias is another one
/// than assumed.
///
/// Samples may come at any rate. One that is not finite or impossible is not used (kStateBadSample, which says, too,
/// that encoders are missing in this cycle), and the last one holds: for three times the gap between the last two,
/// within kShortHold … kLongHold. Beyond that the sensor is lost, and its flag is set:
///   gyro            yaw comes from the wheels, by the calibration learned so far
///   accelerometer   tilt and slip of all wheels together are not noticed
///   one encoder     gyro and the other side continue
///   both encoders, or one and the gyro: no longer kStateValid. The next good reading brings the whole travel.
/// A frame of a cycle that is not newer gives the last state again.
///
/// The angular velocity of the twist is the gyro's, less its bias, behind a tracking loop (rate_tracker.h); pose and
/// biases follow every sample.
///
/// Beside it runs the simple part (simple/simple_part.h). Where both disagree beyond what both can explain, and no slip
/// is proven, the simple part's pose and twist are published (kStateDegraded, simple/supervision.h).
///
/// Confidence of a sensor: 0 not used, else min(1, 1/nis), nis smoothed over kSmoothing.

#include <array>
#include <cstdint>
#include <optional>

#include "estimation/estimator_parameters.h"
#include "estimation/filter/error_state_filter.h"
#include "estimation/filter/state_output.h"
#include "estimation/inertial/imu_samples.h"
#include "estimation/inertial/rate_tracker.h"
#include "estimation/inertial/standstill_window.h"
#include "estimation/simple/simple_part.h"
#include "estimation/simple/supervision.h"
#include "estimation/wheels/side_encoder.h"
#include "estimation/wheels/slip_watch.h"
#include "estimation/wheels/speed_tracker.h"
#include "estimation/wheels/wheel_geometry.h"
#include "estimation/wheels/wheel_velocities.h"
#include "robot/robot_model.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

class Estimator {
 public:
  static constexpr std::uint64_t kMaxHeld = 4;  ///< cycles without encoders, as many as a command lives (hal/gate.h)
  static constexpr double kRestartPosition = 0.05;  ///< m, standard deviation added by a restart
  static constexpr double kRestartYaw = 0.05;       ///< rad
  static constexpr double kSmoothing = 1.0;         ///< s
  static constexpr double kSteadyTime = 10.0;       ///< s; nothing turns a robot so evenly on wheels that stand
  static constexpr double kSettling = 2.0;          ///< s of rest in which yaw still learns from the gyro's bias
  static constexpr double kRestSpeed = 0.01;        ///< m/s, standard deviation of the velocity when rest ends
  static constexpr std::uint64_t kMaxRefused = 50;  ///< encoder readings in a row behind the gate, then restart

  /// `period`: s, > 0. Throws std::invalid_argument: a parameter or a measure of the robot out of range, a
  /// side without a wheel.
  Estimator(const EstimatorParameters& parameters, const RobotModel& robot, double period);

  /// A new run: the first sample is the offset of the encoders, the pose starts at zero.
  void reset() noexcept;

  /// After a restart within a run: continue from the last frame published, covariance grown: by the restart
  /// constants and by what the last twist travels in the cycles between. A frame that is not finite or was
  /// never valid is not continued from.
  void resume(const StateFrame& last) noexcept;

  /// reset_odometry: the pose is zero from this cycle on (exactly zero in the next frame); velocities, biases
  /// and distance stay.
  void reset_pose() noexcept { set_pose({0, 0, 0}); }

  /// set_odometry: from this cycle on the pose is (x [m], y [m], yaw [rad]), exactly so in the next frame, with a
  /// covariance of zero; all else stays.
  void set_pose(const Vector3& pose) noexcept;

  /// Fills everything but `out.head`. dt = (sensors.head.cycle − the last one's) · period.
  void step(const SensorFrame& sensors, StateFrame& out) noexcept;

  /// The same with samples that come at any time: `dt` [s] after the last one, > 0; the head's cycle does not count.
  void step(const SensorFrame& sensors, double dt, StateFrame& out) noexcept;

 private:
  static constexpr int kLeft = 0;  ///< index into sides_
  static constexpr int kRight = 1;

  struct Side {
    SideEncoder encoder;
    SpeedTracker speed;
    double total = 0;  ///< m, all travel of this run
    double ahead = 0;  ///< m, taken as travelled since its last reading
    std::uint64_t refused = 0;
    bool trusted = true;
  };

  /// Of a window at rest that is not over yet.
  struct Held {
    double time = 0;                                 ///< s
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();  ///< rad, base axes, bias included
    double forward = 0;                              ///< m
    double wheel_turn = 0;                           ///< rad
    bool gyro = true;
  };

  void advance(const SensorFrame& sensors, double dt) noexcept;
  void read(const SensorFrame& sensors, double dt) noexcept;
  void follow_wheels() noexcept;
  double wheel_speed() const noexcept;  ///< m/s, mean of both sides
  double wheel_rate() const noexcept;   ///< rad/s, as the model's wheel base has it
  void rest(double dt) noexcept;
  void end_rest() noexcept;
  void learn_at_rest() noexcept;
  bool quiet() const noexcept;
  WindowEnd watch_rest(double dt, double left, double right) noexcept;  ///< travel of this step, m
  Eigen::Vector3d gyro_at_rest() const noexcept;  ///< rad/s, mean of the last window, less what the wheels turned
  bool bias_changed() noexcept;
  void move(double dt) noexcept;
  double rolled(int side, double dt) noexcept;  ///< m in this step; between two readings as the filter moves
  bool lost(int side) const noexcept;
  void correct(double dt) noexcept;
  void correct_side(int side, double dt) noexcept;
  void note(SensorIndex sensor, double nis, double dt) noexcept;
  void fill(StateFrame& out) const noexcept;
  void follow_rate(double dt) noexcept;
  void follow_simply(double dt) noexcept;
  void supervise(double dt) noexcept;
  FullEstimate full_estimate() const noexcept;
  void renew() noexcept;   ///< the full law begins again where the simple part is
  void accept() noexcept;  ///< the full law's pose is the simple part's
  void place_at(const PlanarTrack& track) noexcept;
  void place_simply() noexcept;  ///< the simple part is where the full law is
  PlanarPose base_of(const PlanarPose& middle) const noexcept;
  void fill_simply(StateFrame& out) const noexcept;
  RateNoise rate_noise() const noexcept;
  void fill_health(StateFrame& out) const noexcept;

  EstimatorParameters parameters_;
  double period_;
  WheelGeometry geometry_;
  Eigen::Matrix3d base_from_imu_;
  ErrorStateFilter filter_;
  SlipWatch slip_;
  StandstillWindow standstill_;
  ImuSamples imu_;
  RateTracker rate_;
  double rate_noise_gain_;  ///< RateTracker::noise_gain
  WheelVelocities wheel_velocities_;
  std::array<Side, 2> sides_;
  SimplePart simple_;
  Supervision supervision_;

  bool rate_follows_ = false;  ///< `rate_` tracks the filter's rate
  bool resting_ = true;        ///< nothing is integrated until the window breaks
  Held held_;
  Eigen::Vector3d steady_gyro_ = Eigen::Vector3d::Zero();  ///< rad/s, of windows that contradict the gyro's bias
  double steady_time_ = 0;                                 ///< s, of these windows
  std::uint64_t distrusted_windows_ = 0;                   ///< quiet ones in a row that contradict the velocity
  double rested_ = 0;                                      ///< s
  WheelOdometry wheels_;
  double distance_ = 0;
  std::array<double, kMaxConfidences> nis_{};
  std::array<std::uint64_t, kMaxConfidences> rejected_{};

  bool began_ = false;  ///< a cycle of this run was seen
  std::optional<Vector3> pose_pending_;
  bool restart_pending_ = false;
  std::uint64_t cycle_ = 0;
  std::uint64_t skipped_ = 0;
  std::uint64_t flags_ = 0;  ///< of this cycle
  std::uint64_t lasting_flags_ = 0;
};

}  // namespace robot_control
