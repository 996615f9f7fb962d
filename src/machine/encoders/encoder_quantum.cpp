#include "machine/encoders/encoder_quantum.h"

#include <cmath>
#include <initializer_list>

namespace robot_control {

bool EncoderQuantum::refine(double turned) noexcept {
  constexpr double kExact = 1e-4;    // rad
  constexpr double kMinStep = 1e-9;  // rad, below which a difference is rounding
  const double before = value_;
  if (!changed_ && std::abs(turned) > kMinStep) {
    changed_ = true;
    value_ = kCoarsest;  // The value of another wheel's encoder counts no longer.
  }
  for (const double step : {turned, turned - last_}) {
    const double size = std::abs(step);
    if (size > kMinStep && size < value_) value_ = size < kExact ? 0 : size;
  }
  last_ = turned;
  return value_ != before;
}

bool EncoderQuantum::assume(const EncoderQuantum& other) noexcept {
  if (changed_ || other.value_ >= value_) return false;
  value_ = other.value_;
  return true;
}

}  // namespace robot_control
