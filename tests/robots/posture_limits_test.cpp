/// The limits of robots on legs in the pose, on the slope and with the torques in force.

#include "robots/quadruped_fixture.h"
#include "support/robots/quadruped_trials.h"

namespace robot_control::tests {

Parameters field_parameters(std::uint64_t seed) {
  Parameters parameters = QuadrupedLoop::parameters(seed, ErrorLevel::kDataSheet);
  parameters.plant.contact_sensors = false;
  return parameters;
}

class PostureLimits : public testing::TestWithParam<std::string> {};

/// Without a bound for the pose in force, quadbot is stopped with seed 33, and anymal with seed 3. Without one for its
/// rates, a joint of anymal reaches 1.03 of its speed limit with the seeds 18 and 33. A bearing joint of a1 that
/// nothing turns back is 4 mrad beyond its range with seed 11, and one of quadbot 1 mrad with seed 26.
TEST_P(PostureLimits, APoseWithinItsRangeLetsNoWalkBeStoppedAndNoJointLeaveItsLimits) {
  for (const std::uint64_t seed : {3u, 11u, 18u, 26u, 33u}) {
    const LeaningWalk walk = leaning_walk(legged_robot(GetParam()), field_parameters(seed));
    EXPECT_FALSE(walk.stopped) << seed << walk.causes;
    EXPECT_LE(walk.joint_speed, 1) << seed;
    EXPECT_LE(walk.beyond_range, 0) << seed;
  }
}

TEST_P(PostureLimits, ARobotOnASlopeStandsUpOrRefuses) {
  const LegModel robot = legged_robot(GetParam());
  for (const double degrees : {10, 15, 20, 28}) {
    for (const std::uint64_t eighth : {0u, 5u}) {
      const double slope = degrees * std::numbers::pi / 180,
                   heading = static_cast<double>(eighth) * std::numbers::pi / 4;
      const SlopeTrial trial = stand_up_on(robot, field_parameters(eighth), slope, heading);
      EXPECT_TRUE(trial.stands || trial.refuses) << degrees << " " << eighth << trial.causes;
      EXPECT_FALSE(trial.stopped) << degrees << " " << eighth << trial.causes;
      EXPECT_TRUE(trial.stands || degrees > 17) << degrees << " " << eighth;
      EXPECT_TRUE(trial.refuses || degrees < 25) << eighth;
    }
  }
}

TEST_P(PostureLimits, HipsThatCarryTheWeightLimitTheTwist) {
  const LegModel weak = with_weak_hips(legged_robot(GetParam()));
  for (const std::uint64_t seed : {1u, 9u}) {
    const LeaningWalk walk = leaning_walk(weak, field_parameters(seed), false);
    EXPECT_FALSE(walk.stopped) << seed << walk.causes;
  }
}

/// The load holds its joints while their commands move by 0.057 rad.
TEST(QuadbotPostureLimits, APayloadOnASlopeIsNoStuckEncoder) {
  const LegModel robot = legged_robot("quadbot");
  Parameters parameters = field_parameters(0);
  parameters.plant.payload = 0.7 * robot.mass;
  const SlopeTrial trial = stand_up_on(robot, parameters, std::numbers::pi / 9, 0);
  EXPECT_TRUE(trial.stands);
  EXPECT_FALSE(trial.stopped) << trial.causes;
}

INSTANTIATE_TEST_SUITE_P(Robots, PostureLimits, testing::ValuesIn(legged_robots(true)), robot_name);
INSTANTIATE_TEST_SUITE_P(Nightly, PostureLimits, testing::ValuesIn(legged_robots(false)), robot_name);

}  // namespace robot_control::tests
