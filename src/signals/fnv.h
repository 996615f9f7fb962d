#pragma once
/// FNV-1a, 64 bit (http://www.isthe.com/chongo/tech/comp/fnv): hash = (hash xor byte) * prime, byte by byte.

#include <cstdint>
#include <string_view>

namespace robot_control {

class Fnv1a {
 public:
  void add(unsigned char byte) noexcept { hash_ = (hash_ ^ byte) * 0x100000001B3ULL; }
  void add(std::string_view text) noexcept {
    for (const char c : text) add(static_cast<unsigned char>(c));
  }
  std::uint64_t value() const noexcept { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325ULL;
};

}  // namespace robot_control
