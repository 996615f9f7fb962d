#pragma once
/// What happens to the body: IMU and contact sensors → conditions.
///
///   tilt       angle between up (attitude.h) and the base's z axis > limit
///   tip over   tilt > half the limit of tilt, and growing faster than limit
///   free fall  |a| < limit
///   impact     the part of a across u, mean over kImpactWindow, > limit: limit · kImpactWindow of speed is gone. The
///              mean, because stiff bodies stop within milliseconds; across, because bumps and landings push upwards
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
/// the middle of the axles. What is left: Δv ω/g of wheels that slip by Δv, while they do; Δω r/(g T) of a turn's
/// beginning.
///
/// What normal driving does, in these facts: 13 robots of 1 … 450 kg at up to 1 m/s, 2 rad/s and 1 m/s², with the
/// errors of a BMI088, 2.8 hours of flat ground, a slope of 5°, ice and bumps of 5 … 15 mm. The defaults bear 1.5
/// times that:
///
///   tilt       0.27 rad, a light robot that rocks on its body; of it 0.1 are errors    0.42 rad
///   tip over   0.9 rad/s beyond half that limit                                        1.5 rad/s
///   free fall  0.09 s below 1.5 m/s², hopping off a bump                               0.15 s: 11 cm deep
///   impact     50 m/s², a bump; walls at 0.3 m/s 21 … 35, at 1 m/s 90 … 118 m/s²       80 m/s²: 0.8 m/s at once
///   lift       0.51 s below 0.2 of the weight, the body on a bump                      0.8 s
///
/// Not counted: a robot of 450 kg that turns on the spot and meets a bump sideways with its corner, 74 m/s². The bodies
/// of the plant are stiff; a bumper makes impacts softer, and a device of ±24 g does not see all of a hard one.
///
/// A sample that is missing, not valid or not finite tells nothing: its facts are not beyond their limits.

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "robot/robot_model.h"
#include "safety/conditions/condition_watch.h"
#include "safety/latch/active_causes.h"
#include "safety/measurements/attitude.h"
#include "safety/safety_parameters.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class BodyFacts {
 public:
  static constexpr double kImpactWindow = 0.01;  ///< s

  /// `period` s.
  BodyFacts(const SafetyParameters& parameters, const RobotModel& robot, double period);

  /// A new run: nothing is known.
  void enter_run() noexcept;

  /// Once per cycle; `elapsed` cycles since the last one, ≥ 1. Adds what is active to `out`.
  void step(const SensorFrame& sensors, std::uint64_t elapsed, bool wheels_turn, ActiveCauses& out) noexcept;

  // Intermediates of the last step.
  const Attitude& attitude() const noexcept { return attitude_; }
  double shock() const noexcept { return shock_; }         ///< m/s², the mean that impact is judged by
  double carried() const noexcept { return carried_; }     ///< of the weight, on the wheels; 1 without contact sensors
  double force() const noexcept { return force_.norm(); }  ///< m/s², |a|, of the last good sample

 private:
  static constexpr std::size_t kMostSamples = 20;  ///< kImpactWindow at 2 kHz

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
  void shake(bool felt) noexcept;
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
  std::size_t window_;  ///< samples of it that count
  std::size_t next_ = 0;
  std::array<Eigen::Vector3d, kMostSamples> across_;  ///< m/s², the last ones
  double shock_ = 0;
  double carried_ = 1;
};

}  // namespace robot_control
