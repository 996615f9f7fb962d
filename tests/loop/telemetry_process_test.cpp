#include "loop/processes/telemetry_process.h"

#include "cycle_fixture.h"
#include "loop/cycles/trace_sink.h"
#include "robots/differential_drive.h"
#include "support/bus/scoped_bus.h"
#include "support/matchers.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

struct TelemetryProcessTest : testing::Test {
  using Channel = OwnedChannel<Ring<DriverTrace>>;

  Channel claim() const { return {bus_.name(), kTraceChannels[0]}; }

  static void append(RingWriter<DriverTrace>& writer, std::uint64_t rows) {
    DriverTrace row{};
    for (; rows != 0; --rows, ++row.sensors.head.cycle) writer.append(row, nullptr);
  }

  /// Leaves rows of a node that has ended.
  void leave_rows(std::uint64_t rows) const {
    const Channel channel = claim();
    RingWriter<DriverTrace> writer(channel.memory());
    writer.begin();
    append(writer, rows);
  }

  TelemetryProcess telemetry() const {
    Parameters parameters;
    parameters.telemetry.directory = folder_.path();
    parameters.telemetry.record = RecordMode::kOff;
    parameters.telemetry.black_box = 0;
    return {parameters, DifferentialDrive(parameters, two_wheels()), bus_.name()};
  }

 private:
  ScopedBus bus_;
  TemporaryFolder folder_;
};

TEST(TimingSummaries, NameTheProgramsOfTheRobot) {
  const TraceSummary summary = TimingSummary({.kind = kLeggedKind, .driver = "driver"}).summary(1, {});
  EXPECT_THAT(summary.names, testing::IsSupersetOf({"driver.wake_up", "leg_controller.wake_up.10s"}));
  EXPECT_THAT(summary.counters, testing::Contains("driver.overruns"));
}

TEST_F(TelemetryProcessTest, TakesNoRowOfAnEndedWriterWhileTheNextOneStarts) {
  leave_rows(10);
  const Channel channel = claim();  // locked; it holds nothing of its new writer yet
  TelemetryProcess telemetry = this->telemetry();
  telemetry.poll();
  EXPECT_EQ(telemetry.drain(), 0u);
  RingWriter<DriverTrace> writer(channel.memory());
  writer.begin();
  EXPECT_EQ(telemetry.drain(), 0u);
  append(writer, 3);
  EXPECT_EQ(telemetry.drain(), 3u);
}

TEST_F(TelemetryProcessTest, TakesWhatALivingWriterWroteBeforeOnceItWritesAgain) {
  leave_rows(10);
  const Channel channel = claim();
  RingWriter<DriverTrace> writer(channel.memory());
  writer.begin();
  append(writer, 5);
  TelemetryProcess telemetry = this->telemetry();
  telemetry.poll();
  EXPECT_EQ(telemetry.drain(), 0u) << "it may have ended";
  append(writer, 1);
  EXPECT_EQ(telemetry.drain(), 6u);
}

}  // namespace robot_control::tests
