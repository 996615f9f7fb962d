#include "drivers/mujoco/model/terrain.h"

#include <Eigen/Geometry>
#include <cmath>
#include <set>

#include "drivers/mujoco/model/mujoco_model.h"
#include "drivers/mujoco/plant_fixture.h"

namespace robot_control::tests {

struct TerrainTest : testing::Test {
  TerrainTest() { parameters_.scene = kFlat; }
  MujocoModel compiled() const { return compile_model(robot_, parameters_, 0.001); }

  DriveTrain robot_ = read_drive_train(diffbot_urdf(), {});
  MujocoPlantParameters parameters_;
};

// A ray from above meets the course where its formula says.
TEST_F(TerrainTest, HasTheHeightOfItsFormulaEverywhere) {
  for (const TerrainKind kind : {TerrainKind::kNone, TerrainKind::kStairs, TerrainKind::kRough, TerrainKind::kBars,
                                 TerrainKind::kGap, TerrainKind::kIce}) {
    parameters_.terrain = {.kind = kind, .count = 4, .heading = 0.7};
    const Terrain terrain(parameters_.terrain, parameters_.seed);
    const MujocoModel model = compiled();
    const MujocoData data = set_down(model);
    mj_kinematics(model.model.get(), data.get());
    std::set<double> heights;
    for (double x = -1.013; x < 5; x += 0.083) {
      for (double y = -2.517; y < 2.5; y += 0.083) {
        const mjtNum from[3] = {x, y, 9}, down[3] = {0, 0, -1};
        const mjtByte groups[mjNGROUP] = {1, 1, 1, 1, 1, 0};
        int shape = -1;
        const double length = mj_ray(model.model.get(), data.get(), from, down, groups, 1, -1, &shape);
        const Eigen::Vector2d along = Eigen::Rotation2Dd(-parameters_.terrain.heading) * Eigen::Vector2d(x, y);
        const double height = terrain.height(x, y);
        const double lean = height > 0 ? Terrain::kLean * (along.y() - along.x()) / std::sqrt(2) : 0;
        EXPECT_NEAR(9 - length, height + lean, 1e-9) << x << ' ' << y;
        heights.insert(height);
      }
    }
    EXPECT_EQ(heights.size() == 1, kind == TerrainKind::kNone);
    if (kind == TerrainKind::kRough) {
      EXPECT_GT(heights.size(), 40u);
    } else if (kind == TerrainKind::kStairs) {
      EXPECT_EQ(heights.size(), 5u) << "the floor and four steps";
    }
  }
}

TEST_F(TerrainTest, ARobotStartsOnThePlatformBeforeAGap) {
  const double level = set_down(compiled())->qpos[2];
  parameters_.terrain.kind = TerrainKind::kGap;
  EXPECT_NEAR(set_down(compiled())->qpos[2] - level, Terrain::kDepth, 1e-9);
}

TEST_F(TerrainTest, ARoughFloorDependsOnTheSeed) {
  const TerrainParameters rough{.kind = TerrainKind::kRough};
  EXPECT_EQ(Terrain(rough, 1).height(0.8, 0.1), Terrain(rough, 1).height(0.8, 0.1));
  EXPECT_NE(Terrain(rough, 1).height(0.8, 0.1), Terrain(rough, 2).height(0.8, 0.1));
}

TEST_F(TerrainTest, TheWorldRisesAlongTheHeadingOfTheSlope) {
  parameters_.slope = 0.3;
  for (const double heading : {0.0, 0.5, M_PI / 2, -2.0}) {
    parameters_.slope_heading = heading;
    const MujocoModel model = compiled();
    const mjtNum* const gravity = model.model->opt.gravity;
    EXPECT_NEAR(gravity[0], -9.81 * std::sin(0.3) * std::cos(heading), 1e-9);
    EXPECT_NEAR(gravity[1], -9.81 * std::sin(0.3) * std::sin(heading), 1e-9);
    EXPECT_NEAR(gravity[2], -9.81 * std::cos(0.3), 1e-9);
  }
}

TEST_F(TerrainTest, ACourseWithoutABoxOrWithTooManyIsRefused) {
  for (const TerrainParameters& course : {TerrainParameters{.kind = TerrainKind::kRough, .length = 0.02, .count = 100},
                                          TerrainParameters{.kind = TerrainKind::kRough, .length = 5},
                                          TerrainParameters{.kind = TerrainKind::kBars, .height = 0}})
    EXPECT_THROW(Terrain(course, 0), DriverError);
  EXPECT_NO_THROW(Terrain(TerrainParameters{.height = 0}, 0)) << "there is no course";
}

}  // namespace robot_control::tests
