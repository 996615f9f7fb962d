#pragma once
/// What happens to the body: IMU and contact sensors → conditions.
///
///   tilt       angle between up (attitude.h) and the base's z axis > limit
///   tip over   tilt > half the limit of tilt, and growing faster than limit
///   free fall  |a| < limit
///   impact     |a − g u| > limit
///   lift       Σ F·u < limit · m g, where there are contact sensors; m RobotModel::mass
///   IMU stuck  all axes of gyro or of accelerometer are bit for bit those of the last sample, while the wheels turn.
///              Noise changes the last bits of every fresh sample; an IMU slower than the loop repeats itself for less
///              than any persistence. At standstill exact sensors rest, too.
///
/// a the accelerometer's specific force, u up, base axes. A zero pose in which the base's z axis does not point up is
/// nothing that is known here: a robot that leans at rest leans.
///
/// In a curve the accelerometer leans outwards for as long as it lasts, 0.2 rad at 1 m/s and 2 rad/s, and more where it
/// sits far out. Attitude is told of that: c = ω × (v x̂ + ω × r), v the mean rim speed of the wheels, r the IMU from
/// the middle of the axles. What is left: wheels that slip by Δv, Δv ω/g while they do so; a turn's beginning, Δω r/(g
/// T).
///
/// A sample that is missing, not valid or not finite tells nothing: its facts are not beyond their limits.

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "robot/robot_model.h"
#include "safety/active_causes.h"
#include "safety/attitude.h"
#include "safety/condition_watch.h"
#include "safety/safety_parameters.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class BodyFacts {
 public:
  /// `period` s.
  BodyFacts(const SafetyParameters& parameters, const RobotModel& robot, double period);

  /// A new run: nothing is known.
  void enter_run() noexcept;

  /// Once per cycle; `elapsed` cycles since the last one, ≥ 1. Adds what is active to `out`.
  void step(const SensorFrame& sensors, std::uint64_t elapsed, bool wheels_turn, ActiveCauses& out) noexcept;

  // Intermediates of the last step.
  const Attitude& attitude() const noexcept { return attitude_; }
  double shock() const noexcept { return shock_; }         ///< m/s², |a − g u|; 0 without a sample
  double carried() const noexcept { return carried_; }     ///< of the weight, on the wheels; 1 without contact sensors
  double force() const noexcept { return force_.norm(); }  ///< m/s², |a|, of the last good sample

 private:
  struct Wheel {
    std::size_t joint = 0;
    double rim_per_joint = 0;  ///< m/s per rad/s, forwards
  };
  /// One device's samples, compared bit for bit.
  struct Repetition {
    ConditionWatch watch;
    std::array<std::uint64_t, 3> bits{};
    bool seen = false;
    std::uint64_t cycles = 0;  ///< for which the sample stayed the same while the wheels turned
  };

  bool sample(const SensorFrame& sensors, SensorValidity validity, const Vector3& axes,
              Eigen::Vector3d& base) const noexcept;
  void repeat(Repetition& device, bool good, const Vector3& axes, std::uint64_t elapsed, bool wheels_turn,
              ActiveCauses& out) const noexcept;
  void weigh(const SensorFrame& sensors) noexcept;
  double forward_speed(const SensorFrame& sensors) const noexcept;

  double period_;
  double weight_;       ///< N
  double persistence_;  ///< s, of imu_stuck
  double tip_tilt_;     ///< rad
  std::size_t contacts_;
  Eigen::Matrix3d to_base_;  ///< from IMU axes
  Eigen::Vector3d imu_;      ///< m, from the middle of the axles, base axes
  std::size_t wheel_count_ = 0;
  std::array<Wheel, kMaxWheels> wheels_{};

  ConditionWatch tilt_, tip_over_, free_fall_, lift_, impact_;
  Attitude attitude_;
  Repetition gyro_, accelerometer_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  double shock_ = 0;
  double carried_ = 1;
};

}  // namespace robot_control
