// A node's end of the trace, with a telemetry that reads or does not.

#include "loop/cycles/trace_sink.h"

#include <gtest/gtest.h>

#include <thread>

#include "support/bus/scoped_bus.h"

namespace robot_control::tests {

struct Row {
  std::uint64_t number = 0;
};

struct TraceSinkTest : testing::Test {
  static constexpr TraceRing kRing = TraceRing::kController;

  std::string bus() const { return bus_.name(); }

  /// Appends that many rows, numbered from `first`.
  static void append(TraceSink<Row>& sink, std::uint64_t first, std::size_t count,
                     const LawSnapshot* snapshot = nullptr) {
    std::atomic<bool> stop = false;
    for (std::uint64_t i = 0; i < count; ++i) sink.append({first + i}, snapshot, stop);
  }

 private:
  ScopedBus bus_;
};

/// The reader's side: positions, which a telemetry owns while it lives.
class Telemetry {
 public:
  explicit Telemetry(const std::string& bus)
      : rows_(bus, kTraceChannels[2]),
        snapshots_(bus, kSnapshotChannels[2]),
        positions_(bus, ChannelNames::kTraceRead) {
    rows_.poll();
    snapshots_.poll();
    positions_.memory()->head.attached_run.store(1);
  }
  ~Telemetry() { positions_.memory()->head.attached_run.store(0); }
  Telemetry(const Telemetry&) = delete;
  Telemetry& operator=(const Telemetry&) = delete;

  RingReader<Row> reader() { return RingReader<Row>(rows_.memory(), 0); }
  SnapshotReader snapshots() { return SnapshotReader(snapshots_.memory(), 0); }
  std::uint64_t thread() const { return rows_.memory()->thread.load(); }
  void has_read(std::uint64_t rows) { positions_.memory()->read[2].store(rows); }

 private:
  ForeignChannel<Ring<Row>> rows_;
  ForeignChannel<SnapshotRing> snapshots_;
  OwnedChannel<RingPositions> positions_;
};

TEST_F(TraceSinkTest, OverwritesTheOldestRowsWithoutAReader) {
  TraceSink<Row> sink(bus(), kRing, true);
  append(sink, 0, kRingRows + 3);
  Telemetry telemetry(bus());
  RingReader<Row> reader = telemetry.reader();
  Row row;
  ASSERT_TRUE(reader.read(row));
  EXPECT_EQ(row.number, 3U);
  EXPECT_EQ(reader.dropped(), 0U);
}

TEST_F(TraceSinkTest, DropsAndCountsTheNewRowInWallClockTime) {
  TraceSink<Row> sink(bus(), kRing, false);
  Telemetry telemetry(bus());
  sink.poll();
  append(sink, 0, kRingRows + 3);
  RingReader<Row> reader = telemetry.reader();
  Row row;
  ASSERT_TRUE(reader.read(row));
  EXPECT_EQ(row.number, 0U);
  EXPECT_EQ(reader.dropped(), 3U);
}

TEST_F(TraceSinkTest, BlocksInLockstepUntilARowIsRead) {
  TraceSink<Row> sink(bus(), kRing, true);
  Telemetry telemetry(bus());
  sink.poll();
  append(sink, 0, kRingRows);
  std::atomic<bool> appended = false;
  std::thread writer([&] {
    append(sink, kRingRows, 1);
    appended = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_FALSE(appended);
  telemetry.has_read(1);
  writer.join();
  EXPECT_EQ(telemetry.reader().dropped(), 0U);
  EXPECT_EQ(telemetry.reader().written(), kRingRows + 1);
}

TEST_F(TraceSinkTest, ABlockedWriterEndsWithItsProcess) {
  TraceSink<Row> sink(bus(), kRing, true);
  Telemetry telemetry(bus());
  sink.poll();
  append(sink, 0, kRingRows);
  const std::atomic<bool> stop = true;
  sink.append({1}, nullptr, stop);
  EXPECT_EQ(telemetry.reader().dropped(), 1U);
}

TEST_F(TraceSinkTest, ATelemetryThatEndedBlocksNobody) {
  TraceSink<Row> sink(bus(), kRing, true);
  {
    const Telemetry telemetry(bus());
    sink.poll();
  }
  sink.poll();
  append(sink, 0, kRingRows + 1);
  EXPECT_EQ(Telemetry(bus()).reader().dropped(), 0U);
}

TEST_F(TraceSinkTest, HandsOnSnapshotsAndItsThread) {
  TraceSink<Row> sink(bus(), kRing, false);
  LawSnapshot snapshot{};
  snapshot.law = LawName::kController;
  append(sink, 0, 2, &snapshot);
  append(sink, 2, 3);
  sink.announce_thread(42);
  Telemetry telemetry(bus());
  SnapshotReader snapshots = telemetry.snapshots();
  LawSnapshot out{};
  EXPECT_EQ(snapshots.written(), 2U);
  ASSERT_TRUE(snapshots.read(out));
  EXPECT_EQ(out.law, LawName::kController);
  EXPECT_EQ(telemetry.thread(), 42U);
}

}  // namespace robot_control::tests
