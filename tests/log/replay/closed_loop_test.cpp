/// Drives of the closed loop, computed again from their rows, bit by bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "log/replay/continuity.h"
#include "log/replay/recorded.h"
#include "support/recorded_loop.h"

namespace robot_control::tests {

constexpr std::uint64_t kSecond = 1000;  // cycles

struct ReplayedDrive : testing::Test {
  /// Calls `act(k)` before each step.
  void drive(
      std::uint64_t cycles, const std::function<void(std::uint64_t)>& act = [](std::uint64_t) {}) {
    for (std::uint64_t k = 0; k < cycles; ++k) {
      if (k % 50 == 0) loop.command({.linear = {0.4, 0, 0}, .angular = {0, 0, 0.3 * std::sin(0.001 * double(k))}});
      act(k);
      loop.step();
      recording.add(loop);
    }
  }

  ReplayReport replay() const { return recording.replay(loop.robot(), parameters.loop.period()); }

  void expect_all_compared() const {
    const ReplayReport report = replay();
    EXPECT_TRUE(report.exact()) << text_of(report);
    EXPECT_EQ(report_of(report, LawName::kGate).compared, recording.rows.size());
    EXPECT_EQ(report_of(report, LawName::kEstimator).compared, count(&RecordedRow::has_estimator));
    EXPECT_EQ(report_of(report, LawName::kController).compared, count(&RecordedRow::has_controller));
    EXPECT_EQ(report_of(report, LawName::kMonitor).compared, count(&RecordedRow::has_monitor));
    EXPECT_TRUE(report.gaps.empty()) << text_of(report);
  }

  std::uint64_t count(bool RecordedRow::*has) const {
    return static_cast<std::uint64_t>(std::ranges::count(recording.rows, true, has));
  }

  RecordedRow& row(std::uint64_t cycle) { return recording.rows.at(cycle); }
  static const LawReport& report_of(const ReplayReport& report, LawName law) {
    return report.laws[static_cast<std::size_t>(law)];
  }

  Parameters parameters = default_parameters();
  std::optional<RecordedLoop> made{std::in_place, parameters};
  ClosedLoop& loop = *made;
  Recording recording;
};

TEST_F(ReplayedDrive, IsExactWithEveryFaultOfEveryComponent) {
  for (const std::string component : {"left_encoder", "gyro", "accelerometer", "controller", "estimator", "monitor"}) {
    for (const std::string kind : {"off", "stuck", "garbage", "wrong", "slow", "delayed", "intermittent"}) {
      SCOPED_TRACE(component + " " + kind);
      recording = {};
      made.emplace(parameters);
      drive(600, [&, this](std::uint64_t k) {
        if (k == 300) loop.inject_fault(component, kind);
        if (k == 450) loop.inject_fault(component, "ok");
      });
      expect_all_compared();
    }
  }
}

TEST_F(ReplayedDrive, IsExactForWheelsThatTakeSpeedsAndMeasureNoTorque) {
  parameters.robot.wheel_command = WheelCommand::kVelocity;
  parameters.plant.drive = SimulatedDrive::kVelocity;
  made.emplace(parameters);
  std::vector<LoggedMessage> messages;
  drive(kSecond, [&, this](std::uint64_t k) {
    if (k == 0) return;
    ASSERT_TRUE(std::isnan(loop.row().driver->sensors.joints[0].effort)) << k;
    robot_control::log(loop.row(), loop.robot().machine().joints.size(), messages);
  });
  expect_all_compared();
  const ReplayReport report =
      robot_control::replay(messages, recording.snapshots, loop.robot(), parameters.loop.period());
  EXPECT_TRUE(report.exact()) << text_of(report);
  EXPECT_EQ(report.rows, messages.size());
}

TEST_F(ReplayedDrive, BeginsAtASnapshotInTheMiddle) {
  constexpr std::uint64_t kSnapshot = 3 * kSnapshotCycles, kBefore = kSnapshot - 10;
  drive(kSnapshot + 300);
  std::erase_if(recording.snapshots, [](const LawSnapshot& snapshot) { return snapshot.head.cycle < kBefore; });
  recording.rows.erase(recording.rows.begin(), recording.rows.begin() + kBefore);
  const ReplayReport report = replay();
  EXPECT_TRUE(report.exact()) << text_of(report);
  for (const LawReport& law : report.laws) EXPECT_EQ(law.compared, 300u) << text_of(report);
}

TEST_F(ReplayedDrive, NamesTheCyclesThatAreNotComparedAfterALostRowAndResumes) {
  constexpr std::uint64_t kSnapshot = 2 * kSnapshotCycles, kLost = kSnapshot - 100;
  drive(kSnapshot + 200);
  row(kLost).has_monitor = false;
  const ReplayReport report = replay();
  EXPECT_TRUE(report.exact()) << text_of(report);
  const LawReport& monitor = report_of(report, LawName::kMonitor);
  EXPECT_EQ(monitor.compared, kSnapshot + 100) << text_of(report);
  ASSERT_FALSE(report.gaps.empty());
  const auto gap = std::ranges::find(report.gaps, LawName::kMonitor, &ReplayGap::law);
  EXPECT_EQ(gap->first, kLost + 1);
  EXPECT_EQ(gap->last, kSnapshot - 1);
  EXPECT_EQ(gap->reason, "rows are missing");
}

TEST_F(ReplayedDrive, NamesTheFieldThatDiffers) {
  drive(20);  // near a snapshot: frames are whole
  CommandFrame& command = row(5).controller.command;
  command.twist_limited.angular[2] += 1;
  seal(command);
  row(5).controller.calls.law.output = command.head.checksum;
  const ReplayReport report = replay();
  ASSERT_FALSE(report.exact());
  EXPECT_EQ(report.differences[0].law, LawName::kController);
  EXPECT_EQ(report.differences[0].cycle, 5u);
  EXPECT_EQ(report.differences[0].field, "limited_angular[2]");
}

TEST_F(ReplayedDrive, FindsAnInputThatIsNotTheOneThatWasUsed) {
  drive(kSecond);
  row(500).controller.calls.request.content.twist.linear[0] = 0.1;
  const ReplayReport report = replay();
  ASSERT_FALSE(report.exact());
  EXPECT_EQ(report.differences[0].law, LawName::kController);
  EXPECT_EQ(report.differences[0].cycle, 500u);
}

TEST_F(ReplayedDrive, IsRefusedByAnotherBuild) {
  drive(3);
  recording.snapshots[0].build ^= 1;
  seal(recording.snapshots[0]);
  EXPECT_THROW(replay(), ReplayError);
}

TEST_F(ReplayedDrive, DoesNotUseADamagedSnapshotAndIsNotExactWithIt) {
  drive(3);
  recording.snapshots[0].state[100] ^= std::byte{1};
  const ReplayReport report = replay();
  EXPECT_EQ(report.damaged_snapshots, 1u);
  EXPECT_TRUE(report.differences.empty()) << text_of(report);
  EXPECT_FALSE(report.exact());
}

}  // namespace robot_control::tests
