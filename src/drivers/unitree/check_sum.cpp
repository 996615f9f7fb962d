#include "drivers/unitree/low_level.h"

namespace robot_control::unitree {
namespace {

constexpr std::array<std::uint32_t, 256> check_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t remainder = i << 24U;
    for (int bit = 0; bit < 8; ++bit) remainder = (remainder << 1U) ^ ((remainder >> 31U) != 0 ? 0x04C11DB7U : 0U);
    table[i] = remainder;
  }
  return table;
}

}  // namespace

std::uint32_t check_sum(std::span<const std::uint8_t> bytes) noexcept {
  static constexpr std::array kTable = check_table();
  std::uint32_t sum = 0xFFFFFFFF;
  for (std::size_t word = 0; word + 4 <= bytes.size(); word += 4) {
    for (std::size_t byte = 4; byte-- > 0;) sum = (sum << 8U) ^ kTable[(sum >> 24U) ^ bytes[word + byte]];
  }
  return sum;
}

}  // namespace robot_control::unitree
