/// Robots on legs in the simulated machine, which stand up by a simple law: the feet stay where they lie, and the body
/// rises. Each leg's share of the weight is the feed-forward.

#include <Eigen/Geometry>

#include "drivers/mujoco/mujoco_plant.h"
#include "machine/gravity.h"
#include "machine/legs/legs_corpus.h"
#include "signals/rotation.h"

namespace robot_control::tests {

constexpr double kPeriod = 0.001;    // s
constexpr double kStandUp = 1.5;     // s
constexpr double kHeight = 0.7;      // of the leg's length, from the second joint to the foot
constexpr double kStiffness = 11.0;  // N·m/rad per kg and m of leg
constexpr double kDamping = 0.57;    // N·m·s/rad per kg and m^1.5

struct LeggedPlant : testing::TestWithParam<std::string> {
  LeggedPlant() {
    parameters_.scene = PROJECT_DIRECTORY "/urdf/scenes/flat.xml";
    parameters_.sensor_errors = ErrorLevel::kIdeal;
    parameters_.contact_sensors = true;
    plant_ = std::make_unique<MujocoPlant>(robot_, parameters_, kPeriod);
    plant_->start();
    observe();
  }

  void observe() {
    plant_->read(sensors_);
    plant_->truth(truth_);
    const Quaternion& q = truth_.pose_world.orientation;
    tilt_ = 2 * std::asin(std::min(1.0, std::hypot(q[0], q[1])));
  }
  void step(const std::vector<JointCommand>& commands) {
    plant_->write(commands);
    observe();
  }
  void step(const JointCommand& each, double seconds) {
    const std::vector<JointCommand> commands(kLegsJoints, each);
    for (double t = 0; t < seconds; t += kPeriod) step(commands);
  }

  /// Returns where the foot is in the base's axes while the robot stands: above the point on which it lay.
  Eigen::Vector3d stance(std::size_t leg) const {
    const LegKinematics& kinematics = robot_.legs[leg].kinematics;
    Eigen::Vector3d foot = kinematics.position(robot_.legs[leg].lying);
    foot.z() = kinematics.geometry().hip.z() + kinematics.geometry().upper.z() - kHeight * kinematics.length();
    return foot;
  }

  /// Returns the commands of a robot that has stood up to `part` of its height.
  std::vector<JointCommand> standing(double part) {
    std::vector<JointCommand> commands;
    const double length = robot_.leg_length();
    for (std::size_t i = 0; i < kLegs; ++i) {
      const LegKinematics& leg = robot_.legs[i].kinematics;
      const Eigen::Vector3d from = leg.position(robot_.legs[i].lying);
      const LegAngles angles = leg.inverse(from + part * (stance(i) - from)).angles;
      Eigen::Vector3d foot;
      const Eigen::Vector3d effort =
          -leg.jacobian(angles, foot).transpose() * Eigen::Vector3d(0, 0, part * robot_.mass * kGravity / kLegs);
      for (Eigen::Index j = 0; j < 3; ++j) {
        commands.push_back({.mode = JointMode::kImpedance,
                            .position = angles[j],
                            .stiffness = kStiffness * robot_.mass * length,
                            .damping = kDamping * robot_.mass * std::pow(length, 1.5),
                            .effort = effort[j]});
      }
    }
    return commands;
  }

  double largest_effort_share() const {
    double share = 0;
    for (std::size_t i = 0; i < kLegsJoints; ++i)
      share = std::max(share, std::abs(truth_.joints[i].effort) / robot_.joints[i].effort_limit);
    return share;
  }

  LegModel robot_ = legged_robot(GetParam());
  MujocoPlantParameters parameters_;
  std::unique_ptr<MujocoPlant> plant_;
  SensorFrame sensors_;
  TruthFrame truth_;
  double tilt_ = 0;
};

TEST_P(LeggedPlant, IsSetDownLyingAndRestsThereWithItsBrakesOn) {
  const Vector3 before = truth_.pose_world.position;
  step(JointCommand{}, 1);
  const Vector3& after = truth_.pose_world.position;
  EXPECT_LE(tilt_, 0.2);
  EXPECT_LE(std::hypot(after[0] - before[0], after[1] - before[1], after[2] - before[2]), 1e-4);
  for (std::size_t i = 0; i < kLegsJoints; ++i)
    EXPECT_NEAR(sensors_.joints[i].position, robot_.joints[i].rest_position, 0.05) << robot_.joints[i].name;
}

TEST_P(LeggedPlant, StandsUpWithinItsEffortsAndStandsStill) {
  step(standing(0));
  const double lying = tilt_;
  double effort = 0, tilt = 0;
  for (double t = 0; t < 2; t += kPeriod) {
    const double part = std::min(1.0, t / kStandUp);
    step(standing(part * part * (3 - 2 * part)));
    effort = std::max(effort, largest_effort_share());
    tilt = std::max(tilt, tilt_);
  }
  for (double t = 0; t < 5; t += kPeriod) step(standing(1));
  const Vector3 before = truth_.pose_world.position;
  double load = 0;
  for (double t = 0; t < 1; t += kPeriod) step(standing(1));
  for (std::size_t i = 0; i < kLegs; ++i) {
    load += sensors_.contacts[i].force[2];
    EXPECT_GT(truth_.normal_force[i], 0.1 * robot_.mass * kGravity / kLegs) << name_of(static_cast<LegPlace>(i));
    EXPECT_LE(truth_.slip[i], 1e-3);
  }
  const Vector3& after = truth_.pose_world.position;
  EXPECT_LE(effort, 0.9);
  EXPECT_LE(tilt, std::max(lying + 0.001, 0.05));
  EXPECT_LE(tilt_, 0.03);
  EXPECT_LE(std::hypot(after[0] - before[0], after[1] - before[1]), 1e-3 / 60);  // 1 mm per minute
  const double height = plant_->data()->qpos[plant_->model().base_position + 2];
  EXPECT_NEAR(height, robot_.legs[0].foot_radius - stance(0).z(), 0.015);
  EXPECT_NEAR(load, robot_.mass * kGravity, 0.005 * robot_.mass * kGravity);
}

TEST_P(LeggedPlant, StaysUprightWhenItsJointsLoseTheirPower) {
  step(JointCommand{.mode = JointMode::kEffort}, 5);
  const Vector3& speed = truth_.twist_base.linear;
  EXPECT_LE(std::hypot(speed[0], speed[1], speed[2]), 1e-3);
  EXPECT_LE(tilt_, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Robots, LeggedPlant, testing::ValuesIn(legged_robots()), robot_name);

}  // namespace robot_control::tests
