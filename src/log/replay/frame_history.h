#pragma once
/// The frames of one channel that a law may have used: those of the last cycles, found by their checksum.

#include <array>
#include <cstddef>
#include <cstdint>

namespace robot_control {

template <class Frame>
class FrameHistory {
 public:
  /// The log names the frame by `checksum`.
  void add(std::uint64_t checksum, const Frame& frame) noexcept {
    entries_[next_] = {true, checksum, frame};
    next_ = (next_ + 1) % kFrames;
  }

  /// Null: the history does not hold it.
  const Frame* find(std::uint64_t checksum) const noexcept {
    for (const Entry& entry : entries_) {
      if (entry.filled && entry.checksum == checksum) return &entry.frame;
    }
    return nullptr;
  }

  /// The newest frame of this cycle; null: there is none.
  const Frame* find(std::uint64_t run, std::uint64_t cycle) const noexcept {
    const Frame* found = nullptr;
    for (std::size_t i = 0; i < kFrames; ++i) {
      const Entry& entry = entries_[(next_ + i) % kFrames];
      if (entry.filled && entry.frame.head.run == run && entry.frame.head.cycle == cycle) found = &entry.frame;
    }
    return found;
  }

 private:
  static constexpr std::size_t kFrames = 32;  ///< a channel has 8 slots; a pause may fill more than one a cycle

  struct Entry {
    bool filled = false;
    std::uint64_t checksum = 0;
    Frame frame;
  };
  std::array<Entry, kFrames> entries_{};
  std::size_t next_ = 0;
};

}  // namespace robot_control
