/// Lying, standing up, lying down, and what interrupts them.

#include "control/legged/ideal_legs.h"
#include "control/legged/posture/ground_slope.h"

namespace robot_control::tests {

double smooth(double part) {
  return part <= 0 ? 0 : part >= 1 ? 1 : part * part * (3 - 2 * part);
}

double ground_of(const LegModel& robot, std::size_t leg) {
  return robot.belly + robot.legs[leg].foot_radius;
}

/// Steps until this phase, or for 5 s.
void run_until(IdealLegs& legs, LegPhase phase) {
  for (int k = 0; k < 1000 && legs.out.legged.phase != phase; ++k) legs.step();
  ASSERT_EQ(legs.out.legged.phase, phase);
}

TEST(LyingLegs, BrakeAllJointsUntilARequestToStandUp) {
  IdealLegs legs(lopsided());
  for (const Mode& mode : {Mode{ModeKind::kStay}, Mode{ModeKind::kLie}}) {
    legs.run(0.1, stance_of(mode));
    EXPECT_EQ(legs.out.legged.phase, LegPhase::kLying);
    EXPECT_EQ(legs.out.reasons, std::uint64_t{kReasonHolding});
    EXPECT_EQ(legs.out.joint_count, kLegsJoints);
    for (std::size_t i = 0; i < kLegsJoints; ++i) EXPECT_EQ(legs.out.joints[i].mode, JointMode::kBrake) << i;
  }
  legs.step(stance_of({ModeKind::kLift}));
  EXPECT_EQ(legs.out.reasons, std::uint64_t{kReasonHolding} | kReasonNotStanding);
  Request pose;
  pose.posture.roll = 0.1;
  legs.step(pose);
  EXPECT_EQ(legs.out.reasons, std::uint64_t{kReasonHolding} | kReasonNotStanding);
  legs.step(stance_of({ModeKind::kStand}));
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kGathering);
  EXPECT_EQ(legs.out.reasons, 0u);
}

TEST(LyingLegs, BearNothing) {
  const ContactSchedule none{}, all{0.5, 0.5, 0.5, 0.5};
  IdealLegs legs = standing();
  EXPECT_EQ(legs.out.contact_schedule, all);
  legs.step(stance_of({ModeKind::kLie}));
  EXPECT_EQ(legs.out.contact_schedule, all) << "while the body sinks";
  run_until(legs, LegPhase::kLying);
  EXPECT_EQ(legs.out.contact_schedule, none);
  legs.step(stance_of({ModeKind::kStand}));
  ASSERT_EQ(legs.out.legged.phase, LegPhase::kGathering);
  EXPECT_EQ(legs.out.contact_schedule, none);
  run_until(legs, LegPhase::kRising);
  legs.step();
  EXPECT_EQ(legs.out.contact_schedule, all);
}

/// The attitude of a robot whose ground rises by `slope` rad ahead.
Quaternion uphill(double slope) {
  return {0, std::sin(-slope / 2), 0, std::cos(-slope / 2)};
}

TEST(GatheredLegs, LieWhereTheGroundSlopesTooMuch) {
  EXPECT_LT(kSlopeGrip * std::tan(kMaxSlope), 0.7) << "the friction of rubber on a floor";
  IdealLegs legs(lopsided());
  legs.has_estimate = true;
  legs.estimate.base.flags = kStateValid;
  legs.estimate.base.attitude = uphill(kMaxSlope + 0.001);
  legs.step(stance_of({ModeKind::kStand}));
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kGathering);
  run_until(legs, LegPhase::kLying);
  EXPECT_EQ(legs.out.reasons, std::uint64_t{kReasonHolding} | kReasonTooSteep);
  legs.run(1, stance_of({ModeKind::kStand}));
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kLying) << "it does not gather again there";
  EXPECT_EQ(legs.out.reasons, std::uint64_t{kReasonHolding} | kReasonTooSteep);
  legs.step(stance_of({ModeKind::kStay}));
  EXPECT_EQ(legs.out.reasons, std::uint64_t{kReasonHolding});
  legs.estimate.base.attitude = uphill(kMaxSlope - 0.001);
  legs.step(stance_of({ModeKind::kStand}));
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kGathering);
  EXPECT_EQ(legs.out.reasons, 0u);
  run_until(legs, LegPhase::kRising);
}

/// Legs that were moved one by one lift or tilt the body.
TEST(GatheredLegs, MeasureTheSlopeInTheLyingPostureAlone) {
  constexpr double kSlope = 0.2;
  for (const bool moved : {false, true}) {
    IdealLegs legs(lopsided());
    legs.has_estimate = true;
    legs.estimate.base.flags = kStateValid;
    Request joints = stance_of({ModeKind::kJoints});
    for (std::size_t i = 0; i < kLegsJoints; ++i)
      joints.joints[i] = legs.sensors.joints[i].position + (i % kLegJoints == 1 ? 0.1 : 0);
    if (moved) legs.run(1, joints);
    EXPECT_EQ(legs.out.legged.phase, moved ? LegPhase::kJoints : LegPhase::kLying);
    legs.estimate.base.attitude = uphill(kMaxSlope + 0.1);
    legs.step(stance_of({ModeKind::kStand}));
    EXPECT_EQ(legs.out.legged.phase, LegPhase::kGathering);
    legs.estimate.base.attitude = uphill(kSlope);
    run_until(legs, LegPhase::kRising);
    const std::array<double, 2> rising = legs.out.legged.slope;
    run_until(legs, LegPhase::kStanding);
    EXPECT_EQ(rising, legs.out.legged.slope);
    const Vector3& up = legs.state().stand.up;
    EXPECT_EQ(rising, (std::array{up[0] / up[2], up[1] / up[2]}));
    EXPECT_NEAR(std::atan2(std::hypot(up[0], up[1]), up[2]), kSlope + std::abs(legs.robot.lying_pitch),
                0.01 + std::abs(legs.robot.lying_pitch));
  }
}

/// So each foot bears the same on a slope as on level ground.
TEST(RisingLegs, PutTheCentreOfGravityAmidTheFeetAlongTheVertical) {
  constexpr double kSlope = 0.2;
  IdealLegs legs(lopsided());
  legs.has_estimate = true;
  legs.estimate.base.flags = kStateValid;
  legs.estimate.base.attitude = uphill(kSlope);
  legs.run(4.0, stance_of({ModeKind::kStand}));
  ASSERT_EQ(legs.out.legged.phase, LegPhase::kStanding);
  const IdealLegs level = standing();
  const double height = -level.foot_in_base(0).z() + level.at_rest().centre_of_gravity.z();
  EXPECT_NEAR(legs.centre().x() - level.centre().x(), height * std::tan(kSlope), 1e-3);
  EXPECT_NEAR(legs.centre().y() - level.centre().y(), 0, 1e-3);
}

TEST(LyingLegs, NameInputsThatTheyUseAndThoseThatTheyLack) {
  IdealLegs legs(lopsided());
  StateFrame state;
  state.head.cycle = 41;
  legs.permit.head.cycle = 40;
  legs.sensors.head.cycle = 42;
  CommandFrame out;
  legs.controller.step({.sensors = &legs.sensors, .state = &state, .permit = &legs.permit, .request = {}}, out);
  EXPECT_EQ(out.state_cycle, 41u);
  EXPECT_EQ(out.permit_cycle, 40u);
  EXPECT_EQ(out.first_cycle, 42u);
  legs.controller.step({.sensors = &legs.sensors, .request = {}}, out);
  EXPECT_EQ(out.state_cycle, 0u);
  EXPECT_EQ(out.permit_cycle, 0u);
}

/// Three times as slow at its beginning and end: the smooth way is 1.5 times as fast in its middle.
TEST(GatheringLegs, GoSmoothlyToTheLyingPostureWithinTheGatherSpeed) {
  IdealLegs legs(lopsided());
  std::array<double, kLegsJoints> from{}, to{};
  double farthest = 0;
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    to[i] = legs.sensors.joints[i].position;
    from[i] = legs.sensors.joints[i].position = to[i] + (i % 2 == 0 ? 0.3 : -0.2) - 0.01 * static_cast<double>(i);
    farthest = std::max(farthest, std::abs(to[i] - from[i]));
  }
  const double speed = leg_tuning(legs.robot).joint.speed, time = 1.5 * farthest / speed;
  double fastest = 0;
  legs.step(stance_of({ModeKind::kStand}));
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    EXPECT_EQ(legs.out.joints[i].position, from[i]);
    EXPECT_EQ(legs.out.joints[i].velocity, 0);
  }
  for (double elapsed = kCycle; elapsed < time; elapsed += kCycle) {
    legs.step();
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      EXPECT_NEAR(legs.out.joints[i].position, from[i] + smooth(elapsed / time) * (to[i] - from[i]), 1e-9);
      EXPECT_NEAR(legs.out.joints[i].velocity, (legs.out.joints[i].position - legs.before.joints[i].position) / kCycle,
                  elapsed > 1.5 * kCycle ? 1e-9 : 1);
      fastest = std::max(fastest, std::abs(legs.out.joints[i].velocity));
    }
    EXPECT_EQ(legs.out.legged.phase, LegPhase::kGathering);
  }
  EXPECT_LE(fastest, speed);
  EXPECT_GE(fastest, 0.95 * speed);
  legs.step();
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kRising);
}

TEST(GatheringLegs, TakeATenthOfASecondAtLeastAndEndWithARequestToLie) {
  IdealLegs legs(lopsided());
  legs.step(stance_of({ModeKind::kStand}));
  for (int k = 1; k < 20; ++k) {
    legs.step();
    EXPECT_EQ(legs.out.legged.phase, LegPhase::kGathering) << k;
  }
  IdealLegs down = legs;
  legs.step();
  legs.step();
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kRising);
  down.step(stance_of({ModeKind::kLie}));
  EXPECT_EQ(down.out.legged.phase, LegPhase::kLying);
}

TEST(RisingLegs, LiftTheBodySmoothlyWithItsCentreOfGravityAmidTheFeet) {
  IdealLegs legs(lopsided());
  legs.request(stance_of({ModeKind::kStand}));
  run_until(legs, LegPhase::kRising);
  const double time = leg_tuning(legs.robot).rise_time, height = nominal_height(legs.robot);
  std::array<Eigen::Vector3d, kLegs> began{};
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    began[leg] = legs.robot.legs[leg].kinematics.position(legs.robot.legs[leg].lying);
    middle += began[leg].head<2>() / 4;
  }
  for (double elapsed = kCycle; elapsed < time - kCycle / 2; elapsed += kCycle) {
    legs.step();
    ASSERT_EQ(legs.out.legged.phase, LegPhase::kRising);
    EXPECT_EQ(legs.out.reasons, 0u);
    EXPECT_NEAR(legs.pose()[2], smooth(elapsed / time) * height, 1e-9);
    for (const std::size_t level : {3, 4, 5}) EXPECT_EQ(legs.pose()[level], 0);
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(legs.out.twist_limited.linear[axis], (legs.pose()[axis] - legs.pose_before[axis]) / kCycle, 1e-9);
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const double ground = ground_of(legs.robot, leg), z = began[leg].z();
      const double down = std::max(ground, z - 0.1 * elapsed), up = std::min(ground, z + 0.1 * elapsed);
      const Eigen::Vector3d place(began[leg].x(), began[leg].y(), z > ground ? down : up);
      EXPECT_LE((legs.foot(leg) - place).norm(), 1e-6) << leg << " at " << elapsed;
      EXPECT_NEAR(legs.state().stand.share[leg], std::min(1.0, elapsed / kLoadTime), 1e-9);
    }
  }
  legs.step();
  legs.step();  // the sum of the cycles may be a rounding less
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kStanding);
  EXPECT_LE((legs.centre() - middle).norm(), 0.001);
  legs.run(0.5, {});
  EXPECT_EQ(legs.out.reasons, 0u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(legs.out.legged.body[i], 0, 1e-6) << i;
}

TEST(RisingLegs, StandSevenTenthsOfALegBelowTheirSecondJoints) {
  const IdealLegs legs = standing();
  const LegGeometry& leg = legs.robot.legs[0].kinematics.geometry();
  const double hip = legs.pose()[2] + leg.hip.z() + leg.upper.z();
  EXPECT_NEAR(hip - legs.foot(0).z(), 0.7 * legs.robot.leg_length(), 1e-6);
}

/// Half of the rise takes as long as half of the way down.
TEST(RisingLegs, GoDownAgainFromWhereTheyAre) {
  IdealLegs legs(lopsided());
  legs.request(stance_of({ModeKind::kStand}));
  run_until(legs, LegPhase::kRising);
  const double time = leg_tuning(legs.robot).rise_time;
  for (double elapsed = 0; elapsed < 0.6 * time; elapsed += kCycle) legs.step();
  const double up = legs.pose()[2];
  legs.step(stance_of({ModeKind::kLie}));
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kLowering);
  double left = 0;
  for (; legs.out.legged.phase == LegPhase::kLowering && left < 3; left += kCycle) {
    const double before = legs.pose()[2];
    legs.step();
    if (left == 0) {
      EXPECT_NEAR(legs.pose()[2], up, 0.01);
    }
    if (legs.out.legged.phase != LegPhase::kLowering) break;
    EXPECT_LE(std::abs(legs.pose()[2] - before), 0.01);
  }
  EXPECT_NEAR(left, 0.6 * time, 4 * kCycle);
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kLying);
  EXPECT_NE(legs.out.reasons & kReasonHolding, 0u);
}

TEST(LoweringLegs, SinkWithinTheRiseTime) {
  IdealLegs legs = standing();
  const double time = leg_tuning(legs.robot).rise_time, height = legs.pose()[2];
  const std::array<Eigen::Vector3d, kLegs> feet = legs.feet();
  legs.step(stance_of({ModeKind::kLie}));
  legs.step();
  ASSERT_EQ(legs.out.legged.phase, LegPhase::kLowering);
  for (double elapsed = kCycle; elapsed < time - kCycle / 2; elapsed += kCycle) {
    legs.step();
    ASSERT_EQ(legs.out.legged.phase, LegPhase::kLowering) << elapsed;
    EXPECT_NEAR(legs.pose()[2], smooth(1 - elapsed / time) * height, 1e-9);
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      EXPECT_LE((legs.foot(leg) - feet[leg]).norm(), 1e-6) << leg;
      EXPECT_NEAR(legs.state().stand.share[leg], std::min(1.0, (time - elapsed) / kLoadTime), 1e-9);
    }
    EXPECT_EQ(legs.out.legged.body, (std::array<double, 6>{})) << "only a standing body has a pose";
  }
  legs.step();
  legs.step();  // the sum of the cycles may be a rounding less
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kLying);
}

TEST(LoweringLegs, ReturnToTheNominalPoseFirst) {
  IdealLegs legs = standing();
  Request pose;
  pose.posture = {.height = -0.02, .roll = 0.1, .pitch = -0.05, .x = 0.02, .y = 0.03, .yaw = 0.1};
  const Stance::Pose nominal = legs.pose();
  legs.run(1.5, pose);
  legs.step(stance_of({ModeKind::kLie}));
  for (int k = 0; k < 400 && legs.state().sinks == 0; ++k) {
    EXPECT_GT(legs.pose()[2], nominal[2] - 0.03);
    legs.step();
  }
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(legs.pose()[i], nominal[i], 6e-4) << i;
  legs.step();
  run_until(legs, LegPhase::kLying);
}

TEST(LoweringLegs, StandUpAgainFromWhereTheyAre) {
  IdealLegs legs = standing();
  const double time = leg_tuning(legs.robot).rise_time, height = legs.pose()[2];
  legs.run(0.3 * time, stance_of({ModeKind::kLie}));
  const double down = legs.pose()[2];
  ASSERT_LT(down, 0.9 * height);
  legs.step(stance_of({ModeKind::kStand}));
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kRising);
  legs.step();
  EXPECT_NEAR(legs.pose()[2], down, 0.01);
  int cycles = 0;
  for (; cycles < 400 && legs.out.legged.phase == LegPhase::kRising; ++cycles) legs.step();
  EXPECT_NEAR(cycles * kCycle, 0.3 * time, 4 * kCycle);
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kStanding);
}

TEST(RisingLegs, SinkWithinTheRiseTimeIfALieIsRequestedInTheirLastCycle) {
  IdealLegs legs(lopsided()), next = legs;
  legs.request(stance_of({ModeKind::kStand}));
  for (next = legs; next.out.legged.phase != LegPhase::kStanding; next.step()) legs = next;
  const double height = legs.pose()[2];
  legs.step(stance_of({ModeKind::kLie}));
  legs.step();
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kLowering);
  EXPECT_NEAR(legs.pose()[2], height, 0.01);
}

TEST(LoweringLegs, StandAgainAtOnceWhereTheBodyHasNotSunk) {
  IdealLegs legs = standing();
  Request pose;
  pose.posture.height = 0.04;
  legs.run(1.0, pose);
  legs.run(0.02, stance_of({ModeKind::kLie}));
  ASSERT_EQ(legs.out.legged.phase, LegPhase::kLowering);
  legs.step(stance_of({ModeKind::kStand}));
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kStanding);
}

TEST(StandingLegs, AreReleasedByAPermitToBrakeAndWhereThePermitIsMissingForLong) {
  struct Case {
    bool none;
    int cycles;
    LegPhase after;
  };
  for (const auto& [none, cycles, after] : {Case{false, 1, LegPhase::kLying}, Case{true, 1, LegPhase::kStanding},
                                            Case{true, 20, LegPhase::kStanding}, Case{true, 21, LegPhase::kLying}}) {
    IdealLegs legs = standing();
    legs.has_permit = !none;
    legs.permit.action = none ? PermitAction::kDrive : PermitAction::kBrake;
    for (int i = 0; i < cycles; ++i) {
      legs.step();
      EXPECT_EQ(legs.out.reasons, none ? std::uint64_t{kReasonNoPermit} : std::uint64_t{kReasonPermitBrake});
      EXPECT_EQ(legs.out.joints[3].mode, JointMode::kBrake);
      EXPECT_EQ(legs.out.legged.phase, LegPhase::kLying);
    }
    legs.has_permit = true;
    legs.permit.action = PermitAction::kDrive;
    legs.step();
    EXPECT_EQ(legs.out.legged.phase, after) << "one that lies has to be told to stand up again";
    EXPECT_EQ(legs.out.requests_received, legs.inbox.count);
  }
}

TEST(StandingLegs, AreReleasedByAJointThatIsNotMeasured) {
  for (const std::size_t joint : {0, 11}) {
    IdealLegs legs = standing();
    legs.sensors.joints[joint].position = std::nan("");
    legs.step();
    EXPECT_EQ(legs.out.reasons, std::uint64_t{kReasonBadSensors});
    EXPECT_EQ(legs.out.joints[3].mode, JointMode::kBrake);
    IdealLegs other = standing();
    other.sensors.joints[joint].valid = 0;
    other.step();
    EXPECT_EQ(other.out.reasons, std::uint64_t{kReasonBadSensors});
  }
  IdealLegs legs = standing();
  legs.sensors.joints[12].position = std::nan("");  // no leg's
  legs.step();
  EXPECT_EQ(legs.out.reasons, 0u);
}

TEST(StandingLegs, LieDownWhileThePermitRamps) {
  IdealLegs legs = standing();
  legs.permit.action = PermitAction::kRamp;
  legs.step(stance_of({ModeKind::kStand}));
  EXPECT_EQ(legs.out.reasons, std::uint64_t{kReasonPermitRamp});
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kLowering);
  run_until(legs, LegPhase::kLying);
}

TEST(StandingLegs, ForgetEverythingInANewRun) {
  IdealLegs legs = standing();
  legs.controller.enter_run(legs.inbox, false);
  EXPECT_EQ(legs.controller.phase(), LegPhase::kLying);
  legs.step();
  EXPECT_EQ(legs.out.reasons, kReasonNoCommand | kReasonHolding);
  EXPECT_EQ(legs.out.requests_received, 0u);
}

TEST(StandingLegs, NameARequestOfJoints) {
  IdealLegs legs = standing();
  legs.step(stance_of({ModeKind::kJoints}));
  EXPECT_EQ(legs.out.reasons, std::uint64_t{kReasonNotLying});
  EXPECT_EQ(legs.out.legged.phase, LegPhase::kStanding);
  legs.step(stance_of({ModeKind::kGait, kStandGait}));
  EXPECT_EQ(legs.out.reasons, std::uint64_t{kReasonPartIgnored});
  legs.step(stance_of({ModeKind::kStand}));
  EXPECT_EQ(legs.out.reasons, 0u);
}

}  // namespace robot_control::tests
