#pragma once
/// A foothold is the place at which a foot in the air lands (M. H. Raibert, Legged Robots That Balance, MIT Press 1986,
/// chapter 2).
///
///   place = R(t + T/2) [ n + k (v − w) − ω × w h/g ] + R(t/2) w t + R(t + T/4) w T/2
///   k     = min( T/2 + kReturn √(l/kReferenceLeg), √(h/g) )
///
///   n   nominal place of this foot, from the point of the ground below the centre of gravity now
///   w   requested velocity, v the measured one, ω the requested yaw rate; R(s) turns by ω s
///   t   time until the foot lands; the body still moves by w t
///   T   time for which it then bears; w T/2 puts it below the hip in the middle
///   h   height of the centre of gravity; with ω × w h/g the forces of a robot that turns pass through it
///
/// k (v − w) brings the speed back to the requested one. A foot that is √(h/g) (v − w) farther ahead takes all of the
/// difference away (J. Pratt et al., Humanoids 2006); a long stance would put it beyond that place. The part beyond n
/// is limited to kAhead l and kAside l, so that the leg reaches the foot during its whole stance. All vectors are in
/// level axes with the body's heading now.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "control/legged/walk/gait.h"
#include "machine/gravity.h"

namespace robot_control {

inline constexpr double kReturn = 0.05;  ///< s
inline constexpr double kAhead = 0.66;   ///< of the leg's length
inline constexpr double kAside = 0.47;   ///< of the leg's length

struct FootholdInput {
  Eigen::Vector2d nominal = Eigen::Vector2d::Zero();    ///< m, n
  Eigen::Vector2d requested = Eigen::Vector2d::Zero();  ///< m/s, w
  Eigen::Vector2d measured = Eigen::Vector2d::Zero();   ///< m/s, v
  double yaw_rate = 0;                                  ///< rad/s, ω, requested
  double until_landing = 0;                             ///< s, t
  double stance_time = 0;                               ///< s, T
  double height = 0;                                    ///< m, h
  double leg_length = kReferenceLeg;                    ///< m, l
};

/// Returns the place in m.
inline Eigen::Vector2d foothold(const FootholdInput& input) noexcept {
  const auto turned = [&](double time) { return Eigen::Rotation2Dd(input.yaw_rate * time); };
  const double until = input.until_landing, half = input.stance_time / 2;
  const Eigen::Vector2d inwards = input.yaw_rate * Eigen::Vector2d(-input.requested.y(), input.requested.x());
  const double caught = std::sqrt(std::max(0.0, input.height) / kGravity);
  const double gain = std::min(half + kReturn * std::sqrt(input.leg_length / kReferenceLeg), caught);
  const Eigen::Vector2d placed =
      turned(until + half) *
          (input.nominal + gain * (input.measured - input.requested) - input.height / kGravity * inwards) +
      until * (turned(until / 2) * input.requested) + half * (turned(until + half / 2) * input.requested);
  const Eigen::Vector2d bound(kAhead * input.leg_length, kAside * input.leg_length);
  const Eigen::Vector2d beyond = placed - input.nominal;
  return input.nominal + beyond.cwiseMin(bound).cwiseMax(-bound);
}

}  // namespace robot_control
