#include "bridge/inputs/motion_requests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

#include "bridge/nanoseconds.h"

namespace robot_control {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::int64_t kWindow = kSecond;

class MotionRequestsTest : public testing::Test {
 protected:
  MotionRequestsTest() {
    requests_.set_window(kWindow);
    requests_.follow(permission_, now_);
  }

  void withdraw() {
    ++permission_.withdrawals;
    permission_.granted = false;
    requests_.follow(permission_, now_);
  }

  void grant() {
    permission_.granted = true;
    requests_.follow(permission_, now_);
  }

  std::int64_t now_ = 100 * kSecond;
  MotionPermission permission_{.run = 7, .withdrawals = 0, .granted = true};
  MotionRequests requests_;
  Publisher teleop_{"/teleop", boost::make_shared<char>()};
};

TEST_F(MotionRequestsTest, EndWithinTheWindow) {
  requests_.request(teleop_, now_);
  EXPECT_TRUE(requests_.any(now_ + kWindow));
  EXPECT_FALSE(requests_.any(now_ + kWindow + 1));
}

TEST_F(MotionRequestsTest, AreFoundByTheConnectionAndNotByTheName) {
  requests_.request(teleop_, now_);
  withdraw();
  EXPECT_TRUE(requests_.revoked(teleop_));
  EXPECT_FALSE(requests_.revoked({"/teleop", boost::make_shared<char>()}));
}

TEST_F(MotionRequestsTest, AConnectionThatEndedIsForgotten) {
  requests_.request(teleop_, now_);
  withdraw();
  EXPECT_THAT(requests_.revoked_names(), ElementsAre("/teleop"));
  teleop_.connection = boost::make_shared<char>();
  requests_.end(teleop_);
  EXPECT_THAT(requests_.revoked_names(), IsEmpty());
}

TEST_F(MotionRequestsTest, AWithdrawalThatWasNotSeenByItselfRevokesAll) {
  requests_.request(teleop_, now_);
  permission_.withdrawals += 2;  // and granted again meanwhile
  EXPECT_TRUE(requests_.follow(permission_, now_));
  EXPECT_TRUE(requests_.revoked(teleop_));
  EXPECT_FALSE(requests_.follow(permission_, now_));
}

TEST_F(MotionRequestsTest, AZeroBeforeAnotherWithdrawalDoesNotCountAfterIt) {
  withdraw();
  requests_.end(teleop_);
  withdraw();
  now_ += 2 * kWindow;
  requests_.request(teleop_, now_);
  grant();
  EXPECT_TRUE(requests_.revoked(teleop_));
}

TEST_F(MotionRequestsTest, NothingIsRevokedWithoutARequest) {
  requests_.end(teleop_);
  withdraw();
  grant();
  EXPECT_FALSE(requests_.revoked(teleop_));
}

}  // namespace
}  // namespace robot_control
