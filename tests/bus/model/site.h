#pragma once
/// One atomic access in the tested code, and the ways to break it.

#include <atomic>
#include <compare>
#include <cstddef>
#include <cstdint>

namespace robot_control::model {

enum class Operation { kLoad, kStore, kAdd };

struct Site {
  const char* file = nullptr;
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::size_t name = 0;  ///< index in MemoryModel::names of the accessed member ("version", "words")
  Operation operation = Operation::kLoad;
  std::memory_order order = std::memory_order_relaxed;

  auto operator<=>(const Site&) const = default;
};

enum class Defect {
  kRelaxed,  ///< the access orders nothing
  kSkipped,  ///< the store is not done
  kStale,    ///< the load gives the last value that this thread read there: a check that is not made
};

struct Mutant {
  Site site;
  Defect defect = Defect::kRelaxed;
};

}  // namespace robot_control::model
