/// Held joints whose range does not contain zero: they begin, and stay, where the range is nearest to it.

#include <algorithm>
#include <array>

#include "drivers/mujoco/constants.h"
#include "drivers/mujoco/plant_fixture.h"
#include "support/robots/made_robot.h"

namespace robot_control::tests {

constexpr double kTolerance = 0.003;  // rad or m

/// A lift from 0.3 m on with an arm from 0.5 rad on, and a finger that follows the arm against its own range. The
/// effort limit of the arm is a placeholder.
const std::string kArm = R"(
  <link name="lift"><inertial><mass value="2"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>
  </inertial></link>
  <joint name="lift_joint" type="prismatic"><parent link="base_link"/><child link="lift"/><axis xyz="0 0 1"/>
    <limit lower="0.3" upper="0.9" effort="500" velocity="1"/></joint>
  <link name="arm"><inertial><origin xyz="0.2 0 0"/><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="arm_joint" type="revolute"><parent link="lift"/><child link="arm"/><axis xyz="0 1 0"/>
    <limit lower="0.5" upper="2" effort="1e10" velocity="1"/></joint>
  <link name="finger"><inertial><origin xyz="0.05 0 0"/><mass value="0.1"/>
    <inertia ixx="0.0001" iyy="0.0001" izz="0.0001" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="finger_joint" type="revolute"><parent link="arm"/><child link="finger"/><origin xyz="0.4 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-0.1" upper="0.1" effort="5" velocity="1"/>
    <mimic joint="arm_joint" multiplier="-1" offset="0.1"/></joint>)";

const std::array<std::pair<const char*, double>, 3> kRest{
    {{"lift_joint", 0.3}, {"arm_joint", 0.5}, {"finger_joint", -0.4}}};

struct RestingJoints : testing::Test {
  RestingJoints() {
    parameters_.scene = kFlat;
    parameters_.sensor_errors = ErrorLevel::kIdeal;
  }

  DriveTrain robot_ = MadeRobot{.axles = {0.3, -0.3}, .body_mass = 60, .more = kArm}.model();
  MujocoPlantParameters parameters_;
};

TEST_F(RestingJoints, StayWhileTheRobotDrives) {
  MujocoPlant plant(robot_, parameters_, kStep);
  plant.start();
  std::vector<JointCommand> commands(robot_.joints.size());
  std::fill_n(commands.begin(), robot_.wheels.size(), velocity_command(5));
  SensorFrame sensors;
  for (int k = 0; k < 2000; ++k) {
    plant.read(sensors);
    for (const auto& [name, rest] : kRest) {
      const auto joint = std::ranges::find(robot_.joints, name, &JointModel::name) - robot_.joints.begin();
      ASSERT_NEAR(sensors.joints[static_cast<std::size_t>(joint)].position, rest, kTolerance) << name << k;
    }
    plant.write(commands);
  }
}

/// A viewer opens the model in this posture.
TEST_F(RestingJoints, BeginThereInTheExportedModelAndStay) {
  std::array<char, 500> error{};
  const std::string file = scene_file("resting_joints.xml", exported_mjcf(robot_, parameters_, kStep));
  const std::unique_ptr<mjModel, DeleteMujoco> model(mj_loadXML(file.c_str(), nullptr, error.data(), error.size()));
  ASSERT_TRUE(model) << error.data();
  const MujocoData data(mj_makeData(model.get()));
  for (int k = 0; k < 2000; ++k) {
    for (const auto& [name, rest] : kRest) {
      const int joint = mj_name2id(model.get(), mjOBJ_JOINT, name);
      ASSERT_NEAR(data->qpos[model->jnt_qposadr[joint]], rest, kTolerance) << name << k;
    }
    mj_step(model.get(), data.get());
  }
}

}  // namespace robot_control::tests
