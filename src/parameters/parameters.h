#pragma once
/// Everything a user sets, as structs. The YAML keys stand in schema.h alone.
///
/// A tree of values (YAML file first, then overlays: a parameter server, a Python dict) is read into
/// `Parameters` at once. Missing, unknown, mistyped, NaN, infinite and out-of-range values are collected, and
/// one ParameterError lists them all: path, value, rule, unit, origin.

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

/// What all nodes must agree on (`robot:` block, beside the robot itself).
struct LoopParameters {
  double rate = 1000;  ///< Hz, 100 … 2000
  ClockMode clock = ClockMode::kWall;
  RealtimePolicy realtime = RealtimePolicy::kPreferred;
  std::int64_t core = 0;  ///< the one core the chain is pinned to; -1 = not pinned
  FailAction fail_action = FailAction::kBrake;
  std::string bus;                  ///< empty: from master and namespace
  std::string command_script;       ///< CSV path; empty: none
  bool wait_for_nodes = false;      ///< cycle 0 begins when all four nodes hold their channels; always in lockstep
  bool wait_for_telemetry = false;  ///< … and telemetry is reading

  double period() const { return 1.0 / rate; }                           ///< s
  std::int64_t period_ns() const { return std::llround(1.0e9 / rate); }  ///< ns
};

/// Variances of x, y, z, in m² or m²/s², and about x, y, z, in rad² or rad²/s².
using CovarianceDiagonal = std::array<double, 6>;

/// Rates and names of what the nodes publish; nothing of it touches the loop.
struct ReportParameters {
  double joint_states_rate = 100;  ///< Hz
  double odom_rate = 50;           ///< Hz, odom and wheel_odom
  bool publish_tf = true;
  std::string odom_frame = "odom";
  std::string base_frame;  ///< empty: the robot's root link, so that no frame gets two parents (REP 105)
  std::optional<CovarianceDiagonal> pose_covariance_diagonal;   ///< of odom; none: as estimated
  std::optional<CovarianceDiagonal> twist_covariance_diagonal;  ///< likewise
  double command_rate = 50;    ///< Hz, joint_commands, joint_targets, cmd_vel_out and drive_state
  double imu_rate = 100;       ///< Hz, imu/data_raw
  double imu_data_rate = 100;  ///< Hz, imu/data
  double truth_rate = 50;      ///< Hz
};

struct Parameters {
  std::string urdf;  ///< path; relative to the file it stands in
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
  std::optional<double> no_effect;    ///< of a key of an earlier version
  std::vector<std::string> warnings;  ///< values that were accepted although they are written in an old way
};

/// One value laid over the file: path "robot.rate", YAML text "500", origin "/robot/rate". A condition of the safety
/// monitor is a map: path "safety_monitor.tilt.limit" sets one value in it, "safety_monitor.tilt" those it names.
struct Overlay {
  std::string path;
  std::string text;  ///< a scalar, or a list or a map in brackets; an empty text is the empty string
  std::string origin;
};

/// Throws ParameterError. The file consists of the blocks `robot`, `mujoco_plant`, `state_estimator`,
/// `diff_drive_controller`, `safety_monitor`, `telemetry`; every key must be there, in the file or in an overlay,
/// except what the URDF gives (`robot.wheel_base`, …) or what is derived from it (`pid_kp`, …): those that are
/// kOptional in the schema. With an empty `yaml_path` the overlays are everything there is.
///
/// `base_path`: a complete file over which that of `yaml_path` is laid key by key, so that it may hold only the keys
/// that it changes; empty, not there or the same file: none.
///
/// A file that is a configuration of ros_controllers' or ros2_controllers' diff_drive_controller is one problem.
///
/// Relative paths of input files (`urdf`, `scene`, `command_script`) count from the folder of the YAML file, in
/// an overlay from the current folder; they come out absolute.
Parameters read_parameters(const std::string& yaml_path, const std::vector<Overlay>& overlays = {},
                           const std::string& base_path = "");

}  // namespace robot_control
