#pragma once
/// A slide: the time from the onset of slip that the detector proved until all wheels roll again.
///
/// Before the onset E follows a straight line (motion_difference.h). The slide carries that line on: the slope of E
/// beyond it is the speed by which the wheels run ahead of the ground, and line + ∫ acceleration is the ground speed u.
///
///   σ_u² = σ² + (slow t)² + white² t        t: time since the onset; σ: of the line's slope at the onset
///
/// A side slips while its share of the slope exceeds kSignificant σ_u. Where the slip came so suddenly that its largest
/// slope exceeds kSignificantTurn σ, a side slips until half of that slope is gone: no drift explains it. While one
/// does, the path takes the speed u instead of that of the wheels, clamped between zero, the speed at the onset and
/// that of the wheels: a robot that is lifted or tipped while its wheels stand does not move. Sideways the path is
/// never moved.
///
/// The variance that a slide adds is that of the speed which the path takes, integrated as one error: σ_u within its
/// bounds, and kChoiceDeviation times what wheels and accelerometer are apart, for either of them may be right.
///
/// In a slide wheels and gyro turn apart by Φ = ∫ W dt / B. If the wheels are right and the gyro is wrong, the path
/// by the gyro bends against the acceleration, and E moves across by u Φ. So the gyro is wrong by Φ at most, and by
/// what E moves across, with kSignificant deviations of it, over u.
///
/// The slide ends when nothing has slipped for kRolls.

#include <algorithm>
#include <array>
#include <cstdint>

#include "estimation/slip/motion_difference.h"
#include "estimation/slip/residual_levels.h"

namespace robot_control {

class WheelSlide {
 public:
  /// What is known at a point.
  struct Input {
    AccelerationNoise noise;
    double path_slope_deviation = 0;     ///< m/s, of E along, over two points
    double turn_slope_deviation = 0;     ///< m/s, of W, likewise
    std::array<double, 2> side_speed{};  ///< m/s, of the treads, left and right

    double wheel_base = 0;  ///< m
    bool sideways = false;  ///< slip across is proven now

    double wheel_speed() const noexcept { return (side_speed[0] + side_speed[1]) / 2; }
  };
  /// What is to be added to the path.
  struct Correction {
    Planar shift{};            ///< m, odom axes
    double variance = 0;       ///< m²
    double contradiction = 0;  ///< rad, by how much more the gyro may be wrong than before
  };

  /// Slip was proven that began `span` s ago at most.
  Correction begin(const MotionDifference& difference, double span, const Input& input) noexcept;
  /// At every point of the differences while the slide is active.
  Correction step(const MotionDifference& difference, const Input& input) noexcept;
  void end() noexcept { *this = {}; }

  bool active() const noexcept { return active_; }
  std::uint64_t reasons() const noexcept { return reasons_; }  ///< SlipReason
  bool slips(std::size_t side) const noexcept { return slips_[side]; }
  bool sideways() const noexcept { return sideways_; }
  /// m/s, odom axes, of E while all wheels rolled at the end.
  Planar rolling_slope(const MotionDifference& difference) const noexcept;
  double excess_speed() const noexcept { return excess_speed_; }        ///< m/s, wheels minus the path's speed
  double speed_deviation() const noexcept { return speed_deviation_; }  ///< m/s, of the path's speed

 private:
  static constexpr double kRolls = 2 * Tuning::kResidualSpans[1];  ///< s, in which two residuals show it
  using Point = MotionDifference::Point;

  /// m/s, base axes: slope of E beyond the line, and of W.
  struct Excess {
    double along = 0, across = 0, turn = 0;
    double side(std::size_t i) const noexcept { return along + (i == 0 ? -1 : 1) * turn / 2; }
  };

  Excess excess(const Point& from, const Point& to) const noexcept;
  double slipped_speed(const Excess& excess, const Input& input) const noexcept;  ///< m/s, wheels minus ground
  double contradict(double apart, const Excess& excess, double deviation, const Input& input) noexcept;  ///< rad
  double line_deviation(double time, const AccelerationNoise& noise) const noexcept;                     ///< m/s: σ_u
  void judge(double time, const Excess& excess, double deviation, const Input& input) noexcept;

  bool active_ = false;
  Planar line_;                ///< m/s, odom axes, slope of E before the onset
  double line_deviation_ = 0;  ///< m/s: σ
  double onset_ = 0;           ///< s
  double onset_speed_ = 0;     ///< m/s, along
  double largest_ = 0;         ///< m/s, excess of a side
  Point corrected_;            ///< until which the path is corrected
  double slipped_ = 0;         ///< s, of the last judgement in which something slipped
  std::array<bool, 2> slips_{};
  bool sideways_ = false;
  std::uint64_t reasons_ = 0;
  double excess_speed_ = 0, speed_deviation_ = 0;
  double turned_apart_ = 0;    ///< rad: Φ
  double contradiction_ = 0;   ///< rad, of the gyro
  double path_deviation_ = 0;  ///< m, that this slide has added
};

}  // namespace robot_control
