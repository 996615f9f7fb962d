#pragma once
/// If only motion is recorded (telemetry.record: motion), this watch decides which cycles are.
///
/// The robot moves while a velocity other than zero is requested, while the estimator reports no standstill, or while a
/// node gives no frame. A change of the safety monitor's state or causes counts as motion. Motion ends `kAfter` later.

#include <cstdint>

#include "log/rows/joined_row.h"

namespace robot_control {

class MotionWatch {
 public:
  static constexpr std::int64_t kAfter = 5'000'000'000;  ///< ns; the oscillation after a stop is recorded, too

  /// True: the cycle is to be recorded.
  bool step(const JoinedRow& row, std::int64_t time_ns) noexcept;

 private:
  std::uint64_t state_ = 0;
  std::uint64_t causes_ = 0;
  std::int64_t until_ns_ = 0;
};

}  // namespace robot_control
