#include "ros/inputs/motion_requests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

#include "ros/nanoseconds.h"

namespace robot_control::tests {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::int64_t kWindow = kSecond;

constexpr std::int64_t kInTransit = MotionRequests::in_transit_ns(1'000'000);

struct MotionRequestsTest : testing::Test {
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

  /// True if motion that this process requests over a new connection, which then closes, is revoked.
  bool revoked_again(Publisher sender) {
    sender.connection = boost::make_shared<char>();
    requests_.request(sender, now_);
    return requests_.revoked(sender);
  }

  std::int64_t now_ = 100 * kSecond;
  MotionPermission permission_{.run = 7, .withdrawals = 0, .granted = true};
  MotionRequests requests_;
  std::vector<boost::shared_ptr<const void>> connections_;
  Publisher teleop_{"/teleop", boost::make_shared<char>(), "http://robot:40001/"};
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
  EXPECT_FALSE(revoked_again(teleop_)) << "another connection of the same process, which is open";
}

TEST_F(MotionRequestsTest, GoOnOverAConnectionThatTheSameProcessOpensAgain) {
  requests_.request(teleop_, now_);
  withdraw();
  grant();
  EXPECT_THAT(requests_.revoked_names(), ElementsAre("/teleop"));
  teleop_.connection.reset();
  EXPECT_THAT(requests_.revoked_names(), IsEmpty()) << "closed";
  now_ += 1000 * kWindow;
  EXPECT_TRUE(revoked_again(teleop_));
  EXPECT_THAT(requests_.revoked_names(), IsEmpty()) << "closed again";
  teleop_.connection = boost::make_shared<char>();
  requests_.end(teleop_);
  requests_.request(teleop_, now_);
  EXPECT_FALSE(requests_.revoked(teleop_));
}

TEST_F(MotionRequestsTest, OfTwoTopicsGoOnOverTheConnectionToTheirOwn) {
  Publisher poses{"/teleop", boost::make_shared<char>(), teleop_.uri, "body_pose"};
  requests_.request(poses, now_);
  requests_.request(teleop_, now_);
  requests_.end(teleop_);
  now_ += 2 * kWindow;
  withdraw();
  grant();
  poses.connection.reset();
  teleop_.connection.reset();
  EXPECT_FALSE(revoked_again(teleop_));
  EXPECT_TRUE(revoked_again(poses));
  Publisher another{"/teleop", nullptr, teleop_.uri, "foot_target"};
  EXPECT_TRUE(revoked_again(another)) << "a topic without a record of its own";
}

TEST_F(MotionRequestsTest, OfANewProcessOfTheSameNameAreItsOwn) {
  requests_.request(teleop_, now_);
  withdraw();
  grant();
  teleop_.connection.reset();
  EXPECT_FALSE(revoked_again({"/teleop", nullptr, "http://robot:40002/"}));
  EXPECT_FALSE(revoked_again({"/pad", nullptr, teleop_.uri})) << "it got the port of the other";
  EXPECT_TRUE(revoked_again({"/teleop"})) << "it cannot be distinguished";
}

TEST_F(MotionRequestsTest, OfClosedConnectionsAreForgottenBeyondABound) {
  const auto name = [](std::size_t number) { return "/once_" + std::to_string(number); };
  requests_.request(teleop_, now_);
  for (std::size_t i = 0; i <= MotionRequests::kMaxClosed; ++i) {
    requests_.request({name(i), boost::make_shared<char>()}, now_);
  }
  withdraw();
  EXPECT_TRUE(requests_.revoked(teleop_)) << "it is open";
  EXPECT_TRUE(revoked_again({name(MotionRequests::kMaxClosed)}));
  EXPECT_FALSE(revoked_again({name(0)}));
}

/// The nodes that sent lately.
struct SendersTest : MotionRequestsTest {
  void send(const std::string& name, std::int64_t at) {
    requests_.sent({name, connections_.emplace_back(boost::make_shared<char>()), name}, at);
  }
  std::vector<std::string> at(std::int64_t now) const { return requests_.senders(now, 100); }
};

TEST_F(SendersTest, AreThoseReceivedWithinTheWindow) {
  EXPECT_THAT(at(0), IsEmpty());
  send("/b", 10);
  send("/a", 50);
  EXPECT_THAT(at(110), ElementsAre("/a", "/b"));
  EXPECT_THAT(at(111), ElementsAre("/a"));
  EXPECT_THAT(at(151), IsEmpty());
}

TEST_F(SendersTest, OfOneNameAreOne) {
  for (std::int64_t now = 0; now < 50; ++now) send("/a", now);
  EXPECT_THAT(at(50), ElementsAre("/a"));
}

TEST_F(SendersTest, AreForgottenWhenTimeTurnsBackByMoreThanTheWindow) {
  send("/a", 1000);
  EXPECT_THAT(at(900), ElementsAre("/a")) << "two threads looked in another order";
  EXPECT_THAT(at(899), IsEmpty());
  send("/a", 900);
  EXPECT_THAT(at(950), ElementsAre("/a"));
}

TEST_F(SendersTest, AreListedUpToABound) {
  for (int i = 0; i < 1000; ++i) send("/sender_" + std::to_string(i), 10);
  EXPECT_EQ(at(10).size(), MotionRequests::kMaxNames);
}

/// This controller was started beside a node that publishes already.
struct MotionRequestsOfARestartTest : MotionRequestsTest {
  MotionRequestsOfARestartTest() {
    requests_ = MotionRequests();
    requests_.set_window(kWindow);
    requests_.start({.present = {{"/teleop", nullptr, teleop_.uri}}, .run = 7});
    permission_.granted = false;
  }
};

TEST_F(MotionRequestsOfARestartTest, AreRevokedOfAllProcessesThatWereThere) {
  requests_.follow(permission_, now_);
  grant();
  requests_.request(teleop_, now_);
  EXPECT_TRUE(requests_.revoked(teleop_));
  EXPECT_TRUE(revoked_again(teleop_)) << "over another connection, too";
  EXPECT_FALSE(revoked_again({"/planner", nullptr, "http://robot:40003/"}));
  requests_.end(teleop_);
  EXPECT_FALSE(requests_.revoked(teleop_));
  EXPECT_FALSE(revoked_again(teleop_)) << "that connection has closed before this zero, which counts for it, too";
}

TEST_F(MotionRequestsOfARestartTest, EndWithAZeroOverTheirOwnConnectionAlone) {
  requests_.follow(permission_, now_);
  grant();
  requests_.end(teleop_);
  EXPECT_FALSE(requests_.revoked(teleop_));
  EXPECT_TRUE(revoked_again(teleop_)) << "over another connection, which is open as well";
}

TEST_F(MotionRequestsOfARestartTest, CountAsMadeAtTheStart) {
  requests_.follow(permission_, now_);
  requests_.end(teleop_);
  grant();
  now_ += kWindow;
  withdraw();
  EXPECT_TRUE(requests_.revoked(teleop_)) << "within the window before another withdrawal";
}

TEST_F(MotionRequestsOfARestartTest, LikewiseInAnotherRunWhileAStopIsLatched) {
  permission_.run = 8;
  permission_.stopped = true;
  requests_.follow(permission_, now_);
  grant();
  EXPECT_TRUE(revoked_again(teleop_));
}

TEST_F(MotionRequestsOfARestartTest, LikewiseInAnotherRunIfMotionWasRequestedAtTheEndOfTheOneBefore) {
  requests_.start({.present = {{"/teleop", nullptr, teleop_.uri}}, .run = 7, .requested = true});
  permission_.run = 8;
  requests_.follow(permission_, now_);
  grant();
  EXPECT_TRUE(revoked_again(teleop_));
}

TEST_F(MotionRequestsOfARestartTest, AreNotRevokedByTheFirstStartOfARun) {
  permission_.run = 8;
  requests_.follow(permission_, now_);
  grant();
  EXPECT_FALSE(revoked_again(teleop_));
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

TEST_F(MotionRequestsTest, OfSeveralClosedConnectionsTheRevokedOneGoesOn) {
  for (const bool revoked_first : {false, true}) {
    Publisher node{"/node", nullptr, revoked_first ? "http://robot:1/" : "http://robot:2/"};
    for (const bool moves : {revoked_first, !revoked_first}) {
      node.connection = boost::make_shared<char>();
      requests_.request(node, now_);
      if (!moves) requests_.end(node);
      if (!moves) now_ += 2 * kWindow;
      connections_.push_back(node.connection);
    }
    withdraw();
    grant();
    connections_.clear();
    node.connection.reset();
    EXPECT_TRUE(revoked_again(node)) << revoked_first;
  }
}

TEST_F(MotionRequestsTest, OfAnEarlierTimeThanTheGrantAreRevokedByTheirStamp) {
  withdraw();
  requests_.end(teleop_);
  now_ += 10 * kWindow;
  grant();
  now_ += kSecond;
  requests_.request(teleop_, now_, kSecond + kInTransit);
  EXPECT_FALSE(requests_.revoked(teleop_)) << "with the grant";
  requests_.request(teleop_, now_, kSecond + kInTransit + 1);
  EXPECT_TRUE(requests_.revoked(teleop_));
  requests_.request(teleop_, now_, 0);
  EXPECT_TRUE(requests_.revoked(teleop_)) << "it requested motion before the grant, and goes on";
  requests_.end(teleop_);
  requests_.request(teleop_, now_, 0);
  EXPECT_FALSE(requests_.revoked(teleop_));
}

// A grant follows the zero velocity by up to ten cycles, half a second at 20 Hz.
TEST_F(MotionRequestsTest, ASlowLoopHasLongerWaysFromTheZeroToTheGrant) {
  constexpr std::int64_t kSlowPeriod = 50'000'000;
  EarlierController earlier;
  earlier.period_ns = kSlowPeriod;
  requests_.start(earlier);
  for (const std::int64_t cycles : {10, 11}) {
    withdraw();
    requests_.end(teleop_);
    requests_.request(teleop_, now_);
    now_ += cycles * kSlowPeriod;
    grant();
    EXPECT_EQ(requests_.revoked(teleop_), cycles > 10) << cycles;
  }
}

TEST_F(MotionRequestsTest, OlderThanTheWindowWereNotMadeWithTheGrant) {
  requests_.set_window(kInTransit / 2);
  withdraw();
  requests_.end(teleop_);
  requests_.request(teleop_, now_);
  now_ += kInTransit / 2 + 1;  // a silence that a reset accepts
  grant();
  EXPECT_TRUE(requests_.revoked(teleop_));
}

TEST_F(MotionRequestsTest, NothingIsRevokedWithoutARequest) {
  requests_.end(teleop_);
  withdraw();
  grant();
  EXPECT_FALSE(requests_.revoked(teleop_));
}

}  // namespace robot_control::tests
