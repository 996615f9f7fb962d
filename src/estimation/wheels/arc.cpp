#include "estimation/wheels/arc.h"

#include <cmath>

namespace robot_control {

Sinc sinc(double h) noexcept {
  // Below this the first term left out, h⁶/5040, is under 2⁻⁵³; above it, (cos − sinc)/h keeps 11 digits.
  constexpr double kSeries = 0.008;
  if (std::abs(h) < kSeries) {
    const double square = h * h;
    return {1 - square / 6 * (1 - square / 20), -h / 3 * (1 - square / 10 * (1 - square / 28))};
  }
  const double value = std::sin(h) / h;
  return {value, (std::cos(h) - value) / h};
}

Chord chord_of(const Motion& motion, double yaw) noexcept {
  const Sinc shrink = sinc(motion.turn / 2);
  const double cosine = std::cos(yaw + motion.turn / 2);
  const double sine = std::sin(yaw + motion.turn / 2);
  const double x = cosine * motion.forward - sine * motion.left;
  const double y = sine * motion.forward + cosine * motion.left;

  Chord chord;
  chord.x = shrink.value * x;
  chord.y = shrink.value * y;
  chord.x_by_forward = shrink.value * cosine;
  chord.y_by_forward = shrink.value * sine;
  chord.x_by_left = -chord.y_by_forward;
  chord.y_by_left = chord.x_by_forward;
  chord.x_by_turn = (shrink.slope * x - shrink.value * y) / 2;
  chord.y_by_turn = (shrink.slope * y + shrink.value * x) / 2;
  return chord;
}

}  // namespace robot_control
