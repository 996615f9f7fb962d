#pragma once
/// state_estimator's law: sensors of one cycle → state of that cycle. REP 103, REP 105.
///
///   encoders ─► travel of either side ─┬─► planar core ─► pose, calibration, covariance
///   gyro ──────────────────────────────┤        ▲ explicit, bounded correction of the path
///   accelerometer, tilt filter ────────┴─► slip statistic ─► slide
///
/// The pose is wheels for the distance and gyro for the heading (planar/planar_core.h). The accelerometer enters it by
/// the tilt, which shortens the distance, and the creep of tyres, parts of a percent; else only while slip is proven
/// (slip/slip_statistic.h, slip/slip_correction.h), and then within bounds.
///
/// At rest (rest/rest_watch.h) nothing is integrated: pose and covariance stay, the gyro's bias and the tilt
/// (tilt/tilt.h) are learned; until the first rest is over the pose is corrected by that bias, too. Every run begins at
/// rest. A window that turns out not to be quiet is integrated at once, with the one before.
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
/// kStateDegraded, with a reason: kDegradedHeading, the gyro's bias is known no better than 2e-3 rad/s, which is so
/// before the first rest; kDegradedPosition, the correction of a slide was not believable and was taken back.
///
/// Confidence of a sensor: 0 not used, else min(1, 1/nis), nis smoothed over kSmoothing.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "estimation/estimator_parameters.h"
#include "estimation/inertial/imu_samples.h"
#include "estimation/inertial/rate_tracker.h"
#include "estimation/planar/planar_core.h"
#include "estimation/rest/gyro_noise.h"
#include "estimation/rest/rest_watch.h"
#include "estimation/slip/slip_correction.h"
#include "estimation/slip/slip_statistic.h"
#include "estimation/tilt/tilt.h"
#include "estimation/wheels/side_encoder.h"
#include "estimation/wheels/speed_tracker.h"
#include "estimation/wheels/stamp_jitter.h"
#include "estimation/wheels/wheel_geometry.h"
#include "estimation/wheels/wheel_velocities.h"
#include "robot/robot_model.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

inline constexpr double kPlanarVariance = 1.0e-4;  ///< m², rad²: 1 cm, 0.6°, an even floor

class Estimator {
 public:
  static constexpr std::uint64_t kMaxHeld = 4;  ///< cycles without encoders, as many as a command lives (hal/gate.h)
  static constexpr double kRestartPosition = 0.05;  ///< m, standard deviation added by a restart
  static constexpr double kRestartYaw = 0.05;       ///< rad
  static constexpr double kSmoothing = 1.0;         ///< s
  static constexpr double kLongestGap = 0.2;        ///< s between gyro samples through which a straight line is drawn

  /// `period`: s, > 0. Throws std::invalid_argument: a parameter or a measure of the robot out of range, a
  /// side without a wheel.
  Estimator(const EstimatorParameters& parameters, const RobotModel& robot, double period);

  /// A new run: the first sample is the offset of the encoders, the pose starts at zero.
  void enter_run() noexcept;

  /// After a restart within a run: continue from the last frame published, covariance grown: by the restart
  /// constants and by what the last twist travels in the cycles between. A frame that is not finite or was
  /// never valid is not continued from.
  void resume(const StateFrame& last) noexcept;

  /// reset_odometry: the pose is zero from this cycle on (exactly zero in the next frame); velocities, biases
  /// and distance stay.
  void reset_pose() noexcept { set_pose({0, 0, 0}); }

  /// set_odometry: from this cycle on the pose is (x [m], y [m], yaw [rad]), exactly so in the next frame, with a
  /// covariance of zero; all else stays.
  void set_pose(const Vector3& pose) noexcept { pose_pending_ = pose; }

  /// Fills everything but `out.head`. dt = (sensors.head.cycle − the last one's) · period.
  void step(const SensorFrame& sensors, StateFrame& out) noexcept;

  /// The same with samples that come at any time: `dt` [s] after the last one, > 0; the head's cycle does not count.
  void step(const SensorFrame& sensors, double dt, StateFrame& out) noexcept;

 private:
  static constexpr std::size_t kLeft = 0;  ///< index into sides_
  static constexpr std::size_t kRight = 1;

  struct Side {
    SideEncoder encoder;
    SpeedTracker speed;
    double turned = 0;    ///< rad, since its last reading
    double credited = 0;  ///< m, that the other side rolled for it while it was lost
  };

  /// Of a window at rest that may belong to the next motion.
  struct Held {
    double time = 0;             ///< s
    Vector3 turn{};              ///< rad, base axes, bias included
    double left = 0, right = 0;  ///< m
    bool gyro = true;

    void add(const Held& other) noexcept {
      time += other.time;
      left += other.left;
      right += other.right;
      for (std::size_t i = 0; i < turn.size(); ++i) turn[i] += other.turn[i];
      gyro = gyro && other.gyro;
    }
  };

  /// Wheels' turn against the gyro's, over a while.
  struct Block {
    bool open = false;
    double time = 0, left = 0, right = 0;  ///< s, m
  };

  /// Travel of the middle of the wheels over about the clock offset: one reading alone is a poor speed where stamps
  /// jitter or counts are few.
  struct Recent {
    double way = 0, time = 0;  ///< m, s

    void add(double travel, double dt, double span) noexcept {
      const double keep = span / (span + dt);
      way = keep * way + travel;
      time = keep * time + dt;
    }
    double speed() const noexcept { return time > 0 ? way / time : 0; }  ///< m/s
  };

  /// Of the middle of the wheels.
  struct Travel {
    double distance = 0;  ///< m
    double before = 0;    ///< rad, by which the heading was less halfway
  };

  /// From the core's pose to that of now, and what of it is in proportion to the clock offset.
  struct Lead {
    double distance = 0, turn = 0;  ///< m, rad
    double speed = 0, rate = 0;     ///< m/s, rad/s
  };

  void advance(const SensorFrame& sensors, double dt) noexcept;
  void read(const SensorFrame& sensors, double dt) noexcept;
  void follow_wheels() noexcept;
  const Eigen::Vector3d& gyro_now() const noexcept;
  void follow_rate(double dt) noexcept;
  double wheel_speed() const noexcept;  ///< m/s, mean of both sides
  double wheel_rate() const noexcept;   ///< rad/s, as the model's wheel base has it
  Lead ahead() const noexcept;
  double forward_speed() const noexcept;
  bool lost(std::size_t side) const noexcept;
  bool both_read() const noexcept;

  void rest(double dt) noexcept;
  void end_rest() noexcept;
  void begin_rest() noexcept;
  void learn_at_rest() noexcept;
  bool slides_at_rest() noexcept;
  RestWindow watch_rest(double dt) noexcept;

  void move(double dt) noexcept;
  void turn_tilt(const Vector3& gyro, double dt) noexcept;
  double turn(double dt) noexcept;
  std::optional<double> gyro_turn(double dt) noexcept;
  void roll() noexcept;
  void go(const Travel& travel) noexcept;
  std::array<double, 2> tyres_creep(double distance) const noexcept;
  bool in_a_batch() noexcept;
  void watch_slip(double dt, double turned) noexcept;
  void follow_slide() noexcept;
  void judge_slip() noexcept;
  void correct(const SlipCorrection::Step& correction) noexcept;
  SlipCorrection::Known known() const noexcept;
  void compare_turns(double dt) noexcept;
  void note(SensorIndex sensor, double nis, double dt) noexcept;
  Vector3 in_base(const Vector3& imu) const noexcept;
  Planar axle(double yaw) const noexcept;
  Eigen::Matrix3d of_middle(const StateFrame& frame) const noexcept;
  void place(const Vector3& pose) noexcept;

  void fill(StateFrame& out) const noexcept;
  void fill_pose(StateFrame& out) const noexcept;
  double wheels_late() const noexcept;
  void fill_pose_covariance(double yaw, const Planar& lever, StateFrame& out) const noexcept;
  void fill_twist(StateFrame& out) const noexcept;
  void fill_learned(StateFrame& out) const noexcept;
  void fill_health(StateFrame& out) const noexcept;

  EstimatorParameters parameters_;
  double period_;
  WheelGeometry geometry_;
  Eigen::Matrix3d base_from_imu_;
  double encoder_ = 0;  ///< m, deviation of a reading
  PlanarCore fresh_core_;
  Tilt fresh_tilt_;
  SlipStatistic fresh_slip_;

  ImuSamples imu_;
  RateTracker rate_;
  double rate_noise_gain_;  ///< RateTracker::noise_gain
  WheelVelocities wheel_velocities_;
  std::array<Side, 2> sides_;
  PlanarCore core_;
  Tilt tilt_;
  RestWatch watch_;
  GyroNoise gyro_noise_;
  SlipStatistic slip_;
  SlipCorrection slide_;

  std::array<double, 2> gyro_bias_{};      ///< rad/s, x and y; z is the core's
  std::array<double, 2> gyro_variance_{};  ///< (rad/s)²
  bool gyro_learned_ = false;              ///< since the reset a rest was seen
  bool moved_ = false;                     ///< since the reset
  bool rested_once_ = false;               ///< likewise, and the rest was over
  double height_ = 0;                      ///< m
  double own_yaw_ = 0;                     ///< rad, of the slip statistic's axes
  Planar own_way_;                         ///< m, of this step, in these axes
  Block block_;
  Recent recent_;
  StampJitter jitter_;      ///< of the wheels' readings
  double usual_gap_ = 0;    ///< s, between two readings of the wheels
  double last_sample_ = 0;  ///< rad/s, of the gyro about z
  double silence_ = 0;      ///< s, since a gyro was lost
  double silent_turn_ = 0;  ///< rad, by the wheels since then
  double turning_ = 0;      ///< rad/s

  bool rate_follows_ = false;             ///< `rate_` tracks
  bool resting_ = true;                   ///< nothing is integrated until the window breaks
  Held held_;                             ///< not over yet
  Held kept_;                             ///< the one before
  std::uint64_t distrusted_windows_ = 0;  ///< quiet ones in a row in which it seems to slide
  WheelOdometry wheels_;
  double distance_ = 0;
  double shortened_ = 0;  ///< m, of the distance, by slopes
  std::array<double, kMaxConfidences> nis_{};
  std::array<std::uint64_t, kMaxConfidences> rejected_{};

  bool began_ = false;  ///< a cycle of this run was seen
  std::optional<Vector3> pose_pending_;
  std::optional<Vector3> placed_;  ///< the pose that was set in this cycle
  bool restart_pending_ = false;
  std::uint64_t cycle_ = 0;
  std::uint64_t skipped_ = 0;
  std::uint64_t flags_ = 0;  ///< of this cycle
  std::uint64_t lasting_flags_ = 0;
};

}  // namespace robot_control
