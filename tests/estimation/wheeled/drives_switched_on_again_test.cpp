// A drive loses its supply while the robot moves, and is switched on again with another zero.

#include "estimation/wheeled/estimator_fixture.h"

namespace robot_control::tests {

constexpr double kOtherZero = 7.0;  // rad

/// Healthy case: a second of standing, then 1 m/s straight ahead. A drive without a supply has no valid sample.
struct DrivesSwitchedOnAgain : EstimatorFixture {
  DrivesSwitchedOnAgain() {
    stand();
    drive(1.0, 0, 2000);
  }

  void observe_drives() {
    SensorFrame frame = robot_.frame();
    for (const std::size_t i : {0U, 1U}) {
      frame.joints[i].position += zero_[i];
      if (off_[i]) frame.joints[i] = {};
      frame.joints[i].fault = fault_[i];
    }
    estimator_.step(frame, state_);
  }
  void run(double linear, double angular, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      robot_.drive(linear, angular);
      observe_drives();
    }
  }
  void switch_off(std::size_t joint) {
    off_[joint] = true;
    fault_[joint] = 1;
  }
  void switch_on(std::size_t joint) {
    off_[joint] = false;
    fault_[joint] = 0;
    zero_[joint] = kOtherZero - robot_.frame().joints[joint].position;
  }
  /// Returns how far the position moves in the next cycles, m.
  double jump(int cycles = 500) {
    const double before_x = x(), before_y = y();
    run(0, 0, cycles);
    return std::hypot(x() - before_x, y() - before_y);
  }
  double deviation() const { return std::sqrt(state_.base.pose_covariance[0]); }

  std::array<bool, 2> off_{};
  std::array<std::uint32_t, 2> fault_{};
  std::array<double, 2> zero_{};  // rad
};

TEST_F(DrivesSwitchedOnAgain, TheTravelMeanwhileIsUnknown) {
  switch_off(0);
  switch_off(1);
  run(0, 0, 4000);
  switch_on(0);
  switch_on(1);
  EXPECT_LT(jump(), 0.05);
  EXPECT_LT(position_error(), 3 * deviation());
  EXPECT_TRUE(has(kStateValid));
}

// The drive reports its fault with its position, until the reset takes both from it.
TEST_F(DrivesSwitchedOnAgain, AResetMayChangeTheZeroOfADriveThatHadAPosition) {
  fault_ = {1, 1};
  run(0, 0, 3000);
  const double before = position_error();
  fault_ = {};
  off_ = {true, true};
  run(0, 0, 500);
  switch_on(0);
  switch_on(1);
  EXPECT_LT(jump(), 0.05);
  EXPECT_NEAR(position_error(), before, 0.05);
}

TEST_F(DrivesSwitchedOnAgain, ATurnMeanwhileIsNoTravel) {
  switch_off(0);
  switch_off(1);
  run(0, 2.0, 3000);
  run(0, 0, 1000);
  switch_on(0);
  run(0, 0, 50);
  switch_on(1);
  EXPECT_LT(jump(), 0.05);
  EXPECT_LT(position_error(), 3 * deviation());
}

TEST_F(DrivesSwitchedOnAgain, TheOtherSideReplacesOneDrive) {
  switch_off(0);
  run(0, 0.5, 4000);
  const double deviation_before = deviation();
  switch_on(0);
  EXPECT_LT(jump(), 0.01);
  EXPECT_LT(position_error(), 0.01);
  EXPECT_LT(deviation(), deviation_before + 2 * Tuning::kRestart);
}

// The robot turns about a wheel that stands and is still turning when the other drive is back. The difference of wheels
// and gyro, here 3 % of the turn, moves no pose: the wheels may slip in such a stop.
TEST_F(DrivesSwitchedOnAgain, TheFirstBlockThereafterMovesNoPose) {
  switch_off(0);
  run(-0.5, 2.0, 4000);
  switch_on(0);
  robot_.wheel_base = 0.03;
  double farthest = 0;
  for (int i = 0; i < 2000; ++i) {
    const double before_x = x() - robot_.x(), before_y = y() - robot_.y();
    run(i < 500 ? -0.5 : 0, i < 500 ? 2.0 : 0, 1);
    farthest = std::max(farthest, std::hypot(x() - robot_.x() - before_x, y() - robot_.y() - before_y));
  }
  EXPECT_LT(farthest, 0.001);
}

TEST_F(DrivesSwitchedOnAgain, TheDistanceGoesOn) {
  switch_off(0);
  switch_off(1);
  run(0, 0, 4000);
  switch_on(0);
  switch_on(1);
  run(0, 0, 500);
  const double before_x = x();
  const double before_true = robot_.x();
  run(0.5, 0, 2000);
  EXPECT_NEAR(x() - before_x, robot_.x() - before_true, 0.002);
}

}  // namespace robot_control::tests
