#include "navigation/goals/local_controller.h"

#include "navigation/house.h"
#include "support/matchers.h"

namespace robot_control::navigation::tests {

using namespace testing_house;

constexpr double kControlPeriod = 0.1;  // s

/// A robot in two rooms with a door, which has the requested velocity a period later within its limits.
struct LocalControllerTest : testing::Test {
  explicit LocalControllerTest(double door = 0.8) : costmap_(two_rooms(door), diffbot(), false) {}

  void aim(const PlanarPose& goal) { to_goal_ = costs_to(costmap_, goal, 5); }

  PlanarMotion step() {
    const PlanarMotion request = controller_.step(limits_, costmap_, to_goal_, pose_, motion_, objects_);
    const auto changed = [](double from, double to, double limit) {
      return from + std::clamp(to - from, -limit, limit);
    };
    const double change = limits_.linear_acceleration * kControlPeriod;
    motion_ = {changed(motion_.linear, request.linear, change),
               changed(motion_.angular, request.angular, limits_.angular_acceleration * kControlPeriod),
               changed(motion_.lateral, request.lateral, change)};
    pose_ = composed(
        pose_, {motion_.linear * kControlPeriod, motion_.lateral * kControlPeriod, motion_.angular * kControlPeriod});
    for (MovingObject& object : objects_) {
      for (Point& point : object.points) {
        point.x += object.velocity.x * kControlPeriod;
        point.y += object.velocity.y * kControlPeriod;
        const Point seen = composed(inverse(pose_), std::vector{point})[0];
        least_air_ = std::min(least_air_, diffbot().distance(seen));
      }
    }
    free_ = free_ && costmap_.free(pose_);
    return request;
  }

  double left() const { return to_goal_.at(pose_.x, pose_.y); }

  /// A cart of 0.4 m × 0.4 m.
  static MovingObject cart(Point middle, Point velocity) {
    MovingObject object{{}, velocity};
    for (const double a : {-0.2, 0.0, 0.2}) {
      for (const double b : {-0.2, 0.2}) {
        object.points.push_back({middle.x + a, middle.y + b});
        object.points.push_back({middle.x + b, middle.y + a});
      }
    }
    return object;
  }

  Costmap costmap_;
  LocalController controller_{diffbot()};
  DriveLimits limits_;
  CostsToGoal to_goal_;
  std::vector<MovingObject> objects_;
  PlanarPose pose_{1.0, 0.8, 2.0};
  PlanarMotion motion_;
  double least_air_ = 1e9;
  bool free_ = true;
};

TEST_F(LocalControllerTest, TheSameInputsGiveTheSameBits) {
  aim({5.0, 2.4, 0});
  std::vector<double> first;
  for (int i = 0; i < 40; ++i) {
    const PlanarMotion request = step();
    first.insert(first.end(), {request.linear, request.angular});
  }
  controller_.reset();
  pose_ = {1.0, 0.8, 2.0}, motion_ = {};
  for (int i = 0; i < 40; ++i) {
    const PlanarMotion request = step();
    EXPECT_EQ(request.linear, first[2 * i]) << i;
    EXPECT_EQ(request.angular, first[2 * i + 1]) << i;
  }
}

TEST_F(LocalControllerTest, ItTurnsAndDrivesThroughADoorWithAirAndWithinTheLimits) {
  aim({5.0, 2.4, 0});
  int steps = 0;
  for (; left() > 0.5 && steps < 200; ++steps) {
    const PlanarMotion request = step();
    EXPECT_LE(request.linear, limits_.forward);
    EXPECT_GE(request.linear, -limits_.reverse);
    EXPECT_LE(std::abs(request.angular), limits_.angular);
    EXPECT_LE(std::abs(request.linear * request.angular), limits_.centripetal_acceleration + 1e-9);
    EXPECT_EQ(request.lateral, 0);
  }
  EXPECT_LT(left(), 0.5);
  EXPECT_TRUE(free_);
  // 4.3 m by the door, from standstill, and a turn of 1.6 rad
  EXPECT_LT(steps * kControlPeriod, 1.3 * (4.3 / limits_.forward + 1.6 / limits_.angular));
}

TEST_F(LocalControllerTest, ItStandsWhereTheGoalCannotBeCloser) {
  pose_ = {1.6, 1.6, 0};
  aim(pose_);
  for (int i = 0; i < 30; ++i) step();
  EXPECT_LT(std::hypot(pose_.x - 1.6, pose_.y - 1.6), 0.15);
}

TEST_F(LocalControllerTest, ItLetsACartPassAndBacksOffFromOne) {
  for (const Point velocity : {Point{0, 0.6}, Point{0, 0.9}, Point{-0.5, 0}}) {
    pose_ = {1.0, 1.6, 0}, motion_ = {0.5, 0, 0}, least_air_ = 1e9;
    controller_.reset();
    objects_ = {velocity.x == 0 ? cart({2.0, 0.4}, velocity) : cart({2.6, 1.4}, velocity)};
    aim({5.0, 1.6, 0});
    for (int i = 0; i < 30; ++i) step();
    EXPECT_GT(least_air_, 0) << velocity.x << " " << velocity.y;
  }
}

TEST_F(LocalControllerTest, ALateralAxisIsUsedWhereItHelps) {
  pose_ = {1.6, 0.8, 0};
  limits_.lateral = 0.3;
  limits_.angular = 0.3;
  aim({1.6, 2.4, 0});
  double fastest = 0;
  for (int i = 0; i < 40; ++i) fastest = std::max(fastest, std::abs(step().lateral));
  EXPECT_GT(fastest, 0.15);
  EXPECT_GT(pose_.y, 1.5);
}

}  // namespace robot_control::navigation::tests
