#include "drivers/cia402/pdo.h"

#include "drivers/line/wire_layout.h"

namespace robot_control::canopen {
namespace {

std::uint8_t bytes_of(const PdoMapping& mapping) noexcept {
  return static_cast<std::uint8_t>((mapping.bits() + 7) / 8);
}

}  // namespace

PdoSetup pdo_setup(const Pdo& pdo, std::uint8_t node, std::uint8_t transmission_type, std::uint32_t present) noexcept {
  PdoSetup setup;
  const auto write = [&setup](std::uint16_t index, std::uint8_t sub, std::uint32_t value, std::uint8_t bytes) {
    setup.writes[setup.count++] = {.object = {.index = index, .sub = sub}, .value = value, .bytes = bytes};
  };
  const std::uint32_t cob_id = pdo.cob_id(node) | (present & kPdoWithoutRtr);
  write(pdo.parameters(), 1, cob_id | kPdoDisabled, 4);
  write(pdo.mapping_index(), 0, 0, 1);
  for (std::uint8_t i = 0; i < pdo.mapping.count; ++i) {
    write(pdo.mapping_index(), static_cast<std::uint8_t>(i + 1), pdo.mapping.entries[i].mapped(), 4);
  }
  write(pdo.mapping_index(), 0, pdo.mapping.count, 1);
  write(pdo.parameters(), 2, transmission_type, 1);
  write(pdo.parameters(), 1, cob_id, 4);
  return setup;
}

can_frame encode_pdo(const Pdo& pdo, std::uint8_t node, std::span<const std::int64_t> values) noexcept {
  std::uint64_t word = 0;
  unsigned bit = 0;
  for (std::size_t i = 0; i < pdo.mapping.count && i < values.size(); ++i) {
    const unsigned bits = pdo.mapping.entries[i].bits;
    word |= (static_cast<std::uint64_t>(values[i]) & low_bits(bits)) << bit;
    bit += bits;
  }
  return word_frame(pdo.cob_id(node), word, bytes_of(pdo.mapping));
}

bool decode_pdo(const Pdo& pdo, std::uint8_t node, const can_frame& frame, std::span<std::int64_t> values) noexcept {
  if (!is_standard_data(frame) || frame.can_id != pdo.cob_id(node) || frame.len < bytes_of(pdo.mapping)) return false;
  std::uint64_t word = data_word(frame);
  for (std::size_t i = 0; i < pdo.mapping.count && i < values.size(); ++i) {
    const PdoEntry& entry = pdo.mapping.entries[i];
    const std::uint64_t raw = word & low_bits(entry.bits);
    values[i] = entry.is_signed ? sign_extended(raw, entry.bits) : static_cast<std::int64_t>(raw);
    word = entry.bits < 64 ? word >> entry.bits : 0;
  }
  return true;
}

PdoEntry entry_of(std::uint32_t mapped) noexcept {
  const auto bits = static_cast<std::uint8_t>(mapped & 0xFFU);
  const ObjectAddress object{static_cast<std::uint16_t>(mapped >> 16U),
                             static_cast<std::uint8_t>(mapped >> 8U & 0xFFU)};
  return {.object = object, .bits = bits};
}

const PdoEntry* mapped(const Pdo& pdo, const PdoEntry& entry) noexcept {
  for (std::size_t i = 0; i < pdo.mapping.count; ++i) {
    const PdoEntry& each = pdo.mapping.entries[i];
    if (each.object == entry.object && each.bits == entry.bits) return &each;
  }
  return nullptr;
}

}  // namespace robot_control::canopen
