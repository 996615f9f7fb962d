#pragma once
/// Parameters hold everything that a user sets: the blocks that the folders declare (parameters/block.h), composed.
///
/// A tree of values (the YAML file, then overlays from a parameter server or a Python dict) is read into `Parameters`
/// at once. Missing, unknown, mistyped, NaN, infinite and out-of-range values are collected. One ParameterError lists
/// them all with path, value, rule, unit and origin.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "configuration/loop_parameters.h"
#include "control/legged/leg_controller_parameters.h"
#include "control/wheeled/drive_controller_parameters.h"
#include "drivers/mujoco/mujoco_plant_parameters.h"
#include "estimation/wheeled/estimator_parameters.h"
#include "log/log_parameters.h"
#include "machine/legs/leg_parameters.h"
#include "machine/wheeled/drive_train_parameters.h"
#include "navigation/navigation_parameters.h"
#include "parameters/block.h"
#include "parameters/parameter_tree.h"
#include "parameters/problem_list.h"
#include "parameters/schema.h"
#include "safety/safety_parameters.h"
#include "signals/robot_kinds.h"

namespace robot_control {

/// Variances along x, y, z in m² or m²/s², and about x, y, z in rad² or rad²/s².
using CovarianceDiagonal = NumberList<6>;

/// Rates and frame names of the published topics; they have no effect on the loop. Their keys are in the block of the
/// node that publishes.
struct ReportParameters {
  double joint_states_rate = 100;  ///< Hz
  double odom_rate = 50;           ///< Hz, odom and wheel_odom
  bool publish_tf = true;
  std::string odom_frame = "odom";
  std::string base_frame;  ///< empty: the robot's root link, so that no frame gets two parents (REP 105)
  std::optional<CovarianceDiagonal> pose_covariance_diagonal;   ///< for odom; none: as estimated
  std::optional<CovarianceDiagonal> twist_covariance_diagonal;  ///< for odom; none: as estimated
  double command_rate = 50;    ///< Hz, joint_commands, joint_targets, cmd_vel_out and drive_state
  double leg_state_rate = 50;  ///< Hz, leg_state
  double imu_rate = 100;       ///< Hz, imu/data_raw
  double imu_data_rate = 100;  ///< Hz, imu/data
  double truth_rate = 50;      ///< Hz
};

inline Keys plant_keys(ReportParameters& report) {
  return {
      {"imu_rate", &report.imu_rate, "Hz", 0.1, 2000, kPublishRate},
      {"truth_rate", &report.truth_rate, "Hz", 0.1, 2000, kPublishRate},
  };
}

inline Keys estimator_keys(ReportParameters& report) {
  return {
      {"joint_states_rate", &report.joint_states_rate, "Hz", 0.1, 2000, kPublishRate},
      {"odom_rate", &report.odom_rate, "Hz", 0.1, 2000, kPublishRate},
      {"imu_rate", &report.imu_data_rate, "Hz", 0.1, 2000, kPublishRate},
      {"publish_tf", &report.publish_tf},
      {"odom_frame", &report.odom_frame},
      {"base_frame", &report.base_frame, {}, 0, 0, kMayBeEmpty},
      {"pose_covariance_diagonal", &report.pose_covariance_diagonal, {}, 0, 1e9, kOptional},
      {"twist_covariance_diagonal", &report.twist_covariance_diagonal, {}, 0, 1e9, kOptional},
  };
}

inline Keys leg_control_keys(ReportParameters& report) {
  return {{"state_rate", &report.leg_state_rate, "Hz", 0.1, 2000, kPublishRate}};
}

inline Keys controller_keys(ReportParameters& report) {
  return {{"command_rate", &report.command_rate, "Hz", 0.1, 2000, kPublishRate}};
}

/// The driver that stands before the machine: the simulated machine, or a word of drivers/drive_table.def.
enum class DriverName : std::uint8_t { kMujoco };

inline std::vector<Word> words_of(DriverName) {
  std::vector<Word> words{{"mujoco", DriverName::kMujoco}};
  const auto add = [&](std::string_view driver) {
    if (words.back().text != driver) words.emplace_back(driver, static_cast<DriverName>(words.size()));
  };
#define DRIVE(name, driver, ...) add(#driver);
#include "drivers/drive_table.def"
  return words;
}

/// The kind of the robot.
enum class KindChoice { kDerived, kOnWheels, kOnLegs };  ///< derived: found in the URDF (robots/robot_kind.h)

inline std::vector<Word> words_of(KindChoice) {
  return {{"derived", KindChoice::kDerived}, {"wheels", KindChoice::kOnWheels}, {"legs", KindChoice::kOnLegs}};
}

/// The IMU of a real machine.
enum class ImuChoice {
  kDriver,  ///< what the driver measures, if anything
  kTopic,   ///< sensor_msgs/Imu of another node
  kNone,    ///< not used
};

inline std::vector<Word> words_of(ImuChoice) {
  return {{"driver", ImuChoice::kDriver}, {"topic", ImuChoice::kTopic}, {"none", ImuChoice::kNone}};
}

struct Parameters {
  std::string urdf;  ///< path, relative to the folder of the file that names it
  KindChoice kind = KindChoice::kDerived;
  bool simulated_laser = false;  ///< a URDF without the link of a laser gets one (machine/bodies/added_laser.h)
  DriveTrainParameters robot;
  LegParameters legs;  ///< in the block `robot`, too
  LoopParameters loop;
  DriverName driver = DriverName::kMujoco;
  std::string drives;  ///< path, see drivers/table/read_drive_file.h; empty: the simulated motors are given their
                       ///< torques directly
  ImuChoice imu = ImuChoice::kDriver;
  MujocoPlantParameters plant;
  EstimatorParameters estimator;
  std::string calibration_file;  ///< path, see calibration_file.h; empty: none
  DriveControllerParameters controller;
  LegControllerParameters leg_control;
  std::string command_sources;  ///< path, see command_sources.h; empty: none, cmd_vel and cmd_vel_stamped command
  SafetyParameters safety;
  std::string latch_file;  ///< path, see loop/latch_file.h; empty: none
  ReportParameters report;
  TelemetryParameters telemetry;
  navigation::SlamParameters slam;
  navigation::LocalizationParameters localization;
  navigation::NavigateParameters navigate;
  navigation::GuardParameters collision_guard;
  std::optional<double> no_effect;    ///< value of a key of an earlier version
  std::vector<std::string> warnings;  ///< about accepted values in an old form
};

/// Returns the programs of a robot of this kind. The driver is the simulator's (signals/roles.h), or `driver` for all
/// others.
Programs programs_of(const Parameters& parameters, std::string_view kind) noexcept;

/// Returns the blocks of the file with their places in `parameters`, which must outlive it: `robot`, one per role
/// (signals/roles.h), and one per program of navigation.
Schema schema(Parameters& parameters);

/// Throws ParameterError. Every key of the schema must be in the file or in an overlay, unless it is kOptional.
/// Optional values come from the URDF (`robot.wheel_base`, …) or are derived from it (`pid_kp`, …). With an empty
/// `yaml_path` only the overlays are read.
///
/// `base_path` names a complete file over which that of `yaml_path` is laid key by key. The latter may therefore hold
/// only the keys that it changes. It has no effect if it is empty, does not exist or names the same file.
///
/// A file that is a configuration of ros_controllers' or ros2_controllers' diff_drive_controller is one problem.
///
/// Relative paths of input files (`urdf`, `scene`, `command_script`) refer to the folder of the YAML file, in an
/// overlay to caller_folder(). The returned paths are absolute.
Parameters read_parameters(const std::string& yaml_path, const std::vector<Overlay>& overlays = {},
                           const std::string& base_path = "");

/// Returns the text of a complete YAML file, which read_parameters reads back as the same values. Derived values are
/// left out, and paths are absolute.
std::string parameters_text(Parameters parameters);

}  // namespace robot_control
