#pragma once
/// These structs hold everything that a user sets. Their YAML keys are in schema.cpp.
///
/// A tree of values (the YAML file, then overlays from a parameter server or a Python dict) is read into `Parameters`
/// at once. Missing, unknown, mistyped, NaN, infinite and out-of-range values are collected. One ParameterError lists
/// them all with path, value, rule, unit and origin.

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "control/drive_controller.h"
#include "drivers/mujoco_plant_parameters.h"
#include "estimation/estimator.h"
#include "hal/gate_parameters.h"
#include "robot/robot_model.h"
#include "rt/realtime_thread.h"
#include "safety/safety_monitor.h"
#include "telemetry/log_parameters.h"

namespace robot_control {

class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class ClockMode { kWall, kLockstep };

/// Values on which all nodes must agree; they are in the block `robot:`, beside those of the robot itself.
struct LoopParameters {
  double rate = 1000;  ///< Hz, 100 … 2000
  ClockMode clock = ClockMode::kWall;
  RealtimePolicy realtime = RealtimePolicy::kPreferred;
  std::int64_t core = 0;  ///< core to which the real-time threads are pinned; -1: not pinned
  FailAction fail_action = FailAction::kBrake;
  std::string bus;                  ///< empty: derived from master and namespace
  std::string command_script;       ///< CSV path; empty: none
  bool wait_for_nodes = false;      ///< cycle 0 begins when all four nodes hold their channels; always in lockstep
  bool wait_for_telemetry = false;  ///< … and when telemetry reads

  double period() const { return 1.0 / rate; }                           ///< s
  std::int64_t period_ns() const { return std::llround(1.0e9 / rate); }  ///< ns
};

/// Variances along x, y, z in m² or m²/s², and about x, y, z in rad² or rad²/s².
using CovarianceDiagonal = std::array<double, 6>;

/// Rates and frame names of the published topics; they have no effect on the loop.
struct ReportParameters {
  double joint_states_rate = 100;  ///< Hz
  double odom_rate = 50;           ///< Hz, odom and wheel_odom
  bool publish_tf = true;
  std::string odom_frame = "odom";
  std::string base_frame;  ///< empty: the robot's root link, so that no frame gets two parents (REP 105)
  std::optional<CovarianceDiagonal> pose_covariance_diagonal;   ///< for odom; none: as estimated
  std::optional<CovarianceDiagonal> twist_covariance_diagonal;  ///< for odom; none: as estimated
  double command_rate = 50;    ///< Hz, joint_commands, joint_targets, cmd_vel_out and drive_state
  double imu_rate = 100;       ///< Hz, imu/data_raw
  double imu_data_rate = 100;  ///< Hz, imu/data
  double truth_rate = 50;      ///< Hz
};

struct Parameters {
  std::string urdf;  ///< path, relative to the folder of the file that names it
  RobotParameters robot;
  LoopParameters loop;
  MujocoPlantParameters plant;
  EstimatorParameters estimator;
  std::string calibration_file;  ///< path, see calibration_file.h; empty: none
  DriveControllerParameters controller;
  std::string command_sources;  ///< path, see command_sources.h; empty: none, cmd_vel and cmd_vel_stamped command
  SafetyParameters safety;
  std::string latch_file;  ///< path, see runtime/latch_file.h; empty: none
  ReportParameters report;
  TelemetryParameters telemetry;
  std::optional<double> no_effect;    ///< value of a key of an earlier version
  std::vector<std::string> warnings;  ///< about accepted values in an old form
};

/// One value that is laid over the file: path "robot.rate", YAML text "500", origin "/robot/rate". A condition of the
/// safety monitor is a map. The path "safety_monitor.tilt.limit" sets one value of it, "safety_monitor.tilt" all values
/// that the text names.
struct Overlay {
  std::string path;
  std::string text;  ///< a scalar, or a list or a map in brackets; an empty text is the empty string
  std::string origin;
};

/// Throws ParameterError. The file consists of the blocks `robot`, `mujoco_plant`, `state_estimator`,
/// `diff_drive_controller`, `safety_monitor`, `telemetry`. Every key must be in the file or in an overlay, unless it is
/// kOptional in the schema. Optional values come from the URDF (`robot.wheel_base`, …) or are derived from it
/// (`pid_kp`, …). With an empty `yaml_path` only the overlays are read.
///
/// `base_path` names a complete file over which that of `yaml_path` is laid key by key. The latter may therefore hold
/// only the keys that it changes. It has no effect if it is empty, does not exist or names the same file.
///
/// A file that is a configuration of ros_controllers' or ros2_controllers' diff_drive_controller is one problem.
///
/// Relative paths of input files (`urdf`, `scene`, `command_script`) refer to the folder of the YAML file, in an
/// overlay to the current folder. The returned paths are absolute.
Parameters read_parameters(const std::string& yaml_path, const std::vector<Overlay>& overlays = {},
                           const std::string& base_path = "");

}  // namespace robot_control
