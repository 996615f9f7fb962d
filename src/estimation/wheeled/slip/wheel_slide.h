#pragma once
/// A slide lasts from the onset of slip that the detector proved until all wheels roll again. It names the slip, widens
/// the covariance and moves nothing, with one exception: a blocked robot.
///
/// Before the onset E follows a straight line (motion_difference.h). The slide extends that line. The slope of E beyond
/// it is the excess speed of the wheels over the ground, and line + ∫ acceleration is the ground speed u.
///
///   σ_u² = σ² + (slow t)² + white² t        t: time since the onset; σ: of the line's slope at the onset
///
/// A side slips while its share of the slope exceeds kSignificant σ_u. After sudden slip, whose slope exceeds
/// kSignificantTurn σ_u, a side slips until half of its largest slope is gone, because no drift explains it. Slip
/// sideways begins where the detector has proven it and lasts while the slope across exceeds kSignificant σ_u. The
/// slide ends when nothing has slipped for kRolls.
///
/// A wall blocks the robot while both sides slip and u is zero within kSignificant σ_u. At the beginning the wheels'
/// speed exceeds that, too. After kBlock the path takes back what the wheels have rolled since then. So a robot that is
/// lifted or tipped with standing wheels does not move.
///
/// The variance is that of the path's speed, integrated as one error: kChoiceDeviation times the difference between
/// wheels and accelerometer, because either may be right.

#include <array>
#include <cstdint>

#include "estimation/wheeled/slip/slip_detector.h"

namespace robot_control {

class WheelSlide {
 public:
  using Speeds = std::array<double, 2>;  ///< m/s, of the treads, left and right
  /// Describes the changes of the path that the caller applies.
  struct Correction {
    Planar shift{};       ///< m, odom axes
    double variance = 0;  ///< m²
  };

  /// Begins a slide where the detector has proven slip.
  Correction begin(const SlipDetector& detector, const Speeds& treads) noexcept;
  /// Updates the active slide; called at every point of the differences.
  Correction step(const SlipDetector& detector, const Speeds& treads) noexcept;
  void end() noexcept { *this = {}; }

  bool active() const noexcept { return active_; }
  std::uint64_t reasons() const noexcept { return reasons_; }  ///< SlipReason
  bool slips(std::size_t side) const noexcept { return slips_[side]; }
  bool sideways() const noexcept { return sideways_; }
  /// Returns the slope of E at the end, while all wheels rolled, in m/s, odom axes.
  Planar rolling_slope(const MotionDifference& difference) const noexcept;
  double excess_speed() const noexcept { return excess_speed_; }        ///< m/s, wheels minus path: of a blocked robot
  double speed_deviation() const noexcept { return speed_deviation_; }  ///< m/s, of the path's speed

 private:
  static constexpr double kRolls = 2 * Tuning::kResidualSpans[1];  ///< s, in which two residuals show rolling
  using Point = MotionDifference::Point;

  /// Holds the slopes of E beyond the line and of W, in m/s, base axes.
  struct Excess {
    double along = 0, across = 0, turn = 0;
    double side(std::size_t i) const noexcept { return along + (i == 0 ? -1 : 1) * turn / 2; }
  };

  void evaluate(const SlipDetector& detector, const Excess& excess, double deviation, const Speeds& treads) noexcept;
  void name(const Excess& excess, const Speeds& treads) noexcept;
  Planar take_back(double wheels, double dt, double yaw, bool blocked, bool begins) noexcept;

  bool active_ = false;
  Planar line_;                ///< m/s, odom axes, slope of E before the onset
  double line_deviation_ = 0;  ///< m/s: σ
  double onset_ = 0;           ///< s
  double onset_speed_ = 0;     ///< m/s, along
  double sudden_ = 0;          ///< m/s, largest excess of a side that no drift explains; 0: none
  Point corrected_;            ///< point until which the path is corrected
  double slipped_ = 0;         ///< s, time of the last judgement in which something slipped
  std::array<bool, 2> slips_{};
  bool sideways_ = false;
  std::uint64_t reasons_ = 0;
  double excess_speed_ = 0, speed_deviation_ = 0;
  double blocked_ = 0;         ///< s for which both sides spin and the robot stands
  Planar held_;                ///< m, odom axes, path of the wheels in that time
  double path_deviation_ = 0;  ///< m, deviation that this slide has added
};

}  // namespace robot_control
