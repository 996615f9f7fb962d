#pragma once
/// How the body moves, from IMU, contact sensors and the gate's report; compared with limits in
/// conditions/common/body_conditions.h.
///
/// In a curve the accelerometer measures the centripetal acceleration for as long as the curve lasts; attitude.h is
/// given its expected value c = ω × (v x̂ + ω × r), v the forward speed of a point of the base, as far as the caller
/// measures it, and r the IMU's position relative to that point. Remaining tilt errors: Δv ω/g for an error Δv of the
/// speed; Δω r/(g T) at the beginning of a turn.
///
/// A robot whose base z axis does not point up at the zero pose is measured as tilted. A sample that is missing, not
/// valid or not finite is not used.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "machine/machine_model.h"
#include "machine/stored.h"
#include "safety/measurements/attitude.h"
#include "signals/geometry.h"
#include "signals/sensor_frame.h"

namespace robot_control {

/// How much a gyro's rates change from sample to sample.
///
///   change = median of |ω_k − ω_{k−1}| over the last kSamples changes, rad/s
///
/// ω_k are the samples that differ from the one before: a gyro that is slower than the loop repeats its samples. A
/// median, because a single wrong sample causes two changes, and a foot that lands few: neither is an IMU that fails.
/// Before kSamples changes the missing ones are 0.
class RateChange {
 public:
  static constexpr std::size_t kSamples = 9;  ///< at 1 kHz the fifth jump in a row is found within 5 ms

  void reset() noexcept { *this = {}; }

  /// `rate`: ω, rad/s, finite, in any fixed axes of the body.
  void step(const Vector3& rate) noexcept {
    const double change = std::hypot(rate[0] - rate_[0], rate[1] - rate_[1], rate[2] - rate_[2]);
    rate_ = rate;
    if (!known_ || change == 0) {
      known_ = true;
      return;
    }
    changes_[next_] = change;
    next_ = (next_ + 1) % kSamples;
    std::array<double, kSamples> sorted = changes_;
    std::nth_element(sorted.begin(), sorted.begin() + kSamples / 2, sorted.end());
    value_ = sorted[kSamples / 2];
  }

  double value() const noexcept { return value_; }  ///< rad/s

 private:
  bool known_ = false;  ///< rate_
  Vector3 rate_{};      ///< rad/s, the last one
  std::array<double, kSamples> changes_{};
  std::size_t next_ = 0;
  double value_ = 0;
};

class BodyMotion {
 public:
  static constexpr double kImpactWindow = 0.01;  ///< s
  static constexpr double kPushTime = 0.02;      ///< s
  static constexpr double kPushed = 0.25;        ///< s; a foot that slid is set again within a period of a trot

  /// `point` is the one to which the forward speed belongs, m, base axes. `period` s. `force_time` is that of
  /// Attitude. `landing` s is 0 for a machine that does not fold.
  BodyMotion(const MachineModel& machine, const Vector3& point, double period, double force_time = 0,
             double landing = 0);

  /// A new run: all state restarts.
  void enter_run() noexcept;

  /// Once per cycle; `elapsed` cycles since the last one, ≥ 1. `forward_speed` in m/s is 0 where it is not known.
  void step(const SensorFrame& sensors, std::uint64_t elapsed, double forward_speed, bool moving) noexcept;

  const Attitude& attitude() const noexcept { return attitude_; }
  double shock() const noexcept { return shock_; }  ///< m/s², |mean over kImpactWindow of a across u|
  /// Something besides the floor pushed the machine within the last kPushed: the low pass over kPushTime of `shock` was
  /// above g. A floor of friction 1 pushes no harder, and feet may slide.
  bool pushed() const noexcept { return unpushed_ < kPushed; }
  double carried() const noexcept { return carried_; }        ///< part of the weight on the contacts; 1 without sensors
  double along_z() const noexcept { return along_z_; }        ///< m/s², a_z; NaN without a sample
  bool felt() const noexcept { return felt_; }                ///< The accelerometer brought a sample.
  Eigen::Vector3d rate() const noexcept { return *rate_; }    ///< rad/s, base axes; NaN without a sample
  double force() const noexcept { return (*force_).norm(); }  ///< m/s², |a|, of the last good sample
  /// rad/s, between samples (RateChange); 0 without a sample in this cycle.
  double rate_change() const noexcept { return turned_ ? rate_change_.value() : 0; }
  /// s for which the samples stayed bit for bit the same while the machine moved.
  double gyro_repeated() const noexcept { return gyro_.repeated; }
  double force_repeated() const noexcept { return accelerometer_.repeated; }
  /// The machine folds its legs, or did so less than `landing` ago. It folds when the gate has braked for
  /// kImpactWindow, in which a body that falls gains 0.1 m/s.
  bool folds() const noexcept { return folded_ < landing_; }

 private:
  static constexpr std::size_t kMaxSamples = 20;  ///< kImpactWindow at 2 kHz

  /// One device's samples, compared bit for bit.
  struct Repetition {
    std::array<std::uint64_t, 3> bits{};
    bool seen = false;
    std::uint64_t cycles = 0;
    double repeated = 0;  ///< s
  };

  bool sample(const SensorFrame& sensors, SensorValidity validity, const Vector3& axes,
              Eigen::Ref<Eigen::Vector3d> base) const noexcept;
  void repeat(Repetition& device, bool good, const Vector3& axes, std::uint64_t elapsed, bool moving) const noexcept;
  void weigh(const SensorFrame& sensors) noexcept;
  void shake(double dt) noexcept;

  double period_;
  double weight_;             ///< N
  double landing_;            ///< s
  double folded_ = 0;         ///< s since it folded
  std::uint64_t braked_ = 0;  ///< cycles for which the gate has braked
  std::size_t contacts_;
  Stored<Eigen::Matrix3d> to_base_;  ///< from IMU axes
  Stored<Eigen::Vector3d> imu_;      ///< m, from the point, base axes

  Attitude attitude_;
  RateChange rate_change_;
  Repetition gyro_, accelerometer_;
  Stored<Eigen::Vector3d> force_, rate_;
  bool turned_ = false;  ///< The gyro brought a sample.
  bool felt_ = false;
  std::size_t window_;  ///< samples in kImpactWindow
  std::size_t next_ = 0;
  std::array<Stored<Eigen::Vector3d>, kMaxSamples> across_;  ///< m/s², the last ones
  double along_z_ = 0;
  double shock_ = 0;
  double push_ = 0;                                            ///< m/s², low pass of shock_
  double unpushed_ = std::numeric_limits<double>::infinity();  ///< s since push_ was above g
  double carried_ = 1;
};

}  // namespace robot_control
