#include <gtest/gtest.h>

#include "log/bag_log.h"
#include "log/rows/traces.h"

namespace robot_control::tests {

constexpr std::int64_t kSecond = 1'000'000'000;

/// A robot that stands, and nothing is requested.
struct AMotionWatch : testing::Test {
  AMotionWatch() {
    estimator.state.base.flags = kStateValid | kStateStandstill;
    row.driver = &driver;
    row.set({.estimator = &estimator, .controller = &controller, .monitor = &monitor});
    while (watch.step(row, now)) now += kSecond / 10;  // the first row is a start
  }

  bool step() { return watch.step(row, now += kSecond / 1000); }

  DriverTrace driver = driver_row(1, 0);
  EstimatorTrace estimator = estimator_row(1, 0);
  ControllerTrace controller = controller_row(1, 0);
  MonitorTrace monitor = monitor_row(1, 0);
  JoinedRow row;
  MotionWatch watch;
  std::int64_t now = 0;
};

TEST_F(AMotionWatch, SeesNothingWhereNothingMoves) {
  EXPECT_FALSE(step());
}

TEST_F(AMotionWatch, SeesARequestBeforeTheRobotMoves) {
  controller.command.requested.twist.linear[0] = 0.1;
  EXPECT_TRUE(step());
}

TEST_F(AMotionWatch, SeesARobotThatIsPushed) {
  estimator.state.base.flags = kStateValid;
  EXPECT_TRUE(step());
}

TEST_F(AMotionWatch, SeesANodeWithoutAFrame) {
  row.estimator = nullptr;
  EXPECT_TRUE(step());
}

TEST_F(AMotionWatch, SeesAStopAtStandstill) {
  monitor.permit.causes = kCauseWheelSpeed;
  EXPECT_TRUE(step());
}

TEST_F(AMotionWatch, EndsAWhileAfterTheMotion) {
  estimator.state.base.flags = kStateValid;
  const std::int64_t begin = now;
  EXPECT_TRUE(step());
  estimator.state.base.flags |= kStateStandstill;
  while (step()) {
  }
  EXPECT_NEAR(static_cast<double>(now - begin), static_cast<double>(MotionWatch::kTimeAfterStop), 2e6);
}

}  // namespace robot_control::tests
