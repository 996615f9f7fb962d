#include "estimation/slip/inertial_motion.h"

namespace robot_control {
namespace {

InertialMotion carried_on(const InertialMotion& from, double time) noexcept {
  InertialMotion motion = from;
  motion.time = time;
  motion.path = from.path + from.velocity * (time - from.time);
  motion.yaw = from.yaw + from.yaw_rate * (time - from.time);
  return motion;
}

/// Returns the cubic from `a` to `b` over `span` s at the share `part` of it; `a_rate` and `b_rate` are derivatives.
template <typename Value>
Value cubic(const Value& a, const Value& a_rate, const Value& b, const Value& b_rate, double span,
            double part) noexcept {
  const double rest = 1 - part;
  return a * (rest * rest * (1 + 2 * part)) + b * (part * part * (1 + 2 * rest)) +
         (a_rate * rest - b_rate * part) * (span * part * rest);
}

}  // namespace

InertialMotion interpolated(const InertialMotion& from, const InertialMotion& to, double time) noexcept {
  if (time <= from.time) return carried_on(from, time);
  if (time >= to.time) return carried_on(to, time);
  const double span = to.time - from.time;
  const double part = (time - from.time) / span;
  const double rest = 1 - part;
  return {.time = time,
          .path = cubic(from.path, from.velocity, to.path, to.velocity, span, part),
          .lever = from.lever * rest + to.lever * part,
          .velocity = from.velocity * rest + to.velocity * part,
          .yaw = cubic(from.yaw, from.yaw_rate, to.yaw, to.yaw_rate, span, part),
          .yaw_rate = from.yaw_rate * rest + to.yaw_rate * part};
}

}  // namespace robot_control
