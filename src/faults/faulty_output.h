#pragma once
/// An output into which a fault can be injected (signals/injected_fault.h): the samples of a sensor, the frames of a
/// node.
///
///   kOk            the healthy value
///   kOff           nothing
///   kStuck         the value of the cycle in which the fault began, as long as the fault lasts
///   kGarbage       what `distort` makes of it, from random numbers
///   kWrong         what `distort` makes of it
///   kSlow          a new value when the fault begins and every kFaultCycles cycles after; in between none
///   kDelayed       the value of kFaultCycles cycles ago; until there is one, that of the fault's beginning
///   kIntermittent  on at first, then changes between nothing and the healthy value with kChangeProbability in
///                  each cycle: both last 1 / kChangeProbability cycles on average, from one to a hundred
///
/// A healthy output costs one comparison. Random numbers come from the seed and the cycle in which the fault began
/// alone: the same fault in the same cycle gives the same bits, in whichever process. Real-time safe: no allocation.

#include <cstdint>
#include <random>

#include "faults/delay_line.h"
#include "signals/injected_fault.h"

namespace robot_control {

inline constexpr std::uint64_t kFaultCycles = 10;
inline constexpr double kChangeProbability = 0.1;

/// One seed for each component of a machine.
constexpr std::uint64_t fault_seed(std::uint64_t seed, FaultComponent component) noexcept {
  return seed * kFaultComponents + static_cast<std::uint64_t>(component);
}

/// Random numbers of a fault.
class FaultRandom {
 public:
  void seed(std::uint64_t seed) noexcept { engine_.seed(seed); }

  /// 0 ≤ x < 1
  double unit() noexcept { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// −bound ≤ x < bound
  double within(double bound) noexcept { return (2 * unit() - 1) * bound; }

 private:
  std::mt19937_64 engine_;
};

enum class Emission {
  kValue,    ///< this value comes out
  kNothing,  ///< no new value; of a slow output `value` holds the last one, for a reader that samples a register
};

template <class Value>
class FaultyOutput {
 public:
  /// `seed`: another one for each component, or they all fail in step.
  explicit FaultyOutput(std::uint64_t seed) noexcept : seed_(seed) {}

  /// Healthy, as new.
  void reset() noexcept { kind_ = FaultKind::kOk; }

  /// Once per cycle. `value`: the healthy one goes in, what comes out of the component takes its place.
  /// `distort(kind, value, random)` makes a value garbage or wrong. An unknown kind is kOff.
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

  /// The value of the cycle in which the fault began.
  const Value& held() const noexcept { return held_; }

 private:
  void begin(FaultKind kind, std::uint64_t cycle, const Value& value) noexcept {
    kind_ = kind;
    if (kind == FaultKind::kOk) return;
    held_ = value;
    if (kind == FaultKind::kDelayed) delay_.fill(value);
    random_.seed(seed_ ^ (cycle * 0x9E3779B97F4A7C15ULL));  // 2^64 / golden ratio: neighbours share no bits
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
  std::uint64_t fresh_cycle_ = 0;  ///< of the last new value, kSlow
  bool on_ = true;                 ///< kIntermittent
  Value held_{};
  DelayLine<Value, kFaultCycles> delay_{kFaultCycles};
  FaultRandom random_;
};

}  // namespace robot_control
