#include "navigation/mapping/ray_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace robot_control::navigation::tests {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A laser of 360 rays in the middle of a round room of 3 m.
struct RayGridTest : testing::Test {
  static Scan scan_of(float range) { return {-M_PI, 2 * M_PI / 360, 0.05, 8.0, std::vector<float>(360, range)}; }
  static std::int8_t at(const Grid& grid, double x, double y) {
    const Cell cell = grid.cell_at(x, y);
    return grid.contains(cell) ? grid.cells[grid.index(cell)] : kUnknownCell;
  }
  static std::int8_t at_end(const Grid& grid, const Scan& scan, std::size_t ray, double range) {
    return at(grid, range * std::cos(scan.angle(ray)), range * std::sin(scan.angle(ray)));
  }
  void SetUp() override { grid_.insert(scan_of(3), {}); }
  RayGrid grid_;
};

TEST_F(RayGridTest, EachRayEndsAtAWallAndPassesFreeCells) {
  const Scan scan = scan_of(3);
  const Grid grid = grid_.grid();
  for (std::size_t ray = 0; ray < 360; ++ray) {
    EXPECT_GE(at_end(grid, scan, ray, 3), kOccupiedFrom) << ray;
    EXPECT_LT(at_end(grid, scan, ray, 2), 50) << ray;
    EXPECT_EQ(at_end(grid, scan, ray, 3.3), kUnknownCell) << ray;
  }
}

TEST_F(RayGridTest, RaysThatWereNotMeasuredChangeNothing) {
  const std::vector<std::int8_t> before = grid_.grid().cells;
  for (const float range : {std::nanf(""), 0.0F, 0.04F, -1.0F, -kInfinity}) {
    for (int i = 0; i < 10; ++i) grid_.insert(scan_of(range), {});
    EXPECT_EQ(grid_.grid().cells, before) << range;
  }
  Scan zero = scan_of(0);
  zero.range_min = 0;
  grid_.insert(zero, {});
  EXPECT_EQ(grid_.grid().cells, before);
}

TEST_F(RayGridTest, RaysWithoutAnEchoPassEverythingUpToRangeMax) {
  for (const float range : {kInfinity, 8.0F, 9.0F}) {
    RayGrid empty;
    empty.insert(scan_of(range), {});
    const Grid grid = empty.grid();
    for (std::size_t ray = 0; ray < 360; ++ray) {
      EXPECT_LT(at_end(grid, scan_of(1), ray, 7.8), 50) << range << ' ' << ray;
      EXPECT_EQ(at_end(grid, scan_of(1), ray, 8.2), kUnknownCell) << range << ' ' << ray;
    }
  }
}

TEST_F(RayGridTest, AWallThatIsGoneIsForgotten) {
  for (int i = 0; i < 40; ++i) grid_.insert(scan_of(3), {});
  for (int i = 0; i < 30; ++i) grid_.insert(scan_of(kInfinity), {});
  EXPECT_LT(at(grid_.grid(), 3.02, 0.02), 50);
}

TEST_F(RayGridTest, ASavedGridKeepsItsCellsAndGrows) {
  const Grid saved = grid_.grid();
  RayGrid grown(saved);
  EXPECT_EQ(grown.grid().cells, saved.cells);
  grown.insert(scan_of(3), {20.02, 0.02, 0});
  EXPECT_GE(at(grown.grid(), 3.02, 0.02), kOccupiedFrom);
  EXPECT_GE(at(grown.grid(), 17.02, 0.02), kOccupiedFrom);
}

TEST_F(RayGridTest, AGridThatWouldBeTooLargeDoesNotGrow) {
  const Grid before = grid_.grid();
  grid_.insert(scan_of(3), {1e5, 1e5, 0});
  EXPECT_EQ(grid_.grid().cells, before.cells);
}

}  // namespace robot_control::navigation::tests
