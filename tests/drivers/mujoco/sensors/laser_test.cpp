/// The simulated laser scanner.

#include "drivers/mujoco/sensors/laser.h"

#include <cmath>

#include "drivers/mujoco/plant_fixture.h"
#include "support/message_of.h"
#include "support/robots/made_robot.h"

namespace robot_control::tests {

constexpr double kLaserX = 0.05;  // m, of laser_link ahead of the base
constexpr double kExact = 0.002;  // m: the robot leans by less than 0.1° at rest

struct LaserTest : PlantTest {
  LaserTest() {
    parameters_.sensor_errors = ErrorLevel::kIdeal;
    parameters_.laser = {.rate = 10, .rays = 4, .noise = 0, .drop_outs = 0};
  }
  std::unique_ptr<MujocoPlant> in(const std::string& scene) {
    parameters_.scene = scene;
    auto plant = std::make_unique<MujocoPlant>(robot_, parameters_, period_);
    plant->start();
    return plant;
  }
  std::vector<float> ranges(const std::string& scene) {
    const auto plant = in(scene);
    return plant->scan(truth(*plant)).ranges;
  }
  std::string refusal() {
    return message_of<DriverError>([&] { in(kFlat); }, "accepted");
  }
  /// Returns a scene with one box, whose near face is 2 m ahead of the base.
  static std::string box(const std::string& more) {
    return scene_file("box.xml", R"(<mujoco><worldbody><geom type="plane" size="9 9 1"/><site name="start"/>
      <body name="cart" mocap="true" pos="2.5 0 0.5"><geom type="box" size=".5 .5 .5" )" +
                                     more + R"(/></body></worldbody>
      <custom><numeric name="path/cart" data="1  2.5 0  4.5 0"/></custom></mujoco>)");
  }

  DriveTrain robot_ = read_drive_train(diffbot_urdf(), {});
  MujocoPlantParameters parameters_;
};

const std::string kWalls = PROJECT_DIRECTORY "/urdf/scenes/walls.xml";  // 2 m from the start, on each side

// Rays of −180°, −90°, 0°, 90°.
TEST_F(LaserTest, MeasuresTheDistanceFromItsLink) {
  const std::vector<float> seen = ranges(kWalls);
  ASSERT_EQ(seen.size(), 4u);
  EXPECT_NEAR(seen[0], 2 + kLaserX, kExact);
  EXPECT_NEAR(seen[1], 2, kExact);
  EXPECT_NEAR(seen[2], 2 - kLaserX, kExact);
  EXPECT_NEAR(seen[3], 2, kExact);
}

TEST_F(LaserTest, TurnsWithTheRobot) {
  const auto plant = in(kWalls);
  TruthFrame turned = truth(*plant);
  turned.pose_world.orientation = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};
  const LaserScan scan = plant->scan(turned);
  EXPECT_NEAR(scan.ranges[0], 2 + kLaserX, kExact);
  EXPECT_NEAR(scan.ranges[1], 2, kExact) << "the wall ahead of the start is now at its right";
}

TEST_F(LaserTest, DoesNotSeeTheRobot) {
  parameters_.laser.link = "imu_link";  // in the middle of the chassis
  parameters_.laser.rays = 90;
  for (const float range : ranges(kWalls)) EXPECT_GT(range, 1.9);
}

TEST_F(LaserTest, LooksThroughGlassAndGetsNothingBackFromBlack) {
  EXPECT_NEAR(ranges(box(""))[2], 2 - kLaserX, kExact);
  EXPECT_TRUE(std::isinf(ranges(box("group=\"1\""))[2]));
  EXPECT_TRUE(std::isinf(ranges(box("group=\"2\""))[2]));
}

TEST_F(LaserTest, SeesNothingBeyondItsRangeAndMarksWhatIsTooNear) {
  parameters_.laser.range_max = 1.9;
  EXPECT_EQ(ranges(box(""))[2], INFINITY);
  parameters_.laser = {.rate = 10, .rays = 4, .range_min = 3, .noise = 0, .drop_outs = 0};
  EXPECT_EQ(ranges(box(""))[2], -INFINITY);
}

TEST_F(LaserTest, SeesABodyWhereItsPathIsAtThatTime) {
  const auto plant = in(box(""));
  TruthFrame later = truth(*plant);
  later.head.cycle = 1500;
  EXPECT_NEAR(plant->scan(later).ranges[2], 3.5 - kLaserX, kExact);
  later.head.cycle = 3000;  // on its way back
  EXPECT_NEAR(plant->scan(later).ranges[2], 3 - kLaserX, kExact);
  for (int k = 0; k < 1500; ++k) plant->write(both({}, {}));
  EXPECT_NEAR(plant->data()->mocap_pos[0], 4, 1e-9) << "the plant moves it, too";
}

TEST_F(LaserTest, TheSameStateGivesTheSameBits) {
  parameters_.laser = {.rate = 10};
  const auto first = in(kWalls), second = in(kWalls);
  EXPECT_EQ(first->scan(truth(*first)).ranges, second->scan(truth(*second)).ranges);
  TruthFrame later = truth(*first);
  later.head.cycle = 100;
  EXPECT_NE(first->scan(later).ranges, first->scan(truth(*first)).ranges) << "each scan has its own noise";
}

TEST_F(LaserTest, HasItsNoiseAndItsDropOuts) {
  parameters_.laser = {.rate = 10, .rays = 10000, .angle_min = -0.1, .angle_max = 0.1, .noise = 0.02, .drop_outs = 0.1};
  double lost = 0, square = 0;
  for (const float range : ranges(kWalls)) {
    if (std::isinf(range))
      ++lost;
    else
      square += std::pow(range - (2 - kLaserX), 2);
  }
  EXPECT_NEAR(lost / 10000, 0.1, 0.01);  // three standard deviations
  EXPECT_NEAR(std::sqrt(square / (10000 - lost)), 0.02, 0.003);
}

TEST_F(LaserTest, IsRefusedInWords) {
  parameters_.laser.link = "lidar";
  EXPECT_NE(refusal().find("there is no link \"lidar\" for the laser"), std::string::npos);
  parameters_.laser = {.rate = 10, .angle_min = 1, .angle_max = -1};
  EXPECT_NE(refusal().find("angle_max must be greater"), std::string::npos);
  parameters_.laser = {.rate = 10, .range_min = 3, .range_max = 2};
  EXPECT_NE(refusal().find("range_max must be greater"), std::string::npos);
}

TEST_F(LaserTest, APathNeedsABodyAndTwoCorners) {
  const auto with =
      [&](const std::string& data, const std::string& mocap) {
        return message_of<DriverError>(
            [&] {
              in(scene_file("path.xml", R"(<mujoco><worldbody><site name="start"/><geom type="plane" size="9 9 1"/>
            <body name="cart" )" + mocap + R"( pos="3 0 1"><geom size=".1"/></body></worldbody>
            <custom><numeric name="path/cart" data=")" +
                                            data + R"("/></custom></mujoco>)"));
            },
            "accepted");
      };
  EXPECT_EQ(with("1  0 0  1 0", "mocap=\"true\""), "accepted");
  EXPECT_NE(with("1  0 0  1 0", "").find("there is no such path"), std::string::npos);
  EXPECT_NE(with("1  0 0  0 0", "mocap=\"true\"").find("there is no such path"), std::string::npos);
  EXPECT_NE(with("1  0 0  1", "mocap=\"true\"").find("there is no such path"), std::string::npos);
}

}  // namespace robot_control::tests
