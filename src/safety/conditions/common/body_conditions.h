#pragma once
/// Conditions of the body, from IMU and contact sensors.
///
///   tilt       angle between the vertical u (attitude.h) and the base's z axis > limit
///   tip over   tilt > half the limit of tilt, and tilt rate > limit
///   free fall  |a| < limit
///   impact     component of a perpendicular to u, mean over kImpactWindow, > limit; that is a speed change of
///              limit · kImpactWindow. The mean, because stiff bodies stop within milliseconds; the perpendicular
///              component, because bumps and landings accelerate upwards. It is not judged while a machine folds its
///              legs, and for `landing` after it: the blow is its own. It folds when the gate has braked for
///              kImpactWindow, in which a body that falls gains 0.1 m/s
///   lift       Σ F·u < limit · m g, if the robot has contact sensors; m = MachineModel::mass
///   IMU jump   the change of the gyro's rates from sample to sample (rate_change.h) > limit. The accelerometer is not
///              judged: a robot that falls shakes it as much as random samples would (docs/evidence/derivations.md)
///   IMU stuck  all axes of gyro or of accelerometer are bit for bit equal to the last sample while the machine moves.
///              Noise changes the last bits of every new sample; an IMU that is slower than the loop repeats a sample
///              for less than any allowed persistence. At standstill even correct sensors may repeat a value
///
/// a: specific force of the accelerometer; u: vertical, upwards; both in base axes. A robot whose base z axis does not
/// point up at the zero pose is measured as tilted.
///
/// In a curve the accelerometer measures the centripetal acceleration for as long as the curve lasts; attitude.h is
/// given its expected value c = ω × (v x̂ + ω × r), v the forward speed of a point of the base, as far as the caller
/// measures it, and r the IMU's position relative to that point. Remaining tilt errors: Δv ω/g for an error Δv of the
/// speed; Δω r/(g T) at the beginning of a turn.
///
/// The default limits are 1.5 times what normal driving reaches; the measured values stand in
/// docs/evidence/derivations.md.
///
/// A sample that is missing, not valid or not finite is not evaluated: its conditions are not beyond their limits.

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "machine/machine_model.h"
#include "machine/stored.h"
#include "safety/conditions/common/condition_watch.h"
#include "safety/latch/active_causes.h"
#include "safety/measurements/attitude.h"
#include "safety/measurements/rate_change.h"
#include "safety/safety_parameters.h"
#include "signals/sensor_frame.h"

namespace robot_control {

class BodyConditions {
 public:
  static constexpr double kImpactWindow = 0.01;  ///< s

  /// `point` is the one to which the forward speed belongs, m, base axes. `period` s. `force_time` is that of
  /// Attitude. `landing` s is 0 for a machine that does not fold.
  BodyConditions(const SafetyParameters& parameters, const MachineModel& machine, const Vector3& point, double period,
                 double force_time = 0, double landing = 0);

  /// A new run: all state restarts.
  void enter_run() noexcept;

  /// Once per cycle; `elapsed` cycles since the last one, ≥ 1. `forward_speed` in m/s is 0 where it is not known. Adds
  /// the active causes to `out`. The limit of tilt is at least `least_tilt` rad.
  void step(const SensorFrame& sensors, std::uint64_t elapsed, double forward_speed, bool moving, ActiveCauses& out,
            double least_tilt = 0) noexcept;

  // Intermediates of the last step.
  const Attitude& attitude() const noexcept { return attitude_; }
  double shock() const noexcept { return shock_; }      ///< m/s², the mean that is compared with the limit of impact
  double carried() const noexcept { return carried_; }  ///< part of the weight on the contacts; 1 without sensors
  double along_z() const noexcept { return along_z_; }  ///< m/s², a_z; NaN without a sample
  Eigen::Vector3d rate() const noexcept { return *rate_; }    ///< rad/s, base axes; NaN without a sample
  double force() const noexcept { return (*force_).norm(); }  ///< m/s², |a|, of the last good sample

 private:
  static constexpr std::size_t kMaxSamples = 20;  ///< kImpactWindow at 2 kHz

  /// One device's samples, compared bit for bit.
  struct Repetition {
    ConditionWatch watch;
    std::array<std::uint64_t, 3> bits{};
    bool seen = false;
    std::uint64_t cycles = 0;  ///< for which the sample stayed the same while the machine moved
  };

  bool sample(const SensorFrame& sensors, SensorValidity validity, const Vector3& axes,
              Eigen::Ref<Eigen::Vector3d> base) const noexcept;
  void repeat(Repetition& device, bool good, const Vector3& axes, std::uint64_t elapsed, bool moving,
              ActiveCauses& out) const noexcept;
  void weigh(const SensorFrame& sensors) noexcept;
  void shake(bool felt) noexcept;

  double period_;
  double weight_;             ///< N
  double persistence_;        ///< s, of imu_stuck
  double landing_;            ///< s
  double folded_ = 0;         ///< s since it folded
  std::uint64_t braked_ = 0;  ///< cycles for which the gate has braked
  double tip_tilt_;           ///< rad
  std::size_t contacts_;
  Stored<Eigen::Matrix3d> to_base_;  ///< from IMU axes
  Stored<Eigen::Vector3d> imu_;      ///< m, from the point, base axes

  ConditionWatch tilt_, tip_over_, free_fall_, lift_, impact_, jump_;
  Attitude attitude_;
  RateChange rate_change_;
  Repetition gyro_, accelerometer_;
  Stored<Eigen::Vector3d> force_, rate_;
  std::size_t window_;  ///< samples in kImpactWindow
  std::size_t next_ = 0;
  std::array<Stored<Eigen::Vector3d>, kMaxSamples> across_;  ///< m/s², the last ones
  double along_z_ = 0;
  double shock_ = 0;
  double carried_ = 1;
};

}  // namespace robot_control
