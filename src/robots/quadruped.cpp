#include "robots/quadruped.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "control/legged/leg_controller.h"
#include "control/legged/leg_tuning.h"
#include "control/legged/stand/body_bounds.h"
#include "control/legged/stand/nominal_stance.h"
#include "control/legged/walk/gait.h"
#include "control/legged/walk/walking_speed.h"
#include "drivers/table/drive_table.h"
#include "drivers/table/read_drive_file.h"
#include "estimation/legged/legged_estimator.h"
#include "parameters/problem_list.h"
#include "safety/conditions/legged/legged_conditions.h"
#include "safety/monitor.h"

namespace robot_control {
namespace {

/// s of the present speed that the body still moves after a request to halt, with legs of kReferenceLeg: quadbot at
/// 0.15 and 0.3 m/s (bench/navigation/guard.py).
constexpr double kRollOut = 0.26;

/// Returns the angles of a leg while the robot stands at that height [m], its foot where it lay.
LegAngles upright(const Leg& leg, double height) noexcept {
  const LegGeometry& geometry = leg.kinematics.geometry();
  Eigen::Vector3d foot = leg.kinematics.position(leg.lying);
  foot.z() = geometry.hip.z() + geometry.upper.z() - height;
  return leg.kinematics.inverse(foot).angles;
}

/// Returns why the drive cannot hold all positions of the joint; "" if it can.
std::string beyond_range(const JointModel& joint, const DriveCapability& able) {
  if (joint.range && able.lower <= joint.range->lower && joint.range->upper <= able.upper) return "";
  if (std::isinf(able.lower)) return "";
  const auto interval = [](double lower, double upper) {
    const auto rounded = [](double value) { return shortest(std::round(1000 * value) / 1000); };
    return rounded(lower) + " … " + rounded(upper) + " rad";
  };
  return joint.name + ".position_range: the joint " +
         (joint.range ? "moves in " + interval(joint.range->lower, joint.range->upper) : "turns without end") +
         ", but its drive holds positions in " + interval(able.lower, able.upper) +
         " only; set a wider position_range in the motor and the file, correct gear and offset, or set a smaller "
         "range in the URDF";
}

/// Throws ParameterError unless the drives close the impedance of each joint, and have its limits and its range.
void require_drives(const Parameters& parameters, const LegModel& machine) {
  std::vector<std::string> joints;
  for (const JointModel& joint : machine.joints) joints.push_back(joint.name);
  const std::unique_ptr<DriveFile> file = read_drive_file(parameters, joints);
  const std::string_view drive = file->request().drive;
  if (std::ranges::find(kDriveRows, drive, &DriveRow::name)->command != "impedance") {
    throw ParameterError("robot.drives = " + parameters.drives + ": " + std::string(drive) +
                         " drives do not close the impedance of a joint by themselves, and a robot on legs needs it. "
                         "Use drives that do (docs/drivers.md)");
  }
  std::string problems;
  const auto add = [&](const std::string& problem) {
    if (!problem.empty()) problems += (problems.empty() ? "" : "\n") + parameters.drives + ": " + problem;
  };
  const auto add_limit = [&](const JointModel& joint, const char* key, double of_drive, double of_joint) {
    if (of_drive >= of_joint) return;
    add(joint.name + "." + key + " = " + shortest(of_drive) + ": must be at least the limit of the joint, " +
        shortest(of_joint) + ", with which the robot plans; set a lower limit in the URDF, or use a stronger drive");
  };
  for (std::size_t i = 0; i < machine.joints.size(); ++i) {
    const DriveCapability able = file->capability(i);
    add_limit(machine.joints[i], "torque_limit", able.torque, machine.joints[i].effort_limit);
    add_limit(machine.joints[i], "velocity_limit", able.velocity, machine.joints[i].velocity_limit);
    add(beyond_range(machine.joints[i], able));
  }
  if (!problems.empty()) throw ParameterError(problems);
}

}  // namespace

Quadruped::Quadruped(const Parameters& parameters, const LegModel& machine)
    : parameters_(parameters), machine_(machine) {}

void Quadruped::require_drivable() const {
  if (parameters_.loop.fail_action == StopKind::kCoast) {
    throw ParameterError(
        "robot.fail_action = coast: without torque, a robot on legs falls. Remove it: the robot then folds its legs");
  }
  if (!parameters_.drives.empty()) require_drives(parameters_, machine_);
  if (parameters_.loop.rate < kMinWalkingRate) {
    throw ParameterError("robot.rate = " + shortest(parameters_.loop.rate) + " Hz: a robot on legs falls below " +
                         shortest(kMinWalkingRate) +
                         " Hz, because the forces of its feet change too late. Set at least that");
  }
  const auto rounded = [](double value) { return shortest(std::round(100 * value) / 100); };
  if (const std::optional<LegPlace> leg = nominal_stance(machine_).short_leg) {
    throw ParameterError(machine_.source + ": the leg " + name_of(*leg) +
                         " does not reach the ground while the robot stands " + rounded(leg_tuning(machine_).height) +
                         " m above it. Give its joints ranges that allow this");
  }
  if (const LoadedKnee knee = loaded_knee(machine_); knee.part > kMaxKneePart) {
    throw ParameterError(machine_.source + ": the knee " + machine_.joints[knee.joint].name + " needs " +
                         rounded(knee.effort) + " N·m for half of the weight, as in a trot: " + rounded(knee.part) +
                         " of its effort limit, at most " + shortest(kMaxKneePart) +
                         ". Give a stronger motor, or a lighter robot");
  }
}

SafetyParameters Quadruped::limits() const {
  SafetyParameters limits = legged_limits(parameters_.safety, machine_);
  limits.ramp_time =
      std::max(limits.ramp_time, walk_ending_time(parameters_.leg_control, machine_) + lying_down_time(machine_));
  if (!limits.stop_delay) limits.stop_delay = kRollOut * std::sqrt(machine_.leg_length() / kReferenceLeg);
  limits.imu_lost.reaction = limits.imu_stuck.reaction = limits.imu_jump.reaction = Reaction::kBrake;
  limits.lift.reaction = Reaction::kOff;  // a robot that lies stands on no foot
  double& silence = limits.encoders_lost.persistence;
  silence = std::max(silence, tolerated_silence(parameters_, true));
  return limits;
}

std::uint64_t Quadruped::executable() const noexcept {
  return LegController::kExecutable;
}

std::unique_ptr<EstimatorLaw> Quadruped::make_estimator() const {
  return std::make_unique<EstimatorOf<LeggedEstimator>>(machine_, parameters_.loop.period());
}

std::unique_ptr<ControllerLaw> Quadruped::make_controller() const {
  return std::make_unique<ControllerOf<LegController>>(machine_, parameters_.leg_control, parameters_.loop.period());
}

std::unique_ptr<MonitorLaw> Quadruped::make_monitor() const {
  return std::make_unique<MonitorOf<Monitor<LeggedConditions>>>(limits(), machine_, parameters_.loop.period());
}

MachineNeeds Quadruped::needs() const {
  return {.modes = {JointMode::kBrake, JointMode::kImpedance},
          .inputs = {MachineInput::kJointMotion, MachineInput::kJointEffort, MachineInput::kImu}};
}

std::vector<Brake> Quadruped::brakes() const {
  const LegTuning tuning = leg_tuning(machine_);
  std::vector<Brake> brakes;
  for (const JointModel& joint : machine_.joints) {
    brakes.push_back({.effort = joint.effort_limit,
                      .hold_effort = joint.effort_limit,
                      .damping = tuning.damping,
                      .stiffness = tuning.stiffness,
                      .hold_speed = kHoldSpeed});
  }
  return brakes;
}

GateParameters Quadruped::gate() const {
  const LegTuning tuning = leg_tuning(machine_);
  const double scale = std::sqrt(machine_.leg_length() / kReferenceLeg);
  StopProfile standing, walking;
  for (const Leg& leg : machine_.legs) {
    const LegAngles start = upright(leg, tuning.height);
    for (Eigen::Index i = 0; i < LegAngles::SizeAtCompileTime; ++i) {
      standing.push_back({.kind = StopKind::kMove,
                          .damping = std::sqrt(kFoldStiffness) * tuning.damping,
                          .stiffness = kFoldStiffness * tuning.stiffness,
                          .target = leg.lying[i],
                          .start = start[i],
                          .time = kFoldTime * scale,
                          .brake_after = kBrakeTime * scale});
      walking.push_back(standing.back());
      walking.back().time = kWalkingFoldTime * scale;
    }
  }
  return {.profiles = {standing, walking},  // in the order of LegStop
          .longest_ramp = longest_ramp(limits(), parameters_.loop.period())};
}

}  // namespace robot_control
