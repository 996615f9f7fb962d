/// Keep-out and speed zones beside a map: what they limit, and a robot that meets them.

#include "navigation/zones.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "navigation/goals/navigator.h"
#include "navigation/house.h"
#include "navigation/map_file.h"
#include "support/damaged_text.h"
#include "support/matchers.h"

namespace robot_control::navigation::tests {

using namespace testing_house;

constexpr double kZonePeriod = 0.1;  // s
constexpr double kTopSpeed = 0.5, kDeceleration = 1.0;

/// A mask over the two rooms with cells of 0.2 m, `value` within a box.
Grid mask(Point low, Point high, std::int8_t value = kOccupiedCell) {
  Grid grid{32, 16, 0.2, 0, 0, std::vector<std::int8_t>(32 * 16, kFreeCell)};
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    const Cell cell = grid.cell_of(i);
    const double x = grid.x_of(cell.column), y = grid.y_of(cell.row);
    if (x > low.x && x < high.x && y > low.y && y < high.y) grid.cells[i] = value;
  }
  return grid;
}

TEST(ZonesTest, WithoutAMaskNothingIsLimited) {
  EXPECT_EQ(Zones().speed_limit({1, 1}, kTopSpeed, kDeceleration), kTopSpeed);
}

TEST(ZonesTest, ASpeedZoneLimitsInsideAndOnTheWayToIt) {
  const Zones zones(mask({2, 0}, {4, 3.2}, 60));
  EXPECT_NEAR(zones.speed_limit({3, 1}, kTopSpeed, kDeceleration), 0.2, 1e-9);
  const double delay = kZoneDelay * kTopSpeed;
  EXPECT_NEAR(zones.speed_limit({2 - delay, 1}, kTopSpeed, kDeceleration), 0.2, 1e-6);
  for (const double away : {0.05, 0.1, 0.2})
    EXPECT_NEAR(zones.speed_limit({2 - delay - away, 1}, kTopSpeed, kDeceleration), std::sqrt(0.04 + away), 1e-6);
  EXPECT_EQ(zones.speed_limit({1.2, 1}, kTopSpeed, kDeceleration), kTopSpeed);
}

TEST(ZonesTest, KeepOutAndUnknownCellsLimitNoSpeed) {
  EXPECT_EQ(Zones(mask({2, 0}, {4, 3})).speed_limit({3, 1}, kTopSpeed, kDeceleration), kTopSpeed);
  EXPECT_EQ(Zones(mask({2, 0}, {4, 3}, kUnknownCell)).speed_limit({3, 1}, kTopSpeed, kDeceleration), kTopSpeed);
}

TEST(ZonesTest, APlaceFarOutsideIsNotLimited) {
  const Zones zones(mask({0, 0}, {7, 4}, 60));
  for (const double x : {-5.0, 50.0, 1e7, -1e300})
    EXPECT_EQ(zones.speed_limit({x, 1}, kTopSpeed, kDeceleration), kTopSpeed);
}

/// A robot in two rooms with a door of 1 m. It has each velocity at once and follows paths exactly.
struct RobotWithZones : testing::Test {
  void step() {
    now_ += kZonePeriod;
    costmap_.insert(scan_of(world_, pose_, 180), pose_, now_);
    out_ = navigator_.step({now_, "", "", "", pose_, motion_, report_, {}, {}, kTopSpeed}, &costmap_);
    if (out_.path) path_ = *out_.path, along_ = 0, report_ = {PathReport::State::kActive, ""};
    if (report_.state != PathReport::State::kActive) return;
    const PlanarPose before = pose_;
    if (out_.request) {
      motion_ = *out_.request;
      pose_ = composed(pose_, {motion_.linear * kZonePeriod, 0, motion_.angular * kZonePeriod});
    } else {
      along_ = std::min(along_ + 1, path_.poses.size() - 1);
      pose_ = path_.poses[along_];
      if (along_ + 1 == path_.poses.size()) report_.state = PathReport::State::kDone;
    }
    record(before);
  }

  void record(const PlanarPose& before) {
    const Grid& mask = costmap_.zones().mask();
    const Cell base = mask.cell_at(pose_.x, pose_.y);
    for (int row = 0; row < mask.rows; ++row) {
      for (int column = 0; column < mask.columns; ++column) {
        const Point away = composed(inverse(pose_), std::vector<Point>{{mask.x_of(column), mask.y_of(row)}})[0];
        if (mask.cells[mask.index({column, row})] == kOccupiedCell)
          inside_ = std::min(inside_, diffbot().distance(away));
      }
    }
    if (mask.contains(base) && mask.cells[mask.index(base)] > 0 && out_.request)
      fastest_inside_ = std::max(fastest_inside_, std::hypot(pose_.x - before.x, pose_.y - before.y) / kZonePeriod);
  }

  void drive(const PlanarPose& goal) {
    navigator_.begin(goal, now_);
    for (int i = 0; i < 600 && (i == 0 || navigator_.active()); ++i) step();
  }

  Grid world_ = two_rooms(1.0);
  Costmap costmap_{two_rooms(1.0), diffbot(), false};
  Navigator navigator_;
  NavigatorOutput out_;
  Plan path_;
  std::size_t along_ = 0;
  PathReport report_;
  PlanarPose pose_{0.8, 1.6, 0};
  PlanarMotion motion_;
  double now_ = 100, inside_ = 1e9, fastest_inside_ = 0;  // s; m between outline and keep-out; m/s
};

TEST_F(RobotWithZones, AKeepOutZoneContradictsNoScan) {
  const Agreement without = costmap_.insert(scan_of(world_, pose_), pose_, now_);
  costmap_.set_zones(Zones(mask({1.4, 1.2}, {2.2, 3.2})));
  costmap_.update(now_);
  ASSERT_TRUE(costmap_.occupied(costmap_.grid().cell_at(1.8, 1.6)));
  const Agreement with = costmap_.insert(scan_of(world_, pose_), pose_, now_);
  EXPECT_EQ(with.rays, without.rays);
  EXPECT_EQ(with.contradicting, without.contradicting);
  EXPECT_EQ(with.unexpected, without.unexpected);
}

TEST_F(RobotWithZones, AKeepOutZoneIsPassed) {
  costmap_.set_zones(Zones(mask({1.4, 1.2}, {2.2, 3.2})));
  drive({4.7, 1.6, 0});
  EXPECT_EQ(out_.state, NavigatorState::kReached) << out_.reason;
  EXPECT_GT(inside_, 0);
}

TEST_F(RobotWithZones, AGoalInAKeepOutZoneIsRefusedAtOnce) {
  costmap_.set_zones(Zones(mask({4, 1}, {5.4, 2.2})));
  drive({4.7, 1.6, 0});
  EXPECT_EQ(out_.state, NavigatorState::kFailed);
  EXPECT_THAT(out_.reason, HasSubstr("is in a keep-out zone: choose another goal"));
}

TEST_F(RobotWithZones, AZoneAcrossTheDoorLeavesNoPath) {
  costmap_.set_zones(Zones(mask({2.8, 0}, {3.4, 3.2})));
  drive({4.7, 1.6, 0});
  EXPECT_EQ(out_.state, NavigatorState::kFailed);
  EXPECT_THAT(out_.reason, HasSubstr("keep-out zones"));
  EXPECT_GT(inside_, 0);
}

TEST_F(RobotWithZones, ARobotThatStartsInsideLeavesAndDoesNotComeBack) {
  costmap_.set_zones(Zones(mask({0, 0.6}, {1.8, 2.6})));
  drive({2.4, 0.8, 0});
  EXPECT_EQ(out_.state, NavigatorState::kReached) << out_.reason;
  inside_ = 1e9;
  drive({0.5, 1.6, 0});
  EXPECT_THAT(out_.reason, HasSubstr("is in a keep-out zone"));
  EXPECT_GT(inside_, 0);
}

TEST_F(RobotWithZones, TheLocalControllerKeepsTheSpeedOfAZone) {
  costmap_.set_zones(Zones(mask({2.2, 0}, {4.0, 3.2}, 60)));
  drive({5.2, 1.6, 0});
  EXPECT_EQ(out_.state, NavigatorState::kReached) << out_.reason;
  EXPECT_GT(fastest_inside_, 0.15);
  EXPECT_LE(fastest_inside_, 0.2 + 1e-9);
}

TEST_F(RobotWithZones, APathHasTheSpeedOfItsSlowestZone) {
  costmap_.set_zones(Zones(mask({1.0, 0}, {1.6, 3.2}, 60)));
  navigator_.begin({1.3, 1.6, 0}, now_);
  step();
  ASSERT_TRUE(out_.path && !out_.request);
  EXPECT_NEAR(out_.speed, 0.2, 1e-9);
}

TEST(CostmapWithZones, AWindowKeepsItsZonesWhereTheyAre) {
  Costmap costmap(diffbot());
  costmap.set_zones(Zones(mask({5, 1}, {6, 2})));
  for (const double x : {0.0, 5.0, 9.0}) {
    costmap.centre_on({x, 0}, 1);
    costmap.update(1);
    const auto at = [&](double from, double up) { return costmap.occupied(costmap.grid().cell_at(from, up)); };
    EXPECT_TRUE(at(5.5, 1.5)) << x;
    EXPECT_FALSE(at(4.5, 1.5) || at(5.5, 0.5)) << x;
  }
}

/// A damaged file is read, or refused by one sentence.
TEST(ZonesFileTest, NoDamagedFileEndsTheReader) {
  const auto folder = std::filesystem::temp_directory_path() / ("zones_test" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::string head =
      "image: zones.pgm\nresolution: 0.05\norigin: [-7.0, -5.5, 0]\nnegate: 0\noccupied_thresh: 0.995\n"
      "free_thresh: 0.005\nmode: scale\n";
  const std::string picture = "P5\n4 3\n255\n" + std::string("\xfe\xcd\0\x80\xfe\0\x40\xfe\0\0\0\0", 12);
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
  };
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    write("zones.yaml", i % 2 == 0 ? damaged(head, random) : head);
    write("zones.pgm", i % 2 == 0 ? picture : damaged(picture, random));
    try {
      const Zones zones(read_map((folder / "zones.yaml").string()));
      EXPECT_LE(zones.speed_limit({-6.9, -5.4}, kTopSpeed, kDeceleration), kTopSpeed);
    } catch (const MapError& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(refused, 400);
  std::filesystem::remove_all(folder);
}

}  // namespace robot_control::navigation::tests
