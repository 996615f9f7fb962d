/// Runs the laws of a log with other parameters.

#include <gtest/gtest.h>

#include "log/replay/recorded.h"
#include "robots/differential_drive.h"
#include "support/recorded_loop.h"

namespace robot_control::tests {

struct VariedDrive : testing::Test {
  void drive(double speed) {
    for (int k = 0; k < 2000; ++k) {
      if (k % 50 == 0) loop.command({.linear = {speed, 0, 0}, .angular = {0, 0, 0.2}});
      loop.step();
      recording.add(loop);
    }
  }

  /// `watch` gets the results that the laws of `varied` would have given.
  ReplayReport replay(const Parameters& varied, const std::function<void(const VariedRow&)>& watch) const {
    Replay again(loop.robot(), parameters.loop.period());
    again.vary(DifferentialDrive(varied, drive_train_of(loop.robot().machine())), watch);
    for (const LawSnapshot& snapshot : recording.snapshots) again.add(snapshot);
    for (const RecordedRow& row : recording.rows) again.add(row.joined());
    return again.report();
  }

  Parameters parameters = default_parameters();
  RecordedLoop loop{parameters};
  Recording recording;
};

TEST_F(VariedDrive, IsTheSameWithTheSameParameters) {
  drive(0.5);
  int states = 0, commands = 0, permits = 0;
  const ReplayReport report = replay(parameters, [&](const VariedRow& row) {
    if (row.state != nullptr) {
      ++states;
      ASSERT_EQ(row.varied_state->base.pose_odom.position, row.state->base.pose_odom.position) << row.cycle;
      ASSERT_EQ(row.varied_state->base.pose_covariance, row.state->base.pose_covariance) << row.cycle;
    }
    if (row.command != nullptr) {
      ++commands;
      ASSERT_EQ(row.varied_command->joints[1].effort, row.command->joints[1].effort) << row.cycle;
    }
    if (row.permit != nullptr) {
      ++permits;
      ASSERT_EQ(row.varied_permit->state, row.permit->state) << row.cycle;
    }
  });
  EXPECT_TRUE(report.exact()) << text_of(report);
  EXPECT_EQ(states, 2000);
  EXPECT_EQ(commands, 2000);
  EXPECT_EQ(permits, 2000);
}

TEST_F(VariedDrive, PlansASlowerDriveWithALowerLimitWhileTheLogIsComputedAgainExactly) {
  constexpr double kLimit = 0.3;  // m/s
  drive(0.5);
  Parameters slow = parameters;
  slow.controller.max_linear_speed = kLimit;
  double fastest = 0, logged = 0;
  const ReplayReport report = replay(slow, [&](const VariedRow& row) {
    if (row.command == nullptr) return;
    fastest = std::max(fastest, row.varied_command->twist_limited.linear[0]);
    logged = std::max(logged, row.command->twist_limited.linear[0]);
  });
  EXPECT_TRUE(report.exact()) << text_of(report);
  EXPECT_NEAR(logged, 0.5, 1e-9);
  EXPECT_NEAR(fastest, kLimit, 1e-9);
}

TEST_F(VariedDrive, IsLessSureOfItsPathWithANoisierGyro) {
  drive(0.5);
  Parameters other = parameters;
  other.estimator.gyro_noise *= 3;
  bool differs = false;
  const ReplayReport report = replay(other, [&](const VariedRow& row) {
    if (row.state != nullptr)
      differs = differs || row.varied_state->base.pose_covariance != row.state->base.pose_covariance;
  });
  EXPECT_TRUE(report.exact()) << text_of(report);
  EXPECT_TRUE(differs);
}

}  // namespace robot_control::tests
