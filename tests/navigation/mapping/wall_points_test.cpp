#include "navigation/mapping/wall_points.h"

#include <gtest/gtest.h>

#include "navigation/mapping/mapper.h"
#include "navigation/mapping/point_field.h"

namespace robot_control::navigation::tests {

/// A scan from the middle of a round room of 3 m, with one echo at this range.
Scan scan_with(float range) {
  Scan scan{-M_PI, 2 * M_PI / 360, 0.05, 2e9, std::vector<float>(360, 3)};
  scan.ranges[100] = range;
  return scan;
}

TEST(WallPoints, AnEchoFarAwayIsNoWall) {
  EXPECT_EQ(walls_of(scan_with(29), {}).size(), 360U);
  for (const float range : {31.0F, 1000.0F, 1e9F}) {
    const std::vector<WallPoint> walls = walls_of(scan_with(range), {});
    EXPECT_EQ(walls.size(), 359U);
    for (const WallPoint& wall : walls) EXPECT_LT(wall.at.norm(), 3.1);
  }
}

TEST(WallPoints, AMapGoesOnAfterAnEchoFarAway) {
  Mapper mapper;
  for (int i = 0; i < 20; ++i) mapper.update(scan_with(i % 2 == 0 ? 1e9F : 1000.0F), {}, {{0, 0, 0.1 * i}});
  EXPECT_TRUE(mapper.fits()) << mapper.reason();
  EXPECT_LT(mapper.grid().columns, 2000);
}

TEST(WallPoints, OfASavedMapOnlyThoseNearTheNodeCount) {
  Grid map{2000, 10, 0.05, -50, 0, std::vector<std::int8_t>(20'000, kFreeCell)};
  for (int column = 0; column < map.columns; column += 100) map.cells[map.index({column, 5})] = kOccupiedCell;
  EXPECT_EQ(walls_of(map).size(), 79U);
  const std::vector<WallPoint> near = walls_of(map, Eigen::Vector2d(45, 0));
  EXPECT_EQ(near.size(), 28U);
  for (const WallPoint& wall : near) EXPECT_GT(wall.at.x(), 45 - kFarthestWall - 0.1);
  EXPECT_TRUE(walls_of(map, Eigen::Vector2d(1e6, -1e6)).empty());
}

TEST(WallPoints, AFieldOfTooManyCellsIsEmpty) {
  for (const double far : {1e3, 1e6, 1e12, HUGE_VAL}) {
    PointField field({{{0, 0}, {1, 0}}, {{far, far}, {1, 0}}}, 0.05);
    EXPECT_EQ(field.nearest({0, 0}), nullptr) << far;
    EXPECT_FALSE(field.search({{{0, 0}, {1, 0}}}, {{}, 1, 1}, 0.1)) << far;
  }
}

}  // namespace robot_control::navigation::tests
