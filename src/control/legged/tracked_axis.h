#pragma once
/// Axes that follow targets within a speed Vᵢ and an acceleration Aᵢ each. Axes that are stepped together share their
/// acceleration. From rest they go straight to their targets. With the vectors e of the distances, v of the speeds, and
/// the norm |x| = Σ |xᵢ|/Aᵢ,
///
///   wanted = e min(kFollow, 1/Δt, √(2/|e|), minᵢ Vᵢ/|eᵢ|)      |Δv| ≤ Δt
///
/// From rest the axes brake in time and overshoot by less than the way of one cycle. An axis that moves while another
/// one gets a new target may pass its own, because it brakes with less. The axes lag behind a target that moves by
/// 1/kFollow seconds or a cycle, or |v|/2 where that is longer.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace robot_control {

/// Units per s and per s².
struct AxisBounds {
  double speed = 0;
  double acceleration = 0;
};

/// Returns the bounds with `part` of their speed.
inline AxisBounds paced(AxisBounds bounds, double part) noexcept {
  bounds.speed *= part;
  return bounds;
}

struct TrackedAxis {
  static constexpr double kFollow = 120;  ///< 1/s

  double value = 0;
  double speed = 0;
};

/// Returns s²(3 − 2s), s = `part` within 0 … 1: a way from 0 to 1 that begins and ends at rest.
inline double smooth_step(double part) noexcept {
  const double s = std::clamp(part, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

/// Returns |x|.
template <std::size_t N>
double norm(const std::array<double, N>& x, const std::array<AxisBounds, N>& bounds) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < N; ++i) sum += std::abs(x[i]) / bounds[i].acceleration;
  return sum;
}

/// Advances the axes by `dt` s.
template <std::size_t N>
void track(std::array<TrackedAxis, N>& axes, const std::array<double, N>& targets,
           const std::array<AxisBounds, N>& bounds, double dt) noexcept {
  std::array<double, N> distance{}, change{};
  double rate = std::min(TrackedAxis::kFollow, 1 / dt);
  for (std::size_t i = 0; i < N; ++i) {
    distance[i] = targets[i] - axes[i].value;
    rate = std::min(rate, bounds[i].speed / std::abs(distance[i]));
  }
  rate = std::min(rate, std::sqrt(2 / norm(distance, bounds)));
  for (std::size_t i = 0; i < N; ++i) change[i] = distance[i] * rate - axes[i].speed;
  const double time = norm(change, bounds);
  const double part = time > dt ? dt / time : 1;
  for (std::size_t i = 0; i < N; ++i) {
    axes[i].speed += part * change[i];
    axes[i].value += axes[i].speed * dt;
  }
}

/// Returns in how many s the axes stop, if they brake now.
template <std::size_t N>
double stopping_time(const std::array<TrackedAxis, N>& axes, const std::array<AxisBounds, N>& bounds) noexcept {
  std::array<double, N> speed{};
  for (std::size_t i = 0; i < N; ++i) speed[i] = axes[i].speed;
  return norm(speed, bounds);
}

/// Advances the axes by `dt` s while they brake. They stop at `stopping_place`.
template <std::size_t N>
void brake(std::array<TrackedAxis, N>& axes, const std::array<AxisBounds, N>& bounds, double dt) noexcept {
  const double time = stopping_time(axes, bounds);
  for (TrackedAxis& axis : axes) {
    axis.speed *= time > dt ? 1 - dt / time : 0;
    axis.value += axis.speed * dt;
  }
}

/// Returns the targets at which the axes stop, if they brake now.
template <std::size_t N>
std::array<double, N> stopping_place(const std::array<TrackedAxis, N>& axes,
                                     const std::array<AxisBounds, N>& bounds) noexcept {
  const double time = stopping_time(axes, bounds);
  std::array<double, N> place{};
  for (std::size_t i = 0; i < N; ++i) place[i] = axes[i].value + axes[i].speed * time / 2;
  return place;
}

}  // namespace robot_control
