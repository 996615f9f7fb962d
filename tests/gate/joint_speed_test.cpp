#include "gate/joint_speed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace robot_control::tests {

constexpr double kPeriod = 1e-3;

double quantum_of(int counts) {
  return 2 * M_PI / counts;
}

double counted(double angle, double quantum) {
  return quantum == 0 ? angle : quantum * std::floor(angle / quantum);
}

/// A wheel turns steadily, read by an encoder of `counts` a turn (0: exact).
struct Wheel {
  double speed;
  int counts;
  double phase = 0;
  double at(std::uint64_t cycle, double period) const {
    const double angle = phase + speed * static_cast<double>(cycle) * period;
    return counts == 0 ? angle : counted(angle, quantum_of(counts));
  }
};

TEST(JointSpeed, IsExactOfAnExactPosition) {
  for (const double speed : {0.01, -3.0, 250.0}) {
    JointSpeed joint(kPeriod);
    const Wheel wheel{speed, 0};
    for (std::uint64_t k = 0; k < 100; ++k) joint.step(wheel.at(k, kPeriod), k);
    EXPECT_NEAR(joint.value(), speed, 1e-9 * std::abs(speed) + 1e-12);  // rounding of angles over 12 ms
  }
}

TEST(JointSpeed, IsZeroAtFirstAndAtRest) {
  JointSpeed joint(kPeriod);
  EXPECT_EQ(joint.value(), 0);
  for (std::uint64_t k = 50; k < 80; ++k) {
    joint.step(1234.5, k);
    EXPECT_EQ(joint.value(), 0);
  }
}

// The error is one cycle of the base, or one count within it: joint_speed.h. The base is twelve cycles at 1 kHz, 24 at
// 2 kHz, two at 100 Hz.
TEST(JointSpeed, ASteadySpeedIsOffByOneCycleOrOneCountOfTheBase) {
  for (const double rate : {100.0, 1000.0, 2000.0}) {
    const double base = std::fmax(2.0, std::ceil(kSpeedBase * rate)) / rate;
    for (const int counts : {64, 500, 4096}) {
      for (unsigned seed = 0; seed < 50; ++seed) {
        std::mt19937 random(seed);
        const double speed = std::uniform_real_distribution<double>(10, 40)(random);
        const Wheel wheel{seed % 2 == 0 ? speed : -speed, counts, std::uniform_real_distribution<double>(0, 6)(random)};
        const double quantum = quantum_of(counts);
        const bool coarse = quantum > speed / rate;  // counts are farther apart than samples
        const double bound = (coarse ? speed / (base * rate - 1) : quantum / base) + 1e-6;
        JointSpeed joint(1 / rate);
        for (std::uint64_t k = 0; k < 400; ++k) {
          joint.step(wheel.at(k, 1 / rate), k);
          if (k < 100) continue;
          ASSERT_NEAR(joint.value(), wheel.speed, bound) << counts << " counts, seed " << seed << ", cycle " << k;
        }
      }
    }
  }
}

/// Returns the speed after changes to 0, 1, 2 … rad in these cycles.
double speed_of(std::initializer_list<std::uint64_t> cycles, double period = kPeriod) {
  JointSpeed joint(period);
  double position = 0;
  for (const std::uint64_t cycle : cycles) joint.step(position++, cycle);
  return joint.value();
}

// A single count is as fast as if it took the base: 12 ms, at least two cycles, above 2.5 kHz 30 cycles.
TEST(JointSpeed, ASingleCountTakesTheBase) {
  for (const auto& [rate, base] :
       {std::pair{1.0, 2.0}, {100.0, 2.0}, {333.0, 4.0}, {500.0, 6.0}, {1000.0, 12.0}, {10000.0, 30.0}})
    EXPECT_NEAR(speed_of({50, 51}, 1 / rate), rate / base, 1e-9 * rate) << rate;
}

TEST(JointSpeed, GoesBackToTheLastChangeThatIsABaseBefore) {
  EXPECT_NEAR(speed_of({0, 1, 12}), 2 / 0.012, 1e-9);  // 12 − 1 is less than the base
  EXPECT_NEAR(speed_of({0, 1, 13}), 1 / 0.012, 1e-9);
  EXPECT_NEAR(speed_of({0, 1, 20}), 1 / 0.019, 1e-9);
}

TEST(JointSpeed, SkippedCyclesCount) {
  JointSpeed joint(kPeriod);
  const Wheel wheel{7, 0};
  std::mt19937 random(1);
  std::uint64_t k = 0;
  for (int i = 0; i < 100; ++i) {
    joint.step(wheel.at(k, kPeriod), k);
    k += 1 + random() % 9;
  }
  EXPECT_NEAR(joint.value(), 7, 1e-9);
}

// One count to and fro in every cycle would be 98 rad/s by differences.
TEST(JointSpeed, AnEncoderThatDithersAboutAnEdgeIsNoFasterThanACountPerBase) {
  JointSpeed joint(kPeriod);
  const double quantum = quantum_of(64);
  for (std::uint64_t k = 0; k < 200; ++k) {
    joint.step(k < 20 ? 0 : static_cast<double>(k % 2) * quantum, k);
    ASSERT_LE(std::abs(joint.value()), quantum / kSpeedBase + 1e-12) << k;
  }
}

TEST(JointSpeed, FadesOnceNothingMoves) {
  JointSpeed joint(kPeriod);
  const Wheel wheel{30, 4096};
  for (std::uint64_t k = 0; k < 100; ++k) joint.step(wheel.at(k, kPeriod), k);
  double last = joint.value();
  for (std::uint64_t k = 100; k < 100 + 1200; ++k) {
    joint.step(wheel.at(99, kPeriod), k);
    ASSERT_LE(joint.value(), last);
    last = joint.value();
  }
  EXPECT_LT(last, 0.5);  // 30 rad/s · 12 ms / 1200 ms = 0.3
}

TEST(JointSpeed, NeverSaysNotANumber) {
  std::mt19937_64 random(3);
  JointSpeed joint(kPeriod);
  for (std::uint64_t k = 0; k < 10000; ++k) {
    const double huge = std::ldexp(static_cast<double>(random() % 3) - 1, 1023);
    joint.step(huge, k);
    ASSERT_FALSE(std::isnan(joint.value())) << k;
  }
}

TEST(JointSpeed, RemembersEnoughAtEveryRate) {
  for (const double rate : {1.0, 100.0, 2000.0, 10000.0}) {
    JointSpeed joint(1 / rate);
    const Wheel wheel{5, 0};
    for (std::uint64_t k = 0; k < 300; ++k) joint.step(wheel.at(k, 1 / rate), k);
    EXPECT_NEAR(joint.value(), 5, 1e-6) << rate;
  }
}

}  // namespace robot_control::tests
