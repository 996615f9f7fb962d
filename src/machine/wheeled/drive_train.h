#pragma once
/// The drive train is a machine that drives on wheels: a differential drive or a skid-steer. It alone knows left and
/// right. The joints of its drive wheels come first, in the order of DriveTrain::wheels; the others follow in the order
/// of the file. Its contacts are the drive wheels, then the casters.

#include "machine/machine_model.h"
#include "machine/wheeled/drive_train_parameters.h"
#include "signals/wheeled/wheel_count.h"

namespace robot_control {

/// This is the time in s from no torque to the effort limit, if the torque rate of a wheel is not given. A motor's
/// current needs the inductance over the resistance, which is 0.1 … 1 ms for brushed motors of 10 … 200 W (maxon
/// catalogue, RE series). So the rate makes no motor slower.
inline constexpr double kEffortRise = 0.001;

enum class Side { kLeft, kRight };

/// Describes a wheel that rolls on a lateral axle.
struct WheelModel {
  std::size_t joint = 0;     ///< index into MachineModel::joints
  Vector3 centre_base{};     ///< m, centre of the wheel's shape
  double radius = 0;         ///< m
  double width = 0;          ///< m
  double sign = 1;           ///< +1: positive joint velocity drives forward
  double inertia = 0;        ///< kg·m² about the axle, rotor_inertia included
  double rotor_inertia = 0;  ///< kg·m², assumed if the URDF leaves the drive's rotor out (drive_wheels.h)
  Side side = Side::kLeft;
  bool omni = false;  ///< a caster without a swivel, which slides sideways without friction
};

struct DriveTrain : MachineModel {
  std::vector<WheelModel> wheels;  ///< left ones front to back, then right ones; wheels[i].joint == i
  double wheel_base = 0;           ///< m, distance between the left and right wheel centres, mean over the axles

  /// This is the effective over the geometric wheel base, which relates the turn to the wheels' speed difference. It is
  /// 1 for one wheel a side. Wheels behind each other scrub in a turn. Let xᵢ be the axles' positions from their mean
  /// and b the wheel base. Per rad/s of turning, the tread of axle i slips by s along its rolling direction and by xᵢ
  /// across it. Equal loads under isotropic Coulomb friction turn the robot steadily if
  ///   Σ (b s/2 − xᵢ²)/√(s² + xᵢ²) = 0,   multiplier 1 + 2 s/b:   1 + (L/b)² for two axles L apart.
  double wheel_base_multiplier = 1;

  WheelCommand wheel_command = WheelCommand::kTorque;
  double wheel_response_time = 0;  ///< s, of drives that take velocities

  double yaw_inertia = 0;           ///< kg·m² about the vertical through the middle of the axles
  std::vector<WheelModel> casters;  ///< passive wheels that roll; `side` and `sign` have no meaning

  /// Returns "left wheels a, b, right wheels c, d, radius 0.098 m, wheel base 0.376 m (effective 0.56 m)".
  std::string parts() const override;

  /// Returns the effective wheel base in m.
  double effective_wheel_base() const noexcept { return wheel_base * wheel_base_multiplier; }

  /// Returns the number of drive wheels on the side of this one, itself included.
  double wheels_beside(const WheelModel& wheel) const noexcept;
};

/// Returns the middle of the axles in base axes, m; the base's origin without wheels.
Vector3 middle_of_axles(const DriveTrain& robot) noexcept;

/// Return the inertia about its axle of one wheel of a robot that drives straight on or turns, in kg·m²: J + m r²/(2 h)
/// and J + 2 I r²/(h b b_eff), with h wheels beside it, the yaw inertia I and the wheel base b.
double straight_inertia(const DriveTrain& robot, const WheelModel& wheel) noexcept;
double turning_inertia(const DriveTrain& robot, const WheelModel& wheel) noexcept;

/// Returns the drive train that a machine is. Throws RobotError for a machine without drive wheels.
const DriveTrain& drive_train_of(const MachineModel& machine);

/// Throws RobotError for overrides that are not above zero, and for numbers beyond all bounds. It also throws what
/// read_rigid_bodies, find_running_gear, refuse_too_many_joints, refuse_unheld_joints and imu_link_of refuse.
DriveTrain read_drive_train(const RobotDescription& description, const DriveTrainParameters& parameters);

}  // namespace robot_control
