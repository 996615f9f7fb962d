#pragma once
/// The ground below the feet: its normal, and a level plane of known height (LegFilter::State::ground).
///
/// normal   n of the diagonals between the last footfalls of all legs, with the mean over kFootfalls of them. A ball
///          foot rolls along the ground, not along the horizon
/// level    the ground is level where n and its mean are vertical, and where a footfall is as high as those of the
///          other legs, all within kLevelGate deviations. The mean is still vertical where a slope begins
/// plane    a footfall on level ground shows the height of the body if it is within kPlaneGate deviations of the plane.
///          With it, it shows roll and pitch, and so the bias of the accelerometer. Another height is a new plane; the
///          body's height stays
///
/// So what climbs a slope or stairs, on which footfalls are not level, keeps the height that it sums up.

#include <array>

#include "estimation/legged/leg_filter.h"

namespace robot_control {

class Ground {
 public:
  static constexpr double kFootfalls = 8;  ///< two of each leg
  static constexpr double kLevelGate = 2;
  static constexpr double kPlaneGate = 3;

  struct State {
    Vector3 normal{0, 0, 1};                    ///< odom axes
    std::array<std::uint64_t, kLegs> fallen{};  ///< 1: the filter's foot is a footfall
    std::uint64_t known = 0;                    ///< 1: there is a plane
  };

  /// `length` is that of a leg in m.
  explicit Ground(double length) noexcept : length_(length) {}

  /// Foot `foot` has just landed, at a place that the ground's roughness knows to `deviation` [m].
  void footfall(std::size_t foot, double deviation, LegFilter& filter, State& state) const noexcept;

 private:
  bool level(std::size_t foot, double deviation, const LegFilter& filter, State& state) const noexcept;

  double length_;
};

}  // namespace robot_control
