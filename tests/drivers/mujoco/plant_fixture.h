#pragma once
/// The healthy plant: diffbot on a flat floor at 1 kHz, as it stands after `start`.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>

#include "drivers/mujoco/mujoco_plant.h"
#include "support/robots/diffbot_urdf.h"

namespace robot_control {

inline constexpr const char* kFlat = PROJECT_DIRECTORY "/urdf/scenes/flat.xml";
inline constexpr const char* kSlope = PROJECT_DIRECTORY "/urdf/scenes/slope_5deg.xml";

/// Writes a scene into the tests' directory; returns its path.
inline std::string scene_file(const std::string& name, const std::string& text) {
  const std::string path = testing::TempDir() + name;
  std::ofstream(path) << text;
  return path;
}

inline std::array<JointCommand, 2> both(const JointCommand& left, const JointCommand& right) {
  return {left, right};
}

inline JointCommand effort_command(double effort) {
  JointCommand command;
  command.mode = JointMode::kEffort;
  command.effort = effort;
  return command;
}

/// damping · dt / J = 0.4 on a wheel off the ground.
inline JointCommand velocity_command(double velocity) {
  JointCommand command;
  command.mode = JointMode::kVelocity;
  command.velocity = velocity;
  command.damping = 2.0;
  return command;
}

struct PlantTest : testing::Test {
  std::unique_ptr<MujocoPlant> started(const RobotDescription& description, const std::string& scene,
                                       double period = 0.001, const DriveTrainParameters& robot = {}) {
    MujocoPlantParameters parameters;
    parameters.scene = scene;
    parameters.sensor_errors = ErrorLevel::kIdeal;
    parameters.tyre = tyre_;
    period_ = period;
    auto plant = std::make_unique<MujocoPlant>(read_drive_train(description, robot), parameters, period);
    plant->start();
    return plant;
  }
  std::unique_ptr<MujocoPlant> started(const std::string& scene = kFlat, double period = 0.001) {
    return started(diffbot_urdf(), scene, period);
  }

  void hold(MujocoPlant& plant, const std::array<JointCommand, 2>& commands, double seconds) const {
    for (int i = 0; i < std::lround(seconds / period_); ++i) plant.write(commands);
  }

  /// Reaches the wheel speeds (rad/s) on a ramp of one second, then one second more.
  void speed_up(MujocoPlant& plant, double left, double right) const {
    const auto steps = std::lround(1 / period_);
    for (int i = 1; i <= steps; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(steps);
      plant.write(both(velocity_command(part * left), velocity_command(part * right)));
    }
    hold(plant, both(velocity_command(left), velocity_command(right)), 1);
  }

  static SensorFrame sensors(MujocoPlant& plant) {
    SensorFrame frame;
    plant.read(frame);
    return frame;
  }
  static TruthFrame truth(MujocoPlant& plant) {
    TruthFrame frame;
    plant.truth(frame);
    return frame;
  }
  static double distance(const Vector3& a, const Vector3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  }

  double period_ = 0.001;
  TyreModel tyre_ = TyreModel::kBrush;
  const std::array<JointCommand, 2> brakes_{};
};

}  // namespace robot_control
