#pragma once
/// Everything a user sets, as structs. The schema below is the only place that knows a YAML key.
///
/// A tree of values (YAML file first, then overlays: a parameter server, a Python dict) is read into
/// `Parameters` at once. Missing, unknown, mistyped, NaN, infinite and out-of-range values are collected, and
/// one ParameterError lists them all: path, value, rule, unit, origin.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "control/drive_controller.h"
#include "drivers/mujoco_plant_parameters.h"
#include "estimation/estimator.h"
#include "robot/robot_model.h"
#include "safety/safety_monitor.h"

namespace robot_control {

class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class ClockMode { kWall, kLockstep };
enum class RealtimePolicy { kRequired, kPreferred, kOff };

/// What all nodes must agree on (`robot:` block, beside the robot itself).
struct LoopParameters {
  double rate = 1000;                  ///< Hz, 100 … 2000
  ClockMode clock = ClockMode::kWall;
  RealtimePolicy realtime = RealtimePolicy::kPreferred;
  std::int64_t core = 0;               ///< the one core the chain is pinned to; -1 = not pinned
  std::string bus;                     ///< empty: from master and namespace
  std::string command_script;          ///< CSV path; empty: none
  bool wait_for_nodes = true;          ///< cycle 0 begins when all four nodes hold their channels
  bool wait_for_telemetry = false;     ///< … and telemetry is reading

  double period() const { return 1.0 / rate; }                                              ///< s
  std::int64_t period_ns() const { return static_cast<std::int64_t>(1.0e9 / rate + 0.5); }  ///< ns
};

/// Rates and names of what the nodes publish; nothing of it touches the loop.
struct ReportParameters {
  double joint_states_rate = 100;     ///< Hz
  double odom_rate = 50;              ///< Hz
  bool publish_tf = true;
  std::string odom_frame = "odom";
  std::string base_frame = "base_link";
  double command_rate = 50;           ///< Hz, joint_commands, joint_targets and cmd_vel_out
  double imu_rate = 100;              ///< Hz
  double truth_rate = 50;             ///< Hz
};

struct TelemetryParameters {
  std::string directory;              ///< where runs are written
};

struct Parameters {
  std::string urdf;                   ///< path; relative to the file it stands in
  RobotParameters robot;
  LoopParameters loop;
  MujocoPlantParameters plant;
  EstimatorParameters estimator;
  DriveControllerParameters controller;
  SafetyParameters safety;
  ReportParameters report;
  TelemetryParameters telemetry;
};

/// One value laid over the file: path "robot.rate", YAML text "500", origin "/robot/rate".
struct Overlay {
  std::string path;
  std::string text;
  std::string origin;
};

/// Throws ParameterError.
Parameters read_parameters(const std::string& yaml_path, const std::vector<Overlay>& overlays = {});

}  // namespace robot_control
