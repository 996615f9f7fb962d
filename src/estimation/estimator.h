#pragma once
/// state_estimator's law: sensors of one cycle → state of that cycle. Planar: x, y, yaw; REP 103, REP 105.
///
///   encoders ─► travel ──┬────────────────► distance ─┐
///                        └─► turn of the wheels ─┐    ├─► exact arc ─► pose, covariance
///   gyro ─► trapezoid over [k−1, k] − bias ──────┴► fusion ─► turn
///   all quiet ─► standstill: the bias is learned; otherwise it is frozen and its variance grows
///
/// Distance comes from the wheels, yaw from both (yaw_fusion.h). z, roll and pitch are not estimated: they are
/// zero, with kPlanarVariance (1 cm, 0.6°, an even floor) as an assumption on the diagonal.
///
/// A sample that is missing, not finite or impossible is not used (kStateBadSample). Without encoders the pose
/// is held, and the next good reading brings the whole travel; held for more than kMaxHeld cycles, the state is
/// no longer kStateValid. Without gyro yaw comes from the wheels (kStateNoGyro). A frame of a cycle that is not
/// newer gives the last state again.
///
/// Confidence: both encoders and gyro have that of the yaw fusion when both were used; encoders alone 1 (nothing
/// contradicts them); accelerometer exp(−((|a| − g) / 1 m/s²)² / 2), |a| smoothed: it is used at standstill only.

#include <cstdint>
#include <optional>

#include "estimation/estimator_parameters.h"
#include "estimation/pose_covariance.h"
#include "estimation/speed_tracker.h"
#include "estimation/standstill_window.h"
#include "estimation/wheel_encoders.h"
#include "estimation/wheel_geometry.h"
#include "estimation/yaw_fusion.h"
#include "robot/robot_model.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

class Estimator {
 public:
  static constexpr std::uint64_t kMaxHeld = 4;       ///< cycles, as many as a command lives (hal/gate.h)
  static constexpr double kPlanarVariance = 1.0e-4;  ///< m², rad²
  static constexpr double kGyroRange = 100;          ///< rad/s; beyond what any MEMS gyro measures
  static constexpr double kRestartPosition = 0.05;   ///< m, standard deviation added by a restart
  static constexpr double kRestartYaw = 0.05;        ///< rad

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

  /// The same with samples that come at any time: `dt` [s] after the last one, > 0; the head's cycle only counts.
  void step(const SensorFrame& sensors, double dt, StateFrame& out) noexcept;

 private:
  struct GyroSample {
    bool good = false;
    Vector3 rate{};  ///< rad/s, IMU axes
    double yaw = 0;  ///< rad/s, base z, bias included
  };

  void count_cycles(std::uint64_t cycle) noexcept;
  void read_gyro(const SensorFrame& sensors) noexcept;
  void read_accelerometer(const SensorFrame& sensors) noexcept;
  void travel(const SensorFrame& sensors) noexcept;
  void learn(const SensorFrame& sensors) noexcept;
  void lose_travel(double time) noexcept;
  void clear_gap() noexcept;
  double bias_yaw() const noexcept;
  void fill_twist(StateFrame& out) const noexcept;
  void fill(StateFrame& out) const noexcept;

  EstimatorParameters parameters_;
  double period_;
  WheelGeometry geometry_;
  Vector3 up_in_imu_;  ///< base z in IMU axes: yaw rate = up_in_imu · rate

  WheelEncoders encoders_;
  SpeedTracker left_speed_;
  SpeedTracker right_speed_;
  YawFusion fusion_;
  PoseCovariance covariance_;
  StandstillWindow standstill_;

  double x_ = 0, y_ = 0, yaw_ = 0;
  double distance_ = 0;
  Vector3 bias_{};
  GyroSample gyro_;
  bool accelerometer_good_ = false;
  double gravity_;  ///< m/s², smoothed |a|

  bool began_ = false;     ///< a cycle of this run was seen
  bool anchored_ = false;  ///< the encoders' offset is known
  std::optional<Vector3> pose_pending_;
  bool restart_pending_ = false;
  std::uint64_t cycle_ = 0;
  std::uint64_t cycles_ = 0;  ///< from the last frame to this one
  std::uint64_t skipped_ = 0;
  std::uint64_t flags_ = 0;  ///< of this cycle
  std::uint64_t lasting_flags_ = 0;

  std::uint64_t gap_cycles_ = 0;  ///< since the encoders were last believed
  double gap_turn_ = 0;           ///< rad, gyro with bias, over the gap
  double gap_variance_ = 0;       ///< rad²
  bool gap_gyro_ = true;          ///< no gyro sample is missing in the gap
};

}  // namespace robot_control
