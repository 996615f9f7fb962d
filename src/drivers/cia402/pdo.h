#pragma once
/// Process data objects: frames without an answer whose content, the mapping, is written to the drive beforehand.
///
/// The entries of a mapping follow each other from bit 0 of the data on, little-endian. RPDO and TPDO are named from
/// the drive: it receives RPDOs. Number n = 1 … 4 has by default the COB-ID 0x200 + 0x100 (n − 1) + node (RPDO) or
/// 0x180 + 0x100 (n − 1) + node (TPDO), its parameters in 1400 + n − 1 or 1800 + n − 1 and its mapping in 1600 + n − 1
/// or 1A00 + n − 1. Source: CiA 301, 7.2.2, 7.5.2.35 – 7.5.2.38.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "drivers/cia402/canopen.h"

namespace robot_control::canopen {

inline constexpr std::size_t kMaxPdoEntries = 8;  ///< each has at least one byte
inline constexpr std::uint8_t kEverySync = 1;     ///< transmission type; n: with every n-th SYNC, up to kMaxSyncs
inline constexpr std::uint8_t kMaxSyncs = 240;    ///< transmission type
inline constexpr std::uint8_t kOnEvent = 255;     ///< transmission type

struct PdoEntry {
  ObjectAddress object{};
  std::uint8_t bits = 0;   ///< 8, 16 or 32
  bool is_signed = false;  ///< in two's complement

  /// Returns the value of the entry in 1600 or 1A00.
  constexpr std::uint32_t mapped() const noexcept {
    return static_cast<std::uint32_t>(object.index) << 16U | static_cast<std::uint32_t>(object.sub) << 8U | bits;
  }

  bool operator==(const PdoEntry&) const = default;
};

struct PdoMapping {
  std::array<PdoEntry, kMaxPdoEntries> entries{};
  std::uint8_t count = 0;

  constexpr PdoMapping() = default;
  constexpr PdoMapping(std::initializer_list<PdoEntry> list) {
    for (const PdoEntry& entry : list) entries[count++] = entry;
  }

  constexpr unsigned bits() const noexcept {
    unsigned sum = 0;
    for (unsigned i = 0; i < count; ++i) sum += entries[i].bits;
    return sum;
  }
};

enum class PdoKind : std::uint8_t { kReceive, kTransmit };

struct Pdo {
  PdoKind kind = PdoKind::kReceive;
  std::uint8_t number = 1;  ///< 1 … 4
  PdoMapping mapping;       ///< at most 64 bits

  constexpr canid_t cob_id(std::uint8_t node) const noexcept {
    return (kind == PdoKind::kReceive ? 0x200U : 0x180U) + 0x100U * (number - 1U) + node;
  }
  constexpr std::uint16_t parameters() const noexcept {
    return static_cast<std::uint16_t>((kind == PdoKind::kReceive ? 0x1400 : 0x1800) + number - 1);
  }
  constexpr std::uint16_t mapping_index() const noexcept { return static_cast<std::uint16_t>(parameters() + 0x200); }
};

/// Returns the entry that a mapping holds as this number (PdoEntry::mapped).
PdoEntry entry_of(std::uint32_t mapped) noexcept;

/// Returns the entry of the PDO with this object and length; null if it has none.
const PdoEntry* mapped(const Pdo& pdo, const PdoEntry& entry) noexcept;

/// One write to the object dictionary.
struct SdoWrite {
  ObjectAddress object{};
  std::uint32_t value = 0;
  std::uint8_t bytes = 4;

  bool operator==(const SdoWrite&) const = default;
};

inline constexpr std::uint32_t kPdoDisabled = 0x8000'0000;    ///< bit of a COB-ID
inline constexpr std::uint32_t kPdoWithoutRtr = 0x4000'0000;  ///< bit of a COB-ID

struct PdoSetup {
  std::array<SdoWrite, kMaxPdoEntries + 5> writes{};
  std::size_t count = 0;

  std::span<const SdoWrite> all() const noexcept { return {writes.data(), count}; }
};

/// Returns the writes, in their order, that set the mapping of a PDO in the state pre-operational. They disable the
/// PDO, clear its mapping, write entries, their number and the transmission type, and enable it. `present` is the
/// COB-ID that was read from the drive. Its bit kPdoWithoutRtr is kept, because a drive without remote requests refuses
/// to clear it.
PdoSetup pdo_setup(const Pdo& pdo, std::uint8_t node, std::uint8_t transmission_type, std::uint32_t present) noexcept;

/// Returns the frame of a PDO with one value per entry, of which the lowest bits are sent.
can_frame encode_pdo(const Pdo& pdo, std::uint8_t node, std::span<const std::int64_t> values) noexcept;

/// Writes one value per entry. Returns false, without a change, if the frame is another PDO or shorter than the
/// mapping.
bool decode_pdo(const Pdo& pdo, std::uint8_t node, const can_frame& frame, std::span<std::int64_t> values) noexcept;

}  // namespace robot_control::canopen
