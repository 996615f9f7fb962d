#pragma once
/// A LatestValue passes the latest value between two threads of one process; it is the inbox of a real-time thread.
///
/// It is the sequence lock of LatestFrames with one slot (tests/bus/latest_value_model_test.cpp). If several threads
/// write, the caller serialises `store`. `load` is bounded: if a writer disturbed it kTries times, it returns false and
/// does not change `out`. The reader then keeps its old value and tries again in the next cycle.

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace robot_control {

template <class Value, template <class> class Atomic = std::atomic>
class LatestValue {
  static_assert(std::is_trivially_copyable_v<Value> && sizeof(Value) % 8 == 0);
  static constexpr std::size_t kWords = sizeof(Value) / 8;
  static constexpr int kTries = 4;
  using Words = std::array<std::uint64_t, kWords>;

 public:
  explicit LatestValue(const Value& initial = Value{}) noexcept { store(initial); }

  /// Nothing may be stored in `other` meanwhile.
  LatestValue(const LatestValue& other) noexcept : version_(other.version()) {
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(other.words_[i].load(std::memory_order_relaxed));
  }

  void store(const Value& value) noexcept {
    const auto words = std::bit_cast<Words>(value);
    const std::uint64_t version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_relaxed);
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    version_.store(version + 2, std::memory_order_release);
  }

  /// Returns a number that every store changes, so that a reader need not load an unchanged value.
  std::uint64_t version() const noexcept { return version_.load(std::memory_order_relaxed); }

  bool load(Value& out) const noexcept {
    for (int tries = 0; tries < kTries; ++tries) {
      const std::uint64_t before = version_.load(std::memory_order_acquire);
      if (before % 2 != 0) continue;
      Words words;
      for (std::size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_acquire);
      if (version_.load(std::memory_order_relaxed) != before) continue;
      out = std::bit_cast<Value>(words);
      return true;
    }
    return false;
  }

 private:
  Atomic<std::uint64_t> version_{0};
  std::array<Atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace robot_control
