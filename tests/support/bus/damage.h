#pragma once
/// Damage to memory, drawn from a seed: the traces of a stray writer, a bad bit or another program.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>

namespace robot_control {

class Damage {
 public:
  explicit Damage(std::uint64_t seed) : random_(seed) {}

  std::uint64_t below(std::uint64_t limit) { return random_() % limit; }

  /// A number that looks right, or one at the edges.
  std::uint64_t number() {
    constexpr std::uint64_t kTop = ~std::uint64_t{0};
    constexpr std::uint64_t kNumbers[] = {0,        1,   2, 7, 8, 9, 10, 18, 19, 20, 255, kTop / 2, kTop / 2 + 1,
                                          kTop - 1, kTop};
    return below(8) == 0 ? random_() : kNumbers[below(std::size(kNumbers))];
  }

  /// Damages single bits, a stretch of random bytes, everything, or whole words.
  void strike(std::span<std::byte> memory) {
    switch (below(8)) {
      case 0:
        random_bytes(memory);
        break;
      case 1:
      case 2: {
        const std::size_t first = below(memory.size());
        random_bytes(memory.subspan(first, 1 + below(memory.size() - first)));
        break;
      }
      case 3:
      case 4:
        for (std::uint64_t bits = 1 + below(8); bits > 0; --bits) {
          memory[below(memory.size())] ^= static_cast<std::byte>(1U << below(8));
        }
        break;
      default:
        for (std::uint64_t words = 1 + below(4); words > 0; --words) {
          const std::uint64_t word = number();
          std::memcpy(&memory[8 * below(memory.size() / 8)], &word, sizeof word);
        }
    }
  }

 private:
  void random_bytes(std::span<std::byte> memory) {
    std::uint64_t random = 0;
    for (std::size_t i = 0; i < memory.size(); ++i) {
      if (i % 8 == 0) random = random_();
      memory[i] = static_cast<std::byte>(random >> (8 * (i % 8)));
    }
  }

  std::mt19937_64 random_;
};

}  // namespace robot_control
