#pragma once
/// A FaultyOutput is an output with an injected fault (signals/injected_fault.h): the samples of a sensor or the frames
/// of a node.
///
///   kOk            the healthy value
///   kOff           no output
///   kStuck         the value of the cycle in which the fault began, as long as the fault lasts
///   kGarbage       the healthy value, changed by `distort` with random numbers
///   kWrong         the healthy value, changed by `distort`
///   kSlow          a new value when the fault begins and every kFaultCycles cycles after; in between no output
///   kDelayed       the value of kFaultCycles cycles ago; in the first kFaultCycles cycles that of its beginning
///   kIntermittent  on at first, then changes between no output and the healthy value with kChangeProbability in
///                  each cycle: both last 1 / kChangeProbability cycles on average, from one to a hundred
///
/// A healthy output costs one comparison. Random numbers depend only on the seed and the cycle in which the fault
/// began. So the same fault in the same cycle gives the same bits in every process. The class is real-time safe: it
/// does not allocate.

#include <cstdint>
#include <random>

#include "signals/injected_fault.h"
#include "signals/joint.h"
#include "simulation/faults/delay_line.h"

namespace robot_control {

inline constexpr std::uint64_t kFaultCycles = 10;
inline constexpr double kChangeProbability = 0.1;

/// Returns a different seed for each component of a machine.
constexpr std::uint64_t fault_seed(std::uint64_t seed, FaultComponent component, std::size_t index = 0) noexcept {
  return (seed * kFaultComponents + static_cast<std::uint64_t>(component)) * kMaxJoints + index;
}

/// The source of random numbers of a fault.
class FaultRandom {
 public:
  void seed(std::uint64_t seed) noexcept { engine_.seed(seed); }

  /// Returns a number x with 0 ≤ x < 1.
  double unit() noexcept { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// Returns a number x with −bound ≤ x < bound.
  double within(double bound) noexcept { return (2 * unit() - 1) * bound; }

 private:
  std::mt19937_64 engine_;
};

enum class Emission {
  kValue,    ///< the component outputs this value
  kNothing,  ///< no new output; with kSlow `value` is the last output, for a reader that samples a register
};

template <class Value>
class FaultyOutput {
 public:
  /// `seed` must differ between components, otherwise their faults have the same random numbers.
  explicit FaultyOutput(std::uint64_t seed) noexcept : seed_(seed) {}

  /// Makes the output healthy, as after construction.
  void reset() noexcept { kind_ = FaultKind::kOk; }

  /// Is called once per cycle and replaces the healthy `value` by the component's output. `distort(kind, value,
  /// random)` makes a value garbage or wrong. An unknown kind counts as kOff.
  template <class Distort>
  Emission step(FaultKind kind, std::uint64_t cycle, Value& value, Distort distort) noexcept {
    if (kind != kind_) begin(kind, cycle, value);
    switch (kind) {
      case FaultKind::kOk:
        return Emission::kValue;
      case FaultKind::kStuck:
        value = held_;
        return Emission::kValue;
      case FaultKind::kGarbage:
      case FaultKind::kWrong:
        distort(kind, value, random_);
        return Emission::kValue;
      case FaultKind::kSlow:
        return slow(cycle, value);
      case FaultKind::kDelayed:
        delay_.step(value);
        return Emission::kValue;
      case FaultKind::kIntermittent:
        if (random_.unit() < kChangeProbability) on_ = !on_;
        return on_ ? Emission::kValue : Emission::kNothing;
      case FaultKind::kOff:
        break;
    }
    return Emission::kNothing;
  }

  /// Returns the value of the cycle in which the fault began.
  const Value& held() const noexcept { return held_; }

 private:
  void begin(FaultKind kind, std::uint64_t cycle, const Value& value) noexcept {
    kind_ = kind;
    if (kind == FaultKind::kOk) return;
    held_ = value;
    if (kind == FaultKind::kDelayed) delay_.fill(value);
    random_.seed(
        seed_ ^
        (cycle * 0x9E3779B97F4A7C15ULL));  // 2^64 / golden ratio: seeds of neighbouring cycles differ in many bits
    fresh_cycle_ = cycle;
    on_ = true;
  }

  Emission slow(std::uint64_t cycle, Value& value) noexcept {
    const std::uint64_t age = cycle - fresh_cycle_;
    if (age != 0 && age < kFaultCycles) {
      value = held_;
      return Emission::kNothing;
    }
    fresh_cycle_ = cycle;
    held_ = value;
    return Emission::kValue;
  }

  std::uint64_t seed_;
  FaultKind kind_ = FaultKind::kOk;
  std::uint64_t fresh_cycle_ = 0;  ///< cycle of the last new value, for kSlow
  bool on_ = true;                 ///< the output is on, for kIntermittent
  Value held_{};
  DelayLine<Value, kFaultCycles> delay_{kFaultCycles};
  FaultRandom random_;
};

}  // namespace robot_control
