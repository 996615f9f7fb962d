#include "log/black_box/incident_watch.h"

#include <algorithm>

namespace robot_control {

bool IncidentWatch::update(std::uint64_t causes, std::int64_t now_ns) noexcept {
  const bool stop = std::exchange(seen_, true) && causes_ == 0 && causes != 0;
  causes_ = causes;
  if (stop) {
    if (!pending()) latest_ns_ = now_ns + kMaxDelay;
    due_ns_ = std::min(now_ns + kAfter, latest_ns_);
  }
  if (stop || pending()) causes_to_save_ |= causes;
  return stop;
}

}  // namespace robot_control
