#pragma once
/// Which cycles are worth recording where only motion is (telemetry.record: motion).
///
/// The robot moves while a velocity other than zero is requested, while the estimator does not report that all sensors
/// are quiet, or while a node gives no frame. A change of the safety monitor's state or causes counts, too. It moves
/// until it has stood for `kAfter`.

#include <cstdint>

#include "telemetry/joined_row.h"

namespace robot_control {

class MotionWatch {
 public:
  static constexpr std::int64_t kAfter = 5'000'000'000;  ///< ns; a stop is seen to its end, its oscillation included

  bool step(const JoinedRow& row, std::int64_t time_ns) noexcept;

 private:
  std::uint64_t state_ = 0;
  std::uint64_t causes_ = 0;
  std::int64_t until_ns_ = 0;
};

}  // namespace robot_control
