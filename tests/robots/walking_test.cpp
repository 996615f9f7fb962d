/// Robots on legs that walk, in the closed loop.

#include "control/legged/walk/gait_table.h"
#include "robots/quadruped_fixture.h"

namespace robot_control::tests {

Mode gait(std::uint64_t index) {
  return {ModeKind::kGait, index};
}

/// Returns the mean twist of the base, by truth, while it walks so for `seconds`.
WalkingTwist mean_twist(QuadrupedLoop& robot, double seconds, const Request& request) {
  WalkingTwist mean{};
  const double part = 1 / static_cast<double>(robot.cycles(seconds));
  for (std::uint64_t k = 0; k < robot.cycles(seconds); ++k) {
    if (k % 20 == 0) robot.loop.request(request);
    robot.step();
    const Twist& twist = robot.truth().twist_base;
    mean[0] += part * twist.linear[0];
    mean[1] += part * twist.linear[1];
    mean[2] += part * twist.angular[2];
  }
  return mean;
}

void expect_walk(QuadrupedLoop& robot, const Request& request, double part, double tilt) {
  robot.run(2.0, request);
  robot.clear();
  const WalkingTwist mean = mean_twist(robot, 3.0, request);
  const WalkingTwist wanted{request.twist.linear[0], request.twist.linear[1], request.twist.angular[2]};
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_NEAR(mean[i], wanted[i], part * std::abs(wanted[i]) + 0.01) << i;
  EXPECT_LE(robot.tilt, tilt);
  EXPECT_LE(robot.effort, 0.98);
  EXPECT_EQ(robot.command().legged.phase, LegPhase::kWalking);
  EXPECT_EQ(robot.command().reasons, 0u);
  EXPECT_EQ(robot.permit().causes | robot.permit().warnings, 0u) << robot.causes();
}

/// A lying robot stands up, walks, stops and stands.
class WalkingOf : public testing::TestWithParam<std::string> {};

TEST_P(WalkingOf, ATwistLetsALyingRobotStandUpAndWalkAndAZeroLetsItStand) {
  QuadrupedLoop robot = loop_of(GetParam());
  robot.run(3.0, walk(0.5, 0, 0));
  expect_walk(robot, walk(0.5, 0, 0), 0.03, 0.1);
  double stood = 0;
  while (robot.command().legged.phase == LegPhase::kWalking && stood < 3) {
    robot.run(0.02, {});
    stood += 0.02;
  }
  EXPECT_LE(stood, 1.2);
  robot.run(0.5, {});
  EXPECT_LT(robot.speed(), 0.02);
  EXPECT_EQ(robot.command().legged.phase, LegPhase::kStanding);
  EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
}

INSTANTIATE_TEST_SUITE_P(Robots, WalkingOf, testing::ValuesIn(legged_robots()), robot_name);

struct Walk {
  Request request;
  double part;  ///< of the speed
  double tilt;  ///< rad
};

class WalkOfQuadbot : public testing::TestWithParam<Walk> {};

TEST_P(WalkOfQuadbot, FollowsTheTwist) {
  QuadrupedLoop robot = loop_of("quadbot");
  robot.run(3.0, GetParam().request);
  expect_walk(robot, GetParam().request, GetParam().part, GetParam().tilt);
}

INSTANTIATE_TEST_SUITE_P(Walks, WalkOfQuadbot,
                         testing::Values(Walk{walk(1.0, 0, 0), 0.05, 0.15}, Walk{walk(0, 0.3, 0), 0.05, 0.15},
                                         Walk{walk(0, 0, 1.5), 0.05, 0.15}, Walk{walk(0.5, 0.2, 0.5), 0.05, 0.15},
                                         Walk{walk(0.2, 0, 0, gait(gait_named("crawl"))), 0.03, 0.15},
                                         Walk{walk(0.5, 0, 0, gait(gait_named("walking_trot"))), 0.03, 0.15}));

/// One foot after the other swings, for a quarter of the period.
TEST(Walking, AGaitOfOnesOwnCarriesTheRobotAndIsLimitedByItsLegs) {
  const LegModel model = legged_robot("quadbot");
  Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kIdeal);
  parameters.leg_control.gaits[3] = {
      .name = "amble", .period = 0.6, .duty = 0.75, .phases = NumberList<4>{0.5, 0, 0.25, 0.75}, .lift = 0.06};
  QuadrupedLoop robot(model, parameters);
  robot.wait(0.3);
  const std::uint64_t amble = kGaits.size();
  const Request slow = walk(0.3, 0, 0, gait(amble));
  robot.run(3.0, slow);
  expect_walk(robot, slow, 0.03, 0.15);
  EXPECT_EQ(robot.command().legged.gait, amble);
  const NominalStance stance = nominal_stance(model);
  Gaits gaits = all_gaits(parameters.leg_control.gaits);
  for (Gait& each : gaits) each = gait_of(model, stance, each);
  const double fastest = walking_speeds(model, stance, gaits)[amble][0];
  robot.run(3.0, walk(1.5, 0, 0, gait(amble)));
  EXPECT_NE(robot.command().reasons & kReasonLegSpeed, 0u);
  EXPECT_NEAR(mean_twist(robot, 1.2, walk(1.5, 0, 0, gait(amble)))[0], fastest, 0.05 * fastest);
  EXPECT_EQ(robot.permit().causes | robot.permit().warnings, 0u) << robot.causes();
  robot.run(0.1, walk(0.4, 0, 0, gait(amble + 1)));
  EXPECT_NE(robot.command().reasons & kReasonPartIgnored, 0u);
}

/// Feet that met a tile before their time and did not bear there would let it lean by 0.13 rad.
TEST(Walking, GoesOverTilesOfUpTo40Millimetres) {
  Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kIdeal);
  parameters.plant.scene = PROJECT_DIRECTORY "/urdf/scenes/tiles.xml";
  QuadrupedLoop robot = loop_of(parameters);
  robot.run(10.0, walk(0.4, 0, 0, gait(gait_named("walking_trot"))));
  EXPECT_GT(robot.truth().pose_world.position[0], 2.5);
  EXPECT_LE(robot.tilt, 0.11);
  EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
}

TEST(Walking, AnEmergencyStopFoldsFromAnyPhaseOfTheGait) {
  for (int phase = 0; phase < 4; ++phase) {
    QuadrupedLoop robot = loop_of("quadbot");
    robot.run(4.5 + 0.0475 * phase, walk(1.0, 0, 0));
    const auto [cycles, rest_at] = robot.fold();
    EXPECT_LE(cycles, 3) << phase;
    EXPECT_LE(rest_at, 1.0) << phase;
    EXPECT_LE(robot.tilt, 0.35) << phase;
  }
}

/// Returns a robot with the sensors of data sheets and without force sensors at its feet.
QuadrupedLoop with_errors(const std::string& name, std::uint64_t seed) {
  Parameters parameters = QuadrupedLoop::parameters(seed, ErrorLevel::kDataSheet);
  parameters.plant.contact_sensors = false;
  return loop_of(parameters, name);
}

TEST(Walking, KeepsItsBodyParallelToTheGround) {
  QuadrupedLoop robot = with_errors("quadbot", 0);
  robot.run(4.0, walk(0.25, 0, 0));
  robot.clear();
  robot.run(2.0, walk(0.25, 0, 0));
  EXPECT_LT(robot.tilt, 0.015);  // rad
}

TEST(Walking, AFootThatIsStillInTheAirIsNotPushedFasterThanItsJointsTurn) {
  if (quadrupeds().empty()) GTEST_SKIP() << "no folder of real quadrupeds; ROBOT_QUADRUPEDS names one";
  QuadrupedLoop robot = with_errors("anymal_c", 1);
  robot.run(4.0, walk(1.0, 0, 0));
  double fastest = 0;
  robot.after_step = [&] {
    for (std::size_t i = 0; i < kLegsJoints; ++i)
      fastest = std::max(fastest, std::abs(robot.truth().joints[i].velocity) / robot.robot().joints[i].velocity_limit);
  };
  robot.run(3.0, walk(1.0, 0, 0));
  EXPECT_LE(fastest, 0.9);
}

TEST(Walking, DoesNotBecomeFasterThanRequestedWhenItStarts) {
  QuadrupedLoop robot = loop_of("quadbot");
  robot.run(3.0, walk(0.01, 0, 0));
  double fastest = 0;
  for (int steps = 0; steps < 8; ++steps)
    fastest = std::max(fastest, mean_twist(robot, kGaits[1].period, walk(0.5, 0, 0, gait(gait_named("trot"))))[0]);
  EXPECT_LE(fastest, 0.53);
}

TEST(Walking, ReachesItsSpeedThoughTheErrorOfTheTiltPullsTheBodyBack) {
  QuadrupedLoop robot = with_errors("quadbot", 17);
  robot.run(5.0, walk(1.5, 0, 0));
  EXPECT_NEAR(mean_twist(robot, 2.0, walk(1.5, 0, 0))[0], 1.5, 0.02 * 1.5);
}

TEST(Walking, IsNotStoppedForATiltThatOnlyABiasOfTheGyroShows) {
  Parameters parameters = QuadrupedLoop::parameters(13, ErrorLevel::kField);
  parameters.plant.contact_sensors = false;
  parameters.plant.gyro_bias = 0.02;
  QuadrupedLoop robot = loop_of(parameters);
  robot.run(20.0, walk(0.5, 0, 0));
  EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
  EXPECT_LT(robot.tilt, 0.1);
}

TEST(Walking, GoesOnWhenATrotBecomesACrawlThatIsRequestedFaster) {
  QuadrupedLoop robot = loop_of("quadbot");
  robot.run(5.0, walk(1.0, 0, 0, gait(gait_named("trot"))));
  robot.run(3.0, walk(0.55, 0, 0, gait(gait_named("crawl"))));
  EXPECT_EQ(robot.command().legged.gait, gait_named("crawl"));
  EXPECT_EQ(robot.command().legged.phase, LegPhase::kWalking);
  EXPECT_EQ(robot.command().reasons, kReasonLegSpeed);
  EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
}

/// A crawl ends while its body is twice as fast as requested, and a trot has two feet to bear it.
TEST(Walking, DoesNotRunAheadWhereACrawlBecomesATrot) {
  for (const std::uint64_t next : {gait_named("trot"), gait_named("walking_trot")}) {
    QuadrupedLoop robot = loop_of("quadbot");
    robot.run(6.0, walk(0.13, 0, 0, gait(gait_named("crawl"))));
    while (robot.command().legged.gait != next) robot.run(0.001, walk(0.13, 0, 0, gait(next)));
    double fastest = 0;
    robot.after_step = [&] { fastest = std::max(fastest, robot.truth().twist_base.linear[0]); };
    robot.run(1.0, walk(0.13, 0, 0, gait(next)));
    EXPECT_LE(fastest, 0.35) << kGaits[static_cast<std::size_t>(next)].name.data();
    EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
  }
}

TEST(Walking, IsStoppedByAFaultThatIsNamedBeforeItFalls) {
  struct Fault {
    std::string component, kind, cause;
  };
  for (const Fault& fault :
       {Fault{"front_left_knee_joint_motor", "off", "joint_following"}, Fault{"gyro", "stuck", "body_turn"},
        Fault{"gyro", "garbage", "imu_jump"}, Fault{"gyro", "wrong", "body_turn"},
        Fault{"accelerometer", "wrong", "imu_reversed"}, Fault{"estimator", "wrong", "wrong_state"}}) {
    SCOPED_TRACE(fault.component);
    QuadrupedLoop robot = loop_of("quadbot", 0, ErrorLevel::kDataSheet);
    robot.run(4.0, walk(0.5, 0, 0));
    robot.loop.inject_fault(fault.component, fault.kind);
    robot.run(0.3, walk(0.5, 0, 0));
    EXPECT_EQ(names_of(kStopCauseNames, robot.permit().first_cause), fault.cause);
    robot.run(2.0, {});
    EXPECT_LT(robot.tilt_now(), 0.3);
  }
}

TEST(Walking, IsStoppedUprightByAGyroOfWrongSignInEachPhase) {
  for (int phase = 0; phase < 10; ++phase) {
    QuadrupedLoop robot = loop_of("quadbot", 0, ErrorLevel::kDataSheet);
    robot.run(2.0 + 0.038 * phase, walk(0.5, 0, 0));
    robot.loop.inject_fault("gyro", "wrong");
    robot.run(0.3, walk(0.5, 0, 0));
    EXPECT_EQ(names_of(kStopCauseNames, robot.permit().first_cause), "body_turn") << phase;
    robot.run(2.0, {});
    EXPECT_LT(robot.tilt_now(), 0.3) << phase;
  }
}

/// A walk that goes on until it ends, or a robot that lies down as usual, needs feet that hold.
TEST(Walking, IsStoppedUprightWhereItsFeetSlip) {
  for (const std::uint64_t seed : {0, 1}) {
    Parameters parameters = QuadrupedLoop::parameters(seed, ErrorLevel::kDataSheet);
    parameters.plant.ground_friction = 0.1;
    QuadrupedLoop robot = loop_of(parameters);
    robot.run(8.0, walk(0.2, 0, 0, gait(gait_named("crawl"))));
    EXPECT_EQ(names_of(kStopCauseNames, robot.permit().first_cause), "foot_slip");
    EXPECT_LT(robot.tilt, 0.25);
    EXPECT_LT(robot.tilt_now(), 0.05);
  }
}

/// Its speed jumps, which looks like a load. A foot that bears has no commanded angle.
TEST(Walking, AThighWhoseEncoderTurnsRoundInMidSwingIsNamedInThatSwing) {
  constexpr std::size_t kLeg = 3;
  const Gait& trot = kGaits[gait_named("trot")];
  QuadrupedLoop robot = with_errors("quadbot", 0);
  robot.run(4.0, walk(0.4, 0, 0));
  const auto amid = [&] { return trot.swung(kLeg, robot.command().legged.gait_phase) > 0.6; };
  while (amid()) robot.run(0.001, walk(0.4, 0, 0));
  while (!amid()) robot.run(0.001, walk(0.4, 0, 0));
  robot.loop.inject_fault("rear_right_thigh_joint_encoder", "wrong");
  robot.run(0.08, walk(0.4, 0, 0));
  EXPECT_EQ(names_of(kStopCauseNames, robot.permit().first_cause), "joint_following");
  robot.run(2.0, {});
  EXPECT_LT(robot.tilt, 0.2);
}

}  // namespace robot_control::tests
