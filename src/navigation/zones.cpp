#include "navigation/zones.h"

namespace robot_control::navigation {

double Zones::speed_limit(Point at, double fastest, double deceleration) const {
  const double delay = kZoneDelay * fastest, reach = delay + fastest * fastest / deceleration;
  if (mask_.cells.empty() || std::hypot(at.x, at.y) > kFarthest) return fastest;
  const Cell low = mask_.cell_at(at.x - reach, at.y - reach), high = mask_.cell_at(at.x + reach, at.y + reach);
  double limit = fastest;
  for (int row = std::max(low.row, 0); row <= std::min(high.row, mask_.rows - 1); ++row) {
    for (int column = std::max(low.column, 0); column <= std::min(high.column, mask_.columns - 1); ++column) {
      const int value = mask_.cells[mask_.index({column, row})];
      if (value <= kFreeCell || value >= kOccupiedCell) continue;
      const double half = mask_.resolution / 2;
      const double away = std::hypot(std::max(0.0, std::abs(mask_.x_of(column) - at.x) - half),
                                     std::max(0.0, std::abs(mask_.y_of(row) - at.y) - half));
      const double zone = fastest * (100 - value) / 100;
      limit = std::min(limit, std::sqrt(zone * zone + deceleration * std::max(0.0, away - delay)));
    }
  }
  return limit;
}

}  // namespace robot_control::navigation
