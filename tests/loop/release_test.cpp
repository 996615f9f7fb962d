// Nothing moves without a release: 1 % of scripts/bench release.

#include <gtest/gtest.h>

#include "loop/release_sequences.h"

namespace robot_control {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::uint64_t kSeeds = 20;  // one thread, ten times slower
#else
constexpr std::uint64_t kSeeds = 100;
#endif

class MotionReleaseSequences : public testing::TestWithParam<WheelCommand> {};

TEST_P(MotionReleaseSequences, NothingMovesWithoutARelease) {
  ReleaseFigures figures;
  const std::uint64_t seeds = GetParam() == WheelCommand::kTorque ? kSeeds : kSeeds / 5;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const auto violated = release_violation(seed, figures, GetParam());
    ASSERT_FALSE(violated) << "seed " << seed << ", " << *violated;
  }
  // Otherwise the sequences proved nothing.
  EXPECT_GT(figures.moving_cycles, 30 * seeds);
  EXPECT_GT(figures.accepted_resets, seeds / 2);
  EXPECT_GT(figures.starts, 10 * seeds);
}

TEST(WalkingReleaseSequences, NothingMovesWithoutAReleaseAndAStoppedRobotLies) {
  constexpr std::uint64_t kWalks = kSeeds / 10;
  ReleaseFigures figures;
  for (std::uint64_t seed = 0; seed < kWalks; ++seed) {
    const auto violated = walking_release_violation(seed, figures);
    ASSERT_FALSE(violated) << "seed " << seed << ", " << *violated;
  }
  EXPECT_GT(figures.standing_cycles, 3000 * kWalks);
  EXPECT_GT(figures.lying_cycles, 100 * kWalks);
  EXPECT_GT(figures.accepted_resets, 0);
  EXPECT_GT(figures.starts, 10 * kWalks);
}

INSTANTIATE_TEST_SUITE_P(Drives, MotionReleaseSequences,
                         testing::Values(WheelCommand::kTorque, WheelCommand::kVelocity));

}  // namespace
}  // namespace robot_control
