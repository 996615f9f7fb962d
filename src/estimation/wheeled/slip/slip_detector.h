#pragma once
/// Detects slip by the residuals of wheels against gyro and accelerometer (SlipResidual) over four spans T. Each is
/// compared with its usual level.
///
/// Slip is proven if a residual exceeds kProof deviations and that of the next longer T kSignificant. The second
/// condition excludes a late time stamp, which is as large in every T, while σ grows with T. Without slip, the mean of
/// −D/T² along and across is the error of gravity and bias in the acceleration.
///
/// Real floors shake an accelerometer ten to forty times harder than its data sheet states. Therefore each span of each
/// channel learns a level ≥ 1: the 90 % quantile of |residual|/σ, over that of a normal distribution. Here σ follows
/// from the data sheets. The first level is the largest of kFirstResiduals residuals; before that it is kFirstLevel.
/// Later the logarithm of the level changes by steps of kQuantileStep (H. Robbins, S. Monro, A stochastic approximation
/// method, 1951). The larger one of the level and its fading mean is in use: a level that these steps made low by
/// chance proves nothing. A robot that drives faster shakes more: the excess over the sensors' noise grows in
/// proportion to the speed. The clock offset's uncertainty σ_τ adds (σ_τ speed change)², and (B σ_τ Δω)² in the turn.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "estimation/wheeled/slip/motion_difference.h"

namespace robot_control {

/// A residual is the part of the differences between wheels and inertial sensors (motion_difference.h) that slip, noise
/// and vibration cause. It covers two successive spans of about T:
///
///   along, across:  D = (E₂ − E₁) − (E₁ − E₀) (t₂ − t₁)/(t₁ − t₀)     m, base axes at t₁
///   turn:           V = W₂ − W₁                                       m
///
/// Index 2 is the last point, 1 lies about T and 0 about 2 T before it. The standard deviations follow from the encoder
/// and the accelerometer, whose data sheet gives the white noise n; its slow error is a = kSlowAcceleration. They also
/// contain the slip of rolling wheels (wheel_slip_noise in the turn) and the uncertainties of gravity and the base
/// factor β:
///
///   σ_D² = 6 encoder² + n² 2T³/3 + (a² + σ_g²) T⁴ + 2 kPathSlip² distance + (q T)²/12
///   σ_V² = 4 encoder² + 2 slip² distance + (B σ_β Δψ)² + (B kWindUp)² |Δω| + (q T)²/6
struct SlipResidual {
  enum Channel : std::size_t { kAlong, kAcross, kTurn, kChannels };
  static constexpr std::array<Channel, kChannels> kEach{kAlong, kAcross, kTurn};

  bool known = false;                     ///< There were points for both spans.
  double span = 0;                        ///< s: t₂ − t₁
  double distance = 0;                    ///< m, over both spans
  double turned = 0;                      ///< rad: Δψ, over both spans
  double yaw_rate_change = 0;             ///< rad/s: Δω, over the last span
  double speed_change = 0;                ///< m/s, over both spans, the smaller one of wheels and accelerometer
  std::array<double, kChannels> value{};  ///< m: D along and across, V
  double speed() const noexcept { return distance / (2 * span); }  ///< m/s
};

/// Returns the residual over spans of about `span` s. It is unknown if the points make a span shorter than 0.8 or
/// longer than 1.6 of its nominal length.
SlipResidual slip_residual(const MotionDifference& difference, double span) noexcept;

/// Holds the uncertainties of the estimator's state at a point.
struct SlipUncertainty {
  std::array<double, 2> acceleration_variance{};  ///< (m/s²)²: σ_g², gravity and bias, along and across
  double wheel_base = 0.03;                       ///< σ_β, factor of the wheel base
  double clock_offset = 0;                        ///< s
  double speed_step = 0;                          ///< m/s: q, step in which the wheels' speeds are reported
};

/// Returns the standard deviation by the data sheets, in m.
double residual_deviation(SlipResidual::Channel channel, const SlipResidual& residual,
                          const SlipUncertainty& uncertainty, const SlipParams& params) noexcept;

/// Holds standard deviations of the acceleration.
struct AccelerationNoise {
  double white = 0;  ///< m/s²/√Hz
  double slow = 0;   ///< m/s²
};

class SlipDetector {
 public:
  using Channel = SlipResidual::Channel;

  explicit SlipDetector(const SlipParams& params) noexcept : params_(params), difference_(params) {}

  void restart() noexcept;  ///< restarts the differences (motion_difference.h); the levels stay
  void restart_on_line(const Planar& slope) noexcept;
  void restart_at_rest(double yaw, const Vector3& up, const Planar& velocity) noexcept;
  void begin_path() noexcept { difference_.begin_path(); }
  void set_clock_offset(double offset) noexcept { difference_.set_clock_offset(offset); }  ///< s; not during a slide
  /// Returns true if a point was added, which may be judged.
  bool step(const MotionDifference::Sample& sample) noexcept { return difference_.step(sample); }
  /// Judges a point. `learns` states that no slide is active.
  void evaluate(const SlipUncertainty& uncertainty, bool learns) noexcept;

  const MotionDifference& difference() const noexcept { return difference_; }
  double wheel_base() const noexcept { return params_.wheel_base; }  ///< m
  /// Returns the level along at T = 0.2 s; 0: nothing was compared yet.
  double level() const noexcept { return levels_[kLevelSpan][SlipResidual::kAlong].value; }

  // The members below describe the last judgement.
  bool proven(Channel channel) const noexcept { return proven_span_[channel] > 0; }
  double shortest_proven_span() const noexcept;                         ///< s, of all channels; 0: none
  double nis(Channel channel) const noexcept { return nis_[channel]; }  ///< at T = 0.2 s; < 0: unknown
  /// Returns the deviation of the slope of E or W over T = 0.1 s, in m/s.
  double slope_deviation(Channel channel) const noexcept { return slope_deviation_[channel]; }
  AccelerationNoise acceleration_noise() const noexcept;  ///< learned, while driving

  /// Describes the excess of gravity over the value in use, in base axes.
  struct GravityError {
    bool known = false;
    double along = 0, across = 0, deviation = 0;  ///< m/s²
    double interval = 0;                          ///< s since the last one
  };
  const GravityError& gravity_error() const noexcept { return gravity_error_; }

 private:
  static constexpr std::size_t kSpans = Tuning::kResidualSpans.size();
  static constexpr std::size_t kLevelSpan = 1;  ///< index of T = 0.2 s, whose level is published
  static constexpr std::size_t kTiltSpan = 2;   ///< index of T = 0.4 s, from which tilt and noise are learned
  using Residuals = std::array<SlipResidual, kSpans>;
  struct Level {
    double in_use() const noexcept { return std::max(value, mean); }
    double value = 0, mean = 0;  ///< 0: unknown; its fading mean
    double largest = 0;          ///< of the first residuals
    std::uint64_t count = 0;     ///< of residuals
  };

  void forget_judgement() noexcept;
  double at_speed(double level, double speed) const noexcept;
  double deviation(std::size_t span, Channel channel, const SlipResidual& residual) const noexcept;
  void evaluate_channel(Channel channel, const Residuals& residuals) noexcept;
  void learn(std::size_t span, const SlipResidual& residual, bool slip) noexcept;
  void learn_level(Level& level, double ratio) noexcept;
  void compare_gravity(const SlipResidual& residual, bool learns) noexcept;

  SlipParams params_;
  MotionDifference difference_;
  SlipUncertainty uncertainty_;
  std::array<std::array<Level, SlipResidual::kChannels>, kSpans> levels_{};
  std::array<double, kSpans> learned_at_{};  ///< s
  double usual_speed_ = 0, speed_ = 0;       ///< m/s, at which the levels are learned; now
  std::array<double, SlipResidual::kChannels> proven_span_{}, slope_deviation_{}, nis_{-1, -1, -1};
  GravityError gravity_error_;
  double gravity_compared_at_ = 0;  ///< s
};

}  // namespace robot_control
