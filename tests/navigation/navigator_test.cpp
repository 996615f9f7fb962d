#include "navigation/goals/navigator.h"

#include "navigation/guard/motion_clearance.h"
#include "navigation/house.h"
#include "support/matchers.h"

namespace robot_control::navigation::tests {

using namespace testing_house;
using State = NavigatorState;

constexpr double kPeriod = 0.1;  // s
constexpr double kSpeed = 0.5;   // m/s

/// A robot in two rooms with a door. It has each velocity at once, follows paths exactly, and has a laser of 10 Hz.
struct NavigatorTest : testing::Test {
  void box(int column, int row, std::int8_t cell = kOccupiedCell) {
    for (int i = -2; i <= 2; ++i) {
      for (int j = -2; j <= 2; ++j) world_.cells[world_.index({column + i, row + j})] = cell;
    }
  }

  void step() {
    now_ += kPeriod;
    costmap_.centre_on({pose_.x, pose_.y}, now_);
    costmap_.insert(scan_of(world_, pose_, 180), pose_, now_);
    out_ = navigator_.step({now_, problem_, explanation_, "", pose_, motion_, report_, {}, {}}, &costmap_);
    if (out_.cancel) report_.state = PathReport::State::kNone;
    if (out_.path) path_ = *out_.path, along_ = 0, report_ = {PathReport::State::kActive, ""}, ++paths_;
    if (report_.state == PathReport::State::kActive && !failing_.empty())
      report_ = {PathReport::State::kFailed, failing_};
    if (paused_) report_.state = *paused_;
    if (out_.request && report_.state == PathReport::State::kActive) {
      if (!stuck_) drive(*out_.request);
    } else if (report_.state == PathReport::State::kActive) {
      follow();
    }
  }

  void drive(const PlanarMotion& request) {
    motion_ = request;
    requests_.push_back(request);
    pose_ = composed(pose_, {request.linear * kPeriod, request.lateral * kPeriod, request.angular * kPeriod});
    steered_ += request.linear * kPeriod;
    for (const Point point : points_of(scan_of(world_, pose_, 180), {}))
      least_air_ = std::min(least_air_, diffbot().distance(point));
  }

  void follow() {
    motion_ = {};
    double left = kSpeed * kPeriod;
    for (; along_ + 1 < path_.poses.size() && left > 0; ++along_) {
      left -= std::hypot(path_.poses[along_ + 1].x - pose_.x, path_.poses[along_ + 1].y - pose_.y);
      pose_ = path_.poses[along_ + 1];
      for (const Point point : points_of(scan_of(world_, pose_, 180), {}))
        least_air_ = std::min(least_air_, diffbot().distance(point));
    }
    if (along_ + 1 == path_.poses.size()) report_.state = PathReport::State::kDone;
  }

  /// Steps for this long, or until the goal is over.
  void run(double seconds) {
    for (const double end = now_ + seconds; now_ < end && (navigator_.active() || out_.state == State::kIdle);) step();
  }

  Grid world_ = two_rooms(1.0);
  Costmap costmap_{two_rooms(1.0), diffbot(), false};
  Navigator navigator_;
  NavigatorOutput out_;
  Plan path_;
  std::size_t along_ = 0;
  PathReport report_;
  std::string problem_, explanation_, failing_;
  PlanarPose pose_{1.6, 1.6, 0};
  PlanarMotion motion_;
  std::vector<PlanarMotion> requests_;
  double steered_ = 0;  // m
  double now_ = 100, least_air_ = 1e9;
  int paths_ = 0;
  bool stuck_ = false;                       // no velocity moves it, but a path does
  std::optional<PathReport::State> paused_;  // follow_path does not drive, and reports this
};

TEST_F(NavigatorTest, AGoalInTheOtherRoomIsReachedByVelocitiesAndAtTheEndByAPath) {
  navigator_.begin({4.7, 2.2, 1}, now_);
  run(30);
  EXPECT_EQ(out_.state, State::kReached) << out_.reason;
  EXPECT_NEAR(pose_.x, 4.7, 1e-6);
  EXPECT_NEAR(pose_.yaw, 1, 1e-6);
  EXPECT_EQ(paths_, 2);
  EXPECT_GT(steered_, 2);
  EXPECT_GT(least_air_, 0);
}

TEST_F(NavigatorTest, EqualScansGiveEqualVelocitiesBitForBit) {
  std::vector<PlanarMotion> first;
  for (const int repetition : {0, 1}) {
    costmap_ = Costmap(two_rooms(1.0), diffbot(), false);
    pose_ = {1.6, 1.6, 0}, motion_ = {}, now_ = 100, report_ = {};
    requests_.clear();
    navigator_.begin({4.7, 2.2, 1}, now_);
    run(30);
    if (repetition == 0) first = requests_;
  }
  ASSERT_EQ(requests_.size(), first.size());
  ASSERT_GT(first.size(), 20U);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(requests_[i].linear, first[i].linear) << i;
    EXPECT_EQ(requests_[i].angular, first[i].angular) << i;
  }
}

TEST_F(NavigatorTest, ARobotThatIsStuckAgainFollowsAPathToTheGoal) {
  costmap_ = Costmap(diffbot());
  world_.cells.assign(world_.cells.size(), kFreeCell);
  stuck_ = true;
  navigator_.begin({8, 1.6, 0}, now_);
  run(60);
  EXPECT_EQ(out_.state, State::kReached) << out_.reason;
  EXPECT_EQ(paths_, 4);  // two that show the way, and two that are driven
}

TEST_F(NavigatorTest, APathBeginsAtThePose) {
  pose_ = {1.63, 1.58, 0.3};
  navigator_.begin({2.1, 1.6, 1}, now_);
  step();
  EXPECT_FALSE(out_.request);
  EXPECT_EQ(path_.poses.front().x, 1.63);
  EXPECT_EQ(path_.poses.front().y, 1.58);
}

TEST_F(NavigatorTest, AGoalOutsideAWindowIsReached) {
  costmap_ = Costmap(diffbot());
  world_.cells.assign(world_.cells.size(), kFreeCell);
  navigator_.begin({14, 5, 1}, now_);
  run(100);
  EXPECT_EQ(out_.state, State::kReached) << out_.reason;
  EXPECT_NEAR(pose_.x, 14, 1e-6);
  EXPECT_EQ(paths_, 2);
}

TEST_F(NavigatorTest, AGoalInAWallIsRefusedAtOnce) {
  navigator_.begin({3.15, 0.3, 0}, now_);
  step();
  EXPECT_EQ(out_.state, State::kFailed);
  EXPECT_THAT(out_.reason, HasSubstr("is in an obstacle"));
}

TEST_F(NavigatorTest, ANewGoalTakesThePlaceOfTheOneBeforeWithoutAStop) {
  navigator_.begin({4.7, 2.2, 1}, now_);
  run(1);
  for (int i = 0; i < 40; ++i) {
    navigator_.begin({4.7, 2.2 - 0.02 * i, 1}, now_);
    step();
    EXPECT_FALSE(out_.cancel) << i;
    EXPECT_EQ(out_.state, State::kDriving) << i;
  }
  run(30);
  EXPECT_EQ(out_.state, State::kReached);
  EXPECT_NEAR(pose_.y, 1.42, 1e-6);
}

TEST_F(NavigatorTest, ANewGoalThatIsRefusedEndsThePathOfTheOneBefore) {
  navigator_.begin({4.7, 2.2, 1}, now_);
  run(1);
  navigator_.begin({3.15, 0.3, 0}, now_);
  step();
  EXPECT_EQ(out_.state, State::kFailed);
  EXPECT_TRUE(out_.cancel);
}

TEST_F(NavigatorTest, ABoxOnThePathIsPassed) {
  box(45, 16);
  navigator_.begin({5.6, 1.6, 0}, now_);
  run(40);
  EXPECT_EQ(out_.state, State::kReached);
  EXPECT_GT(least_air_, 0);
}

/// The costs lead through it, paths and velocities do not.
TEST_F(NavigatorTest, AGapThatIsTooNarrowIsLeftForTheLongWay) {
  world_ = two_rooms(0.4);
  world_.rows = 100;
  world_.cells.resize(100 * 63, kFreeCell);
  for (int row = 31; row < 100; ++row) {
    for (const int column : {0, 31, 62}) {
      const bool door = column == 31 && row >= 80 && row < 92;
      world_.cells[world_.index({column, row})] = door ? kFreeCell : kOccupiedCell;
    }
  }
  for (int column = 1; column < 62; ++column) {
    world_.cells[world_.index({column, 31})] = column == 31 ? kOccupiedCell : kFreeCell;
    world_.cells[world_.index({column, 99})] = kOccupiedCell;
  }
  costmap_ = Costmap(world_, diffbot(), false);
  navigator_.begin({4.7, 1.6, 0}, now_);
  run(90);
  EXPECT_EQ(out_.state, State::kReached) << out_.reason;
}

TEST_F(NavigatorTest, ADoorThatIsShutWhileItDrivesIsWaitedForAndPassedWhenItOpens) {
  navigator_.begin({5.0, 1.6, 0}, now_);
  run(0.5);
  box(31, 16);
  run(8);
  EXPECT_EQ(out_.state, State::kWaiting);
  EXPECT_THAT(out_.reason, HasSubstr("no path"));
  EXPECT_GT(least_air_, 0);
  box(31, 16, kFreeCell);
  run(20);
  EXPECT_EQ(out_.state, State::kReached);
}

TEST_F(NavigatorTest, ADoorThatStaysShutIsGivenUpWithTheReason) {
  navigator_.begin({5.0, 1.6, 0}, now_);
  run(0.5);
  box(31, 16);
  explanation_ = "; perhaps the map is wrong";
  run(kNoProgressTime + 10);
  EXPECT_EQ(out_.state, State::kFailed);
  EXPECT_THAT(out_.reason, HasSubstr("no path"));
  EXPECT_THAT(out_.reason, HasSubstr("(for 20 s); perhaps the map is wrong"));
}

TEST_F(NavigatorTest, ABoxOnTheGoalIsWaitedForFromTheStart) {
  box(47, 16);
  costmap_.insert(scan_of(world_, {4.0, 1.6, 0}, 720), {4.0, 1.6, 0}, now_);
  navigator_.begin({4.7, 1.6, 0}, now_);
  run(5);
  EXPECT_EQ(out_.state, State::kWaiting);
  EXPECT_THAT(out_.reason, HasSubstr("obstacle"));
}

TEST_F(NavigatorTest, ANewMapWithoutTheGoalIsWaitedFor) {
  Grid lower_part = two_rooms(1.0);
  lower_part.rows = 20;  // cells lie row by row
  lower_part.cells.resize(20 * 63);
  navigator_.begin({4.7, 2.6, 0}, now_);
  run(1);
  costmap_ = Costmap(lower_part, diffbot(), false);
  for (int i = 0; i < 30; ++i) {
    step();
    EXPECT_EQ(out_.state, State::kWaiting) << i;
    EXPECT_THAT(out_.reason, HasSubstr("the goal (4.70, 2.60) m is outside the map")) << i;
  }
  costmap_ = Costmap(two_rooms(1.0), diffbot(), false);
  run(30);
  EXPECT_EQ(out_.state, State::kReached) << out_.reason;
}

TEST_F(NavigatorTest, AGoalWithoutALaserIsRefusedAfterTheStartPatience) {
  problem_ = "scan is silent";
  navigator_.begin({4.7, 1.6, 0}, now_);
  run(kFirstPathTime + 1);
  EXPECT_EQ(out_.state, State::kFailed);
  EXPECT_THAT(out_.reason, HasSubstr("scan is silent"));
  EXPECT_EQ(paths_, 0);
}

TEST_F(NavigatorTest, DrivesNothingWhileTheLaserIsSilent) {
  navigator_.begin({4.7, 1.6, 0}, now_);
  run(1);
  problem_ = "scan is silent";
  step();
  EXPECT_TRUE(out_.cancel);
  EXPECT_EQ(out_.state, State::kWaiting);
  EXPECT_EQ(out_.reason, "scan is silent");
  problem_.clear();
  run(30);
  EXPECT_EQ(out_.state, State::kReached);
}

TEST_F(NavigatorTest, APathThatCannotBeFollowedIsTriedAgainAndGivenUp) {
  failing_ = "0.40 m off the path, more than 0.3 m";
  navigator_.begin({4.7, 1.6, 0}, now_);
  run(30);
  EXPECT_EQ(out_.state, State::kFailed);
  EXPECT_THAT(out_.reason, HasSubstr("off the path"));
  EXPECT_EQ(paths_, kAttempts + 1);
}

TEST_F(NavigatorTest, ARobotThatDoesNotMoveIsGivenUp) {
  paused_ = PathReport::State::kNone;
  navigator_.begin({4.7, 1.6, 0}, now_);
  run(kNoProgressTime + 1);
  EXPECT_EQ(out_.state, State::kFailed);
  EXPECT_THAT(out_.reason, HasSubstr("does not move"));
}

TEST_F(NavigatorTest, AWayThatIsBlockedAgainAndAgainIsGivenUp) {
  paused_ = PathReport::State::kNone;
  navigator_.begin({4.7, 1.6, 0}, now_);
  for (const double end = now_ + 2 * kNoProgressTime; now_ < end && out_.state != State::kFailed;) {
    problem_ = "scan is silent";
    run(0.5);
    problem_.clear();
    run(1.5);
  }
  EXPECT_EQ(out_.state, State::kFailed);
  EXPECT_GT(paths_, 5);
}

TEST_F(NavigatorTest, WhatIsPausedIsNotReplacedBeforeItGoesOn) {
  navigator_.begin({4.7, 1.6, 0}, now_);
  run(1);
  paused_ = PathReport::State::kPaused;
  for (const double end = now_ + 3 * kStuckTime; now_ < end;) {
    step();
    EXPECT_FALSE(out_.path || out_.cancel) << now_;
  }
  paused_.reset();
  report_.state = PathReport::State::kActive;
  run(30);
  EXPECT_EQ(out_.state, State::kReached) << out_.reason;
}

/// Neither the border of the approach, over which the robot brakes, nor a scan that is missing, nor a new map.
TEST_F(NavigatorTest, NothingStartsWhatIsPaused) {
  Grid lower_part = two_rooms(1.0);
  lower_part.rows = 20;
  lower_part.cells.resize(20 * 63);
  for (const double begin : {3.0, kApproach + 0.1, 0.5}) {  // m left
    navigator_ = {}, pose_ = {1.6, 1.6, 0}, motion_ = {}, report_ = {}, paused_ = {};
    costmap_ = Costmap(two_rooms(1.0), diffbot(), false);
    navigator_.begin({4.7, 2.2, 1}, now_);
    do step();
    while (navigator_.active() && out_.remaining > begin);
    ASSERT_EQ(out_.state, State::kDriving) << begin;
    paused_ = PathReport::State::kPaused;
    if (begin > kApproach) pose_ = composed(pose_, {0.2, 0, 0});
    for (int i = 0; i < 60; ++i) {
      problem_ = i >= 10 && i < 20 ? "scan is silent" : "";
      if (i == 25) costmap_ = Costmap(lower_part, diffbot(), false);
      if (i == 40) costmap_ = Costmap(two_rooms(1.0), diffbot(), false);
      step();
      EXPECT_FALSE(out_.path || out_.cancel) << begin << " m, step " << i;
      EXPECT_EQ(out_.reason, problem_) << begin << " m, step " << i;
    }
    paused_.reset();
    report_.state = PathReport::State::kActive;
    run(30);
    EXPECT_EQ(out_.state, State::kReached) << out_.reason;
  }
}

TEST_F(NavigatorTest, AStartTooNearToAWallIsLeft) {
  pose_ = {0.25, 1.6, 0};  // as the map has it, its back is in the wall
  ASSERT_FALSE(costmap_.free(pose_));
  navigator_.begin({4.7, 1.6, 0}, now_);
  run(30);
  EXPECT_EQ(out_.state, State::kReached) << out_.reason;
  EXPECT_LE(paths_, 3);
}

}  // namespace robot_control::navigation::tests
