// Nothing moves without a release: 1 % of scripts/bench release at night, two fifths of it in every run.

#include <gtest/gtest.h>

#include "loop/release_sequences.h"

namespace robot_control::tests {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::uint64_t kSlower = 5;  // one thread, ten times slower
#else
constexpr std::uint64_t kSlower = 1;
#endif

struct Drives {
  WheelCommand command;
  std::uint64_t seeds;
};

class MotionReleaseSequences : public testing::TestWithParam<Drives> {};

TEST_P(MotionReleaseSequences, NothingMovesWithoutARelease) {
  ReleaseFigures figures;
  const std::uint64_t seeds = GetParam().seeds / kSlower;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const auto violated = release_violation(seed, figures, GetParam().command);
    ASSERT_FALSE(violated) << "seed " << seed << ", " << *violated;
  }
  // Otherwise the sequences proved nothing.
  EXPECT_GT(figures.moving_cycles, 30 * seeds);
  EXPECT_GT(figures.accepted_resets, seeds / 2);
  EXPECT_GT(figures.starts, 10 * seeds);
}

class WalkingReleaseSequences : public testing::TestWithParam<std::uint64_t> {};

TEST_P(WalkingReleaseSequences, NothingMovesWithoutAReleaseAndAStoppedRobotLies) {
  const std::uint64_t walks = GetParam() / kSlower;
  ReleaseFigures figures;
  for (std::uint64_t seed = 0; seed < walks; ++seed) {
    const auto violated = walking_release_violation(seed, figures);
    ASSERT_FALSE(violated) << "seed " << seed << ", " << *violated;
  }
  EXPECT_GT(figures.standing_cycles, 3000 * walks);
  EXPECT_GT(figures.lying_cycles, 100 * walks);
  EXPECT_GT(figures.accepted_resets, 0);
  EXPECT_GT(figures.starts, 10 * walks);
}

INSTANTIATE_TEST_SUITE_P(EveryDay, MotionReleaseSequences,
                         testing::Values(Drives{WheelCommand::kTorque, 40}, Drives{WheelCommand::kVelocity, 10}));
INSTANTIATE_TEST_SUITE_P(Nightly, MotionReleaseSequences,
                         testing::Values(Drives{WheelCommand::kTorque, 100}, Drives{WheelCommand::kVelocity, 20}));
INSTANTIATE_TEST_SUITE_P(EveryDay, WalkingReleaseSequences, testing::Values(5));
INSTANTIATE_TEST_SUITE_P(Nightly, WalkingReleaseSequences, testing::Values(10));

}  // namespace robot_control::tests
