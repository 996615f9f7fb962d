#pragma once
/// A Ring passes rows from one writer to one reader in another process and counts lost rows.
///
/// The ring belongs to the writer, the read position to the reader. The positions are a separate object
/// (RingPositions), so that neither process needs write access to the other's memory. Each slot is a sequence lock as
/// in LatestFrames. However, only `written` publishes a row; the slot's version shows whether the row has been
/// overwritten. The test tests/bus/ring_model_test.cpp visits every execution of a small model of this code. In a full
/// ring with a reader the writer waits (lockstep) or drops the new row and counts it. Without a reader it overwrites
/// the oldest rows.

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "bus/latest_frames.h"

namespace robot_control {

inline constexpr std::size_t kRingRows = 2048;
inline constexpr std::size_t kTraceRings = 4;

/// Index into RingPositions::read.
enum class TraceRing : std::size_t { kDriver = 0, kEstimator = 1, kController = 2, kMonitor = 3 };

/// The number of rows read so far from each ring; written by the reader (telemetry).
struct RingPositions {
  ChannelHead head;
  alignas(64) std::array<std::atomic<std::uint64_t>, kTraceRings> read;
};

/// Atomic and SlotCount have other values than their defaults only in the tests' model.
template <class Row, template <class> class Atomic = std::atomic, std::size_t SlotCount = kRingRows>
struct Ring {
  static_assert(std::is_trivially_copyable_v<Row> && sizeof(Row) % 8 == 0);
  static constexpr std::size_t kWords = sizeof(Row) / 8;
  struct Slot {
    Atomic<std::uint64_t> version;  ///< 2 * (position + 1) when row `position` is complete
    std::array<Atomic<std::uint64_t>, kWords> words;
  };
  ChannelHead head;
  alignas(64) Atomic<std::uint64_t> written;  ///< rows appended by all writers
  Atomic<std::uint64_t> dropped;              ///< rows dropped by all writers
  Atomic<std::uint64_t> began;                ///< rows appended before the present writer began
  Atomic<std::uint64_t> thread;               ///< id of the thread that appends (gettid(2)); 0: not known
  alignas(64) std::array<Slot, SlotCount> slots;
};

template <class Row, template <class> class Atomic = std::atomic, std::size_t SlotCount = kRingRows>
class RingWriter {
 public:
  using Rows = Ring<Row, Atomic, SlotCount>;

  explicit RingWriter(Rows* memory = nullptr) noexcept : memory_(memory) {}

  /// Marks all rows in the ring as those of an earlier writer.
  void begin() noexcept {
    memory_->began.store(memory_->written.load(std::memory_order_relaxed), std::memory_order_release);
  }

  /// Appends a row. `read` is the reader's position, or null if there is no reader. Returns false if the row was
  /// dropped and counted.
  bool append(const Row& row, const Atomic<std::uint64_t>* read) noexcept {
    const std::uint64_t position = memory_->written.load(std::memory_order_relaxed);
    if (full_at(position, read)) {
      memory_->dropped.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    auto& slot = memory_->slots[position % SlotCount];
    const auto words = std::bit_cast<std::array<std::uint64_t, Rows::kWords>>(row);
    slot.version.store(2 * position + 1, std::memory_order_relaxed);
    for (std::size_t i = 0; i < words.size(); ++i) slot.words[i].store(words[i], std::memory_order_release);
    slot.version.store(2 * (position + 1), std::memory_order_relaxed);
    memory_->written.store(position + 1, std::memory_order_release);
    return true;
  }

  /// Returns whether `append` would drop the row.
  bool full(const Atomic<std::uint64_t>* read) const noexcept {
    return full_at(memory_->written.load(std::memory_order_relaxed), read);
  }

 private:
  static bool full_at(std::uint64_t position, const Atomic<std::uint64_t>* read) noexcept {
    if (read == nullptr) return false;
    const std::uint64_t done = read->load(std::memory_order_acquire);
    return position >= done && position - done >= SlotCount;
  }

  Rows* memory_;
};

template <class Row, template <class> class Atomic = std::atomic, std::size_t SlotCount = kRingRows>
class RingReader {
 public:
  using Rows = Ring<Row, Atomic, SlotCount>;

  /// Starts at the row that will be written next.
  explicit RingReader(const Rows* memory) noexcept
      : memory_(memory), position_(memory->written.load(std::memory_order_acquire)) {}

  /// Starts at `position`: 0 for every row that is still in the ring, or the position at which an earlier reader ended.
  RingReader(const Rows* memory, std::uint64_t position) noexcept : memory_(memory), position_(position) {}

  /// Reads the next row. Returns false if there is none yet, or if the writer disturbed it kReadTries times; the caller
  /// tries again later. Rows that were overwritten meanwhile are skipped and counted.
  bool read(Row& row) noexcept {
    for (int tries = 0; tries < kReadTries; ++tries) {
      const std::uint64_t written = memory_->written.load(std::memory_order_acquire);
      if (position_ >= written) {
        position_ = written;  // the position is that of an earlier reader, and the ring was created again since
        return false;
      }
      if (written - position_ > SlotCount) {
        overwritten_ += written - position_ - SlotCount;
        position_ = written - SlotCount;
      }
      const auto& slot = memory_->slots[position_ % SlotCount];
      const std::uint64_t expected = 2 * (position_ + 1);
      std::array<std::uint64_t, Rows::kWords> words;
      if (slot.version.load(std::memory_order_relaxed) == expected) {
        for (std::size_t i = 0; i < words.size(); ++i) words[i] = slot.words[i].load(std::memory_order_acquire);
        if (slot.version.load(std::memory_order_relaxed) == expected) {
          row = std::bit_cast<Row>(words);
          ++position_;
          return true;
        }
      }
      ++overwritten_;
      ++position_;
    }
    return false;
  }

  std::uint64_t position() const noexcept { return position_; }
  std::uint64_t written() const noexcept { return memory_->written.load(std::memory_order_acquire); }
  std::uint64_t overwritten() const noexcept { return overwritten_; }
  std::uint64_t dropped() const noexcept { return memory_->dropped.load(std::memory_order_relaxed); }

  /// Returns the position of the present writer's first row. Before it has appended a row, this is the position of its
  /// predecessor.
  std::uint64_t began() const noexcept { return memory_->began.load(std::memory_order_acquire); }

 private:
  const Rows* memory_;
  std::uint64_t position_;
  std::uint64_t overwritten_ = 0;
};

}  // namespace robot_control
