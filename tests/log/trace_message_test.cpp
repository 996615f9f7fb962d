#include "log/messages/trace_message.h"

#include <cmath>
#include <cstring>

#include "log/messages/message_types.h"
#include "log/packed_chunk.h"
#include "recorded_drive.h"
#include "signals/names.h"
#include "support/log_table.h"
#include "support/matchers.h"
#include "support/recorded_loop.h"

namespace robot_control::tests {

struct TraceMessages : testing::Test {
  TraceMessages() : TraceMessages(drive_parameters()) {}
  explicit TraceMessages(const Parameters& parameters) : loop(parameters) {}

  /// Visits every row of a drive, and the row that was read from its message.
  template <class Visit>
  void each(std::uint64_t cycles, Visit visit) {
    drive(loop, cycles, [&](const JoinedRow& row) {
      encode_trace({.row = row, .joints = loop.robot().machine().joints.size()}, message);
      decoder.decode(message, read);
      visit(row, read.joined(loop.parameters().loop.period()));
    });
  }

  RecordedLoop loop;
  TraceDecoder decoder{trace_definition()};
  std::string message;
  TraceRow read;
};

TEST_F(TraceMessages, AreThoseOfTheMessageFile) {
  EXPECT_EQ(trace_definition(), trace_type().definition) << "run tests/docs/trace_message.py, then build";
}

TEST_F(TraceMessages, HoldTheSensorsBitForBit) {
  each(2000, [](const JoinedRow&, const JoinedRow& again) {
    ASSERT_NE(again.driver, nullptr);
    ASSERT_TRUE(intact(again.driver->sensors)) << "cycle " << again.cycle;
  });
}

TEST_F(TraceMessages, HoldWhatEachLawWasGivenBitForBit) {
  const auto same = [](const auto& a, const auto& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
  each(2000, [&](const JoinedRow& row, const JoinedRow& again) {
    ASSERT_TRUE(same(row.driver->calls, again.driver->calls)) << "cycle " << again.cycle;
    ASSERT_TRUE(same(row.estimator->calls, again.estimator->calls)) << "cycle " << again.cycle;
    ASSERT_TRUE(same(row.controller->calls, again.controller->calls)) << "cycle " << again.cycle;
    ASSERT_TRUE(same(row.controller->tuning, again.controller->tuning)) << "cycle " << again.cycle;
    ASSERT_TRUE(same(row.monitor->calls, again.monitor->calls)) << "cycle " << again.cycle;
    ASSERT_TRUE(same(row.driver->gate, again.driver->gate)) << "cycle " << again.cycle;
  });
}

TEST_F(TraceMessages, HoldEveryColumnOfTheTable) {
  constexpr double kFloat = 1.2e-7;  // relative error of a float32, 2^-23
  const MachineModel& robot = loop.robot().machine();
  const std::vector<TraceColumn> columns = log_columns(joint_names(robot), robot.contacts, true);
  each(3000, [&](const JoinedRow& row, const JoinedRow& again) {
    for (const TraceColumn& column : columns) {
      const double expected = column.value(row, column.element);
      const double found = column.value(again, column.element);
      if (std::isnan(expected) || column.integer) {
        ASSERT_TRUE(LogTable::same(expected, found)) << column.name;
        continue;
      }
      // Angles are computed from four float32 up to 1.
      ASSERT_NEAR(found, expected, 4 * kFloat * std::max(1.0, std::abs(expected))) << column.name;
    }
  });
}

TEST_F(TraceMessages, HoldTheWholeFrameThatAFaultChanged) {
  for (const auto& [component, kind] :
       {std::pair{"controller", "wrong"}, {"monitor", "garbage"}, {"estimator", "off"}}) {
    loop.inject_fault(component, kind);
    int changed = 0;
    each(300, [&](const JoinedRow& row, const JoinedRow& again) {
      if (row.controller != nullptr && row.controller->calls.law.output != row.controller->command.head.checksum) {
        ASSERT_EQ(std::memcmp(&row.controller->command, &again.controller->command, sizeof(CommandFrame)), 0);
        ++changed;
      }
      if (row.monitor != nullptr && row.monitor->calls.law.output != row.monitor->permit.head.checksum) {
        ASSERT_EQ(std::memcmp(&row.monitor->permit, &again.monitor->permit, sizeof(Permit)), 0);
        ++changed;
      }
      ASSERT_EQ(row.estimator == nullptr, again.estimator == nullptr);
      ASSERT_EQ(row.laws.estimator == nullptr, again.laws.estimator == nullptr);
      if (row.estimator == nullptr) ++changed;
    });
    EXPECT_GT(changed, 100) << component << " " << kind;
    loop.inject_fault(component, "ok");
  }
}

TEST_F(TraceMessages, HoldWholeFramesNearASnapshot) {
  for (int i = 0; i < 5; ++i) loop.step();
  encode_trace({.row = loop.row(), .joints = 2}, message);
  decoder.decode(message, read);
  EXPECT_TRUE(intact(read.estimator.state));
  EXPECT_TRUE(intact(read.controller.command));
  EXPECT_TRUE(intact(read.monitor.permit));
}

TEST_F(TraceMessages, HoldTheLawAloneOfARowThatRepeatsACycle) {
  loop.step();
  JoinedRow row{.run = 3, .cycle = 7};
  row.repeats = true;
  row.laws.estimator = loop.row().laws.estimator;
  encode_trace({.row = row, .joints = 2}, message);
  decoder.decode(message, read);
  const JoinedRow again = read.joined(0.001);
  EXPECT_TRUE(again.repeats);
  EXPECT_EQ(again.driver, nullptr);
  EXPECT_EQ(again.estimator, nullptr);
  EXPECT_EQ(again.laws.estimator, &read.estimator);
  EXPECT_EQ(read.estimator.calls.law.output, row.laws.estimator->calls.law.output);
}

TEST_F(TraceMessages, AreRefusedIfTheyAreTooShortOrTooLong) {
  each(1, [](const JoinedRow&, const JoinedRow&) {});
  const std::string whole = message;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW(decoder.decode(std::string_view(whole).substr(0, size), read), TraceError) << size;
  }
  EXPECT_THROW(decoder.decode(whole + "x", read), TraceError);
}

TEST_F(TraceMessages, AreReadByTheNamesOfTheirFieldsInAnotherVersion) {
  const TraceDecoder other(
      "# an earlier version\nuint8 KIND=3\nfloat32[] of_another_version # m\nuint64 cycle\nuint32 run\n");
  std::string bytes;
  ByteSink sink(bytes);
  sink.number(std::uint32_t{2});
  sink.number(1.0F);
  sink.number(2.0F);
  sink.number(std::uint64_t{77});
  sink.number(std::uint32_t{9});
  other.decode(bytes, read);
  EXPECT_EQ(read.cycle, 77u);
  EXPECT_EQ(read.run, 0) << "of another type";
  EXPECT_THAT(other.missing(), testing::Contains("gyro"));
}

TEST_F(TraceMessages, AreRefusedWithAListLongerThanItsMember) {
  const TraceDecoder list("float64[] joint_position\n");
  std::string bytes("\x21\0\0\0", 4);
  bytes.append(33 * 8, '\0');
  EXPECT_THAT([&] { list.decode(bytes, read); }, testing::ThrowsMessage<TraceError>(HasSubstr("joint_position")));
}

}  // namespace robot_control::tests
