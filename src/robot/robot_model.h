#pragma once
/// What the machine is: the one description that every node derives its numbers from.
///
/// Read from a URDF with urdfdom; positions through a KDL tree at the zero pose. `base` is the root link's
/// frame (REP 103: x forward, y left, z up).

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "signals/geometry.h"

namespace robot_control {

/// One message: what is wrong, in which file and element, and what to do about it.
class RobotError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a user may say about the robot beside its URDF (the `robot:` block).
struct RobotParameters {
  std::string left_wheel_joint = "left_wheel_joint";
  std::string right_wheel_joint = "right_wheel_joint";
  std::optional<double> wheel_base;    ///< m; overrides the URDF
  std::optional<double> wheel_radius;  ///< m; overrides the URDF, both sides
};

/// A URDF text and where it was read, for messages ("urdf/diffbot.urdf", "/robot_description").
struct RobotDescription {
  std::string text;
  std::string source;
};

/// A moving joint, in the order of the frames' joint arrays: wheels first (left, right), then the others as
/// they stand in the file.
struct JointModel {
  std::string name;
  std::string child_link;
  double effort_limit = 0;    ///< N·m or N
  double velocity_limit = 0;  ///< rad/s or m/s
};

struct WheelModel {
  std::size_t joint = 0;  ///< index into RobotModel::joints
  Vector3 centre_base{};  ///< m, centre of the wheel's shape
  double radius = 0;      ///< m
  double width = 0;       ///< m
  double sign = 1;        ///< +1: positive joint velocity drives forward
  double inertia = 0;     ///< kg·m² about the axle
};

struct RobotModel {
  std::string name;
  std::string source;
  std::string urdf;        ///< the text itself
  std::uint64_t hash = 0;  ///< of the URDF text and every override; equal hash = same robot
  std::vector<JointModel> joints;
  WheelModel left;
  WheelModel right;
  double wheel_base = 0;             ///< m, distance between the left and right wheel centres
  double mass = 0;                   ///< kg, all links
  Vector3 centre_of_gravity_base{};  ///< m
  double yaw_inertia = 0;            ///< kg·m² about the vertical through the middle of the axle
  std::string base_link;
  std::string imu_link;  ///< empty: the IMU sits in base_link
  Pose imu_in_base;      ///< orientation rotates from IMU axes to base axes
};

/// Reads a file; throws RobotError naming it.
RobotDescription load_description(const std::string& path);

/// Throws RobotError: malformed XML, no such joint, not a wheel, no shape, no mass, more than kMaxJoints …
RobotModel read_robot(const RobotDescription& description, const RobotParameters& parameters);

}  // namespace robot_control
