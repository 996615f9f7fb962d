/// An arm on a robot on wheels: joints that the controller does not drive have motors, and their brakes hold them.

#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/mujoco/constants.h"
#include "drivers/mujoco/motors/brake_limits.h"
#include "drivers/mujoco/plant_fixture.h"
#include "machine/fault_names.h"
#include "support/robots/made_robot.h"

namespace robot_control::tests {

constexpr int kJoints = 6;
constexpr double kGivesWay = 0.0035;  // rad or m, under the full effort limit

/// An arm of `length` m a link that is stretched out forwards, with a lift below it. Each link weighs 0.6 of the one
/// before it; `inertia` is that of each link, in kg·m² of a link of 1 kg and 1 m.
struct Arm {
  double length = 0.2;
  double mass = 2;
  double inertia = 1.0 / 12;
  double effort = 200;

  double mass_of(int link) const { return mass * std::pow(0.6, link); }

  /// The torque of gravity at the joint of this link in N·m.
  double load(int link) const {
    double torque = 0;
    for (int i = link; i < kJoints; ++i) torque += mass_of(i) * kEarthGravity * length * (i - link + 0.5);
    return torque;
  }

  /// kg, of all links.
  double weight() const {
    double sum = 0;
    for (int i = 0; i < kJoints; ++i) sum += mass_of(i);
    return sum;
  }

  std::string urdf() const {
    std::ostringstream text;
    text << R"(<link name="lift"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0"
      iyz="0"/></inertial></link><joint name="lift_joint" type="prismatic"><parent link="base_link"/>
      <child link="lift"/><origin xyz="-0.3 0 0.2"/><axis xyz="0 0 1"/>
      <limit lower="-0.3" upper="0.3" effort="500" velocity="1"/></joint>)";
    for (int i = 0; i < kJoints; ++i) {
      const double spread = inertia * mass_of(i) * length * length;
      const std::string parent = i == 0 ? "lift" : "arm_" + std::to_string(i - 1);
      text << "<link name=\"arm_" << i << "\"><inertial><origin xyz=\"" << length / 2 << " 0 0\"/><mass value=\""
           << mass_of(i) << "\"/><inertia ixx=\"" << spread << "\" iyy=\"" << spread << "\" izz=\"" << spread
           << "\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link><joint name=\"arm_joint_" << i
           << "\" type=\"revolute\"><parent link=\"" << parent << "\"/><child link=\"arm_" << i << "\"/><origin xyz=\""
           << (i == 0 ? 0 : length) << " 0 0\"/><axis xyz=\"0 1 0\"/><limit lower=\"-2\" upper=\"2\" effort=\""
           << effort << "\" velocity=\"2\"/></joint>";
    }
    return text.str();
  }
};

struct HeldJoints : testing::TestWithParam<Arm> {
  HeldJoints() {
    parameters_.scene = kFlat;
    parameters_.sensor_errors = ErrorLevel::kIdeal;
  }

  /// Drives for `cycles` with these wheels' commands. Returns the last sample.
  SensorFrame drive(MujocoPlant& plant, const JointCommand& wheels, int cycles) {
    std::vector<JointCommand> commands(robot_.joints.size());
    std::fill_n(commands.begin(), robot_.wheels.size(), wheels);
    SensorFrame sensors;
    for (int k = 0; k < cycles; ++k) {
      plant.write(commands);
      plant.read(sensors);
      for (std::size_t i = robot_.wheels.size(); i < robot_.joints.size(); ++i)
        furthest_ = std::max(furthest_, std::abs(sensors.joints[i].position));
    }
    return sensors;
  }

  std::size_t index_of(const std::string& name) const {
    const auto joint = std::ranges::find(robot_.joints, name, &JointModel::name);
    if (joint == robot_.joints.end()) throw std::out_of_range(name);
    return static_cast<std::size_t>(joint - robot_.joints.begin());
  }

  DriveTrain robot_ = MadeRobot{.axles = {0.3, -0.3}, .body_mass = 60, .more = GetParam().urdf()}.model();
  MujocoPlantParameters parameters_;
  double furthest_ = 0;  ///< rad or m
};

TEST_P(HeldJoints, StayWithTheTorqueOfTheirLoad) {
  MujocoPlant plant(robot_, parameters_, kStep);
  plant.start();
  const SensorFrame sensors = drive(plant, {}, 5000);
  for (int i = 0; i < kJoints; ++i) {
    const JointSample& joint = sensors.joints[index_of("arm_joint_" + std::to_string(i))];
    EXPECT_NEAR(joint.effort, -GetParam().load(i), 0.02 * GetParam().load(i)) << i;
    EXPECT_NEAR(joint.velocity, 0, 1e-6) << i;
  }
  EXPECT_NEAR(sensors.joints[index_of("lift_joint")].effort, (GetParam().weight() + 1) * kEarthGravity, 0.1);
  EXPECT_LT(furthest_, kGivesWay);
}

TEST_P(HeldJoints, StayWhileTheRobotDrivesAndStops) {
  MujocoPlant plant(robot_, parameters_, kStep);
  plant.start();
  drive(plant, velocity_command(10), 2000);
  drive(plant, {}, 2000);
  EXPECT_LT(furthest_, kGivesWay);
}

/// The user's brake_… are those of the driven joints.
TEST_P(HeldJoints, KeepTheirOwnBrake) {
  const std::size_t joint = index_of("arm_joint_0");
  MujocoPlantParameters given = parameters_;
  given.brake_effort = 1;
  given.brake_damping = 0.001;
  given.rotor_inertia = 0.01;
  const Brake brake = brake_of(true_robot(robot_, given, kStep), joint, given, kStep);
  const double rotor = std::min(GetParam().effort / 200, robot_.mass);
  EXPECT_EQ(brake.effort, GetParam().effort);
  EXPECT_NEAR(brake.damping, 0.4 * rotor / kStep, 1e-9);
  EXPECT_NEAR(brake.stiffness, 0.06 * rotor / (kStep * kStep), 1e-6);
}

TEST_P(HeldJoints, FallWithoutTheirMotor) {
  MujocoPlant plant(robot_, parameters_, kStep);
  plant.start();
  InjectedFaults faults{};
  ASSERT_EQ(set_fault(faults, robot_, "arm_joint_0_motor", "off"), "");
  plant.inject(faults);
  drive(plant, {}, 1000);
  EXPECT_GT(furthest_, 20 * kGivesWay);
}

/// Another program has no brakes, so dry friction holds.
TEST_P(HeldJoints, StayInTheExportedModel) {
  std::array<char, 500> error{};
  const std::string file = scene_file("held_joints.xml", exported_mjcf(robot_, parameters_, kStep));
  const std::unique_ptr<mjModel, DeleteMujoco> model(mj_loadXML(file.c_str(), nullptr, error.data(), error.size()));
  ASSERT_TRUE(model) << error.data();
  const MujocoData data(mj_makeData(model.get()));
  for (int k = 0; k < 2000; ++k) mj_step(model.get(), data.get());
  const int joint = mj_name2id(model.get(), mjOBJ_JOINT, "arm_joint_0");
  EXPECT_LT(std::abs(data->qpos[model->jnt_qposadr[joint]]), 0.02);
}

INSTANTIATE_TEST_SUITE_P(Arms, HeldJoints,
                         testing::Values(Arm{}, Arm{.length = 0.05, .mass = 0.2, .effort = 5},
                                         Arm{.length = 0.5, .mass = 8, .effort = 1000}, Arm{.inertia = 1e-4},
                                         Arm{.effort = 1e7}));

}  // namespace robot_control::tests
