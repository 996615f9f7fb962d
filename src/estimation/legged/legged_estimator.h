#pragma once
/// Estimates the state of a robot on legs while it lies or stands, from joints and IMU.
///
/// attitude   the gyro, less its bias, turns it; the accelerometer corrects roll and pitch with kTilt, or with
///            kTiltAtRest while nothing moves. Yaw is that of the gyro alone
/// bias       the mean of the gyro while nothing moves
/// contact    foot_contacts.h; a foot bears where it is more probable than not
/// position   the mean over the feet that bear of aᵢ − R pᵢ. A foot that begins to bear is anchored at aᵢ = p + R pᵢ. A
///            ball rolls: aᵢ moves with ωᵢ × r u, ωᵢ the rate of the shank
/// height     the ground is level where the robot lies: feet that bear after it lay stand where the first ones of the run
///            stood. While nothing moves and no foot bears, it lies, at zero. A restarted estimator takes its belly's
///            height
/// velocity   the mean over the same feet of r ωᵢ × u − (Jᵢ q̇ᵢ + ω × pᵢ), through a low pass of kSmooth
///
/// While no foot bears and none is asked to, the robot lies on its body or falls: x and y stay. Between two steps it
/// keeps its velocity. The pose begins at zero.
///
/// A contact's slip is the speed of its foot against the mean.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "estimation/legged/feet_motion.h"
#include "estimation/legged/foot_contacts.h"
#include "machine/legs/leg_model.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

class LeggedEstimator {
 public:
  static constexpr double kTilt = 1.5;        ///< s
  static constexpr double kTiltAtRest = 0.3;  ///< s
  static constexpr double kBand = 1.0;        ///< m/s², of |a| about g within which the accelerometer corrects
  static constexpr double kRest = 0.3;        ///< s without motion
  static constexpr double kStill = 0.05;      ///< rad/s, of gyro and joints
  static constexpr double kBiasTime = 0.5;    ///< s
  static constexpr double kSmooth = 0.02;  ///< s

  /// `period` is in s.
  LeggedEstimator(const LegModel& robot, double period);

  void enter_run() noexcept { state_ = {}; }
  /// Continues from the last published frame.
  void resume(const StateFrame& last) noexcept;
  /// x [m], y [m], yaw [rad] of the next frame. The height stays.
  void set_pose(const Vector3& pose) noexcept;
  /// Fills everything but `out.head`. It is real-time safe.
  void step(const SensorFrame& sensors, StateFrame& out) noexcept;

  struct State {
    std::array<double, 4> attitude{0, 0, 0, 1};  ///< x y z w, base → odom
    Vector3 position{};                          ///< m
    Vector3 velocity{};                          ///< m/s, base axes
    Vector3 rate{};                              ///< rad/s, base axes
    Vector3 bias{};                              ///< rad/s, base axes
    Vector3 force{};                             ///< m/s², base axes: the newest specific force
    std::array<Vector3, kLegs> anchors{};        ///< m, odom axes
    FootContacts::State contacts;
    std::array<std::uint64_t, kLegs> bears{};    ///< 1: the foot bears
    std::uint64_t lay = 1;                       ///< 1: no foot has borne since the robot lay
    double ground = 0;                           ///< m, odom axes: height of the centres of feet on the ground
    std::uint64_t grounded = 0;                  ///< 1: `ground` is known
    double still = 0;                            ///< s since anything moved
    double distance = 0;                         ///< m
    std::uint64_t begun = 0;                     ///< 1: the attitude was set by an accelerometer
    std::uint64_t last_cycle = 0;
    std::uint64_t stepped = 0;  ///< 1: last_cycle is that of a step
  };
  const State& state() const noexcept { return state_; }
  void set_state(const State& state) noexcept { state_ = state; }

 private:
  bool turn(const SensorFrame& sensors, double dt) noexcept;
  void correct(const Eigen::Vector3d& force, double dt) noexcept;
  void weigh(const SensorFrame& sensors, const FeetMotion& feet) noexcept;
  void anchor(const FeetMotion& feet) noexcept;
  void move(const SensorFrame& sensors, const FeetMotion& feet, double dt) noexcept;
  void write(const SensorFrame& sensors, const FeetMotion& feet, bool good, StateFrame& out) const noexcept;

  double period_;
  std::array<Leg, kLegs> legs_;
  FootContacts contacts_;
  Eigen::Matrix3d base_from_imu_;
  double belly_ground_ = 0;  ///< m, base axes: height of the centres of feet on the ground on which the belly lies
  State state_;
};

}  // namespace robot_control
