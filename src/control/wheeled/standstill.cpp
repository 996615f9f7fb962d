#include "control/wheeled/standstill.h"

#include <cmath>

namespace robot_control {

Standstill::Standstill(double period)
    : cycles_needed_(static_cast<std::uint64_t>(std::lround(kStandstillTime / period))) {}

void Standstill::step(const WheelValues& angles, std::uint64_t cycle) noexcept {
  constexpr double kWindow = kStandstillSpeed * kStandstillTime;
  bool inside = since_.has_value();
  for (std::size_t i = 0; i < angles.size(); ++i) inside = inside && std::abs(angles[i] - anchor_[i]) < kWindow;
  if (!inside) {
    anchor_ = angles;
    since_ = cycle;
  }
  cycles_ = cycle - *since_;
}

}  // namespace robot_control
