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

TEST(MotionReleaseSequences, NothingMovesWithoutARelease) {
  ReleaseFigures figures;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const auto violated = release_violation(seed, figures);
    ASSERT_FALSE(violated) << "seed " << seed << ", " << *violated;
  }
  // Otherwise the sequences proved nothing.
  EXPECT_GT(figures.moving_cycles, 30 * kSeeds);
  EXPECT_GT(figures.accepted_resets, kSeeds / 2);
  EXPECT_GT(figures.starts, 10 * kSeeds);
}

}  // namespace
}  // namespace robot_control
