#pragma once
/// When a black box is to be saved: `kAfter` after a latched stop. One that comes before is saved with it, `kLongest`
/// after the first at the latest, so that what came before that one is still there.
///
/// A stop is latched where causes appear and there were none. What is latched when it is first seen was so before.

#include <cstdint>

namespace robot_control {

class IncidentWatch {
 public:
  static constexpr std::int64_t kAfter = 5'000'000'000;     ///< ns; the robot stands, its oscillation included
  static constexpr std::int64_t kLongest = 30'000'000'000;  ///< ns; a black box holds a minute or more

  /// `causes`: Permit::causes of now. True: a stop.
  bool see(std::uint64_t causes, std::int64_t now_ns) noexcept;

  /// There was a stop that is not saved.
  bool pending() const noexcept { return causes_to_save_ != 0; }

  bool due(std::int64_t now_ns) const noexcept { return pending() && now_ns >= due_ns_; }

  /// Causes of the stops that are saved now.
  std::uint64_t take() noexcept;

 private:
  bool seen_ = false;
  std::uint64_t causes_ = 0;
  std::uint64_t causes_to_save_ = 0;
  std::int64_t latest_ns_ = 0;  ///< of the time at which it is due
  std::int64_t due_ns_ = 0;
};

}  // namespace robot_control
