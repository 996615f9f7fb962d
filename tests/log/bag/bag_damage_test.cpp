#include <gtest/gtest.h>

#include "log/bag/bag_trials.h"

namespace robot_control::tests {

/// 1 % of `scripts/bench bags`.
TEST(ADamagedBag, IsRefusedOrReadAsItWas) {
  BagFigures figures;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const auto wrong = bag_violation(seed, figures);
    EXPECT_FALSE(wrong) << "seed " << seed << ": " << *wrong;
  }
  EXPECT_GT(figures.refused, 20U);
  EXPECT_GT(figures.cut, 10U);
  EXPECT_GT(figures.whole, 0U);
}

}  // namespace robot_control::tests
