/// Real robots, as their makers publish them, on the plant alone: they stand still and stop without tipping
/// (support/robots/corpus.h).

#include <cstdlib>
#include <filesystem>

#include "drivers/mujoco/plant_fixture.h"
#include "drivers/mujoco/sensors/integrated_force.h"
#include "support/robots/corpus.h"

namespace robot_control::tests {

namespace fs = std::filesystem;

struct RealRobot : testing::TestWithParam<const char*> {
  void SetUp() override { set_down({}); }

  void set_down(std::optional<double> ground_friction) {
    if (corpus().empty()) GTEST_SKIP() << kNoCorpus;
    const fs::path folder = corpus() / GetParam();
    setenv("ROS_PACKAGE_PATH", folder.c_str(), 1);
    MujocoPlantParameters parameters;
    parameters.scene = kFlat;
    parameters.sensor_errors = ErrorLevel::kIdeal;
    parameters.ground_friction = ground_friction;
    robot_ = read_drive_train(load_description((folder / "robot.urdf").string()), {});
    plant_ = std::make_unique<MujocoPlant>(robot_, parameters, 0.001);
    plant_->start();
  }

  TruthFrame truth() {
    TruthFrame frame;
    plant_->truth(frame);
    return frame;
  }
  void brake(int steps) {
    const std::vector<JointCommand> brakes(robot_.joints.size());
    for (int k = 0; k < steps; ++k) plant_->write(brakes);
  }
  /// One cycle with the rims at these speeds (m/s), with wheel loops as the controller's.
  void step(double left, double right) {
    std::vector<JointCommand> commands(robot_.joints.size());
    SensorFrame sensors;
    plant_->read(sensors);
    integral_.resize(robot_.wheels.size());
    for (const WheelModel& wheel : robot_.wheels) {
      JointCommand& command = commands[wheel.joint];
      command.mode = JointMode::kVelocity;
      command.velocity = (wheel.side == Side::kLeft ? left : right) / wheel.radius * wheel.sign;
      command.damping = 0.4 * wheel.inertia / 0.001;
      integral_[wheel.joint] +=
          command.damping / 0.1 * (command.velocity - sensors.joints[wheel.joint].velocity) * 0.001;
      command.effort = integral_[wheel.joint];
    }
    plant_->write(commands);
  }
  /// Ramps the rims to these speeds (m/s) in two seconds and goes on for one.
  void drive(double left, double right) {
    integral_.clear();
    for (int k = 1; k <= 3000; ++k) step(std::min(1.0, k / 2000.0) * left, std::min(1.0, k / 2000.0) * right);
  }
  double full_speed() const {
    double speed = 1;  // m/s, if the description has no limit
    for (const WheelModel& wheel : robot_.wheels) {
      const double limit = robot_.joints[wheel.joint].velocity_limit;
      if (limit > 0) speed = std::min(speed, limit * wheel.radius);
    }
    return speed;
  }
  /// rad, between the robot's up and the world's.
  double tilt() const {
    const mjtNum up[3] = {0, 0, 1};
    mjtNum turned[3];
    mju_rotVecQuat(turned, up, plant_->data()->qpos + plant_->model().base_position + 3);
    return std::acos(std::min(1.0, turned[2]));
  }

  DriveTrain robot_;
  std::unique_ptr<MujocoPlant> plant_;
  std::vector<double> integral_;
};

TEST_P(RealRobot, WeighsWhatItsLinksWeigh) {
  const MujocoModel& model = plant_->model();
  EXPECT_NEAR(model.model->body_subtreemass[model.base_body], robot_.mass, 1e-6 * robot_.mass);
}

TEST_P(RealRobot, StandsStillForHalfAMinute) {
  brake(30000);
  const Vector3 moved = truth().pose_world.position;
  EXPECT_LT(std::hypot(moved[0], moved[1], moved[2]), 0.001);
}

TEST_P(RealRobot, StopsHardFromFullSpeedWithoutTipping) {
  for (const double direction : {1.0, -1.0}) {
    drive(direction * full_speed(), direction * full_speed());
    double tipped = 0;
    for (int k = 0; k < 3000; ++k) {
      brake(1);
      tipped = std::max(tipped, tilt());
    }
    EXPECT_LT(tipped, 10 * M_PI / 180);
    EXPECT_NEAR(truth().twist_base.linear[0], 0, 0.001);
  }
}

// The rate is 0.5 rad/s, or as much as the wheels' speed limits allow.
TEST_P(RealRobot, TurnsWithoutHopping) {
  const double rim = std::min(0.25 * robot_.effective_wheel_base(), 0.6 * full_speed());
  drive(-rim, rim);
  int grounded = 0;
  for (int k = 0; k < 2000; ++k) {
    step(-rim, rim);
    const TruthFrame frame = truth();
    const auto* first = frame.normal_force.begin();
    grounded += std::all_of(first, first + robot_.wheels.size(), [](double force) { return force > 0; });
  }
  EXPECT_GT(grounded, 1980);
  EXPECT_GT(truth().twist_base.angular[2], 0.8 * 2 * rim / robot_.effective_wheel_base()) << "it does turn";
}

// The drive goes from rest to full speed, a turn, and the brake: the accelerometer integrates to the velocity
// (SensorFrame).
TEST_P(RealRobot, MeasuresTheForceThatMovesIt) {
  IntegratedForce force(robot_.imu_in_base, 0.001);
  const auto look = [&] {
    SensorFrame sensors;
    plant_->read(sensors);
    force.add(sensors, truth());
  };
  const double turn = std::min(0.25 * robot_.effective_wheel_base(), 0.6 * full_speed());
  for (int k = 0; k < 4000; ++k) {
    if (k < 2000)
      step(std::min(1.0, k / 1000.0) * full_speed(), std::min(1.0, k / 1000.0) * full_speed());
    else if (k < 3000)
      step(-turn, turn);
    else
      brake(1);
    look();
  }
  EXPECT_LT(force.worst(), 0.001);
}

struct RealRobotOnIce : RealRobot {
  static constexpr double kFriction = 0.3;  // no robot tips

  void SetUp() override { set_down(kFriction); }

  /// Springs that hold the wheels at their present angles: μ N moves their rims by a millimetre.
  std::vector<JointCommand> locks() {
    SensorFrame sensors;
    plant_->read(sensors);
    std::vector<JointCommand> commands(robot_.joints.size());
    for (const WheelModel& wheel : robot_.wheels) {
      commands[wheel.joint] = {.mode = JointMode::kImpedance,
                               .position = sensors.joints[wheel.joint].position,
                               .stiffness = 0.06 * wheel.inertia / 1e-6,
                               .damping = 0.4 * wheel.inertia / 1e-3};
    }
    return commands;
  }
};

// Fixed casters slide without friction; rolling ones have to be slowed as well, as masses of J/r².
TEST_P(RealRobotOnIce, SlidesOnLockedWheelsWithFrictionTimesTheirLoad) {
  drive(full_speed(), full_speed());
  const std::vector<JointCommand> locked = locks();
  for (int k = 0; k < 100; ++k) plant_->write(locked);  // until suspensions have dived
  const double before = truth().twist_base.linear[0];
  double load = 0;
  constexpr int kCycles = 60;
  for (int k = 0; k < kCycles; ++k) {
    plant_->write(locked);
    const TruthFrame frame = truth();
    for (std::size_t i = 0; i < robot_.wheels.size(); ++i) load += frame.normal_force[i] / kCycles;
  }
  double mass = robot_.mass;
  for (const WheelModel& caster : robot_.casters) mass += caster.inertia / (caster.radius * caster.radius);
  const double deceleration = (before - truth().twist_base.linear[0]) / (kCycles * 0.001);
  EXPECT_NEAR(deceleration, kFriction * load / mass, 0.02 * kFriction * load / mass);
}

// diffbot_ros2control is left out, because its 15 mm/s are over within 5 ms.
INSTANTIATE_TEST_SUITE_P(Corpus, RealRobotOnIce,
                         testing::Values("jackal", "kobuki", "create3", "pmb2", "boxer", "scout_v2", "p3dx_mario",
                                         "linorobot2_2wd", "rosbot2r", "dingo_d", "create_2"),
                         [](const auto& named) { return std::string(named.param); });

INSTANTIATE_TEST_SUITE_P(Corpus, RealRobot,
                         testing::Values("jackal", "kobuki", "create3", "pmb2", "boxer", "diffbot_ros2control",
                                         "scout_v2", "p3dx_mario", "linorobot2_2wd", "rosbot2r", "dingo_d", "create_2"),
                         [](const auto& named) { return std::string(named.param); });

}  // namespace robot_control::tests
