/// Robots on legs in the closed loop: lie, stand, move the body, lift a foot, lie down, and be stopped.

#include "robots/quadruped_fixture.h"

namespace robot_control {
namespace {

constexpr double kPi = 3.14159265358979323846;

class QuadrupedOf : public testing::TestWithParam<std::string> {};

TEST_P(QuadrupedOf, StandsUpWithinTwoSecondsAndLiesDownAgain) {
  QuadrupedLoop robot = loop_of(GetParam());
  robot.wait(0.3);
  robot.clear();
  robot.run(2.0, stance(kStanceStand));
  EXPECT_LE(robot.tilt_now(), 0.03);
  EXPECT_EQ(robot.command().reasons & kReasonOutOfReach, 0u);
  EXPECT_LE(robot.effort, 0.9);
  const double rise = robot.truth().pose_world.position[2];
  robot.run(3.0, {});
  const Vector3 before = robot.truth().pose_world.position;
  robot.run(2.0, {});
  const Vector3& after = robot.truth().pose_world.position;
  // m in a minute
  const double creep = 30 * std::hypot(after[0] - before[0], after[1] - before[1]);
  EXPECT_LE(robot.tilt_now(), 0.03);
  EXPECT_LE(creep, 0.001);
  EXPECT_NEAR(after[2], rise, 0.002);  // it was up after two seconds
  EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
  robot.run(3.0, stance(kStanceLie));
  EXPECT_NE(robot.command().reasons & kReasonHolding, 0u);
  EXPECT_NEAR(robot.truth().pose_world.position[2], 0, 0.03);
  EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
}

TEST_P(QuadrupedOf, IsFoldedByAnEmergencyStopAndLiesUpright) {
  QuadrupedLoop robot = loop_of(GetParam());
  robot.wait(0.3);
  robot.run(2.5, stance(kStanceStand));
  robot.clear();
  robot.loop.e_stop();
  robot.wait(0.003);
  EXPECT_EQ(robot.gate().verdict, GateVerdict::kBrake);
  double rested = 0, rest_at = 0;
  for (double t = 0; t < 3; t += 0.001) {
    robot.step();
    rested = robot.speed() < 0.01 ? rested + 0.001 : 0;
    if (rested < 0.001) rest_at = t;
  }
  EXPECT_LE(robot.tilt, 0.15);
  EXPECT_LE(robot.shock, 150);  // docs/legs.md has the measured values
  EXPECT_LE(rest_at, 1.5);
}

INSTANTIATE_TEST_SUITE_P(Robots, QuadrupedOf, testing::ValuesIn(legged_robots()), robot_name);

class Quadbot : public testing::Test {
 protected:
  void SetUp() override {
    robot.wait(0.3);
    robot.run(2.0, stance(kStanceStand));
    robot.run(0.5, {});
  }
  /// Returns the pose in the axes of the beginning: x y z roll pitch yaw.
  std::array<double, 6> pose() const {
    const Pose& p = robot.truth().pose_world;
    return {p.position[0],          p.position[1],           p.position[2],
            roll_of(p.orientation), pitch_of(p.orientation), yaw_of(p.orientation)};
  }
  QuadrupedLoop robot = loop_of("quadbot");
};

TEST_F(Quadbot, MovesItsBodyAsRequested) {
  const double length = robot.robot().leg_length(), omega = 2 * kPi * 0.5;
  const double sizes[6] = {0.1 * length, 0.1 * length, 0.15 * length, 0.25, 0.25, 0.25};
  const char* names[6] = {"sway x", "sway y", "height", "roll", "pitch", "yaw"};
  for (std::size_t axis = 0; axis < 6; ++axis) {
    robot.run(1.0, {});
    const std::array<double, 6> begin = pose();
    robot.clear();
    double sum = 0;
    for (int k = 0; k < 4000; ++k) {
      const double t = k * 0.001, size = sizes[axis];
      Request request;
      double* const values[6] = {&request.posture.x,    &request.posture.y,     &request.posture.height,
                                 &request.posture.roll, &request.posture.pitch, &request.posture.yaw};
      *values[axis] = size * std::sin(omega * t);
      robot.loop.request(request);
      robot.step();
      const double error = pose()[axis] - begin[axis] - size * std::sin(omega * t);
      sum += error * error;
    }
    const double rms = std::sqrt(sum / 4000);
    EXPECT_LE(rms, axis < 3 ? 0.005 : 0.015) << names[axis];
    EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
  }
}

TEST_F(Quadbot, DrawsACircleWithEachFoot) {
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    robot.clear();
    Request up = stance(kStanceLift + leg);
    up.posture.height = 0.08;
    robot.run(2.0, up);
    const LegKinematics& kinematics = robot.robot().legs[leg].kinematics;
    const auto foot = [&]() -> Eigen::Vector3d {
      std::array<double, kLegsJoints> angles{};
      for (std::size_t i = 0; i < kLegsJoints; ++i) angles[i] = robot.truth().joints[i].position;
      return rotation_of(robot.truth().pose_world.orientation) * kinematics.position(LegModel::angles_of(angles, leg));
    };
    EXPECT_LT(robot.truth().normal_force[leg], 1) << leg;
    const Eigen::Vector3d begin = foot();
    double sum = 0;
    constexpr double kRadius = 0.05, kOmega = kPi;  // m, rad/s
    for (int k = 0; k < 2000; ++k) {
      const double t = k * 0.001;
      Request request = up;
      request.posture.x = kRadius * std::sin(kOmega * t);
      request.posture.height += kRadius * (1 - std::cos(kOmega * t));
      robot.loop.request(request);
      robot.step();
      const Eigen::Vector3d wanted =
          begin + kRadius * Eigen::Vector3d(std::sin(kOmega * t), 0, 1 - std::cos(kOmega * t));
      sum += (foot() - wanted).squaredNorm();
    }
    EXPECT_LE(std::sqrt(sum / 2000), 0.006) << leg;
    EXPECT_LE(robot.tilt, 0.065) << leg;
    robot.run(2.0, {});
    EXPECT_GT(robot.truth().normal_force[leg], 10) << leg;
    EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
  }
}

TEST_F(Quadbot, StaysAsItStandsWhenItsSenderIsSilent) {
  const double height = robot.truth().pose_world.position[2];
  robot.wait(1.0);
  EXPECT_NEAR(robot.truth().pose_world.position[2], height, 0.002);
  EXPECT_NE(robot.command().reasons & kReasonTimedOut, 0u);
}

TEST_F(Quadbot, StopsItsBodyWhereItIsWhenItsSenderIsSilent) {
  robot.run(1.0, {.twist = {}, .posture = {.height = -0.03, .roll = 0.1}});
  const std::array<double, 6> asked = pose();
  robot.wait(2.0);
  EXPECT_NE(robot.command().reasons & kReasonTimedOut, 0u);
  for (std::size_t axis = 0; axis < 6; ++axis) EXPECT_NEAR(pose()[axis], asked[axis], 0.002) << axis;
}

TEST_F(Quadbot, NamesWhatItCannotDo) {
  robot.run(0.1, {.twist = {.linear = {0.5, 0, 0}, .angular = {}}});
  EXPECT_NE(robot.command().reasons & kReasonPartIgnored, 0u);
  EXPECT_EQ(robot.command().ignored, kPartLinearX);
  robot.run(0.1, {.twist = {}, .posture = {.height = 1}});
  EXPECT_NE(robot.command().reasons & kReasonOutOfReach, 0u);
  robot.run(3.0, stance(kStanceLie));
  robot.run(0.1, {.twist = {}, .posture = {.roll = 0.1}});
  EXPECT_NE(robot.command().reasons & kReasonNotStanding, 0u);
  EXPECT_EQ(robot.command().legged.phase, LegPhase::kLying);
}

TEST_F(Quadbot, StandsUpOnlyAfterAResetThatFollowsZero) {
  robot.loop.e_stop();
  robot.run(1.0, stance(kStanceStand));
  robot.loop.e_stop_reset();
  robot.run(0.1, stance(kStanceStand));
  EXPECT_NE(robot.permit().causes, 0u);
  robot.run(2.0, {});
  robot.loop.e_stop_reset();
  robot.run(0.1, {});
  EXPECT_EQ(robot.permit().causes, 0u) << names_of(kResetRefusalNames, robot.permit().reset_refusal);
  robot.run(2.5, stance(kStanceStand));
  EXPECT_GT(robot.truth().pose_world.position[2], 0.2);
}

TEST(QuadrupedReplay, IsExactOverStandingAStopAndAReset) {
  QuadrupedLoop robot = loop_of("quadbot", 1, ErrorLevel::kField);
  robot.record = true;
  robot.wait(0.3);
  robot.run(2.5, stance(kStanceStand));
  robot.run(0.5, {.twist = {}, .posture = {.height = 0.02, .roll = 0.1, .x = 0.02, .y = 0.01}});
  robot.loop.e_stop();
  robot.run(2.0, {});
  robot.loop.e_stop_reset();
  robot.run(0.5, {});
  const ReplayReport report = robot.recording.replay(robot.loop.robot(), 0.001);
  EXPECT_TRUE(report.exact()) << text_of(report);
}

}  // namespace
}  // namespace robot_control
