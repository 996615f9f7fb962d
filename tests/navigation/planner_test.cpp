#include "navigation/goals/planner.h"

#include <algorithm>
#include <fstream>
#include <random>

#include "navigation/house.h"
#include "navigation/map_consistency.h"
#include "support/matchers.h"

namespace robot_control::navigation::tests {

using namespace testing_house;

constexpr PlanarPose kLeft{1.6, 1.6, 0}, kRight{4.7, 1.6, 0};

Costmap costmap_of(const Grid& grid, bool unknown_is_free = false) {
  return {grid, diffbot(), unknown_is_free};
}

/// Returns the smallest distance of the true outline from any occupied cell's border along the plan, m.
double air(const Grid& grid, const Plan& plan) {
  double least = 1e9;
  for (const PlanarPose& pose : plan.poses) {
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
      if (grid.cells[i] != kOccupiedCell) continue;
      const int column = static_cast<int>(i) % grid.columns, row = static_cast<int>(i) / grid.columns;
      for (const double u : {-0.5, 0.5}) {
        for (const double v : {-0.5, 0.5}) {
          const double dx = grid.x_of(column) + u * grid.resolution - pose.x;
          const double dy = grid.y_of(row) + v * grid.resolution - pose.y;
          const double c = std::cos(pose.yaw), s = std::sin(pose.yaw);
          least = std::min(least, diffbot().distance({c * dx + s * dy, c * dy - s * dx}));
        }
      }
    }
  }
  return least;
}

TEST(FootprintTest, TheOutlineOfTheShippedRobotHoldsBodyAndWheels) {
  std::ifstream file(PROJECT_DIRECTORY "/urdf/diffbot.urdf");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const Footprint outline = footprint_of(read_rigid_bodies({text, "diffbot.urdf"}));
  EXPECT_NEAR(outline.inscribed, 0.12, 1e-3);
  EXPECT_NEAR(outline.half_width, 0.27, 1e-3);
  EXPECT_NEAR(outline.circumscribed, std::hypot(0.28, 0.18), 1e-3);
  EXPECT_NEAR(outline.distance({0.22, 0}), 0.1, 1e-3);
  EXPECT_LT(outline.distance({-0.2, 0.17}), 0);
}

TEST(FootprintTest, ABaseBesideTheOutlineIsRefused) {
  EXPECT_THROW(hull({{1, 0}, {2, 0}, {2, 1}}), std::invalid_argument);
  EXPECT_THROW(hull({}), std::invalid_argument);
}

TEST(CostmapTest, AMapOfFinerCellsIsTakenInCoarserOnes) {
  Grid fine{.columns = 602, .rows = 400, .resolution = 0.01F, .origin_x = -1, .origin_y = 2, .cells = {}};
  fine.cells.assign(602 * 400, kFreeCell);
  fine.cells[fine.index({601, 7})] = kOccupiedCell;
  const Costmap costmap = costmap_of(fine);
  EXPECT_EQ(costmap.grid().columns, 121);
  EXPECT_EQ(costmap.grid().rows, 80);
  EXPECT_NEAR(costmap.grid().resolution, 0.05, 1e-6);
  EXPECT_TRUE(costmap.occupied(costmap.grid().cell_at(5.015, 2.075)));
  EXPECT_FALSE(costmap.occupied(costmap.grid().cell_at(4.945, 2.075)));
}

TEST(CostmapTest, ARayMarksWhatTheMapDoesNotHaveAndClearsItAgain) {
  const Grid map = two_rooms(0.8);
  Grid world = map;
  world.cells[world.index({20, 16})] = kOccupiedCell;
  Costmap costmap = costmap_of(map);
  const Agreement seen = costmap.insert(scan_of(world, kLeft), kLeft, 1.0);
  costmap.update(1.0);
  EXPECT_TRUE(costmap.occupied({20, 16}));
  EXPECT_GT(seen.explained, seen.rays * 9 / 10);
  EXPECT_EQ(seen.contradicting, 0);
  costmap.insert(scan_of(map, kLeft), kLeft, 1.1);
  costmap.update(1.1);
  EXPECT_FALSE(costmap.occupied({20, 16}));
}

TEST(CostmapTest, WhatIsNotSeenAgainIsForgotten) {
  const Grid map = two_rooms(0.8);
  Grid world = map;
  world.cells[world.index({20, 16})] = kOccupiedCell;
  Costmap costmap = costmap_of(map);
  costmap.insert(scan_of(world, kLeft), kLeft, 1.0);
  costmap.update(0.9 + kMemory);
  EXPECT_TRUE(costmap.occupied({20, 16}));
  costmap.update(1.1 + kMemory);
  EXPECT_FALSE(costmap.occupied({20, 16}));
}

TEST(CostmapTest, APictureShowsThePredictedAndLeavesTheDistancesOfTheControl) {
  Costmap costmap = costmap_of(two_rooms(0.8));
  costmap.set_predicted({{1.65, 1.65}});
  costmap.update(1, false);
  const double before = costmap.distance({16, 16});
  const Grid shown = costmap.picture(1);
  EXPECT_EQ(shown.cells[shown.index({16, 16})], kOccupiedCell);
  EXPECT_EQ(shown.cells[shown.index({17, 16})], 99);
  EXPECT_LT(shown.cells[shown.index({10, 16})], 99);
  EXPECT_EQ(costmap.distance({16, 16}), before);
  EXPECT_GT(before, 0.5);
}

TEST(CostmapTest, WhatIsFreeHasAirAboutTheTrueOutline) {
  Grid map = grid_of(std::vector<std::string>(40, std::string(40, '.')));
  map.resolution = 0.05;
  map.cells[map.index({20, 20})] = kOccupiedCell;
  const Costmap costmap = costmap_of(map);
  const double half_cell = map.resolution * M_SQRT1_2;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> offset(-0.4, 0.4), yaw(-M_PI, M_PI);
  double narrowest_free = 1, widest_refused = 0;
  for (int i = 0; i < 5'000; ++i) {
    const PlanarPose pose{map.x_of(20) + offset(random), map.y_of(20) + offset(random), yaw(random)};
    double& found = costmap.free(pose) ? narrowest_free : widest_refused;
    const double left = air(map, {{pose}, 0, ""});
    found = costmap.free(pose) ? std::min(found, left) : std::max(found, left);
  }
  EXPECT_GT(narrowest_free, kPadding - half_cell - 1e-9);
  EXPECT_LT(widest_refused, kPadding);
}

TEST(CostmapTest, AnUntruePoseLetsRaysPassWalls) {
  const Grid map = two_rooms(0.8);
  Costmap costmap = costmap_of(map);
  const PlanarPose shifted{kLeft.x + 0.5, kLeft.y, kLeft.yaw}, turned{kLeft.x, kLeft.y, M_PI / 6};
  for (const PlanarPose& wrong : {shifted, turned}) {
    const Agreement seen = costmap.insert(scan_of(map, kLeft), wrong, 1.0);
    EXPECT_GT(seen.contradicting, seen.rays / 8);
  }
}

/// A window that has seen the left room of the house from kLeft.
Costmap window_of(const Grid& world, const PlanarPose& pose) {
  Costmap window(diffbot());
  window.insert(scan_of(world, pose, 1440), pose, 1);
  window.update(1);
  return window;
}

TEST(WindowTest, WhatIsSeenIsOccupiedAndTheUnseenIsFree) {
  const Costmap window = window_of(two_rooms(0.8), kLeft);
  EXPECT_TRUE(window.occupied(window.grid().cell_at(3.12, 0.6)));
  EXPECT_FALSE(window.occupied(window.grid().cell_at(4.7, 0.6)));
  EXPECT_TRUE(window.unknown(window.grid().cell_at(4.7, 0.6)));
}

TEST(WindowTest, ItMovesWithTheRobotAndKeepsWhatItHasSeen) {
  Costmap window = window_of(two_rooms(0.8), kLeft);
  const Cell before = window.grid().cell_at(3.12, 0.6);
  window.centre_on({kWindow / 8 - 0.1, 0}, 2);
  EXPECT_EQ(window.grid().cell_at(3.12, 0.6), before);
  window.centre_on({5.01, 1.01}, 2);
  const Cell after = window.grid().cell_at(3.12, 0.6);
  EXPECT_EQ(after.column, before.column - 100);
  EXPECT_EQ(after.row, before.row - 20);
  EXPECT_TRUE(window.occupied(after));
  window.centre_on({50.0, 1.0}, 2);
  window.centre_on({5.01, 1.01}, 2);
  EXPECT_FALSE(window.occupied(window.grid().cell_at(3.12, 0.6)));
}

TEST(WindowTest, AMapDoesNotMove) {
  Costmap costmap = costmap_of(two_rooms(0.8));
  costmap.centre_on({50, 50}, 1);
  EXPECT_EQ(costmap.grid().origin_x, 0);
}

TEST(WindowTest, WhatIsHiddenIsRememberedUntilARayPasses) {
  Costmap window = window_of(two_rooms(0.8), kLeft);
  const double later = 1 + 10 * kMemory;
  window.update(later);
  EXPECT_TRUE(window.occupied(window.grid().cell_at(3.12, 0.6)));
  Grid open = two_rooms(0.8);
  std::ranges::fill(open.cells, kFreeCell);  // no ray returns
  window.insert(scan_of(open, kLeft, 1440), kLeft, 1.1);
  window.update(1.1);
  EXPECT_TRUE(window.occupied(window.grid().cell_at(3.12, 0.6))) << "a ray without return is no evidence at once";
  window.insert(scan_of(open, kLeft, 1440), kLeft, later);
  window.update(later);
  EXPECT_FALSE(window.occupied(window.grid().cell_at(3.12, 0.6)));
}

TEST(WindowTest, AMissingMapIsNoFalseMap) {
  Costmap window(diffbot());
  MapConsistency consistency;
  for (int i = 0; i < 2 * kBadScans; ++i) consistency.update(window.insert(scan_of(two_rooms(0.8), kLeft), kLeft, 1));
  EXPECT_EQ(consistency.problem(), "");
  EXPECT_EQ(consistency.explanation(), "");
}

TEST(WindowTest, AGoalOutsideIsPlannedToTheBestPointOfTheBorder) {
  Grid world = two_rooms(0.8);
  for (int row = 0; row < world.rows; ++row) world.cells[world.index({62, row})] = kFreeCell;  // the wall on the right
  const Costmap window = window_of(world, kLeft);
  for (const PlanarPose& goal : {PlanarPose{100, 1.6, 1}, PlanarPose{kWindow / 2 - 0.1, 1.6, 1}}) {
    const Plan plan = plan_path(window, kLeft, goal);
    ASSERT_EQ(plan.problem, "");
    EXPECT_TRUE(plan.partial);
    EXPECT_NEAR(plan.poses.back().x, kWindow / 2, 0.7);
    EXPECT_NEAR(plan.poses.back().y, 1.6, 1.0);
    for (const PlanarPose& pose : plan.poses) EXPECT_TRUE(window.free(pose));
  }
  EXPECT_FALSE(plan_path(window, kLeft, kRight).partial);
  EXPECT_THAT(plan_path(window, kLeft, {1e300, 0, 0}).problem, HasSubstr("is outside the map"));
}

TEST(WindowTest, AGoalOutsideOfAClosedRoomHasNoPath) {
  const Costmap window = window_of(two_rooms(0), kLeft);
  EXPECT_THAT(plan_path(window, kLeft, {100, 1.6, 1}).problem, HasSubstr("no path"));
}

TEST(DoubtTest, AnUntruePoseIsDoubtedAfterHalfASecondAndATrueOneTrustedAgain) {
  const Grid map = two_rooms(0.8);
  Costmap costmap = costmap_of(map);
  MapConsistency consistency;
  const PlanarPose wrong{kLeft.x + 0.5, kLeft.y, kLeft.yaw};
  for (int i = 0; i < kBadScans - 1; ++i) consistency.update(costmap.insert(scan_of(map, kLeft), wrong, 1));
  EXPECT_EQ(consistency.problem(), "");
  consistency.update(costmap.insert(scan_of(map, kLeft), wrong, 1));
  EXPECT_THAT(consistency.problem(), HasSubstr("contradicts the map: of 360 rays"));
  for (int i = 0; i < kBadScans; ++i) consistency.update(costmap.insert(scan_of(map, kLeft), kLeft, 1));
  EXPECT_EQ(consistency.problem(), "");
}

TEST(DoubtTest, AHouseThatHasOtherWallsIsRemarked) {
  const Grid map = two_rooms(0.8);
  Grid other = map;
  for (int row = 0; row < other.rows; ++row)
    other.cells[other.index({24, row})] = kOccupiedCell;  // nearer than the map's
  for (const Grid* house : std::initializer_list<const Grid*>{&map, &other}) {
    Costmap costmap = costmap_of(map);
    MapConsistency consistency;
    for (int i = 0; i < 10; ++i) consistency.update(costmap.insert(scan_of(*house, kLeft), kLeft, 1));
    EXPECT_EQ(consistency.explanation().empty(), house == &map) << consistency.explanation();
    EXPECT_EQ(consistency.problem(), "");
  }
}

TEST(PlannerTest, TheWayThroughADoorKeepsTheOutlineFree) {
  const Grid map = two_rooms(0.8);
  for (const double yaw : {0.0, 1.0, 2.0, 3.0, -1.0, -2.0}) {
    const PlanarPose start{1.0, 0.7, yaw}, goal{5.3, 2.5, -yaw};
    const Plan plan = plan_path(costmap_of(map), start, goal);
    ASSERT_EQ(plan.problem, "");
    EXPECT_LT(plan.length, 1.1 * (std::hypot(2.15, 0.9) + std::hypot(2.15, 0.9)));
    EXPECT_GT(air(map, plan), 0.02);
    EXPECT_NEAR(plan.poses.front().x, start.x, 1e-9);
    EXPECT_NEAR(plan.poses.back().x, goal.x, 1e-9);
    EXPECT_NEAR(plan.poses.back().yaw, goal.yaw, 1e-9);
  }
}

TEST(PlannerTest, NoCornerOfTheWayIsSharpWhereThereIsRoom) {
  const Plan plan = plan_path(costmap_of(two_rooms(1.6)), {1.0, 0.7, 0.4}, {5.3, 2.5, 0});
  for (std::size_t i = 2; i + 1 < plan.poses.size(); ++i) {
    EXPECT_LT(std::abs(std::remainder(plan.poses[i].yaw - plan.poses[i - 1].yaw, 2 * M_PI)), 0.6);
  }
}

TEST(PlannerTest, ATooNarrowDoorIsNamed) {
  EXPECT_THAT(plan_path(costmap_of(two_rooms(0.5)), kLeft, kRight).problem, HasSubstr("wide at (3.15, 1.65) m"));
  EXPECT_THAT(plan_path(costmap_of(two_rooms(0)), kLeft, kRight).problem, HasSubstr("surround the goal or the robot"));
}

TEST(PlannerTest, EachGoalThatCannotBeIsRefused) {
  const Costmap costmap = costmap_of(two_rooms(0.8));
  const auto problem = [&](double x, double y, double yaw = 0) {
    return plan_path(costmap, kLeft, {x, y, yaw}).problem;
  };
  EXPECT_THAT(problem(3.15, 0.3), HasSubstr("is in an obstacle"));
  EXPECT_THAT(problem(6.05, 1.6, M_PI / 2), HasSubstr("too near to an obstacle"));
  EXPECT_THAT(problem(1e6, 0), HasSubstr("is outside the map"));
  EXPECT_THAT(problem(1e300, 0), HasSubstr("is outside the map"));
  EXPECT_THAT(problem(std::nan(""), 1), HasSubstr("NaN or infinity"));
  EXPECT_THAT(problem(1, 1, INFINITY), HasSubstr("NaN or infinity"));
}

TEST(PlannerTest, NoCostIsFiniteIfTheGoalIsOutsideTheMap) {
  const Costmap costmap = costmap_of(two_rooms(0.8));
  for (const PlanarPose& goal : {PlanarPose{6.5, 1.6, 0}, PlanarPose{-0.5, 1.6, 0}, PlanarPose{1.6, 1e6, 0}}) {
    for (const float cost : costs_to(costmap, goal, 1).costs) ASSERT_TRUE(std::isinf(cost)) << goal.x << ' ' << goal.y;
  }
}

/// Those beyond the margin are left out, the others are the same.
TEST(PlannerTest, CostsNearARobotDoNotGrowWithTheMap) {
  for (const int size : {400, 800}) {
    Grid map;
    map.columns = map.rows = size, map.resolution = 0.05;
    map.cells.assign(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), kFreeCell);
    for (int row = 20; row < 100; ++row) map.cells[map.index({100, row})] = kOccupiedCell;
    const Costmap costmap = costmap_of(map);
    const CostsToGoal all = costs_to(costmap, {2, 3, 0}, 5);
    const CostsToGoal some = costs_to(costmap, {2, 3, 0}, 5, Point{6, 3});
    const double border = all.at(6, 3) + kCostMargin;
    std::size_t within = 0;
    for (std::size_t i = 0; i < all.costs.size(); ++i) {
      if (all.costs[i] > border) continue;
      ++within;
      ASSERT_EQ(some.costs[i], all.costs[i]) << "cell " << i;
    }
    EXPECT_GE(some.settled, within);
    EXPECT_LT(some.settled, 1.05 * static_cast<double>(within));
  }
}

TEST(PlannerTest, UnknownSpaceIsDrivenOnlyOnRequest) {
  Grid map = two_rooms(0.8);
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    if (map.cells[i] == kFreeCell && static_cast<int>(i) % map.columns > 31) map.cells[i] = kUnknownCell;
  }
  EXPECT_THAT(plan_path(costmap_of(map), kLeft, kRight).problem, HasSubstr("is in unknown space"));
  EXPECT_EQ(plan_path(costmap_of(map, true), kLeft, kRight).problem, "");
}

TEST(PlannerTest, ATurnOnTheSpotIsAPath) {
  const Plan plan = plan_path(costmap_of(two_rooms(0.8)), kLeft, {kLeft.x + 0.01, kLeft.y, 2});
  ASSERT_EQ(plan.poses.size(), 2u);
  EXPECT_EQ(plan.poses.back().yaw, 2);
  EXPECT_LT(plan.length, 0.01);
}

TEST(PlannerTest, ADeadEndIsLeftBackwards) {
  // A slot of 0.7 m, in which an outline of 0.8 m × 0.4 m cannot turn.
  Grid map = grid_of(std::vector<std::string>(40, std::string(40, '.')));
  for (int column = 20; column < 40; ++column) {
    for (int row = 0; row < 40; ++row) {
      if (row < 15 || row > 21) map.cells[map.index({column, row})] = kOccupiedCell;
    }
  }
  const PlanarPose inside{3.0, 1.85, 0};
  const Costmap costmap(map, hull({{0.2, 0.2}, {-0.6, 0.2}, {-0.6, -0.2}, {0.2, -0.2}}), false);
  const Plan plan = plan_path(costmap, inside, {0.8, 1.85, M_PI});
  ASSERT_EQ(plan.problem, "");
  EXPECT_LT(std::cos(plan.poses[1].yaw) * (plan.poses[1].x - plan.poses[0].x), 0);
}

TEST(PlannerTest, AGoalInASlotIsReachedWhoseHeadingIsBetweenTwoSectors) {
  // A slot of 0.7 m, in which the outline of 0.8 m × 0.38 m has room for ±14°.
  Grid map = grid_of(std::vector<std::string>(40, std::string(40, '.')));
  for (int column = 20; column < 40; ++column) {
    for (int row = 0; row < 40; ++row) {
      if (row < 15 || row > 21) map.cells[map.index({column, row})] = kOccupiedCell;
    }
  }
  const Costmap costmap(map, hull({{0.2, 0.19}, {-0.6, 0.19}, {-0.6, -0.19}, {0.2, -0.19}}), false);
  const PlanarPose outside{0.8, 1.85, 1}, inside{3.0, 1.85, 0.235};
  ASSERT_TRUE(costmap.free(inside));
  EXPECT_EQ(plan_path(costmap, outside, inside).problem, "");
  EXPECT_EQ(plan_path(costmap, inside, outside).problem, "");
}

TEST(PlannerTest, TheDistanceToWhatBlocksThePathFallsAsTheRobotMoves) {
  const Grid map = two_rooms(0.8);
  Costmap costmap = costmap_of(map);
  const Plan plan = plan_path(costmap, kLeft, kRight);
  std::size_t passed = 0;
  EXPECT_TRUE(std::isinf(free_distance(costmap, plan.poses, kLeft, passed)));
  Grid world = map;
  world.cells[world.index({28, 16})] = kOccupiedCell;
  costmap.insert(scan_of(world, kLeft), kLeft, 1);
  costmap.update(1);
  const double far = free_distance(costmap, plan.poses, kLeft, passed);
  EXPECT_NEAR(far, 2.8 - 1.6 - 0.12 - kPadding, 0.15);
  EXPECT_NEAR(free_distance(costmap, plan.poses, {2.1, 1.6, 0}, passed), far - 0.5, 0.11);
}

}  // namespace robot_control::navigation::tests
