#include "control/standstill.h"

#include <cmath>

namespace robot_control {

Standstill::Standstill(double period)
    : cycles_needed_(static_cast<std::uint64_t>(std::lround(kStandstillTime / period))) {}

void Standstill::reset() noexcept {
  anchored_ = standing_ = false;
}

void Standstill::step(const WheelPair& angles, std::uint64_t cycle) noexcept {
  constexpr double kWindow = kStandstillSpeed * kStandstillTime;
  const bool inside =
      anchored_ && std::abs(angles.left - anchor_.left) < kWindow && std::abs(angles.right - anchor_.right) < kWindow;
  if (!inside) {
    anchor_ = angles;
    since_ = cycle;
    anchored_ = true;
  }
  standing_ = inside && cycle - since_ >= cycles_needed_;
}

}  // namespace robot_control
