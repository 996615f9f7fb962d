/// A walk whose forces have no solution, and the speeds of gaits.

#include "control/legged/walk/walker.h"

#include "control/legged/stand/stand.h"
#include "control/legged/walk/own_gaits.h"
#include "control/legged/walk/walking_speed.h"
#include "machine/legs/legs_corpus.h"
#include "signals/legged/legged_command.h"

namespace robot_control::tests {

/// quadbot in its nominal stance, whose estimate is right.
struct WalkerTest : testing::Test {
  WalkerTest() {
    sensors.joint_count = kLegsJoints;
    const NominalStance stance = nominal_stance(robot);
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      const LegAngles angles = robot.legs[leg].kinematics.inverse(stance.feet[leg]).angles;
      for (std::size_t i = 0; i < kLegJoints; ++i)
        sensors.joints[kLegJoints * leg + i].position = angles[static_cast<Eigen::Index>(i)];
      estimate.contacts[leg].probability = 1;
    }
    estimate.base.attitude = {0, 0, 0, 1};
    walker.begin(state, sensors, estimate);
  }

  /// Returns whether the walk goes on after a plan.
  bool plan() {
    out = {};
    state.planned = Walker::plan_cycles(0.001);
    return walker.step(state, {.sensors = &sensors, .state = &estimate, .twist = {}, .gait = kStandGait}, out);
  }

  LegModel robot = legged_robot("quadbot");
  Walker walker{robot, all_gaits({}), 0.4, 0.001};
  Walker::State state;
  SensorFrame sensors;
  StateFrame estimate;
  CommandFrame out;
};

TEST_F(WalkerTest, KeepsTheLastForcesForThreePlansThatFailAndSaysSo) {
  ASSERT_TRUE(plan());
  EXPECT_EQ(out.reasons & kReasonNoPlan, 0u);
  const auto forces = state.forces;
  estimate.base.twist_base.linear[0] = std::numeric_limits<double>::infinity();
  for (std::uint64_t i = 0; i < Walker::kFailures; ++i) {
    EXPECT_TRUE(plan());
    EXPECT_NE(out.reasons & kReasonNoPlan, 0u);
    EXPECT_EQ(state.forces, forces);
  }
  EXPECT_FALSE(plan());
  EXPECT_NE(out.reasons & kReasonNoPlan, 0u);
}

TEST_F(WalkerTest, AFootThatIsInTheAirWhenTheGaitChangesSwingsOnFromWhereItIs) {
  state.gait = gait_named("crawl");
  state.phase = 1 - 1e-9;
  state.lasted = walker.gaits()[gait_named("crawl")].period;
  state.swings[0] = 1;
  state.bears[0] = 0;
  state.footprints[0] = {-0.3, 0, 0};
  estimate.contacts[0].probability = 0;
  walker.step(state, {.sensors = &sensors, .state = &estimate, .twist = {}, .gait = gait_named("trot")}, out);
  ASSERT_EQ(state.gait, gait_named("trot"));
  for (std::size_t i = 0; i < kLegJoints; ++i)
    EXPECT_NEAR(out.joints[i].position, sensors.joints[i].position, 1e-3) << i;
}

TEST_F(WalkerTest, ACrawlIsSoSlowThatAFootReachesThroughItsStanceAfterTheEndOfThatOfATrot) {
  const NominalStance stance = nominal_stance(robot);
  const Gaits& gaits = walker.gaits();
  const Gait& trot = gaits[gait_named("trot")];
  const Gait& crawl = gaits[gait_named("crawl")];
  const Speeds speeds = walking_speeds(robot, stance, gaits);
  const double fastest = speeds[gait_named("crawl")][0];
  EXPECT_GT(fastest, 0.3);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const double stood = (trot.leg_phase(leg, 0) > 0 ? 0.5 : -0.5) * trot.stance_time();
    const double stands = crawl.period * (crawl.duty - crawl.leg_phase(leg, crawl.begins_after(trot)));
    const Eigen::Vector3d way(fastest * (stood + stands), 0, 0);
    EXPECT_EQ(robot.legs[leg].kinematics.inverse(stance.feet[leg] - way).reach, FootReach::kReached) << leg;
  }
  EXPECT_GT(speeds[gait_named("walking_trot")][0], 1.0);
  EXPECT_DOUBLE_EQ(speeds[gait_named("trot")][0], 1.7);  // of any gait
}

struct SwingingWalkerTest : WalkerTest {
  SwingingWalkerTest() {
    state.gait = gait_named("trot");
    state.bears = {1, 0, 0, 1};
    state.swings = {0, 1, 1, 0};
    for (std::size_t leg = 0; leg < kLegs; ++leg) state.departs[leg] = state.footprints[leg];
    state.departs[1][0] += 0.06;  // the path of this foot is ahead of it
    state.departs[2][0] -= 0.02;
    while (walker.gaits()[state.gait].swung(1, state.phase) < 0.4) state.phase += 0.01;
  }
  void step() {
    const WalkInput input{.sensors = &sensors, .state = &estimate, .twist = {1, 0, 0}, .gait = state.gait};
    walker.step(state, input, out);
  }
};

TEST_F(SwingingWalkerTest, AFootThatMeetsARiserIsLiftedAgainFromThere) {
  const double height = state.footprints[1][2], ahead = state.footprints[1][0];
  step();
  EXPECT_GT(state.departed[1], 0.39);
  EXPECT_NEAR(state.departs[1][2], height, 0.01) << "it begins where it is";
  EXPECT_LT(state.departs[1][0], ahead - 0.01) << "and backs off";
  EXPECT_EQ(state.departed[2], 0) << "the other foot swings on";
  EXPECT_EQ(out.reasons, kReasonMetRiser);
  EXPECT_EQ(out.legged.risers, 2u);
}

TEST_F(SwingingWalkerTest, APushThatMovesThePathsAwayFromTheFeetIsNoRiser) {
  estimate.base.twist_base.linear[0] = 1.5;
  step();
  EXPECT_EQ(state.departed[1], 0);
  EXPECT_EQ(state.departed[2], 0);
  EXPECT_EQ(out.reasons, 0u);
}

TEST_F(WalkerTest, AFootThatFindsNoGroundIsNotThrownDown) {
  ASSERT_TRUE(plan());
  const double bears = std::abs(out.joints[2].effort);
  sensors.joints[2].velocity = 10;
  sensors.joints[2].valid = kValidMotion;
  const WalkingBody body = walker.measure(sensors, estimate);
  const double falls = -(body.jacobians[0] * Eigen::Map<const Eigen::Vector3d>(body.rates.data())).z();
  if (falls < 0) sensors.joints[2].velocity = -10;
  ASSERT_GT(std::abs(falls), 1);
  EXPECT_EQ(out.reasons, 0u);
  ASSERT_TRUE(plan());
  EXPECT_LT(std::abs(out.joints[2].effort), 0.5 * bears);
  EXPECT_EQ(out.reasons, kReasonReaching);
}

TEST_F(WalkerTest, AWalkThatEndsOnASlopeStandsParallelToIt) {
  for (const double slope : {0.0, 0.3}) {
    estimate.base.attitude = {0, std::sin(-slope / 2), 0, std::cos(-slope / 2)};
    walker.begin(state, sensors, estimate);
    const Stand stand(robot, 0.001);
    Stand::State standing;
    stand.begin(standing, walker.measure(sensors, estimate), state.ground);
    EXPECT_NEAR(standing.body[Stand::kPitch].value, 0, 0.01) << slope;
    EXPECT_NEAR(stand.lean(standing)[0].value, 0, 0.003) << slope;
    EXPECT_NEAR(std::atan2(standing.up[0], standing.up[2]), slope, 0.01) << "the vertical leans back";
  }
}

}  // namespace robot_control::tests
