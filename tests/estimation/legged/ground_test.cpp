#include "estimation/legged/ground.h"

#include <gtest/gtest.h>

#include <random>

#include "estimation/legged/small_turn.h"

namespace robot_control::tests {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// A body 0.3 m above feet that fall on made ground, one after the other. It moves by a part of a stride between two
/// footfalls, as its filter knows to kDrift of the height. So the height and its deviation are those of the footfalls.
struct Footfalls {
  static constexpr double kLeg = 0.4;          // m
  static constexpr double kDeviation = 0.004;  // m, of a foot
  static constexpr double kStride = 0.025;     // m, between two footfalls
  static constexpr double kDrift = 0.002;      // m, between two footfalls
  explicit Footfalls(double tilt_deviation = 0.002) {
    state.position = {0, 0, 0.3};
    LegFilter(state).begin(Quaterniond::Identity(), Vector3d::Zero(), tilt_deviation, 0);
  }

  /// One footfall of each leg, on ground of this height at a place.
  template <class Height>
  void step(const Height& height) {
    constexpr std::array<std::size_t, kLegs> kOrder{0, 3, 1, 2};
    for (const std::size_t foot : kOrder) {
      x += kStride;
      const Vector3d hip(foot < 2 ? 0.2 : -0.2, foot % 2 == 0 ? 0.15 : -0.15, 0);
      // The body follows the ground below it, by the slope of its feet.
      const double rise = height(x) - body;
      body += rise;
      for (auto& known : state.feet) known[0] -= kStride, known[2] -= rise + drift;
      state.position[0] += kStride;
      state.position[2] += rise + drift;
      for (int i : {LegFilter::kPlace + 2, LegFilter::kFeet + 2, LegFilter::kFeet + 5, LegFilter::kFeet + 8,
                    LegFilter::kFeet + 11})
        state.covariance[static_cast<std::size_t>(i * (LegFilter::kEntries + 1))] += kDrift * kDrift;
      LegFilter filter(state);
      const double rough = noise(random);
      filter.land(foot, turn().conjugate() * (hip + Vector3d(0, 0, height(x + hip.x()) + rough - body - 0.3)));
      ground.footfall(foot, kDeviation, filter, plane);
      filter.finish();
    }
  }
  Quaterniond turn() const { return quaternion_of(state.attitude); }
  double error() const { return state.position[2] - 0.3 - body; }

  LegFilter::State state;
  Ground ground{kLeg};
  Ground::State plane;
  std::mt19937_64 random{1};
  std::normal_distribution<double> noise{0, 0.001};
  double x = 0, body = 0, drift = 0;
};

TEST(Ground, HoldsTheHeightOnLevelGround) {
  Footfalls feet;
  feet.drift = 0.002;  // 80 mm per metre
  for (int k = 0; k < 200; ++k) feet.step([](double) { return 0.0; });
  EXPECT_LE(std::abs(feet.error()), 0.02);
}

TEST(Ground, WhatClimbsStairsOfTwoMetresEndsTwoMetresHigher) {
  Footfalls feet;
  const auto stairs = [](double x) { return std::clamp(0.1 * std::ceil((x - 2) / 0.4), 0.0, 2.0); };
  for (int k = 0; k < 150; ++k) feet.step(stairs);
  EXPECT_EQ(feet.body, 2.0);
  EXPECT_LE(std::abs(feet.error()), 0.05);
  EXPECT_NEAR(feet.state.ground, 2.0, 0.05);
}

TEST(Ground, WhatClimbsARampEndsAsHighAsItClimbed) {
  for (const double slope : {0.035, 0.087, 0.176}) {  // 2, 5 and 10°
    Footfalls feet;
    const auto ramp = [&](double x) { return std::clamp(slope * (x - 2), 0.0, 1.0); };
    for (int k = 0; k < 400; ++k) feet.step(ramp);
    EXPECT_EQ(feet.body, 1.0);
    EXPECT_LE(std::abs(feet.error()), 0.05) << slope;
  }
}

TEST(Ground, AStoneDoesNotMoveTheBody) {
  Footfalls feet;
  for (int k = 0; k < 20; ++k) feet.step([](double) { return 0.0; });
  const double before = feet.error();
  feet.noise = std::normal_distribution<double>{0.05, 0.001};
  feet.step([](double) { return 0.0; });
  feet.noise = std::normal_distribution<double>{0, 0.001};
  EXPECT_LE(std::abs(feet.error() - before), 0.005);
}

}  // namespace robot_control::tests
