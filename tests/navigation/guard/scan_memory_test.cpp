#include "navigation/guard/scan_memory.h"

#include <algorithm>
#include <random>

#include "navigation/house.h"
#include "support/matchers.h"

namespace robot_control::navigation::tests {

using testing_house::diffbot;

/// The robot drives along x through a closed room of 3 m; its laser of 360 rays measures with noise of 1 cm.
struct ScanMemoryTest : testing::Test {
  static constexpr float kNothing = std::numeric_limits<float>::infinity();

  Scan scan() {
    Scan scan = testing_house::scan_of(house, base);
    for (float& range : scan.ranges) range += noise(random);
    return scan;
  }

  /// Drives for so many scans of 0.1 s at `speed` and `turn`; each is changed by `lie`.
  void drive(
      int scans, double speed, double turn = 0, const std::function<void(Scan&)>& lie = [](Scan&) {}) {
    for (int i = 0; i < scans; ++i) {
      base.x += 0.1 * speed * std::cos(base.yaw), base.y += 0.1 * speed * std::sin(base.yaw), base.yaw += 0.1 * turn;
      Scan seen = scan();
      lie(seen);
      memory.update(seen, {}, base, stamp += 0.1, diffbot());
    }
  }

  static void half(Scan& scan) {
    scan.ranges = std::vector<float>(scan.ranges.begin() + 90, scan.ranges.begin() + 270);
    scan.angle_min = -M_PI / 2;
  }

  static std::function<void(Scan&)> front(float value) {
    return [value](Scan& scan) { std::fill(scan.ranges.begin() + 120, scan.ranges.begin() + 240, value); };
  }

  /// m from the place to the nearest point that is not forgotten.
  double nearest(Point place) const {
    double result = HUGE_VAL;
    for (const Point at : memory.points()) result = std::min(result, std::hypot(at.x - place.x, at.y - place.y));
    return result;
  }

  Grid house = testing_house::two_rooms(0);
  PlanarPose base{0.8, 1.6, 0};
  double stamp = 100;
  std::mt19937 random{1};
  std::normal_distribution<float> noise{0, 0.01F};
  ScanMemory memory;
  const Point ahead{3.1, 1.6};
};

TEST_F(ScanMemoryTest, ATrueScanIsNotDoubtedWhileTheRobotDrivesAndTurns) {
  for (int i = 0; i < 5; ++i) {
    drive(20, 0.5);
    EXPECT_EQ(memory.problem(), "");
    drive(20, 0, 1.57);
    EXPECT_EQ(memory.problem(), "");
  }
}

/// Rays that graze a wall end far from each other. A point between two of their ends vanishes when one drops out.
TEST_F(ScanMemoryTest, RaysThatDropOutBesideACorridorAreNoBlindness) {
  house = testing_house::two_rooms(0);
  house.columns = 160, house.rows = 14, house.cells.assign(160 * 14, kFreeCell);
  for (int column = 0; column < house.columns; ++column)
    for (const int row : {0, 13}) house.cells[house.index({column, row})] = kOccupiedCell;
  base = {4, 0.7, 0};
  std::bernoulli_distribution dropped(0.1);
  for (int i = 0; i < 100; ++i) {
    drive(1, 0.5, i % 20 < 10 ? 0.2 : -0.2, [&](Scan& scan) {
      for (float& range : scan.ranges) range = dropped(random) ? kNothing : range;
    });
    EXPECT_EQ(memory.problem(), "") << i;
  }
}

TEST_F(ScanMemoryTest, RaysWithoutAnEchoAreNotFrozenWhereTwoEchoesSwapSidesAtTheFirstRay) {
  Scan scan{-M_PI, M_PI / 180, 0.05, 8.0, std::vector<float>(360, kNothing)};
  const Scan empty = scan;
  scan.ranges[355] = 0.6F, scan.ranges[356] = 0.8F;
  // After 5.4 cm to the left, the nearer end lies in the direction of ray 0.2, the farther one in that of ray 359.9.
  memory.update(scan, {}, {0, 0, 0}, 1.0, diffbot());
  memory.update(empty, {}, {0, 0.054, 0}, 1.1, diffbot());
  EXPECT_EQ(memory.problem(), "");
}

TEST_F(ScanMemoryTest, AnOpeningBetweenTwoEchoesIsNotFrozen) {
  Scan scan{-M_PI, M_PI / 180, 0.05, 8.0, std::vector<float>(360, kNothing)};
  const Scan empty = scan;
  scan.ranges[180] = 1.0F, scan.ranges[179] = 0.8F;
  memory.update(scan, {}, {0, 0, 0}, 1.0, diffbot());
  memory.update(empty, {}, {0.74, 0, 0}, 1.1, diffbot());  // now they are 13 degrees apart
  EXPECT_EQ(memory.problem(), "");
}

TEST_F(ScanMemoryTest, ALaserThatMeasuresInCentimetresIsNotFrozen) {
  noise = std::normal_distribution<float>(0, 0);
  drive(20, 0.5);
  EXPECT_EQ(memory.problem(), "");
}

TEST_F(ScanMemoryTest, ASectorThatReturnsNothingIsDoubtedAndWhatItSawStays) {
  for (const float nothing : {kNothing, 0.0F, std::nanf(""), 8.0F, 0.01F}) {
    memory = ScanMemory(), base = {0.8, 1.6, 0};
    drive(5, 0.5);
    drive(1, 0.5, 0, front(nothing));
    EXPECT_THAT(memory.problem(), HasSubstr("scan is blind in part: no echo over"));
    drive(30, 0, 0, front(nothing));
    EXPECT_THAT(memory.problem(), HasSubstr("scan is blind in part: no echo over"));
    EXPECT_LT(nearest(ahead), 0.1);
    drive(2, 0);
    EXPECT_EQ(memory.problem(), "");
  }
}

TEST_F(ScanMemoryTest, ASectorThatRepeatsItsRangesIsDoubtedOnceTheRobotHasMoved) {
  drive(5, 0.5);
  const Scan before = scan();
  const auto frozen = [&](Scan& scan) {
    std::copy(before.ranges.begin() + 120, before.ranges.begin() + 240, scan.ranges.begin() + 120);
  };
  drive(10, 0, 0, frozen);
  EXPECT_EQ(memory.problem(), "");
  drive(3, 0.5, 0, frozen);
  EXPECT_THAT(memory.problem(), HasSubstr("scan is frozen in part"));
}

TEST_F(ScanMemoryTest, WhatHasLeftTheFieldOfViewIsForgottenAfterTheDistanceThatTheGuardLooksAhead) {
  drive(1, 0, 0, half);
  drive(3, 0, 6, half);
  EXPECT_LT(nearest(ahead), 0.1);
  for (int i = 0; i < 3000; ++i) drive(1, i % 2 == 0 ? 0.02 : -0.02, 0, half);  // sways by 2 mm for five minutes
  EXPECT_LT(nearest(ahead), 0.1);
  for (int i = 0; i < 19; ++i) drive(1, i % 2 == 0 ? 2 : -2, 0, half);
  EXPECT_LT(nearest(ahead), 0.1);
  drive(2, 2, 0, half);
  EXPECT_GT(nearest(ahead), 0.5);
}

TEST_F(ScanMemoryTest, ARobotThatStandsRemembersEachRayOnce) {
  const auto far = [&](Scan& scan) {
    for (float& range : scan.ranges) range = 0.97F * static_cast<float>(scan.range_max) + noise(random);
  };
  drive(100, 0, 0, far);
  EXPECT_EQ(memory.points().size(), scan().ranges.size());
}

TEST_F(ScanMemoryTest, ScansThatDropOutWhileTheRobotTurnsAreNoBlindness) {
  const auto nothing = [](Scan& scan) {
    half(scan);
    std::fill(scan.ranges.begin(), scan.ranges.end(), kNothing);
  };
  for (int i = 0; i < 3; ++i) {
    drive(5, 0, 1, half);
    drive(1, 0, 1, nothing);
    drive(5, 0.3, 0, half);
    EXPECT_EQ(memory.problem(), "");
  }
}

TEST_F(ScanMemoryTest, WhatARayPassesIsForgottenAtOnce) {
  const auto box = [](Scan& scan) { std::fill(scan.ranges.begin() + 170, scan.ranges.begin() + 190, 1.0F); };
  drive(3, 0, 0, box);
  EXPECT_LT(nearest({1.8, 1.6}), 0.05);
  drive(1, 0);
  EXPECT_GT(nearest({1.8, 1.6}), 0.5);
}

TEST_F(ScanMemoryTest, AnObjectThatMovesAwayInTheOpenIsNoDoubt) {
  const auto person = [&](double bearing) {
    return [bearing](Scan& scan) {
      for (std::size_t i = 0; i < scan.ranges.size(); ++i)
        scan.ranges[i] = std::abs(scan.angle(i) - bearing) < 0.25 ? 1.0F : kNothing;
    };
  };
  for (double bearing = -1; bearing < 1; bearing += 0.15) {
    drive(1, 0, 0, person(bearing));
    EXPECT_EQ(memory.problem(), "");
  }
  drive(1, 0, 0, front(kNothing));
  EXPECT_THAT(memory.problem(), HasSubstr("scan is blind in part"));
}

TEST_F(ScanMemoryTest, AJumpOfThePoseBeginsAnew) {
  drive(5, 0.5);
  base.x += 0.2;
  drive(1, 0, 0, front(kNothing));
  EXPECT_NE(memory.problem(), "");
  base.x += 1;
  drive(1, 0, 0, front(kNothing));
  EXPECT_EQ(memory.problem(), "");
}

TEST_F(ScanMemoryTest, HostileScansNeitherEndNorReleaseAnything) {
  drive(5, 0.5);
  const auto nan = std::nan("");
  for (int i = 1; i < 100; ++i) {
    drive(1, 0, 0, [&](Scan& scan) {
      for (float& range : scan.ranges) range = i % 2 ? static_cast<float>(nan) : kNothing;
      if (i % 3 == 0) scan.ranges.resize(2 + static_cast<std::size_t>(i), kNothing);
      if (i % 5 == 0) scan.angle_increment *= -1;
    });
    EXPECT_NE(memory.problem(), "");
  }
}

}  // namespace robot_control::navigation::tests
