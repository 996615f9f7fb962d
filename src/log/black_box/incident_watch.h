#pragma once
/// A black box is saved `kAfter` after a latched stop. A further stop before that time is saved with it. The delay is
/// at most `kMaxDelay` after the first stop, so that the rows before that one are still present.
///
/// A stop is latched when causes appear and there were none. Causes in the first update were latched before.

#include <cstdint>
#include <utility>

namespace robot_control {

class IncidentWatch {
 public:
  static constexpr std::int64_t kAfter = 5'000'000'000;      ///< ns; the oscillation after the stop has ended
  static constexpr std::int64_t kMaxDelay = 30'000'000'000;  ///< ns; a black box holds a minute or more

  /// `causes` are the present Permit::causes; true: there is a new stop.
  bool update(std::uint64_t causes, std::int64_t now_ns) noexcept;

  /// True: there was a stop that is not saved.
  bool pending() const noexcept { return causes_to_save_ != 0; }

  bool due(std::int64_t now_ns) const noexcept { return pending() && now_ns >= due_ns_; }

  /// Returns the causes of the stops that are saved now, and forgets them.
  std::uint64_t clear() noexcept { return std::exchange(causes_to_save_, 0); }

 private:
  bool seen_ = false;
  std::uint64_t causes_ = 0;
  std::uint64_t causes_to_save_ = 0;
  std::int64_t latest_ns_ = 0;  ///< latest time at which saving is due
  std::int64_t due_ns_ = 0;
};

}  // namespace robot_control
