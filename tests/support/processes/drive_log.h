#pragma once
/// The true motion of the plant, cycle by cycle, from its trace ring, which tolerates a late reader.

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/ring.h"
#include "loop/cycles/trace_sink.h"
#include "signals/trace.h"

namespace robot_control {

struct DrivenCycle {
  std::uint64_t run = 0;
  std::uint64_t cycle = 0;
  GateVerdict verdict = GateVerdict::kBrake;
  std::uint64_t reasons = 0;
  double speed = 0;  ///< m/s, true, ahead
  double x = 0;      ///< m, true
  double y = 0;
};

class DriveLog {
 public:
  explicit DriveLog(const std::string& bus)
      : channel_(bus, kTraceChannels[static_cast<std::size_t>(TraceRing::kDriver)]) {}

  /// Maps the ring when it appears or is replaced.
  void poll() {
    if (channel_.poll()) reader_.emplace(channel_.memory());
  }

  /// Takes the available rows. A ring holds 2 s at 1 kHz: call it more often.
  void read_rows() {
    while (reader_ && reader_->read(row_)) {
      const TruthFrame& truth = row_.truth;
      cycles_.push_back({.run = row_.sensors.head.run,
                         .cycle = row_.sensors.head.cycle,
                         .verdict = row_.gate.verdict,
                         .reasons = row_.gate.reasons,
                         .speed = truth.twist_base.linear[0],
                         .x = truth.pose_world.position[0],
                         .y = truth.pose_world.position[1]});
    }
  }

  /// Rows overwritten before they were read.
  std::uint64_t lost() const { return reader_ ? reader_->overwritten() : 0; }

  void forget() { cycles_.clear(); }
  const std::vector<DrivenCycle>& cycles() const noexcept { return cycles_; }
  bool empty() const noexcept { return cycles_.empty(); }
  const DrivenCycle& last() const { return cycles_.back(); }

  /// True if the last `count` cycles all braked, at rest.
  bool rested(std::size_t count) const {
    constexpr double kRest = 0.01;  // m/s, a hundredth of full speed
    if (cycles_.size() < count) return false;
    for (std::size_t i = cycles_.size() - count; i < cycles_.size(); ++i) {
      if (cycles_[i].verdict != GateVerdict::kBrake || std::abs(cycles_[i].speed) > kRest) return false;
    }
    return true;
  }

  /// The first cycle from which on every one braked; nothing if the last one did not.
  std::optional<std::uint64_t> braking_since() const {
    std::optional<std::uint64_t> since;
    for (std::size_t i = cycles_.size(); i-- > 0 && cycles_[i].verdict == GateVerdict::kBrake;)
      since = cycles_[i].cycle;
    return since;
  }

  /// m, along the path, from `cycle` to `last`.
  double way_since(std::uint64_t cycle, std::uint64_t last = std::numeric_limits<std::uint64_t>::max()) const {
    double distance = 0;
    for (std::size_t i = 1; i < cycles_.size(); ++i) {
      if (cycles_[i].cycle <= cycle || cycles_[i].cycle > last) continue;
      distance += std::hypot(cycles_[i].x - cycles_[i - 1].x, cycles_[i].y - cycles_[i - 1].y);
    }
    return distance;
  }

  /// m, the longest step from a cycle to the next: top speed · period, if nothing jumps.
  double longest_step() const {
    double longest = 0;
    for (std::size_t i = 1; i < cycles_.size(); ++i) {
      if (cycles_[i].run != cycles_[i - 1].run || cycles_[i].cycle != cycles_[i - 1].cycle + 1) continue;
      longest = std::max(longest, std::hypot(cycles_[i].x - cycles_[i - 1].x, cycles_[i].y - cycles_[i - 1].y));
    }
    return longest;
  }

 private:
  ForeignChannel<Ring<DriverTrace>> channel_;
  std::optional<RingReader<DriverTrace>> reader_;
  DriverTrace row_;
  std::vector<DrivenCycle> cycles_;
};

}  // namespace robot_control
