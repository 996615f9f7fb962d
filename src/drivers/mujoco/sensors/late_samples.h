#pragma once
/// LateSamples simulates a device whose samples arrive after a varying delay, as over a serial line or a USB port.
/// Sample i, taken in cycle i, arrives at
///
///   a(i) = max(a(i−1), i·T + delay + |jitter·w(i)|)      w independent standard normal numbers, at most 6
///
/// In cycle k the driver reports the newest sample that has arrived, or the first sample until one has. A sample may be
/// reported in several cycles or in none; their order is kept. The frame's stamp is the time of the cycle, not of the
/// sample, as with a driver that cannot measure the delay. The receiver has to estimate or to tolerate the age of a
/// sample.
///
/// The class holds all samples that have not arrived yet itself and never allocates after construction.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "drivers/mujoco/sensors/normal_stream.h"

namespace robot_control {

template <class Value>
class LateSamples {
 public:
  /// `delay` ≥ 0, `jitter` ≥ 0 and `period` > 0 are in s.
  LateSamples(double delay, double jitter, double period, ErrorStream stream)
      : delay_(delay / period), jitter_(jitter / period), stream_(stream), on_the_way_(longest() + 2) {}

  void reset(std::uint64_t seed) {
    random_.seed(seed, stream_);
    cycle_ = sent_ = arrived_ = 0;
    last_arrival_ = 0;
  }

  /// Returns after how many cycles every sample has arrived; 0 if all are on time.
  std::size_t longest() const noexcept {
    return delay_ == 0 && jitter_ == 0 ? 0 : static_cast<std::size_t>(std::ceil(delay_ + kMaxDeviations * jitter_));
  }

  /// Replaces the sample of this cycle by the one that the driver reports.
  void step(Value& value) noexcept {
    if (delay_ == 0 && jitter_ == 0) return;
    if (cycle_ == 0) reported_ = value;
    const auto now = static_cast<double>(cycle_++);
    const double late = jitter_ > 0 ? jitter_ * std::min(kMaxDeviations, std::abs(random_.next())) : 0;
    last_arrival_ = std::max(last_arrival_, now + delay_ + late);
    on_the_way_[sent_++ % on_the_way_.size()] = {value, last_arrival_};
    while (arrived_ < sent_ && on_the_way_[arrived_ % on_the_way_.size()].arrival <= now + kRounding) {
      reported_ = on_the_way_[arrived_++ % on_the_way_.size()].value;
    }
    value = reported_;
  }

 private:
  static constexpr double kMaxDeviations = 6;  ///< standard deviations
  static constexpr double kRounding = 1e-6;    ///< cycles

  struct Sample {
    Value value{};
    double arrival = 0;  ///< cycles
  };

  double delay_, jitter_;  ///< cycles
  ErrorStream stream_;
  NormalStream random_;
  std::uint64_t cycle_ = 0, sent_ = 0, arrived_ = 0;
  double last_arrival_ = 0;
  Value reported_{};
  std::vector<Sample> on_the_way_;
};

}  // namespace robot_control
