/// The promises of the brush tyre, on robots that slide.

#include <cmath>

#include "drivers/mujoco/constants.h"
#include "drivers/mujoco/plant_fixture.h"
#include "support/robots/made_robot.h"

namespace robot_control::tests {

struct BrushTyreTest : PlantTest {
  std::unique_ptr<MujocoPlant> started(const MadeRobot& robot) {
    parameters_.scene = kFlat;
    parameters_.sensor_errors = ErrorLevel::kIdeal;
    auto plant = std::make_unique<MujocoPlant>(robot.model(), parameters_, period_);
    plant->start();
    return plant;
  }

  /// A wheel loop as the controller's: damping · dt / J = 0.4 on the lifted wheel, an integral with a tenth of a
  /// second, so that the wheels reach their speeds under load.
  void turn(MujocoPlant& plant, const MadeRobot& robot, double left, double right) {
    const double damping = 0.4 * robot.wheel_inertia() / 0.001;
    const SensorFrame frame = sensors(plant);
    std::vector<JointCommand> commands(2 * robot.axles.size());
    integral_.resize(commands.size());
    for (std::size_t i = 0; i < commands.size(); ++i) {
      commands[i] = velocity_command(i < robot.axles.size() ? left : right);
      commands[i].damping = damping;
      integral_[i] += damping / 0.1 * (commands[i].velocity - frame.joints[i].velocity) * 0.001;
      commands[i].effort = integral_[i];
    }
    plant.write(commands);
  }

  /// Ramps the wheels of either side to these speeds (rad/s) within a second, then goes on for `seconds`.
  void drive(MujocoPlant& plant, const MadeRobot& robot, double left, double right, double seconds) {
    for (int k = 1; k <= std::lround((1 + seconds) / 0.001); ++k) {
      const double part = std::min(1.0, k * 0.001);
      turn(plant, robot, part * left, part * right);
    }
  }

  std::vector<double> integral_;
  MujocoPlantParameters parameters_;
};

MadeRobot skid_steer(double length) {
  MadeRobot robot;
  robot.axles = {length / 2, -length / 2};
  robot.body_mass = 56;
  return robot;
}

class SkidSteer : public BrushTyreTest, public testing::WithParamInterface<double> {};

// Coulomb's moment balance of four equally loaded wheels is 1 + (L/B)². The body leans and loads differ: 2 %.
TEST_P(SkidSteer, TurnsByTheFactorOfCoulombFriction) {
  const MadeRobot robot = skid_steer(GetParam());
  auto plant = started(robot);
  drive(*plant, robot, -3, 3, 3);
  const SensorFrame frame = sensors(*plant);
  const double geometric = robot.radius * (frame.joints[3].velocity - frame.joints[0].velocity) / robot.wheel_base;
  const double expected = 1 + std::pow(GetParam() / robot.wheel_base, 2);
  EXPECT_NEAR(geometric / truth(*plant).twist_base.angular[2], expected, 0.02 * expected);
}

TEST_P(SkidSteer, DoesNotHop) {
  const MadeRobot robot = skid_steer(GetParam());
  auto plant = started(robot);
  drive(*plant, robot, -3, 3, 1);
  int grounded = 0;
  for (int k = 0; k < 1000; ++k) {
    turn(*plant, robot, -3, 3);
    const TruthFrame frame = truth(*plant);
    grounded +=
        std::all_of(frame.normal_force.begin(), frame.normal_force.begin() + 4, [](double force) { return force > 0; });
  }
  EXPECT_GT(grounded, 990);
}

INSTANTIATE_TEST_SUITE_P(BrushTyre, SkidSteer, testing::Values(0.2, 0.4, 0.6));

class LockedWheels : public BrushTyreTest, public testing::WithParamInterface<double> {};

// All the weight is on the four wheels: a = μ g. Over the middle of the stop, past the load's first swing forward.
TEST_P(LockedWheels, SlideWithTheFrictionOfTheGround) {
  const MadeRobot robot = skid_steer(0.4);
  parameters_.ground_friction = GetParam();
  auto plant = started(robot);
  drive(*plant, robot, 30, 30, 1);
  std::vector<JointCommand> locked(4, velocity_command(0));
  for (JointCommand& wheel : locked) wheel.damping = 0.4 * robot.wheel_inertia() / 0.001;
  for (int k = 0; k < 50; ++k) plant->write(locked);
  const double before = truth(*plant).twist_base.linear[0];
  for (int k = 0; k < 150; ++k) plant->write(locked);
  const double deceleration = (before - truth(*plant).twist_base.linear[0]) / 0.150;
  EXPECT_NEAR(deceleration, GetParam() * kEarthGravity, 0.02 * GetParam() * kEarthGravity);
}

INSTANTIATE_TEST_SUITE_P(BrushTyre, LockedWheels, testing::Values(0.3, 0.6, 1.0));

class OfAnySize : public BrushTyreTest, public testing::WithParamInterface<MadeRobot> {};

// Creep stays below 1 % at walking pace, as tyre.h says; nothing moves when braked.
TEST_P(OfAnySize, DrivesTurnsAndStands) {
  const MadeRobot& robot = GetParam();
  auto plant = started(robot);
  const double speed = 0.3 / robot.radius;
  drive(*plant, robot, speed, speed, 2);
  EXPECT_NEAR(truth(*plant).twist_base.linear[0], 0.3, 0.003);
  const double turn = 0.25 * robot.wheel_base / robot.radius;
  drive(*plant, robot, -turn, turn, 2);
  EXPECT_NEAR(truth(*plant).twist_base.angular[2], 0.5, 0.005);
  std::vector<JointCommand> brakes(2);
  for (int k = 0; k < 10000; ++k) plant->write(brakes);
  const Vector3 rest = truth(*plant).pose_world.position;
  for (int k = 0; k < 30000; ++k) plant->write(brakes);
  EXPECT_LT(distance(truth(*plant).pose_world.position, rest), 0.001);
  EXPECT_EQ(sensors(*plant).faults, 0u);
}

MadeRobot heavy() {
  MadeRobot robot;
  robot.body_mass = 450;
  robot.body_x = -0.2;
  robot.ball_x = -0.5;
  robot.wheel_mass = 5;
  robot.effort = 200;
  return robot;
}

MadeRobot light() {
  MadeRobot robot;
  robot.wheel_base = 0.1;
  robot.radius = 0.015;
  robot.width = 0.005;
  robot.wheel_mass = 0.05;
  robot.body_mass = 1;
  robot.body_x = -0.02;
  robot.ball_x = -0.05;
  robot.effort = 0.5;
  return robot;
}

INSTANTIATE_TEST_SUITE_P(BrushTyre, OfAnySize, testing::Values(heavy(), light()),
                         [](const auto& made) { return made.param.body_mass > 100 ? "of450kg" : "of1kg"; });

}  // namespace robot_control::tests
