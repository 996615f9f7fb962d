/// A writer changes any word between any two reads, and a reader still ends within a fixed number of loads. The atomics
/// of this test give another value at every load.

#include <gtest/gtest.h>

#include "bus/latest_frames.h"
#include "bus/latest_value.h"
#include "bus/ring.h"
#include "support/bus/damage.h"

namespace robot_control::tests {

constexpr int kLooks = 100'000;

Damage hostile(1);
std::uint64_t counted_loads = 0;

template <class T>
struct HostileAtomic {
  HostileAtomic() = default;
  HostileAtomic(T) {}  // NOLINT: as std::atomic
  T load(std::memory_order) const noexcept {
    ++counted_loads;
    return static_cast<T>(hostile.number());
  }
  void store(T, std::memory_order) noexcept {}
};

struct Frame {
  FrameHead head;
};

struct Row {
  std::array<std::uint64_t, 3> values{};
};

/// The largest number of loads in one call.
template <class Look>
std::uint64_t most_loads(Look look) {
  std::uint64_t largest = 0;
  for (int i = 0; i < kLooks; ++i) {
    counted_loads = 0;
    look();
    largest = std::max(largest, counted_loads);
  }
  return largest;
}

TEST(BoundedReader, TriesToReadFramesAsOftenAsItMay) {
  const LatestFrames<Frame, HostileAtomic> memory{};
  const FrameReader<Frame, HostileAtomic> reader(&memory);
  Frame frame;
  constexpr std::uint64_t kCopy = 2 + kFrameWords<Frame>;  // the version before and after
  const std::uint64_t newest = most_loads([&] { reader.newest(frame); });
  EXPECT_LE(newest, kReadTries * (2 + kCopy));
  EXPECT_GT(newest, 2 + kCopy);  // it does try again
  EXPECT_LE(most_loads([&] { reader.at(7, 9, frame); }), kReadTries * kCopy);
  EXPECT_LE(most_loads([&] { reader.newest_within(7, hostile.number(), hostile.number(), frame); }),
            kFrameSlots * kReadTries * kCopy);
}

TEST(BoundedReader, TriesToReadAValueAsOftenAsItMay) {
  const LatestValue<Row, HostileAtomic> latest;
  Row value;
  const std::uint64_t largest = most_loads([&] { latest.load(value); });
  EXPECT_LE(largest, 4u * (2 + 3));
  EXPECT_GT(largest, 2u + 3u);
}

TEST(BoundedReader, TriesToReadARingAsOftenAsItMay) {
  const Ring<Row, HostileAtomic, 16> ring{};
  RingReader<Row, HostileAtomic, 16> reader(&ring, 0);
  Row row;
  const std::uint64_t largest = most_loads([&] { reader.read(row); });
  EXPECT_LE(largest, kReadTries * (1 + 2 + 3));
  EXPECT_GT(largest, 1u + 2u + 3u);
}

}  // namespace robot_control::tests
