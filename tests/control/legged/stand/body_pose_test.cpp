/// The body of standing legs.

#include "control/legged/ideal_legs.h"

namespace robot_control::tests {

Request pose_of(const std::array<double, 6>& pose) {
  Request request;
  request.posture = {.height = pose[2], .roll = pose[3], .pitch = pose[4], .x = pose[0], .y = pose[1], .yaw = pose[5]};
  return request;
}

TEST(BodyPose, IsReachedWithAllFeetWhereTheyStood) {
  for (const std::array<double, 6>& wanted : {std::array<double, 6>{0.02, -0.015, -0.03, 0.08, -0.06, 0.1},
                                              std::array<double, 6>{-0.02, 0.02, 0.02, -0.1, 0.05, -0.12}}) {
    IdealLegs legs = standing();
    const std::array<Eigen::Vector3d, kLegs> feet = legs.feet();
    const Stance::Pose from = legs.pose();
    legs.request(pose_of(wanted));
    for (int k = 0; k < 300; ++k) {
      legs.step();
      for (std::size_t leg = 0; leg < kLegs; ++leg) ASSERT_LE((legs.foot(leg) - feet[leg]).norm(), 1e-6) << leg;
      for (std::size_t i = 0; i < 6; ++i) {
        const double speed = (legs.pose()[i] - legs.pose_before[i]) / kCycle;
        ASSERT_NEAR(i < 3 ? legs.out.twist_limited.linear[i] : legs.out.twist_limited.angular[i - 3], speed, 1e-9);
      }
    }
    EXPECT_EQ(legs.out.reasons, 0u);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(legs.pose()[i] - from[i], wanted[i], 1e-4) << i;
      EXPECT_NEAR(legs.out.legged.body[i], wanted[i], 1e-4) << i;
    }
  }
}

TEST(BodyPose, StaysWithinItsRanges) {
  const LegModel robot = lopsided();
  const LegTuning tuning = leg_tuning(robot);
  const double ranges[6] = {tuning.sway, tuning.sway, tuning.bob, tuning.lean, tuning.lean, tuning.lean};
  for (std::size_t i = 0; i < 6; ++i) {
    for (const double side : {-1.0, 1.0}) {
      IdealLegs legs = standing(robot);
      std::array<double, 6> wanted{};
      wanted[i] = 1.01 * side * ranges[i];
      legs.step(pose_of(wanted));
      EXPECT_EQ(legs.out.reasons, std::uint64_t{kReasonOutOfReach}) << i;
      EXPECT_NEAR(legs.state().stand.held[i], side * ranges[i], 1e-12) << i;
      wanted[i] = 0.99 * side * ranges[i];
      legs.step(pose_of(wanted));
      EXPECT_EQ(legs.out.reasons, 0u) << i;
      EXPECT_NEAR(legs.state().stand.held[i], wanted[i], 1e-12) << i;
    }
  }
}

TEST(BodyPose, LeansNoFartherInRollAndPitchTogether) {
  IdealLegs legs = standing();
  legs.step(pose_of({0, 0, 0, 0.3, -0.4, 0}));
  EXPECT_NE(legs.out.reasons & kReasonOutOfReach, 0u);
  EXPECT_NEAR(legs.state().stand.held[3], 0.18, 1e-12);
  EXPECT_NEAR(legs.state().stand.held[4], -0.24, 1e-12);
  legs.step(pose_of({0, 0, 0, 0.3, 0, 0}));
  EXPECT_EQ(legs.out.reasons, 0u);
}

TEST(BodyPose, HoldsTheStoppingPlaceOfAMotionThatIsInterrupted) {
  IdealLegs legs(lopsided(), kCycle, 0.1);
  for (int k = 0; k < 700; ++k) legs.step(stance_of({ModeKind::kStand}));
  const std::array<AxisBounds, 6> bounds = body_bounds(legs.robot);
  legs.step(pose_of({0.05, 0.05, -0.05, 0.2, 0.1, 0.2}));
  for (int k = 0; k < 100 && (legs.out.reasons & kReasonTimedOut) == 0; ++k) {
    legs.pose_before = stopping_place(legs.state().stand.body, bounds);
    const Stance::Pose place = legs.pose_before;
    legs.step();
    if ((legs.out.reasons & kReasonTimedOut) == 0) continue;
    ASSERT_GT(stopping_time(legs.state().stand.body, bounds), 0.01);
    for (int wait = 0; wait < 200; ++wait) legs.step();
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(legs.pose()[i], place[i], 1e-3) << i;
  }
  EXPECT_NE(legs.out.reasons & kReasonTimedOut, 0u);
}

/// Returns lopsided() with another range of this joint for standing legs alone. The range begins `left` rad from the
/// joint's angle in the nominal pose, on the side of `side`.
LegModel with_end(std::size_t leg, std::size_t joint, double side, double left) {
  const IdealLegs legs = standing();
  LegModel robot = legs.robot;
  LegGeometry geometry = robot.legs[leg].kinematics.geometry();
  const double end = legs.angles(leg)[static_cast<Eigen::Index>(joint)] + side * left;
  (side > 0 ? geometry.range[joint].upper : geometry.range[joint].lower) = end;
  robot.legs[leg].kinematics = LegKinematics(geometry);
  return robot;
}

/// Every joint of every leg has an end that the body's motion comes to.
TEST(BodyPose, StopsBeforeAJointMeetsTheEndOfItsRange) {
  const std::array<double, 6> ways[6] = {{0, 0.05, 0, 0, 0, 0},  {0, -0.05, 0, 0, 0, 0}, {0.05, 0, 0, 0, 0, 0},
                                         {-0.05, 0, 0, 0, 0, 0}, {0, 0, 0.06, 0, 0, 0},  {0, 0, -0.06, 0, 0, 0}};
  const IdealLegs nominal = standing();
  for (const std::array<double, 6>& way : ways) {
    IdealLegs free = nominal;
    free.run(1.5, pose_of(way));
    ASSERT_EQ(free.out.reasons, 0u);
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      for (std::size_t joint = 0; joint < kLegJoints; ++joint) {
        const auto axis = static_cast<Eigen::Index>(joint);
        const double turned = free.angles(leg)[axis] - nominal.angles(leg)[axis];
        if (std::abs(turned) < 0.1) continue;
        const double side = std::copysign(1.0, turned);
        LegModel robot = with_end(leg, joint, side, 0.08);
        // Lying down uses the range, too, where the folded leg is on its other side.
        IdealLegs legs(robot);
        legs.controller.set_state(nominal.state());
        for (std::size_t i = 0; i < kLegsJoints; ++i) legs.sensors.joints[i].position = nominal.out.joints[i].position;
        legs.inbox = nominal.inbox;
        legs.run(1.5, pose_of(way));
        const double spare = side * (nominal.angles(leg)[axis] + side * 0.08 - legs.angles(leg)[axis]);
        EXPECT_NEAR(spare, 0.03, 0.012) << leg << joint << " by " << way[0] << " " << way[1] << " " << way[2];
        EXPECT_GE(spare, 0.029) << leg << joint;
        EXPECT_NE(legs.out.reasons & kReasonOutOfReach, 0u);
        EXPECT_EQ(legs.out.twist_limited.linear, Vector3{});
        legs.run(1.0, {});
        for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(legs.out.legged.body[i], 0, 1e-4) << "it returns";
      }
    }
  }
}

/// A body that is high enough has straight legs: the knee keeps 0.3 rad and the margin.
TEST(BodyPose, StopsBeforeAKneeIsStraight) {
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    LegModel robot = lopsided();
    LegGeometry geometry = robot.legs[leg].kinematics.geometry();
    geometry.range[2] = {-3, 3};
    robot.legs[leg].kinematics = LegKinematics(geometry);
    IdealLegs nominal = standing(robot);
    LegController::State state = nominal.state();
    // This foot stands in a hole.
    const LegKinematics& kinematics = nominal.robot.legs[leg].kinematics;
    for (int k = 0; k < 100; ++k) {
      state.stand.places[leg][2] -= 0.001;
      const Eigen::Vector3d foot(state.stand.places[leg][0] - nominal.pose()[0],
                                 state.stand.places[leg][1] - nominal.pose()[1],
                                 state.stand.places[leg][2] - nominal.pose()[2]);
      if (std::abs(kinematics.bend(kinematics.inverse(foot).angles)) < 0.5) break;
    }
    nominal.controller.set_state(state);
    nominal.run(1.0, pose_of({0, 0, 0.06, 0, 0, 0}));
    EXPECT_NE(nominal.out.reasons & kReasonOutOfReach, 0u);
    const double bend = std::abs(kinematics.bend(nominal.angles(leg)));
    EXPECT_NEAR(bend, 0.33, 0.02) << leg;
    EXPECT_GE(bend, 0.329) << leg;
  }
}

/// A body that is low enough has knees on the ground: they keep the margin as a part of the leg.
TEST(BodyPose, StopsBeforeAKneeIsOnTheGround) {
  const IdealLegs nominal = standing();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    LegModel robot = nominal.robot;
    const auto clear_of = [&](const IdealLegs& legs) {
      const Eigen::Vector3d knee = IdealLegs::attitude(legs.pose()) * robot.legs[leg].kinematics.knee(legs.angles(leg));
      return legs.pose()[2] + knee.z() - robot.belly;
    };
    robot.legs[leg].knee_radius = clear_of(nominal) - 0.03;
    IdealLegs legs(robot);
    legs.controller.set_state(nominal.state());
    for (std::size_t i = 0; i < kLegsJoints; ++i) legs.sensors.joints[i].position = nominal.out.joints[i].position;
    legs.inbox = nominal.inbox;
    legs.run(1.0, pose_of({0, 0, -0.06, leg % 2 == 0 ? -0.05 : 0.05, 0, 0}));
    EXPECT_NE(legs.out.reasons & kReasonOutOfReach, 0u) << leg;
    const double spare = (clear_of(legs) - robot.legs[leg].knee_radius) / robot.legs[leg].kinematics.length();
    EXPECT_NEAR(spare, 0.03, 0.006) << leg;
    EXPECT_GE(spare, 0.0295) << leg;
  }
}

TEST(BodyPose, MovesAtThePartOfItsSpeedThatThePermitAllows) {
  IdealLegs legs = standing();
  legs.permit.speed_limit = 0.1;
  const std::array<AxisBounds, 6> bounds = body_bounds(legs.robot);
  const double pace = 0.1 / bounds[0].speed;
  const std::array<double, 6> ways[6] = {{0.04, 0, 0, 0, 0, 0}, {0, 0.04, 0, 0, 0, 0}, {0, 0, -0.05, 0, 0, 0},
                                         {0, 0, 0, 0.2, 0, 0},  {0, 0, 0, 0, 0.2, 0},  {0, 0, 0, 0, 0, 0.2}};
  for (std::size_t axis = 0; axis < 6; ++axis) {
    IdealLegs slow = legs;
    slow.request(pose_of(ways[axis]));
    double fastest = 0;
    for (int k = 0; k < 300; ++k) {
      slow.step();
      fastest = std::max(fastest, std::abs(slow.state().stand.body[axis].speed));
      const bool arrived = std::abs(slow.out.legged.body[axis] - ways[axis][axis]) < 4e-4;
      if (k < 5) {
        EXPECT_EQ(slow.out.reasons, std::uint64_t{kReasonPermitSlow});
      }
      if (arrived && std::abs(slow.state().stand.body[axis].speed) < 0.01) {
        EXPECT_EQ(slow.out.reasons, 0u);
      }
    }
    EXPECT_NEAR(fastest, pace * bounds[axis].speed, 1e-3) << axis;
  }
  legs.permit.speed_limit = 0;
  const Stance::Pose stood = legs.pose();
  legs.run(0.5, pose_of(ways[0]));
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(legs.pose()[i], stood[i], 1e-9);
  EXPECT_EQ(legs.out.reasons, std::uint64_t{kReasonPermitSlow});
}

/// Each ball turns with its shank, so that its centre moves by the radius times the angle.
TEST(BodyPose, RollsOnTheBallsOfItsFeet) {
  LegModel robot = lopsided();
  for (Leg& leg : robot.legs) leg.foot_radius = 0.03;
  for (const std::array<double, 6>& way :
       {std::array<double, 6>{0.03, 0, -0.04, 0, 0, 0}, std::array<double, 6>{0, 0.04, 0, 0.1, 0, 0},
        std::array<double, 6>{0, 0, 0, 0, 0.1, 0}, std::array<double, 6>{0, 0, 0.03, -0.05, 0, 0.1}}) {
    IdealLegs legs = standing(robot);
    const auto shank = [&](std::size_t leg) -> Eigen::Matrix3d {
      const auto& sign = robot.legs[leg].kinematics.geometry().sign;
      const LegAngles q = legs.angles(leg);
      return IdealLegs::attitude(legs.pose()) * Eigen::AngleAxisd(sign[0] * q[0], Eigen::Vector3d::UnitX()) *
             Eigen::AngleAxisd(sign[1] * q[1] + sign[2] * q[2], Eigen::Vector3d::UnitY()).toRotationMatrix();
    };
    std::array<Eigen::Vector3d, kLegs> rolled{}, from = legs.feet();
    rolled.fill(Eigen::Vector3d::Zero());
    legs.request(pose_of(way));
    for (int k = 0; k < 300; ++k) {
      std::array<Eigen::Matrix3d, kLegs> before;
      for (std::size_t leg = 0; leg < kLegs; ++leg) before[leg] = shank(leg);
      legs.step();
      for (std::size_t leg = 0; leg < kLegs; ++leg) {
        const Eigen::AngleAxisd turn(Eigen::Matrix3d(shank(leg) * before[leg].transpose()));
        rolled[leg] += 0.03 * turn.angle() * turn.axis().cross(Eigen::Vector3d::UnitZ());
      }
    }
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      EXPECT_GT(rolled[leg].norm(), 0.0005);
      const Eigen::Vector3d moved = legs.foot(leg) - from[leg];
      EXPECT_LE((moved.head<2>() - rolled[leg].head<2>()).norm(), 0.05 * rolled[leg].norm() + 1e-5)
          << leg << " by " << rolled[leg].transpose();
    }
  }
}

TEST(BodyPose, AFootThatComesOutOfReachMovesItsJointsNoFasterThanTheyMay) {
  IdealLegs legs = standing(legged_robot("quadbot"), 0.001);
  LegController::State state = legs.state();
  state.stand.places[0] = {-0.6, -0.3, 0.1};
  legs.controller.set_state(state);
  for (int k = 0; k < 200; ++k) {
    legs.step(Request{});
    for (std::size_t i = 0; i < kLegsJoints; ++i)
      ASSERT_LE(std::abs(legs.out.joints[i].position - legs.before.joints[i].position),
                legs.robot.joints[i].velocity_limit * legs.period + 1e-12)
          << i << " in cycle " << k;
  }
  EXPECT_NE(legs.out.reasons & kReasonOutOfReach, 0u);
}

}  // namespace robot_control::tests
