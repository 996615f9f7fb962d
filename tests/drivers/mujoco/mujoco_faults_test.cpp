/// The physics fails: a fault is reported, the last good values stay, no file is written, no exit, no reset by itself.

#include <filesystem>

#include "drivers/mujoco/mujoco_errors.h"
#include "drivers/mujoco/plant_fixture.h"
#include "support/allocation_guard.h"
#include "support/matchers.h"

namespace robot_control::tests {

struct MujocoFaultTest : PlantTest {
  void SetUp() override { std::filesystem::remove("MUJOCO_LOG.TXT"); }
  void TearDown() override { EXPECT_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT")); }

  // A drive without bounds: 10¹² N·m cause accelerations that MuJoCo calls bad.
  std::unique_ptr<MujocoPlant> unbounded() {
    DriveTrainParameters robot;
    robot.wheel_effort_limit = 1e12;
    return started(diffbot_urdf(), kFlat, 0.001, robot);
  }

  // A grid of 40 balls that falls for t = √(2·5.9/9.81) = 1.1 s; with it on the floor, MuJoCo wants more than
  // it has set aside (`size`).
  std::unique_ptr<MujocoPlant> under_falling_balls(const std::string& name, const std::string& size) {
    std::string balls = "<body pos=\"10 0 6\"><freejoint/>";
    for (int i = 0; i < 40; ++i) {
      balls +=
          "<geom size=\"0.1\" condim=\"6\" pos=\"" + std::to_string(i % 8) + " " + std::to_string(i / 8) + " 0\"/>";
    }
    balls += "</body>";
    MujocoPlantParameters parameters;
    parameters.scene = scene_file(name, "<mujoco><size " + size + "/><worldbody><geom type=\"plane\" size=\"1 1 1\"/>" +
                                            "<site name=\"start\"/>" + balls + "</worldbody></mujoco>");
    auto plant = std::make_unique<MujocoPlant>(read_drive_train(diffbot_urdf(), {}), parameters, 0.001);
    plant->start();
    return plant;
  }
};

void expect_finite(const SensorFrame& frame) {
  for (std::size_t joint = 0; joint < frame.joint_count; ++joint) {
    EXPECT_TRUE(
        std::isfinite(frame.joints[joint].position + frame.joints[joint].velocity + frame.joints[joint].effort));
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_TRUE(std::isfinite(frame.imu.angular_velocity[axis] + frame.imu.linear_acceleration[axis]));
  }
}

TEST_F(MujocoFaultTest, DivergenceIsAFaultWithTheLastGoodValues) {
  auto plant = unbounded();
  speed_up(*plant, 2, 2);
  const SensorFrame good = sensors(*plant);
  plant->write(both(effort_command(1e12), effort_command(0)));
  const SensorFrame frame = sensors(*plant);
  EXPECT_EQ(frame.driver_state, DriverState::kFault);
  EXPECT_EQ(frame.faults, kFaultSimulationDiverged);
  EXPECT_EQ(frame.valid, 0u);
  EXPECT_EQ(frame.joints[0].position, good.joints[0].position) << "not MuJoCo's silent reset";
  EXPECT_THAT(plant->fault_message(), HasSubstr("QACC"));
  expect_finite(frame);
}

TEST_F(MujocoFaultTest, AFaultedSimulationStands) {
  auto plant = unbounded();
  plant->write(both(effort_command(1e12), effort_command(0)));
  const SensorFrame before = sensors(*plant);
  hold(*plant, brakes_, 1);
  EXPECT_EQ(sensors(*plant).joints[0].position, before.joints[0].position);
  EXPECT_EQ(sensors(*plant).driver_state, DriverState::kFault);
}

TEST_F(MujocoFaultTest, StartRecoversFromDivergence) {
  auto plant = unbounded();
  plant->write(both(effort_command(1e12), effort_command(0)));
  plant->start();
  EXPECT_EQ(sensors(*plant).driver_state, DriverState::kRunning);
  EXPECT_EQ(sensors(*plant).faults, 0u);
  EXPECT_EQ(plant->fault_message(), "");
}

TEST_F(MujocoFaultTest, AFaultDoesNotAllocate) {
  auto plant = unbounded();
  AllocationGuard guard;
  plant->write(both(effort_command(1e12), effort_command(0)));
  EXPECT_EQ(guard.count(), 0u);
}

TEST_F(MujocoFaultTest, CommandsThatAreNotFiniteBrakeAndAreNoFault) {
  auto plant = started();
  JointCommand command = effort_command(std::numeric_limits<double>::quiet_NaN());
  hold(*plant, both(command, command), 0.1);
  EXPECT_EQ(sensors(*plant).driver_state, DriverState::kRunning);
  EXPECT_LT(std::abs(truth(*plant).twist_base.linear[0]), 1e-5);
}

TEST_F(MujocoFaultTest, ASceneInWhichTheRobotCannotRestIsRefused) {
  const std::string scene = scene_file("void.xml", "<mujoco><worldbody><site name=\"start\"/></worldbody></mujoco>");
  EXPECT_THROW(started(scene), DriverError);
}

TEST_F(MujocoFaultTest, OverflowingContactsAreAFault) {
  auto plant = under_falling_balls("contacts.xml", "nconmax=\"10\"");
  ASSERT_EQ(sensors(*plant).driver_state, DriverState::kRunning);
  hold(*plant, brakes_, 2);
  EXPECT_EQ(sensors(*plant).faults, kFaultSimulationDiverged);
  expect_finite(sensors(*plant));
}

TEST_F(MujocoFaultTest, AnErrorOfMujocoIsAFaultForGood) {
  // The robot alone needs 868 numbers of stack, with the balls on the floor 2415.
  auto plant = under_falling_balls("stack.xml", "nstack=\"1600\"");
  ASSERT_EQ(sensors(*plant).driver_state, DriverState::kRunning);
  hold(*plant, brakes_, 2);
  EXPECT_EQ(sensors(*plant).driver_state, DriverState::kFault);
  EXPECT_EQ(sensors(*plant).faults, kFaultSimulationError);
  EXPECT_THAT(plant->fault_message(), HasSubstr("Stack overflow"));
  expect_finite(sensors(*plant));
  EXPECT_THROW(plant->start(), DriverError);
}

TEST_F(MujocoFaultTest, AnErrorOutsideTheLoopIsAnException) {
  install_mujoco_handlers();
  EXPECT_THROW(mju_error("boom"), DriverError);
  EXPECT_STREQ(last_mujoco_message(), "boom");
}

TEST(RunGuarded, ReturnsFalseWhenMujocoRaisesAnError) {
  install_mujoco_handlers();
  int steps = 0;
  const auto failing = [](void* context) {
    ++*static_cast<int*>(context);
    mju_error("torn");
    ++*static_cast<int*>(context);
  };
  EXPECT_FALSE(run_guarded(failing, &steps));
  EXPECT_EQ(steps, 1);
  EXPECT_TRUE(run_guarded([](void* context) { ++*static_cast<int*>(context); }, &steps));
  EXPECT_EQ(steps, 2);
}

}  // namespace robot_control::tests
