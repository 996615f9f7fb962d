#pragma once
/// TraceTiming fills the LoopDurations of one role from the rows that the real-time threads write anyway.
///
/// An ordinary thread of a node reads its own ring and those of the driver and of the node that wakes it. The real-time
/// threads do not notice it. A row that was overwritten before it was read, or whose driver's row was, does not count.

#include <cstdint>
#include <memory>
#include <string>

#include "timing/loop_durations.h"

namespace robot_control {

class TraceTiming {
 public:
  /// `role` is one of the four of the loop. The rings are those of `bus`.
  TraceTiming(const std::string& bus, Role role);
  ~TraceTiming();

  /// Reads what has been written. Call it at 10 Hz; a ring holds 2048 cycles.
  void poll();

  const LoopDurations& durations() const noexcept { return durations_; }
  std::uint64_t rows() const noexcept { return rows_; }  ///< number of own rows that were read

 private:
  struct Rings;

  Role role_;
  LoopDurations durations_;
  std::unique_ptr<Rings> rings_;
  std::uint64_t rows_ = 0;
};

}  // namespace robot_control
