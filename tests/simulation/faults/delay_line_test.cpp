#include "simulation/faults/delay_line.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

TEST(DelayLine, GivesWhatWentInSoManyStepsAgo) {
  for (const std::size_t delay : {1u, 2u, 5u}) {
    DelayLine<int, 5> line(delay);
    line.fill(-1);
    for (int k = 0; k < 20; ++k) {
      int value = k;
      line.step(value);
      const int expected = k < static_cast<int>(delay) ? -1 : k - static_cast<int>(delay);
      EXPECT_EQ(value, expected) << "delay " << delay << ", step " << k;
    }
  }
}

TEST(DelayLine, ChangesNothingWithoutADelay) {
  DelayLine<int, 5> line(0);
  line.fill(-1);
  int value = 7;
  line.step(value);
  EXPECT_EQ(value, 7);
}

TEST(DelayLine, ForgetsWhenFilled) {
  DelayLine<int, 5> line(3);
  line.fill(0);
  for (int value : {1, 2}) line.step(value);
  line.fill(9);
  for (int k = 0; k < 3; ++k) {
    int value = 5;
    line.step(value);
    EXPECT_EQ(value, 9);
  }
}

TEST(DelayLine, RefusesADelayItCannotHold) {
  EXPECT_THROW((DelayLine<int, 5>(6)), std::invalid_argument);
}

}  // namespace robot_control::tests
