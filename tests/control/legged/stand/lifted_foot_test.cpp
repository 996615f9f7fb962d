/// A foot in the air.

#include "control/legged/ideal_legs.h"

namespace robot_control::tests {

Request lift_of(std::size_t leg, double x, double y, double height) {
  Request request = stance_of({ModeKind::kLift, leg});
  request.posture = {.height = height, .x = x, .y = y};
  return request;
}

struct LiftedFoot : testing::TestWithParam<std::size_t> {
  static const IdealLegs& nominal() {
    static const IdealLegs kStanding = standing();
    return kStanding;
  }
  std::size_t leg_ = GetParam();
  IdealLegs legs_ = nominal();
  std::array<Eigen::Vector3d, kLegs> feet_ = legs_.feet();
  LegTuning tuning_ = leg_tuning(legs_.robot);
};

TEST_P(LiftedFoot, GoesUpAfterItsLoadAndAfterTheBodyIsAboveTheOthers) {
  Eigen::Vector2d three = Eigen::Vector2d::Zero(), middle = Eigen::Vector2d::Zero();
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    middle += feet_[leg].head<2>() / 4;
    if (leg != leg_) three += feet_[leg].head<2>() / 3;
  }
  const Eigen::Vector2d place = middle + 0.6 * (three - middle);
  legs_.request(lift_of(leg_, 0, 0, 0.08));
  double unloading = 0;
  while (legs_.state().stand.share[leg_] > 0 && unloading < 3) {
    const double before = legs_.state().stand.share[leg_];
    legs_.step();
    EXPECT_EQ(legs_.out.legged.lifted, leg_ + 1);
    if (legs_.state().stand.share[leg_] < before) {
      EXPECT_LE((legs_.centre() - place).norm(), 0.002);
      unloading += kCycle;
    }
    if (legs_.state().stand.share[leg_] == 0) break;
    EXPECT_LE((legs_.foot(leg_) - feet_[leg_]).norm(), 1e-6) << "it stands until it carries nothing";
  }
  EXPECT_NEAR(unloading, kLoadTime, kCycle);
  double low = 0;
  for (int k = 0; k < 200; ++k) {
    const double height = legs_.foot(leg_).z() - feet_[leg_].z();
    legs_.step();
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      if (leg == leg_) continue;
      EXPECT_LE((legs_.foot(leg) - feet_[leg]).norm(), 1e-6) << leg;
    }
    low = std::max(low, height);
  }
  EXPECT_EQ(legs_.out.reasons, 0u);
  EXPECT_NEAR(low, 0.08, 0.002);
  EXPECT_LE((legs_.foot(leg_) - feet_[leg_] - Eigen::Vector3d(0, 0, 0.08)).norm(), 2e-4);
  for (const std::size_t level : {3, 4, 5}) EXPECT_NEAR(legs_.pose()[level], 0, 1e-9);
}

TEST_P(LiftedFoot, GoesWhereItIsRequestedOnceItIsClearOfTheGround) {
  legs_.request(lift_of(leg_, 0.05, -0.04, 0.06));
  for (int k = 0; k < 500; ++k) {
    legs_.step();
    const Eigen::Vector3d way = legs_.foot(leg_) - feet_[leg_];
    if (way.head<2>().norm() > 1e-5) {
      EXPECT_GT(way.z(), 0.8 * 0.25 * tuning_.lift - 1e-4) << k;
    }
    for (const TrackedAxis& axis : legs_.state().stand.foot) EXPECT_LE(std::abs(axis.speed), tuning_.foot.speed + 1e-9);
  }
  EXPECT_LE((legs_.foot(leg_) - feet_[leg_] - Eigen::Vector3d(0.05, -0.04, 0.06)).norm(), 2e-4);
}

TEST_P(LiftedFoot, StaysWithinItsRange) {
  legs_.run(2.0, lift_of(leg_, 0, 0, 0.08));
  ASSERT_EQ(legs_.out.reasons, 0u);
  for (const double side : {-1.0, 1.0}) {
    const double beyond = 1.05 * side * tuning_.foot_range, within = 0.9 * side * tuning_.foot_range;
    IdealLegs legs = legs_;
    legs.step(lift_of(leg_, beyond, 0, 0.08));
    EXPECT_NE(legs.out.reasons & kReasonOutOfReach, 0u);
    EXPECT_NEAR(legs.state().stand.foot_target[0], side * tuning_.foot_range, 1e-12);
    legs.step(lift_of(leg_, 0, beyond, 0.08));
    EXPECT_NE(legs.out.reasons & kReasonOutOfReach, 0u);
    EXPECT_NEAR(legs.state().stand.foot_target[1], side * tuning_.foot_range, 1e-12);
    legs.step(lift_of(leg_, within, within, 0.08));
    EXPECT_EQ(legs.out.reasons, 0u);
    EXPECT_NEAR(legs.state().stand.foot_target[0], within, 1e-12);
    EXPECT_NEAR(legs.state().stand.foot_target[1], within, 1e-12);
  }
  const double highest = tuning_.lift + tuning_.foot_range, lowest = 0.25 * tuning_.lift;
  legs_.step(lift_of(leg_, 0, 0, highest + 0.01));
  EXPECT_NE(legs_.out.reasons & kReasonOutOfReach, 0u);
  EXPECT_NEAR(legs_.state().stand.foot_target[2], highest, 1e-12);
  legs_.step(lift_of(leg_, 0, 0, lowest - 0.01));
  EXPECT_NE(legs_.out.reasons & kReasonOutOfReach, 0u);
  EXPECT_NEAR(legs_.state().stand.foot_target[2], lowest, 1e-12);
}

TEST_P(LiftedFoot, ComesDownWhereItStoodAndCarriesAgain) {
  legs_.run(2.0, lift_of(leg_, 0.05, 0.03, 0.08));
  const Eigen::Vector2d centre = legs_.centre();
  legs_.request({});
  double loading = 0;
  for (int k = 0; k < 600; ++k) {
    const Eigen::Vector3d way = legs_.foot(leg_) - feet_[leg_];
    const double share = legs_.state().stand.share[leg_];
    if (legs_.out.legged.lifted != 0) {
      EXPECT_LE((legs_.centre() - centre).norm(), 0.003) << "the body waits";
    }
    if (way.head<2>().norm() > 0.01) {
      EXPECT_GE(way.z(), 0.079) << "it goes above its place first";
    }
    legs_.step();
    if (legs_.state().stand.share[leg_] > share) {
      EXPECT_LE(way.norm(), 0.0015);
      loading += kCycle;
    }
  }
  EXPECT_NEAR(loading, kLoadTime, kCycle);
  EXPECT_EQ(legs_.out.legged.lifted, 0u);
  EXPECT_LE((legs_.foot(leg_) - feet_[leg_]).norm(), 2e-3);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(legs_.out.legged.body[i], 0, 1e-3) << i;
}

TEST_P(LiftedFoot, ComesDownBeforeAnotherGoesUp) {
  legs_.run(2.0, lift_of(leg_, 0, 0, 0.08));
  const std::size_t other = (leg_ + 1) % kLegs;
  legs_.request(lift_of(other, 0, 0, 0.05));
  while (legs_.state().stand.share[leg_] < 1) {
    ASSERT_EQ(legs_.out.legged.lifted, leg_ + 1);
    EXPECT_EQ(legs_.state().stand.share[other], 1);
    legs_.step();
  }
  for (int k = 0; k < 500; ++k) legs_.step();
  EXPECT_EQ(legs_.out.legged.lifted, other + 1);
  EXPECT_NEAR(legs_.foot(other).z() - feet_[other].z(), 0.05, 1e-3);
}

TEST_P(LiftedFoot, ComesDownBeforeTheRobotLies) {
  const double height = legs_.pose()[2];
  legs_.run(2.0, lift_of(leg_, 0.04, 0, 0.08));
  legs_.step(stance_of({ModeKind::kLie}));
  int cycles = 1;
  for (; cycles < 1000 && legs_.out.legged.phase != LegPhase::kLying; ++cycles) {
    if (legs_.state().stand.share[leg_] < 1 && legs_.state().sinks == 0) {
      EXPECT_NEAR(legs_.pose()[2], height, 1e-3);
    }
    legs_.step();
  }
  EXPECT_LE(cycles * kCycle, lying_down_time(legs_.robot));
  EXPECT_EQ(legs_.out.legged.phase, LegPhase::kLying);
}

TEST_P(LiftedFoot, IsAsSlowAsThePermitSaysAndComesDownAtItsOwnSpeed) {
  legs_.run(2.0, lift_of(leg_, 0, 0, 0.08));
  legs_.permit.speed_limit = 0.1 * body_bounds(legs_.robot)[0].speed;
  const auto fastest = [&](const Request& request) {
    double speed = 0;
    legs_.request(request);
    for (int k = 0; k < 120; ++k) {
      legs_.step();
      for (const TrackedAxis& axis : legs_.state().stand.foot) speed = std::max(speed, std::abs(axis.speed));
    }
    return speed;
  };
  EXPECT_NEAR(fastest(lift_of(leg_, 0.1, 0, 0.08)), 0.1 * tuning_.foot.speed, 1e-3);
  EXPECT_GT(fastest({}), 0.3 * tuning_.foot.speed);
}

TEST_P(LiftedFoot, LeavesTheBodyItsNominalAttitude) {
  Request tilted;
  tilted.posture = {.roll = 0.1, .yaw = 0.1};
  legs_.run(1.0, tilted);
  legs_.run(2.0, lift_of(leg_, 0, 0, 0.08));
  for (const std::size_t level : {3, 4, 5}) EXPECT_NEAR(legs_.pose()[level], 0, 6e-4);
  legs_.run(2.0, {});
  EXPECT_EQ(legs_.state().stand.lifted, kLegs);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(legs_.out.legged.body[i], 0, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Legs, LiftedFoot, testing::Values(0, 1, 2, 3));

}  // namespace robot_control::tests
