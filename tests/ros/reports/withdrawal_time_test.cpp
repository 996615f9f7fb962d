#include "ros/reports/withdrawal_time.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

/// Looks at times that grow by one.
struct WithdrawalTimeTest : testing::Test {
  void observe(PermitAction action, std::uint64_t causes = 0) {
    permit_.action = action;
    permit_.causes = causes;
    time_.update(permit_, ++now_ns_);
  }

  void start() {
    observe(PermitAction::kBrake);
    permit_.withdrawals = 3;
    observe(PermitAction::kDrive);
  }

  Permit permit_;
  WithdrawalTime time_;
  std::int64_t now_ns_ = 0;
};

TEST_F(WithdrawalTimeTest, IsNoneBeforeAPermissionEnded) {
  start();
  EXPECT_FALSE(time_.last_ns());
}

TEST_F(WithdrawalTimeTest, IsTheEndOfALatchedStop) {
  observe(PermitAction::kBrake, kCauseEmergencyStopService);
  observe(PermitAction::kBrake, kCauseEmergencyStopService);
  EXPECT_EQ(time_.last_ns(), now_ns_);
  start();
  EXPECT_EQ(time_.last_ns(), 2);
}

TEST_F(WithdrawalTimeTest, IsTheEndOfAPermissionAndNotOfTheWaitForTheNextOne) {
  start();
  observe(PermitAction::kBrake);
  EXPECT_EQ(time_.last_ns(), 3);
  observe(PermitAction::kBrake);
  observe(PermitAction::kDrive);
  EXPECT_EQ(time_.last_ns(), 3);
}

TEST_F(WithdrawalTimeTest, IsTheLookAfterAStopThatWasReleasedBetweenTwo) {
  start();
  ++permit_.withdrawals;
  observe(PermitAction::kDrive);
  EXPECT_EQ(time_.last_ns(), 3);
  observe(PermitAction::kDrive);
  EXPECT_EQ(time_.last_ns(), 3);
}

}  // namespace robot_control::tests
