// The estimator's state is copied as bytes into another estimator, which continues with the same bits.

#include <cstring>

#include "estimation/wheeled/estimator_fixture.h"
#include "signals/law_snapshot.h"
#include "support/constants.h"

namespace robot_control::tests {

struct EstimatorSnapshotTest : EstimatorFixture {
  EstimatorSnapshotTest() { robot_.noise = {.gyro = 2.44e-4, .accelerometer = 2e-3, .counts = 4096}; }
  /// The events are rest, drive, wheels that spin, a gyro that is lost, and rest again.
  void event(int cycle) {
    const bool moves = cycle > 1500 && cycle < 9000;
    if (cycle == 5500) robot_.tread = {1.2, 1.2};
    if (cycle == 6200) robot_.tread = {};
    if (cycle == 7000) robot_.frame().valid &= ~std::uint64_t{kValidGyro};
    if (cycle == 7400) robot_.frame().valid |= kValidGyro;
    robot_.drive(moves ? 0.4 : 0, moves ? 0.5 * std::sin(cycle * 1e-3) : 0);
  }
};

TEST_F(EstimatorSnapshotTest, ARestoredEstimatorContinuesWithTheSameBits) {
  Estimator restored(rigid_tyres(), two_wheeler(), kPeriod);
  const auto snapshot = std::make_unique<LawSnapshot>();
  StateFrame other;
  for (int cycle = 0; cycle < 11000; ++cycle) {
    if (cycle % 497 == 0) {
      save_state(estimator_, *snapshot);
      restored.enter_run();
      ASSERT_TRUE(restore_state(*snapshot, restored));
    }
    event(cycle);
    observe();
    restored.step(robot_.frame(), other);
    ASSERT_EQ(std::memcmp(&state_, &other, sizeof other), 0) << "cycle " << cycle;
  }
  EXPECT_TRUE(has(kStateStandstill));
}

TEST_F(EstimatorSnapshotTest, ANewRunIsThatOfANewEstimator) {
  for (int cycle = 0; cycle < 6000; ++cycle) {
    event(cycle);
    observe();
  }
  ASSERT_TRUE(has(kStateSlip));
  estimator_.enter_run();
  robot_ = RollingRobot();
  Estimator fresh(rigid_tyres(), two_wheeler(), kPeriod);
  StateFrame other;
  for (int cycle = 0; cycle < 11000; ++cycle) {
    event(cycle);
    observe();
    fresh.step(robot_.frame(), other);
    ASSERT_EQ(std::memcmp(&state_, &other, sizeof other), 0) << "cycle " << cycle;
  }
}

}  // namespace robot_control::tests
