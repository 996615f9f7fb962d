#include "ros/wheeled/calibration_keeper.h"

#include <gtest/gtest.h>

#include "ros/nanoseconds.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

/// The healthy case has a state that learned something, and a file in an existing folder.
struct CalibrationKeeperTest : testing::Test {
  CalibrationKeeperTest() {
    robot_.name = "diffbot";
    robot_.wheels.resize(2);
    robot_.wheels[0].radius = robot_.wheels[1].radius = 0.1;
    robot_.wheel_base = 0.5;
    parameters_.calibration_file = folder_.path() / "learned.yaml";
    state_.base.flags = kStateValid;
    state_.wheeled.calibration = {.radius_ratio = 1.01, .radius_ratio_deviation = 0.001};
  }

  std::optional<LearnedCalibration> kept() const {
    return read_calibration(folder_.path() / "learned.yaml", robot_, parameters_.estimator);
  }

  TemporaryFolder folder_;
  DriveTrain robot_;
  Parameters parameters_;
  StateFrame state_;
};

TEST_F(CalibrationKeeperTest, WritesAfterThirtySecondsAndNotBefore) {
  CalibrationKeeper keeper(parameters_, robot_);
  keeper.write_if_due(state_, 100 * kSecond);
  keeper.write_if_due(state_, 129 * kSecond);
  keeper.wait();
  EXPECT_FALSE(kept());
  keeper.write_if_due(state_, 130 * kSecond);
  keeper.wait();
  ASSERT_TRUE(kept());
  EXPECT_EQ(kept()->wheels.radius_ratio, 1.01);
  state_.wheeled.calibration = {.radius_ratio = 1.02, .radius_ratio_deviation = 0.0005};
  keeper.write_if_due(state_, 159 * kSecond);
  keeper.wait();
  EXPECT_EQ(kept()->wheels.radius_ratio, 1.01);
  keeper.write_if_due(state_, 160 * kSecond);
  keeper.wait();
  EXPECT_EQ(kept()->wheels.radius_ratio, 1.02);
}

TEST_F(CalibrationKeeperTest, WritesAtTheEnd) {
  CalibrationKeeper keeper(parameters_, robot_);
  keeper.finish(state_);
  EXPECT_TRUE(kept());
}

TEST_F(CalibrationKeeperTest, WritesNothingOfAStateThatIsNotValid) {
  CalibrationKeeper keeper(parameters_, robot_);
  state_.base.flags = 0;
  keeper.finish(state_);
  EXPECT_FALSE(kept());
}

TEST_F(CalibrationKeeperTest, WritesNothingWhereNothingIsLearned) {
  parameters_.estimator.self_calibration = false;
  CalibrationKeeper(parameters_, robot_).finish(state_);
  EXPECT_FALSE(kept());
}

TEST_F(CalibrationKeeperTest, WithoutAFileDoesNothing) {
  parameters_.calibration_file.clear();
  CalibrationKeeper(parameters_, robot_).finish(state_);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(CalibrationKeeperTest, GoesOnWhereItCannotWriteAndTriesAgain) {
  const std::filesystem::path folder = folder_.path() / "gone";
  parameters_.calibration_file = folder / "learned.yaml";
  CalibrationKeeper keeper(parameters_, robot_);
  keeper.finish(state_);
  std::filesystem::create_directory(folder);
  keeper.finish(state_);
  EXPECT_TRUE(std::filesystem::exists(folder / "learned.yaml"));
}

TEST_F(CalibrationKeeperTest, GivesTheNextStartWhatItKept) {
  CalibrationKeeper(parameters_, robot_).finish(state_);
  const Parameters next = with_calibration(parameters_, robot_);
  EXPECT_EQ(next.estimator.calibration.radius_ratio, 1.01);
  EXPECT_GT(next.estimator.calibration.radius_ratio_deviation, 0.001);
  EXPECT_EQ(next.estimator.calibration.wheel_base_factor, 1);
}

}  // namespace robot_control::tests
