/// Robots on legs in the closed loop: lie, stand, move the body, lift a foot, lie down, and be stopped.

#include <random>

#include "control/legged/stand/body_bounds.h"
#include "robots/quadruped_fixture.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

constexpr double kPi = 3.14159265358979323846;

class QuadrupedOf : public testing::TestWithParam<std::string> {};

TEST_P(QuadrupedOf, StandsUpWithinTwoSecondsAndLiesDownAgain) {
  QuadrupedLoop robot = loop_of(GetParam());
  robot.clear();
  robot.run(2.0, stance({ModeKind::kStand}));
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
  EXPECT_EQ(robot.permit().causes | robot.permit().warnings, 0u) << robot.causes();
  robot.run(3.0, stance({ModeKind::kLie}));
  EXPECT_NE(robot.command().reasons & kReasonHolding, 0u);
  EXPECT_NEAR(robot.truth().pose_world.position[2], 0, 0.03);
  EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
}

/// An emergency stop folds the robot: the promises of docs/legs.md.
void expect_fold(QuadrupedLoop& robot) {
  const auto [cycles, rest_at] = robot.fold();
  EXPECT_LE(cycles, 3);
  EXPECT_LE(rest_at, 1.5);
  EXPECT_LE(robot.tilt, 0.15);
  EXPECT_LE(robot.shock, 40);
}

TEST_P(QuadrupedOf, IsFoldedByAnEmergencyStopAndLiesUpright) {
  QuadrupedLoop robot = loop_of(GetParam());
  robot.run(2.5, stance({ModeKind::kStand}));
  expect_fold(robot);
}

TEST_P(QuadrupedOf, KnowsItsHeightAfterEveryFold) {
  QuadrupedLoop robot = loop_of(GetParam());
  const auto error = [&] { return robot.state().base.pose_odom.position[2] - robot.truth().pose_world.position[2]; };
  for (int round = 0; round < 3; ++round) {
    robot.run(3.0, stance({ModeKind::kStand}));
    EXPECT_NEAR(error(), 0, 0.01) << round;
    robot.fold();
    EXPECT_NEAR(error(), 0, 0.035) << round;  // it may lie on a folded leg
    robot.run(0.5, {});
    robot.loop.e_stop_reset();
    robot.run(0.1, {});
  }
}

/// Returns a robot that stands, with a fault of the encoder of this joint.
QuadrupedLoop standing_with_fault(const std::string& name, std::size_t joint, const std::string& kind) {
  QuadrupedLoop robot = loop_of(name);
  robot.run(2.5, stance({ModeKind::kStand}));
  robot.loop.inject_fault(robot.robot().joints[joint].name + "_encoder", kind);
  return robot;
}

/// A pose that moves no command by 0.25 rad.
TEST_P(QuadrupedOf, IsStoppedByAStuckEncoderWhenItsCommandMoves) {
  for (const std::size_t joint : {1, 5, 9}) {
    SCOPED_TRACE(joint);
    QuadrupedLoop robot = standing_with_fault(GetParam(), joint, "stuck");
    robot.run(0.5, {});
    EXPECT_EQ(robot.causes(), "") << "its joint is where it reports to be";
    const double length = robot.robot().leg_length(), from = robot.command().joints[joint].position;
    double moved = 0;
    for (int k = 0; k < 2000 && robot.permit().causes == 0; ++k) {
      robot.run(0.001, {.twist = {}, .posture = {.height = -0.07 * length, .roll = 0.1, .y = 0.03 * length}});
      moved = std::max(moved, std::abs(robot.command().joints[joint].position - from));
    }
    EXPECT_NEAR(moved, 0.05, 0.005);
    robot.wait(0.003);
    EXPECT_EQ(robot.causes(), "encoder_stuck");
    EXPECT_EQ(robot.permit().evidence[0].joint, joint);
    EXPECT_EQ(robot.gate().verdict, GateVerdict::kBrake);
  }
}

TEST_P(QuadrupedOf, IsStoppedByAnEncoderWithRandomAngles) {
  for (const std::size_t joint : {3, 7, 11}) {
    SCOPED_TRACE(joint);
    QuadrupedLoop robot = standing_with_fault(GetParam(), joint, "garbage");
    robot.run(0.05, {});
    EXPECT_EQ(robot.permit().first_cause, std::uint64_t{kCauseEncoderJump}) << robot.causes();
    EXPECT_EQ(robot.permit().evidence[0].joint, joint);
    EXPECT_EQ(robot.gate().verdict, GateVerdict::kBrake);
  }
}

TEST_P(QuadrupedOf, IsFoldedWithARearFootInTheAir) {
  QuadrupedLoop robot = loop_of(GetParam());
  robot.run(2.5, stance({ModeKind::kStand}));
  Request up = stance({ModeKind::kLift, 2});
  up.posture.height = leg_tuning(robot.robot()).lift;
  robot.run(2.0, up);
  ASSERT_EQ(robot.command().legged.lifted, 3u);
  expect_fold(robot);
}

/// Some of these poses are out of reach: the body stops before them.
TEST_P(QuadrupedOf, StandsFirmWhileItsPoseStepsOnAllAxesAtOnce) {
  QuadrupedLoop robot = loop_of(GetParam(), 1, ErrorLevel::kField);
  robot.run(2.5, stance({ModeKind::kStand}));
  robot.run(0.5, {});
  robot.clear();
  const double length = robot.robot().leg_length();
  for (unsigned corner = 0; corner < 24; ++corner) {
    const auto side = [&](unsigned axis) { return ((corner * 29) >> axis & 1u) != 0 ? 1.0 : -1.0; };
    robot.run(1.2, {.twist = {},
                    .posture = {.height = 0.15 * length * side(0),
                                .roll = 0.25 * side(1),
                                .pitch = 0.25 * side(2),
                                .x = 0.1 * length * side(3),
                                .y = 0.1 * length * side(4),
                                .yaw = 0.25 * side(5)}});
    ASSERT_EQ(robot.permit().causes | robot.permit().warnings, 0u) << corner << ": " << robot.causes();
  }
  EXPECT_LE(robot.effort, 0.9);
  EXPECT_LE(*std::ranges::max_element(robot.slipped), 0.15 * length);  // in half a minute
  EXPECT_LE(robot.tilt, 0.33);                                         // rad, roll and pitch together
}

/// From random poses: `moving` of them while the body moves, then one with each of `feet` in the air.
void expect_lying_in_time(const std::string& name, std::size_t moving, const std::vector<std::uint64_t>& feet) {
  QuadrupedLoop robot = loop_of(name);
  const double length = robot.robot().leg_length();
  std::mt19937_64 random(7);
  const auto within = [&](double size) { return std::uniform_real_distribution<double>(-size, size)(random); };
  for (std::size_t trial = 0; trial < moving + feet.size(); ++trial) {
    robot.run(2.5, stance({ModeKind::kStand}));
    ASSERT_EQ(robot.command().legged.phase, LegPhase::kStanding) << trial;
    if (trial >= moving) {
      const LegTuning tuning = leg_tuning(robot.robot());
      Request foot = stance({ModeKind::kLift, feet[trial - moving]});
      foot.posture = {
          .height = tuning.lift + tuning.foot_range, .x = within(tuning.foot_range), .y = within(tuning.foot_range)};
      robot.run(2.2, foot);
      ASSERT_NE(robot.command().legged.lifted, 0u) << trial;
    }
    for (const double seconds : {0.6 + within(0.4), 0.35 + within(0.25)}) {
      if (trial >= moving) break;
      robot.run(seconds, {.twist = {},
                          .posture = {.height = within(0.16 * length),
                                      .roll = within(0.3),
                                      .pitch = within(0.3),
                                      .x = within(0.12 * length),
                                      .y = within(0.12 * length),
                                      .yaw = within(0.3)}});
    }
    double took = 0;
    for (; took < 5 && robot.command().legged.phase != LegPhase::kLying; took += 0.02)
      robot.run(0.02, stance({ModeKind::kLie}));
    EXPECT_LE(took, lying_down_time(robot.robot())) << trial;
    ASSERT_EQ(robot.permit().causes, 0u) << trial << ": " << robot.causes();
  }
}

TEST_P(QuadrupedOf, LiesDownFromAnyPoseAndMotionInTime) {
  expect_lying_in_time(GetParam(), 2, {0, 3});
}

class NightlyQuadrupedOf : public QuadrupedOf {};

TEST_P(NightlyQuadrupedOf, LiesDownFromMorePosesAndMotionsInTime) {
  expect_lying_in_time(GetParam(), 8, {0, 1, 2, 3});
}

TEST_P(QuadrupedOf, MovesItsJointsAlongAPathWhileItLies) {
  QuadrupedLoop robot = loop_of(GetParam());
  // The front left leg unfolds a little and folds again.
  std::array<double, kLegsJoints> lying{}, way{};
  for (std::size_t i = 0; i < kLegsJoints; ++i) lying[i] = robot.robot().joints[i].rest_position;
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    const JointRange range = joint_bounds(robot.robot())[i].range;
    way[i] = std::copysign(0.2, (range.lower + range.upper) / 2 - lying[i]);
  }
  const auto path = [&](double t) {
    Request request = stance({ModeKind::kJoints});
    for (std::size_t i = 0; i < kLegsJoints; ++i) request.joints[i] = lying[i] + way[i] * (1 - std::cos(kPi * t)) / 2;
    return request;
  };
  std::array<double, kLegsJoints> planned{};
  double largest_error = 0;
  std::array<double, kLegsJoints> moved{};
  for (int k = 0; k < 3000; ++k) {
    const double t = k * 0.001;
    if (k % 10 == 0) robot.loop.request(path(t + JointMotion::kHorizon));
    robot.step();
    ASSERT_EQ(robot.command().legged.phase, LegPhase::kJoints);
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      planned[i] = robot.command().joints[i].position;
      // It begins where the joints are, not where they rest.
      if (k < 200) continue;
      largest_error = std::max(largest_error, std::abs(planned[i] - path(t).joints[i]));
      moved[i] = std::max(moved[i], std::abs(robot.truth().joints[i].position - lying[i]));
    }
  }
  // The axis lags by 1/kFollow of 0.31 rad/s, the horizon by half the acceleration of 1 rad/s² times its square.
  EXPECT_LE(largest_error, 0.01);
  // The leg also presses on the ground, so that it does not go the whole way.
  EXPECT_GE(*std::max_element(moved.begin(), moved.begin() + kLegJoints), 0.05);
  EXPECT_LE(*std::max_element(moved.begin() + kLegJoints, moved.end()), 0.1);
  EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
  robot.wait(1.5);
  EXPECT_NE(robot.command().reasons & kReasonTimedOut, 0u);
  for (std::size_t i = 0; i < kLegsJoints; ++i) EXPECT_NEAR(robot.command().joints[i].position, planned[i], 0.05) << i;
  EXPECT_EQ(robot.command().legged.phase, LegPhase::kJoints);
  robot.run(2.5, stance({ModeKind::kStand}));
  EXPECT_EQ(robot.command().legged.phase, LegPhase::kStanding);
  EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
}

INSTANTIATE_TEST_SUITE_P(Robots, QuadrupedOf, testing::ValuesIn(legged_robots(true)), robot_name);
INSTANTIATE_TEST_SUITE_P(Nightly, QuadrupedOf, testing::ValuesIn(legged_robots(false)), robot_name);
INSTANTIATE_TEST_SUITE_P(Robots, NightlyQuadrupedOf, testing::ValuesIn(legged_robots()), robot_name);

struct Quadbot : testing::Test {
  void SetUp() override {
    robot.wait(0.3);
    robot.run(2.0, stance({ModeKind::kStand}));
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
    Request up = stance({ModeKind::kLift, leg});
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
    EXPECT_LE(std::sqrt(sum / 2000), 0.005) << leg;
    EXPECT_LE(robot.tilt, 0.04) << leg;
    robot.run(2.0, {});
    EXPECT_GT(robot.truth().normal_force[leg], 10) << leg;
    EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
  }
}

TEST(QuadbotJoints, AreReleasedByAStopAndStayUntilTheNextRequest) {
  QuadrupedLoop robot = loop_of("quadbot");
  Request request = stance({ModeKind::kJoints});
  for (std::size_t i = 0; i < kLegsJoints; ++i) request.joints[i] = robot.robot().joints[i].rest_position;
  request.joints[2] += 0.3;
  robot.run(0.5, request);
  EXPECT_EQ(robot.command().legged.phase, LegPhase::kJoints);
  robot.loop.e_stop();
  robot.run(0.003, request);
  EXPECT_EQ(robot.gate().verdict, GateVerdict::kBrake);
  EXPECT_EQ(robot.command().legged.phase, LegPhase::kLying);
  robot.loop.e_stop_reset();
  robot.run(2.0, request);
  EXPECT_NE(robot.permit().causes, 0u);  // a motion is requested
  robot.run(0.5, {});
  robot.loop.e_stop_reset();
  robot.run(0.5, {});
  EXPECT_EQ(robot.permit().causes, 0u) << names_of(kResetRefusalNames, robot.permit().reset_refusal);
  EXPECT_EQ(robot.command().legged.phase, LegPhase::kLying);
}

TEST_F(Quadbot, StaysAsItStandsWhenItsSenderIsSilent) {
  const double height = robot.truth().pose_world.position[2];
  robot.wait(1.0);
  EXPECT_NEAR(robot.truth().pose_world.position[2], height, 0.002);
  EXPECT_NE(robot.command().reasons & kReasonTimedOut, 0u);
}

TEST(QuadbotScript, LetsItStandUpAndWalk) {
  const TemporaryFolder folder;
  Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kIdeal);
  parameters.loop.command_script = folder.write("script.csv", "cycle,linear,angular\n0,0,0\n1,0.5,0\n").string();
  parameters.leg_control.request_timeout = 0;
  QuadrupedLoop robot(legged_robot("quadbot"), parameters);
  robot.wait(3);
  EXPECT_EQ(robot.command().legged.phase, LegPhase::kWalking);
}

/// Returns quadbot standing, with so much clearance in m.
QuadrupedLoop with_clearance(double clearance) {
  Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kIdeal);
  parameters.safety.clearance = clearance;
  QuadrupedLoop robot = loop_of(parameters);
  robot.run(2.0, stance({ModeKind::kStand}));
  robot.run(0.5, {});
  return robot;
}

TEST(QuadbotClearance, KeepsBodyAndFeetWhereTheyAreAndLetsItLieDown) {
  QuadrupedLoop robot = with_clearance(1e-9);  // 0 in the parameter means unlimited
  ASSERT_EQ(robot.command().legged.phase, LegPhase::kStanding);
  EXPECT_EQ(robot.command().reasons & kReasonPermitSlow, 0u) << "no motion is requested";
  const Vector3 stood = robot.truth().pose_world.position;
  robot.run(1.0, {.twist = {}, .posture = {.height = -0.03, .roll = 0.1, .x = 0.02}});
  EXPECT_NE(robot.command().reasons & kReasonPermitSlow, 0u);
  robot.run(1.0, stance({ModeKind::kLift}));
  EXPECT_GT(robot.truth().normal_force[0], 10);
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(robot.truth().pose_world.position[axis], stood[axis], 1e-3);
  EXPECT_LE(robot.tilt_now(), 0.01);
  robot.run(5.0, stance({ModeKind::kLie}));
  EXPECT_NE(robot.command().reasons & kReasonHolding, 0u);
}

// A box on which a box lies flat threw the robot away on this one.
TEST(QuadbotTerrain, StandsUpOnAPlatform) {
  Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kField);
  parameters.plant.terrain = {.kind = TerrainKind::kGap, .length = 0.1, .distance = 0.85, .heading = -0.2};
  QuadrupedLoop robot = loop_of(parameters);
  robot.run(2.5, stance({ModeKind::kStand}));
  EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
  EXPECT_LE(robot.tilt, 0.1);
}

TEST_F(Quadbot, StandsUpOnlyAfterAResetThatFollowsZero) {
  robot.loop.e_stop();
  robot.run(1.0, stance({ModeKind::kStand}));
  robot.loop.e_stop_reset();
  robot.run(0.1, stance({ModeKind::kStand}));
  EXPECT_NE(robot.permit().causes, 0u);
  robot.run(2.0, {});
  robot.loop.e_stop_reset();
  robot.run(0.1, {});
  EXPECT_EQ(robot.permit().causes, 0u) << names_of(kResetRefusalNames, robot.permit().reset_refusal);
  robot.run(2.5, stance({ModeKind::kStand}));
  EXPECT_GT(robot.truth().pose_world.position[2], 0.2);
}

TEST(QuadbotFeet, AreWeighedByForceSensorsWithOffsetNoiseAndThreshold) {
  QuadrupedLoop robot = loop_of("quadbot", 3, ErrorLevel::kDataSheet);
  robot.run(2.5, stance({ModeKind::kStand}));
  constexpr int kCycles = 1000;
  std::array<double, kLegs> sum{}, squares{};
  for (int k = 0; k < kCycles; ++k) {
    robot.run(0.001, {});
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      ASSERT_EQ(robot.state().contacts[leg].probability, 1) << leg;
      const double error = robot.state().contacts[leg].load - robot.truth().normal_force[leg];
      sum[leg] += error / kCycles;
      squares[leg] += error * error / kCycles;
    }
  }
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    EXPECT_LE(std::abs(sum[leg]), 4 * robot.parameters_.plant.foot_offset) << leg;
    EXPECT_GE(std::abs(sum[leg]), 0.01) << leg;
    // A standard deviation of 1000 samples is right to 10 % in 4 σ.
    const double noise = robot.parameters_.plant.foot_noise / std::sqrt(0.001);
    EXPECT_NEAR(std::sqrt(squares[leg] - sum[leg] * sum[leg]), noise, 0.12 * noise) << leg;
  }
  robot.run(2.0, stance({ModeKind::kLift, 1}));
  EXPECT_EQ(robot.loop.row().driver->sensors.contacts[1].force, Vector3{});
  EXPECT_EQ(robot.state().contacts[1].probability, 0);
  EXPECT_EQ(robot.state().contacts[2].probability, 1);
}

TEST(QuadrupedReplay, IsExactOverStandingAStopAndAReset) {
  QuadrupedLoop robot(legged_robot("quadbot"), 1, ErrorLevel::kField);
  robot.record = true;
  robot.wait(0.3);
  Request joints = stance({ModeKind::kJoints});
  for (std::size_t i = 0; i < kLegsJoints; ++i) joints.joints[i] = robot.robot().joints[i].rest_position;
  joints.joints[1] += 0.1;
  robot.run(0.5, joints);
  robot.run(2.5, stance({ModeKind::kStand}));
  robot.run(0.5, {.twist = {}, .posture = {.height = 0.02, .roll = 0.1, .x = 0.02, .y = 0.01}});
  robot.loop.e_stop();
  robot.run(2.0, {});
  robot.loop.e_stop_reset();
  robot.run(0.5, {});
  const ReplayReport report = robot.recording.replay(robot.loop.robot(), 0.001);
  EXPECT_TRUE(report.exact()) << text_of(report);
}

}  // namespace robot_control::tests
