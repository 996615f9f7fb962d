/// The worlds around the robot: ours, and what the parameters make of them.

#include "drivers/mujoco/constants.h"
#include "drivers/mujoco/plant_fixture.h"
#include "support/matchers.h"
#include "support/message_of.h"
#include "support/robots/made_robot.h"

namespace robot_control::tests {

struct SceneTest : PlantTest {
  std::unique_ptr<MujocoPlant> in(const std::string& scene) {
    parameters_.scene = scene.front() == '/' ? scene : PROJECT_DIRECTORY "/urdf/scenes/" + scene;
    parameters_.sensor_errors = ErrorLevel::kIdeal;
    auto plant = std::make_unique<MujocoPlant>(robot_, parameters_, period_);
    plant->start();
    return plant;
  }
  std::string refusal(const std::string& scene) {
    return message_of<DriverError>([&] { in(scene); }, "accepted");
  }

  DriveTrain robot_ = read_drive_train(diffbot_urdf(), {});
  MujocoPlantParameters parameters_;
};

TEST_F(SceneTest, DrivesOverBumps) {
  auto plant = in("bumps.xml");
  double highest = 0;
  for (int k = 0; k < 10000; ++k) {
    plant->write(both(velocity_command(5), velocity_command(5)));
    highest = std::max(highest, truth(*plant).pose_world.position[2]);
  }
  EXPECT_EQ(sensors(*plant).faults, 0u);
  EXPECT_GT(truth(*plant).pose_world.position[0], 4.0);
  EXPECT_GT(highest, 0.004) << "the axle's middle rises by the bumps";
}

// On the ice the wheels spin: 0.1 · 45 N · 0.1 m = 0.45 N·m is all that they can transmit.
TEST_F(SceneTest, WheelsSpinOnTheIceAndGripBehindIt) {
  auto plant = in("low_friction_patch.xml");
  speed_up(*plant, 5, 5);  // 0.75 m: before the ice
  while (truth(*plant).pose_world.position[0] < 1.1) plant->write(both(velocity_command(5), velocity_command(5)));
  for (int k = 0; k < 100; ++k) plant->write(both(effort_command(2), effort_command(2)));
  EXPECT_GT(truth(*plant).slip[0], 1.0);
  while (truth(*plant).pose_world.position[0] < 3.2) plant->write(both(velocity_command(5), velocity_command(5)));
  hold(*plant, both(velocity_command(5), velocity_command(5)), 1);
  EXPECT_LT(truth(*plant).slip[0], 1e-3);
}

TEST_F(SceneTest, AnotherShapeIsNoRegionOfFriction) {
  const auto with = [&](const std::string& region) {
    return refusal(scene_file("region.xml", R"(<mujoco><worldbody><geom type="plane" size="9 9 1"/><site name="start"/>
      <geom name="friction/ice" )" + region + R"( friction="0.1 0 0"/></worldbody></mujoco>)"));
  };
  const std::string through = R"( contype="0" conaffinity="0")";
  EXPECT_EQ(with(R"(type="box" size="1 1 0.01" pos="3 0 0")" + through), "accepted");
  for (const std::string& region :
       {R"(type="cylinder" size="1 0.01" pos="3 0 0")" + through, R"(type="plane" size="1 1 1")" + through,
        std::string(R"(type="box" size="1 1 0.01" pos="3 0 0")")}) {
    EXPECT_THAT(with(region), AllOf(HasSubstr("region.xml"), HasSubstr("friction/ice")));
  }
}

TEST_F(SceneTest, WallsStopTheRobot) {
  auto plant = in("walls.xml");
  hold(*plant, both(velocity_command(5), velocity_command(5)), 8);
  EXPECT_LT(truth(*plant).pose_world.position[0], 2.0);
  EXPECT_NEAR(truth(*plant).twist_base.linear[0], 0, 0.01);
  EXPECT_EQ(sensors(*plant).faults, 0u);
}

TEST_F(SceneTest, ASlopeByParameterIsASlope) {
  parameters_.slope = 5 * M_PI / 180;
  const ImuSample imu = sensors(*in("flat.xml")).imu;
  EXPECT_NEAR(imu.linear_acceleration[0], kEarthGravity * std::sin(parameters_.slope), 1e-3) << "facing uphill";
  EXPECT_NEAR(imu.linear_acceleration[2], kEarthGravity * std::cos(parameters_.slope), 1e-3);
}

// tan 5° = 0.087: less than that does not hold.
TEST_F(SceneTest, GroundTooSlipperyForItsSlopeIsRefused) {
  parameters_.ground_friction = 0.05;
  EXPECT_THAT(refusal("slope_5deg.xml"), HasSubstr("does not come to rest"));
}

// A robot on two wheels alone has nothing to stand on.
TEST_F(SceneTest, ARobotThatFallsOverIsRefused) {
  MadeRobot made;
  made.body_x = 0.05;
  made.body_z = 0.2;
  robot_ = made.model();
  EXPECT_THAT(refusal("flat.xml"), HasSubstr("falls over"));
}

TEST_F(SceneTest, ARobotThatWasRefusedDoesNotRun) {
  MadeRobot made;
  made.body_x = 0.05;
  made.body_z = 0.2;
  parameters_.scene = kFlat;
  MujocoPlant plant(made.model(), parameters_, period_);
  EXPECT_THROW(plant.start(), DriverError);
  plant.write(both(effort_command(1), effort_command(1)));
  const SensorFrame frame = sensors(plant);
  EXPECT_EQ(frame.driver_state, DriverState::kStarting);
  EXPECT_EQ(frame.valid, 0u);
}

// F t / (m + Σ J/r²): wheels that roll freely; the push is over before the robot has moved a millimetre.
TEST_F(SceneTest, APushGivesItsMomentum) {
  parameters_.push_x = 60;
  parameters_.push_start = 0.5;
  parameters_.push_duration = 0.1;
  auto plant = in("flat.xml");
  const auto free = both(effort_command(0), effort_command(0));
  hold(*plant, free, 0.499);
  EXPECT_NEAR(truth(*plant).twist_base.linear[0], 0, 1e-3);
  hold(*plant, free, 0.2);
  EXPECT_NEAR(truth(*plant).twist_base.linear[0], 60 * 0.1 / 13, 0.01 * 60 * 0.1 / 13);
}

// 3 %: the robot leans by 0.2°, off the middle of its tyres.
TEST_F(SceneTest, ARobotWithALargerLeftWheelDrivesToTheRight) {
  parameters_.left_radius_error = 0.02;
  auto plant = in("flat.xml");
  speed_up(*plant, 5, 5);
  EXPECT_NEAR(truth(*plant).twist_base.angular[2], -0.02 * 0.1 * 5 / 0.5, 0.03 * 0.02);
}

}  // namespace robot_control::tests
