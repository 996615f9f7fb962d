#pragma once
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

#include <array>
#include <cstddef>

#include "estimation/wheeled/slip/motion_difference.h"

namespace robot_control {

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

}  // namespace robot_control
