#pragma once
/// Names slip of the wheels along the robot's way, and a robot that is blocked. Slip widens the covariance; it moves no
/// path.
///
///   E(t) = way by the wheels + τ v − ∬ acceleration dt² − height of the IMU · u_x
///
/// The stamps of the wheels are late by τ, at their speed v. Without slip E is a straight line, whose slope is the
/// unknown speed at the beginning. The acceleration is that of the middle of the wheels, without gravity. The residual
/// is the second difference of E over T = kSlipSpan:
///
///   D  = (E₂ − E₁) − (E₁ − E₀)
///   σ² = 6 encoder² + n² 2T³/3 + (a² + σ_g²) T⁴ + 2 kPathSlip² way + q² (T² + 3 τ²)/6
///
/// The noise n is that of the data sheet, a is kSlowAcceleration, σ_g that of gravity, q the step of wheel speeds. The
/// deviation of τ adds itself times the change of speed that wheels and accelerometer share.
///
/// Real floors shake an accelerometer ten to forty times harder than its data sheet states. Therefore a level ≥ 1 is
/// learned, the 90 % quantile of |D|/σ over that of a normal distribution (H. Robbins, S. Monro, A stochastic
/// approximation method, 1951). The first one is the largest of kFirstResiduals; before that it is kFirstLevel. The
/// larger one of the level and its fading mean is in use. A residual is learned when the next one shows that it did not
/// begin slip, or when that slip has ended without a blocked robot. Otherwise the level would rise with what it shows.
///
/// Slip begins where |D| exceeds kProof deviations. The earlier slope of E is extended then, and what the slope exceeds
/// it by is the excess of the wheels over the ground. Slip ends where the excess has been below kSignificant deviations
/// for T/2, or below half of its largest value if no drift explains that. While the ground speed is zero within
/// these deviations and the wheels turn, the robot is blocked; after kBlock it is named so. Other slip ends T + kBlock
/// after its onset, because slow errors of the accelerometer then look like it.
///
/// The excess is kept as one error of the path, of kChoiceDeviation times its length: either sensor may be right.

#include <array>
#include <cstddef>
#include <cstdint>

#include "estimation/common/tuning.h"
#include "estimation/common/values.h"

namespace robot_control {

struct SlipParams {
  double encoder = 4.4e-5;        ///< m, of one reading
  double accelerometer = 1.7e-3;  ///< m/s²/√Hz
  double imu_x = 0, imu_y = 0;    ///< m, base axes, of the IMU from the middle of the wheels
  double imu_above_ground = 0;    ///< m
};

class SlipWatch {
 public:
  /// Describes the motion of one step.
  struct Sample {
    double dt = 0;                         ///< s
    std::array<double, 2> acceleration{};  ///< m/s², base axes, without gravity
    double up_x = 0;                       ///< of the unit vector up
    double yaw_rate = 0;                   ///< rad/s
    double travel = 0;                     ///< m, of the middle of the wheels
    double speed = 0;                      ///< m/s, of the wheels
    double clock_offset = 0;               ///< s, by which the stamps of the wheels are late
    bool both_sides_read = false;          ///< The travel of both sides was read in this step.
  };
  /// Holds the uncertainties of the estimator's state at a point.
  struct Uncertainty {
    double gravity_variance = 0;  ///< (m/s²)², of gravity and bias along
    double clock_offset = 0;      ///< s, deviation
    double offset = 0;            ///< s, that is applied
    double speed_step = 0;        ///< m/s
  };
  /// Describes the excess of gravity over the value in use, in base axes; interval 0: not known.
  struct GravityError {
    double along = 0, across = 0, deviation = 0;  ///< m/s²
    double interval = 0;                          ///< s since the last one
  };

  explicit SlipWatch(const SlipParams& params) noexcept : params_(params) {}

  void restart() noexcept;                      ///< removes all points and ends slip; the level stays
  void restart_at_rest(double speed) noexcept;  ///< The wheels have stood; `speed` (m/s) is gained since then.
  bool step(const Sample& sample) noexcept;     ///< Returns true if a point was added, which may be judged.
  /// Judges a point. Before a first rest nothing is named. Returns the variance of the path that it adds, m².
  double evaluate(const Uncertainty& uncertainty, bool names) noexcept;

  bool slips() const noexcept { return slips_; }
  bool interrupted() const noexcept {
    return count_ > 0 && now_.time - record(count_ - 1).time > Tuning::kSlipSpan / 2;
  }
  std::uint64_t reasons() const noexcept { return reasons_; }           ///< SlipReason
  double speed_deviation() const noexcept { return speed_deviation_; }  ///< m/s, of the path's speed
  double level() const noexcept { return level_; }                      ///< 0: nothing was compared yet
  double nis() const noexcept { return nis_; }                          ///< < 0: unknown
  const GravityError& gravity_error() const noexcept { return gravity_error_; }

 private:
  static constexpr std::size_t kPoints = 32;

  struct Record {
    double time = 0, way = 0, distance = 0;  ///< s, m, m: the last one always grows
    Planar difference;                       ///< m: E along, and −∬ acceleration dt² across
    double speed = 0;                        ///< m/s: ∫ acceleration dt along
  };

  Record& record(std::size_t i) noexcept { return records_[i % kPoints]; }
  const Record& record(std::size_t i) const noexcept { return records_[i % kPoints]; }
  const Record& before(double time) const noexcept;  ///< the newest one that is not later, else the oldest
  double slide(const Record& first, const Record& middle, double deviation, double slow, double ratio) noexcept;
  void learn() noexcept;

  SlipParams params_;
  std::array<Record, kPoints> records_{};  ///< ring, at least kPointInterval apart
  std::size_t count_ = 0;
  Record now_;
  Planar velocity_, inertial_;  ///< m/s, m: integrals of the acceleration
  double wheels_ = 0;           ///< m/s
  double level_ = 0, nis_ = -1, mean_level_ = 0;
  double pending_ = 0;          ///< ratio that the level has not learned yet; 0: none
  std::uint64_t compared_ = 0;  ///< residuals from which the level was learned
  double compared_at_ = 0;      ///< s
  GravityError gravity_error_;

  bool slips_ = false;
  std::uint64_t reasons_ = 0;
  double line_ = 0, line_deviation_ = 0, sudden_ = 0;  ///< m/s: slope of E at the onset; excess that no drift explains
  double onset_ = 0, counted_ = 0, slipped_ = 0;       ///< s: times of the onset, of the last point and excess
  double blocked_ = 0;                                 ///< s
  double path_deviation_ = 0, speed_deviation_ = 0;    ///< m, m/s
};

}  // namespace robot_control
