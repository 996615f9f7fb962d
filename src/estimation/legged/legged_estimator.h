#pragma once
/// Estimates the state of a robot on legs from joints, IMU, foot sensors and what was asked of its feet. It owns the
/// state.
///
///   contacts   foot_contacts.h: what each foot bears, and how probably
///   rest       nothing moves: joints slower than kRestRate in the mean over kMeanTime, and a gyro within kRestRate about it,
///              for kRestTime
///   filter     leg_filter.h: feet that stand are landmarks. A foot that bears stands once the velocity of the body that
///              it shows is that of the filter, within kStandGate deviations. Before, it still falls, rolls or slides.
///              At rest the gyro measures its bias, and the velocity is zero. The end of a rest shows late, so that the
///              velocity is hardly known then. A robot whose feet neither bear nor are asked to lies, or falls on its
///              body: its velocity vanishes
///   plain      plain_legs.h. Where feet bear, but none shows the filter's velocity for kDivergenceTime, the filter
///              begins again with roll, pitch and velocity of the plain estimate, and the state is degraded for
///              kDegraded
///   height     ground.h. A robot that lies at rest for kRestTime has its belly on the plane, and the first foot
///              that lands then is on it, too
///
/// The deviations of a contact scale with the length l of a leg. A foot is known to kFootfall l. The ground is as rough
/// as that, and foot and ground give way by as much. The foot creeps as far within √(l/g). While it stands, it moves
/// with kFootSpeed √(l g).
///
/// The pose begins at zero. A contact's slip is the speed of its foot over the ground.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "estimation/legged/feet_motion.h"
#include "estimation/legged/foot_contacts.h"
#include "estimation/legged/ground.h"
#include "estimation/legged/leg_filter.h"
#include "estimation/legged/plain_legs.h"
#include "machine/legs/leg_model.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

class LeggedEstimator {
 public:
  static constexpr double kRestTime = 0.3;        ///< s without motion
  static constexpr double kRestRate = 0.05;       ///< rad/s, of gyro and joints
  static constexpr double kMaxBias = 0.1;         ///< rad/s
  static constexpr double kMeanTime = 0.1;        ///< s, of the means of gyro and joints
  static constexpr double kDivergenceTime = 0.1;  ///< s
  static constexpr double kDegraded = 1.0;        ///< s
  static constexpr double kFootfall = 0.0125;     ///< of a leg's length
  static constexpr double kFootSpeed = 0.04;      ///< of √(l g)
  static constexpr double kStandGate = 6;

  /// `period` is in s.
  LeggedEstimator(const LegModel& robot, double period);

  void enter_run() noexcept;
  /// Continues from the last published frame.
  void resume(const StateFrame& last) noexcept;
  /// x [m], y [m], yaw [rad] of the next frame. The height stays.
  void set_pose(const Vector3& pose) noexcept;
  /// Fills everything but `out.head`. It is real-time safe.
  void step(const SensorFrame& sensors, StateFrame& out) noexcept;

  struct State {
    LegFilter::State filter;
    PlainLegs::State plain;
    FootContacts::State contacts;
    std::array<std::uint64_t, kLegs> stands{};  ///< 1: the foot is a landmark
    Vector3 rate{}, force{};                    ///< rad/s, m/s², base axes: the newest sample
    Vector3 mean_rate{};                        ///< rad/s, base axes
    LegsValues mean_rates{};                    ///< rad/s, of the joints
    Ground::State ground;
    double still = 0;         ///< s since anything moved
    double lies = 0;          ///< s for which no foot bears or is asked to
    std::uint64_t lay = 0;    ///< 1: it lay at rest, and no foot has landed since
    double apart = 0;         ///< s for which no foot that bears shows the filter's velocity
    double degraded = 0;      ///< s left
    double distance = 0;      ///< m
    std::uint64_t begun = 0;  ///< 1: the attitude was set by an accelerometer
    std::uint64_t last_cycle = 0;
    std::uint64_t stepped = 0;  ///< 1: last_cycle is that of a step
  };
  const State& state() const noexcept { return state_; }
  void set_state(const State& state) noexcept { state_ = state; }

 private:
  bool read(const SensorFrame& sensors, double dt) noexcept;
  bool filter(const SensorFrame& sensors, const FeetMotion& feet, double dt) noexcept;
  bool stand(const std::array<bool, kLegs>& bear, const FeetMotion& feet, LegFilter& filter) noexcept;
  void compare(bool lost, double dt) noexcept;
  LegFilter leg_filter() noexcept { return LegFilter(state_.filter); }
  Eigen::Vector3d rate() const noexcept;      ///< rad/s, less its bias
  Eigen::Vector3d velocity() const noexcept;  ///< m/s, of the base's origin, base axes
  Eigen::Vector3d position() const noexcept;  ///< m, of the base's origin
  void set_height(double height) noexcept;
  void write_covariances(BaseState& base) const noexcept;
  void write(const SensorFrame& sensors, const FeetMotion& feet, bool good, StateFrame& out) const noexcept;

  double period_;
  double footfall_;    ///< m, deviation of a foot
  double creep_;       ///< m/√s
  double foot_speed_;  ///< m/s
  std::array<Leg, kLegs> legs_;
  FootContacts contacts_;
  Ground ground_;
  Eigen::Matrix3d base_from_imu_;
  Eigen::Vector3d imu_;      ///< m, base axes
  double belly_ground_ = 0;  ///< m, base axes: height of the centres of feet on the ground on which the belly lies
  State state_;
};

}  // namespace robot_control
