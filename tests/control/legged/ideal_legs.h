#pragma once
/// A leg controller whose joints are where it commands them, and what its commands mean by forward kinematics.

#include <Eigen/Geometry>
#include <cmath>

#include "control/legged/leg_controller.h"
#include "control/legged/stand/body_bounds.h"
#include "machine/gravity.h"
#include "machine/legs/legs_corpus.h"

namespace robot_control {

inline Request stance_of(const Mode& mode) {
  Request request;
  request.mode = mode;
  return request;
}

/// Returns quadbot without any symmetry: hips off the middle, legs that lie differently, and joints of every sense. Its
/// feet are points, which do not roll.
inline LegModel lopsided() {
  constexpr double kSigns[kLegs][kLegJoints] = {{1, 1, 1}, {-1, 1, 1}, {1, -1, -1}, {-1, -1, -1}};
  LegModel robot = legged_robot("quadbot");
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    LegGeometry geometry = robot.legs[leg].kinematics.geometry();
    geometry.hip += Eigen::Vector3d(0.015, 0.01, 0);
    const auto number = static_cast<double>(leg);
    robot.legs[leg].lying += LegAngles(0.02 * number, 0.03 * number, -0.04 * number);
    for (std::size_t i = 0; i < kLegJoints; ++i) {
      if (kSigns[leg][i] > 0) continue;
      JointModel& joint = robot.joints[kLegJoints * leg + i];
      geometry.sign[i] = -1;
      geometry.range[i] = {-geometry.range[i].upper, -geometry.range[i].lower};
      joint.range = JointRange{-joint.range->upper, -joint.range->lower};
      robot.legs[leg].lying[static_cast<Eigen::Index>(i)] *= -1;
    }
    robot.legs[leg].kinematics = LegKinematics(geometry);
    robot.legs[leg].foot_radius = 0;
  }
  return robot;
}

/// Returns the lopsided robot with `part` of its lengths, and as heavy.
inline LegModel sized(double part) {
  LegModel robot = lopsided();
  robot.belly *= part;
  for (Leg& leg : robot.legs) {
    LegGeometry geometry = leg.kinematics.geometry();
    for (Eigen::Vector3d* length : {&geometry.hip, &geometry.upper, &geometry.lower, &geometry.foot}) *length *= part;
    leg.kinematics = LegKinematics(geometry);
  }
  for (std::size_t i = 0; i < kLegsJoints; ++i) robot.joints[i].effort_limit *= part;  // its weight is the same
  return robot;
}

/// The cycle is as long as the low pass of the accelerations, which has no effect then.
inline constexpr double kCycle = 0.005;  // s

struct IdealLegs {
  explicit IdealLegs(const LegModel& model, double cycle = kCycle, double timeout = 0)
      : robot(model), period(cycle), controller(model, {.request_timeout = timeout}, cycle) {
    sensors.joint_count = kLegsJoints;
    for (std::size_t leg = 0; leg < kLegs; ++leg) {
      for (std::size_t i = 0; i < kLegJoints; ++i) {
        JointSample& joint = sensors.joints[kLegJoints * leg + i];
        joint.valid = kValidPosition;
        joint.position = model.legs[leg].lying[static_cast<Eigen::Index>(i)];
      }
    }
    permit.action = PermitAction::kDrive;
    permit.speed_limit = kNoSpeedLimit;
  }

  void request(const Request& wanted) {
    inbox.content = wanted;
    ++inbox.count;
  }
  void step() {
    ++sensors.head.cycle;
    before = out;
    pose_before = pose();
    estimate.head.cycle = sensors.head.cycle;
    controller.step({.sensors = &sensors,
                     .state = has_estimate ? &estimate : nullptr,
                     .permit = has_permit ? &permit : nullptr,
                     .request = inbox},
                    out);
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      if (out.joints[i].mode == JointMode::kImpedance) sensors.joints[i].position = out.joints[i].position;
    }
  }
  void step(const Request& wanted) {
    request(wanted);
    step();
  }
  void run(double seconds, const Request& wanted) {
    request(wanted);
    for (double time = 0; time < seconds - period / 2; time += period) step();
  }

  const LegController::State& state() const { return controller.state(); }
  Stance::Pose pose() const {
    Stance::Pose result{};
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = state().stand.body[i].value;
    return result;
  }
  static Eigen::Vector3d position(const Stance::Pose& pose) { return {pose[0], pose[1], pose[2]}; }
  static Eigen::Matrix3d attitude(const Stance::Pose& pose) {
    const double r = pose[3], p = pose[4], y = pose[5];
    Eigen::Matrix3d yaw, pitch, roll;
    yaw << std::cos(y), -std::sin(y), 0, std::sin(y), std::cos(y), 0, 0, 0, 1;
    pitch << std::cos(p), 0, std::sin(p), 0, 1, 0, -std::sin(p), 0, std::cos(p);
    roll << 1, 0, 0, 0, std::cos(r), -std::sin(r), 0, std::sin(r), std::cos(r);
    return yaw * pitch * roll;
  }
  LegAngles angles(std::size_t leg) const {
    const JointCommand* joint = &out.joints[kLegJoints * leg];
    return {joint[0].position, joint[1].position, joint[2].position};
  }
  /// Returns the foot in the axes of the base.
  Eigen::Vector3d foot_in_base(std::size_t leg) const { return robot.legs[leg].kinematics.position(angles(leg)); }
  /// Returns the foot in the stance frame.
  Eigen::Vector3d foot(std::size_t leg) const { return position(pose()) + attitude(pose()) * foot_in_base(leg); }
  std::array<Eigen::Vector3d, kLegs> feet() const { return {foot(0), foot(1), foot(2), foot(3)}; }

  /// The equations of the commanded angles at rest.
  LeggedEquations at_rest() const {
    LeggedMotion motion;
    for (std::size_t i = 0; i < kLegsJoints; ++i) motion.angles[i] = out.joints[i].position;
    motion.gravity = -kGravity * attitude(pose()).row(2).transpose();
    LeggedEquations equations;
    LegDynamics(robot).step(motion, equations);
    return equations;
  }
  /// Returns x and y of the centre of gravity in the stance frame.
  Eigen::Vector2d centre() const {
    return (position(pose()) + attitude(pose()) * at_rest().centre_of_gravity).head<2>();
  }

  LegModel robot;
  double period;
  LegController controller;
  SensorFrame sensors;
  Permit permit;
  bool has_permit = true;
  StateFrame estimate;
  bool has_estimate = false;
  VelocityCommand inbox;
  CommandFrame out, before;
  Stance::Pose pose_before{};
};

/// Returns the robot after it stood up and came to rest.
inline IdealLegs standing(const LegModel& robot = lopsided(), double cycle = kCycle) {
  IdealLegs legs(robot, cycle);
  legs.run(3.0, stance_of({ModeKind::kStand}));
  legs.run(0.5, {});
  return legs;
}

}  // namespace robot_control
