#include "ros/legged/joint_trajectory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "machine/description/robot_description.h"

namespace robot_control::tests {

using testing::HasSubstr;
using testing::StartsWith;

/// The healthy message moves the first joint of quadbot by 0.2 rad in 1 s, and the second one back and forth.
struct JointTrajectoryTest : testing::Test {
  void SetUp() override {
    for (std::size_t i = 0; i < kLegsJoints; ++i) start_[i] = robot_.joints[i].rest_position;
    message_.joint_names = {name(0), name(1)};
    add(1, {start_[0] - 0.2, start_[1]});
    add(2, {start_[0], start_[1] - 0.1});
  }
  const std::string& name(std::size_t joint) const { return robot_.joints[joint].name; }
  void add(double time, const std::vector<double>& positions) {
    trajectory_msgs::JointTrajectoryPoint& point = message_.points.emplace_back();
    point.positions.assign(positions.begin(), positions.end());
    point.time_from_start.fromSec(time);
  }
  std::string read() { return path_.read(message_, robot_, start_); }

  LegModel robot_ = read_legs(load_description(PROJECT_DIRECTORY "/urdf/quadbot.urdf"), {}, {});
  JointTrajectory::Positions start_{};
  trajectory_msgs::JointTrajectory message_;
  JointTrajectory path_;
};

TEST_F(JointTrajectoryTest, IsAStraightLineBetweenPointsWithoutVelocities) {
  ASSERT_EQ(read(), "");
  EXPECT_EQ(path_.duration(), 2);
  EXPECT_EQ(path_.at(-1), start_);
  for (const double t : {0.0, 0.25, 0.5, 1.0}) EXPECT_NEAR(path_.at(t)[0], start_[0] - 0.2 * t, 1e-12) << t;
  EXPECT_NEAR(path_.at(1.5)[0], start_[0] - 0.1, 1e-12);
  EXPECT_NEAR(path_.at(1.5)[1], start_[1] - 0.05, 1e-12);
  EXPECT_NEAR(path_.at(9)[1], start_[1] - 0.1, 1e-12);
  for (std::size_t i = 2; i < kLegsJoints; ++i) EXPECT_EQ(path_.at(1.5)[i], start_[i]) << i;
}

TEST_F(JointTrajectoryTest, IsACubicBetweenPointsWithVelocities) {
  message_.points[0].velocities = {-0.3, 0};
  message_.points[1].velocities = {0, 0};
  ASSERT_EQ(read(), "");
  // p(t) = start + c t² + d t³ with p(1) = start − 0.2, p'(1) = −0.3
  const double c = 3 * -0.2 + 0.3, d = -0.3 + 2 * 0.2;
  for (const double t : {0.1, 0.5, 0.9}) EXPECT_NEAR(path_.at(t)[0], start_[0] + c * t * t + d * t * t * t, 1e-12) << t;
  const double step = 1e-6;
  EXPECT_NEAR((path_.at(1)[0] - path_.at(1 - step)[0]) / step, -0.3, 1e-5);
  EXPECT_NEAR((path_.at(1 + step)[0] - path_.at(1)[0]) / step, -0.3, 1e-5);
}

TEST_F(JointTrajectoryTest, TakesAFirstPointAtTimeZeroWhereTheJointsAre) {
  message_.points[0].time_from_start.fromSec(0);
  EXPECT_THAT(read(), HasSubstr("begin there, or with a time above 0"));
  message_.points[0].positions = {start_[0] + 0.01, start_[1]};
  EXPECT_EQ(read(), "");
  message_.points.pop_back();
  EXPECT_THAT(read(), HasSubstr("give it time to move"));
}

struct BrokenMessage {
  const char* name;
  std::function<void(trajectory_msgs::JointTrajectory&)> breaks;
  const char* sentence;
};

class BrokenTrajectory : public JointTrajectoryTest, public testing::WithParamInterface<BrokenMessage> {};

TEST_P(BrokenTrajectory, IsRefusedInWordsAndTheEarlierPathStays) {
  ASSERT_EQ(read(), "");
  GetParam().breaks(message_);
  EXPECT_THAT(read(), HasSubstr(GetParam().sentence));
  EXPECT_EQ(path_.duration(), 2);
}

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN(), kNoEnd = std::numeric_limits<double>::infinity();

std::vector<BrokenMessage> broken_messages() {
  return {
      {"NoJoint", [](auto& m) { m.joint_names.clear(); }, "it names no joint; name some of front_left"},
      {"UnknownJoint", [](auto& m) { m.joint_names[1] = "tail"; }, "there is no joint 'tail'; name some of"},
      {"JointTwice", [](auto& m) { m.joint_names[1] = m.joint_names[0]; }, "twice"},
      {"FewPositions", [](auto& m) { m.points[1].positions.pop_back(); }, "point 2: it has 1 positions for 2 joints"},
      {"NoPositions", [](auto& m) { m.points[0].positions.clear(); }, "it has 0 positions for 2 joints"},
      {"ManyVelocities", [](auto& m) { m.points[0].velocities.assign(3, 0); }, "it has 3 velocities"},
      {"OneAcceleration", [](auto& m) { m.points[0].accelerations.assign(1, 0); }, "it has 1 accelerations"},
      {"Efforts", [](auto& m) { m.points[0].effort.assign(2, 0); }, "efforts, which are not executed"},
      {"NaN", [](auto& m) { m.points[1].positions[0] = kNoNumber; }, "one of its positions is nan"},
      {"Infinite", [](auto& m) { m.points[0].velocities.assign(2, kNoEnd); }, "velocities is inf"},
      {"SameTime", [](auto& m) { m.points[1].time_from_start = m.points[0].time_from_start; },
       "point 2: its time_from_start 1 s is not after 1 s"},
      {"TimeGoesBack", [](auto& m) { m.points[1].time_from_start.fromSec(0.5); }, "is not after 1 s"},
      {"NegativeTime", [](auto& m) { m.points[0].time_from_start.fromSec(-1); }, "is not after 0 s"},
      {"OutOfRange",
       [](auto& m) {
         m.points[1].positions[0] = 50;
         m.points[1].time_from_start.fromSec(100);
       },
       "would be at 50 rad; its range is -0.86 to 0.86 rad"},
      // Both ends are inside the range, the cubic between them is not.
      {"OutOfRangeOnTheWay",
       [](auto& m) {
         m.points[0].velocities = {2.5, 0};
         m.points[1].velocities = {0, 0};
         m.points[1].time_from_start.fromSec(4);
       },
       "its range is"},
      {"TooFast", [](auto& m) { m.points[0].time_from_start.fromSec(0.01); }, "give it more time"},
      {"TooFastOnTheWay",
       [](auto& m) {
         m.points[0].velocities = {4, 0};
       },
       "give it more time"},
      {"Overflow",
       [](auto& m) {
         m.points[0].time_from_start.fromNSec(1);
         m.points[0].velocities = {1e308, -1e308};
       },
       "its range is"}};
}

INSTANTIATE_TEST_SUITE_P(Each, BrokenTrajectory, testing::ValuesIn(broken_messages()),
                         [](const testing::TestParamInfo<BrokenMessage>& one) { return std::string(one.param.name); });

}  // namespace robot_control::tests
