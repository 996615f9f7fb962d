/// The exact accelerometer integrates to the velocity with any damping of the joints (specific_force.h). The bound is 1
/// mm/s over any second: with the wheels ramped up, in a curve, on the spot, and braked hard.

#include "drivers/mujoco/plant_fixture.h"
#include "drivers/mujoco/sensors/integrated_force.h"
#include "support/robots/made_robot.h"

namespace robot_control::tests {

struct Case {
  const char* name;
  DriveTrain robot;
};

DriveTrain diffbot() {
  return read_drive_train(diffbot_urdf(), {});
}

/// diffbot with its IMU turned about two axes and far from the wheels' middle.
DriveTrain diffbot_with_a_remote_imu() {
  return read_drive_train(
      diffbot_with("<joint name=\"imu_joint\"", "xyz=\"0.05 0.02 0.06\"", "xyz=\"0.4 -0.3 0.5\" rpy=\"1.2 0.3 -2\""),
      {});
}

DriveTrain skid_steer() {
  MadeRobot made;
  made.axles = {0.2, -0.2};
  made.effort = 20;
  return made.model();
}

struct Accelerometer : testing::TestWithParam<std::tuple<double, double>> {
  /// m/s, the largest error over a second of a drive.
  static double worst(const DriveTrain& robot, double damping, double period) {
    MujocoPlantParameters parameters;
    parameters.scene = kFlat;
    parameters.sensor_errors = ErrorLevel::kIdeal;
    parameters.motor_damping = damping;
    MujocoPlant plant(robot, parameters, period);
    plant.start();
    IntegratedForce force(robot.imu_in_base, period);
    const auto second = static_cast<int>(std::lround(1 / period));
    for (int k = 0; k < 5 * second; ++k) {
      const double speed = std::min(1.0, static_cast<double>(k) / second) * 6;
      const std::array<std::array<double, 2>, 5> phases{{{1, 1}, {1, 1}, {0.4, 1}, {-0.4, 0.4}, {0, 0}}};
      const auto& phase = phases[static_cast<std::size_t>(k / second)];
      std::vector<JointCommand> commands(robot.joints.size());
      for (const WheelModel& wheel : robot.wheels) {
        if (k < 4 * second) commands[wheel.joint] = velocity_command(speed * phase[wheel.side == Side::kLeft ? 0 : 1]);
      }
      plant.write(commands);
      SensorFrame sensors;
      TruthFrame truth;
      plant.read(sensors);
      plant.truth(truth);
      force.add(sensors, truth);
    }
    return force.worst();
  }
};

TEST_P(Accelerometer, IntegratesToTheVelocity) {
  const auto& [damping, period] = GetParam();
  for (const auto& [name, robot] :
       {Case{"diffbot", diffbot()}, {"remote IMU", diffbot_with_a_remote_imu()}, {"skid steer", skid_steer()}}) {
    EXPECT_LT(worst(robot, damping, period), 0.001) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(DampingAndPeriod, Accelerometer,
                         testing::Combine(testing::Values(0, 0.01, 0.1, 1), testing::Values(0.01, 0.001)));

}  // namespace robot_control::tests
