#include "safety/latch/evidence.h"

#include <algorithm>

namespace robot_control {

void Evidence::latch(const ActiveCauses& active, std::uint64_t cycle) noexcept {
  std::uint64_t fresh = active.stopping() & ~known_;
  known_ |= fresh;
  for (const CauseEvidence& measurement : active.measurements()) {
    if ((measurement.cause & fresh) == 0 || count_ == kMaxEvidence) continue;
    fresh &= ~measurement.cause;
    latched_[count_] = measurement;
    latched_[count_].cycle = cycle;
    ++count_;
  }
}

void Evidence::restore(const Permit& last) noexcept {
  clear();
  known_ = last.causes;
  for (const CauseEvidence& evidence : last.evidence) {
    if ((evidence.cause & last.causes) != 0) latched_[count_++] = evidence;
  }
}

void Evidence::write(const Warnings& warnings, std::array<CauseEvidence, kMaxEvidence>& out) const noexcept {
  std::copy_n(latched_.begin(), count_, out.begin());
  std::size_t i = count_;
  for (std::uint64_t rest = warnings.bits(); rest != 0 && i < kMaxEvidence; rest &= rest - 1) {
    out[i++] = warnings.evidence(rest);
  }
  std::fill(out.begin() + static_cast<std::ptrdiff_t>(i), out.end(), CauseEvidence{});
}

}  // namespace robot_control
