#pragma once
/// Trials of robots on legs that a benchmark repeats often and a test once: walks with poses, and standing up on
/// slopes.

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "support/robots/quadruped_loop.h"
#include "support/temporary_folder.h"

namespace robot_control {

struct LeaningWalk {
  bool stopped = false;
  std::string causes;
  double joint_speed = 0;    ///< of the limit, the largest one
  double beyond_range = -1;  ///< rad, of a joint; negative: it stayed within
};

/// Takes a random pose, and walks for 8 s with random twists, of which one axis has its largest speed, and with random
/// poses. Both change every two seconds. The poses are within the ranges of a robot that stands, or walks.
inline LeaningWalk leaning_walk(const LegModel& model, const Parameters& parameters, bool poses = true) {
  std::mt19937_64 random(parameters.plant.seed + 1);
  const auto within = [&](double range) { return std::uniform_real_distribution<double>(-range, range)(random); };
  const LegControllerParameters& legs = parameters.leg_control;
  const std::array<double, 3> fastest{legs.max_linear_speed, legs.max_lateral_speed, legs.max_angular_speed};
  const LegTuning tuning = leg_tuning(model);
  QuadrupedLoop robot(model, parameters);
  LeaningWalk result;
  robot.wait(0.3);
  robot.run(3.0, stance({ModeKind::kStand}));
  robot.after_step = [&] {
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      const JointModel& joint = model.joints[i];
      const auto& truth = robot.truth().joints[i];
      result.joint_speed = std::max(result.joint_speed, std::abs(truth.velocity) / joint.velocity_limit);
      if (joint.range)
        result.beyond_range =
            std::max({result.beyond_range, truth.position - joint.range->upper, joint.range->lower - truth.position});
    }
  };
  if (poses) {
    Request lean = stance({ModeKind::kStay});
    lean.posture = {.height = within(tuning.bob), .roll = within(tuning.lean), .pitch = within(tuning.lean)};
    robot.run(1.5, lean);
  }
  for (int part = 0; part < 4 && robot.permit().causes == 0; ++part) {
    const std::size_t full = random() % fastest.size();
    const double sign = random() % 2 == 0 ? 1 : -1;
    const auto speed = [&](std::size_t axis) { return axis == full ? sign * fastest[axis] : within(fastest[axis]); };
    Request request{.twist = {.linear = {speed(0), speed(1), 0}, .angular = {0, 0, speed(2)}}, .posture = {}};
    if (poses)
      request.posture = {
          .height = within(tuning.bob / 2), .roll = within(tuning.lean / 2), .pitch = within(tuning.lean / 2)};
    for (double time = 0; time < 2 && robot.permit().causes == 0; time += 0.02) robot.run(0.02, request);
  }
  result.stopped = robot.permit().causes != 0;
  result.causes = robot.causes();
  return result;
}

/// Returns the robot with first joints that need 0.97 of their torque for half of the weight, as in a trot in place.
inline LegModel with_weak_hips(LegModel robot) {
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const LegKinematics& kinematics = robot.legs[leg].kinematics;
    const double lever = std::abs(kinematics.position(robot.legs[leg].lying).y() - kinematics.geometry().hip.y());
    double& limit = robot.joints[kLegJoints * leg].effort_limit;
    limit = std::min(limit, robot.mass * 9.81 / 2 * lever / 0.97);
  }
  return robot;
}

/// Returns a scene whose ground rises by `slope` rad towards `heading` from the robot, in a file of this folder.
inline std::string sloping_scene(const TemporaryFolder& folder, double slope, double heading, double friction = 1) {
  const double along = -9.81 * std::sin(slope);
  return folder.write("slope.xml",
                      "<mujoco><option gravity=\"" + std::to_string(along * std::cos(heading)) + " " +
                          std::to_string(along * std::sin(heading)) + " " + std::to_string(-9.81 * std::cos(slope)) +
                          "\"/><worldbody><geom name=\"floor\" type=\"plane\" size=\"50 50 1\" "
                          "friction=\"" +
                          std::to_string(friction) + " 0.005 0.0001\"/><site name=\"start\"/></worldbody></mujoco>");
}

struct SlopeTrial {
  bool stands = false;   ///< four feet bear it at the end, within 0.1 rad of the ground
  bool refuses = false;  ///< it lies as before
  bool stopped = false;
  bool turned_over = false;
  std::string causes;
  double tilt = 0;  ///< rad from the ground, the largest
};

/// Lets a robot that lies on this slope stand up, and stand for three seconds.
inline SlopeTrial stand_up_on(const LegModel& model, Parameters parameters, double slope, double heading) {
  const TemporaryFolder folder;
  parameters.plant.scene = sloping_scene(folder, slope, heading);
  QuadrupedLoop robot(model, parameters);
  robot.wait(2.0);
  robot.clear();
  robot.run(6.0, stance({ModeKind::kStand}));
  const LegPhase phase = robot.command().legged.phase;
  return {.stands = phase == LegPhase::kStanding && robot.tilt_now() < 0.1,
          .refuses = phase == LegPhase::kLying && robot.permit().causes == 0,
          .stopped = robot.permit().causes != 0,
          .turned_over = robot.tilt > 1,
          .causes = robot.causes(),
          .tilt = robot.tilt};
}

/// Lets a robot stand up on a slope of friction 0.7, walk ahead, turn, stop and walk again. An e-stop then comes
/// `phase` s later.
inline SlopeTrial walk_on(const LegModel& model, Parameters parameters, double slope, double heading, double phase) {
  const TemporaryFolder folder;
  parameters.plant.scene = sloping_scene(folder, slope, heading, 0.7);
  QuadrupedLoop robot(model, parameters);
  robot.wait(2.0);
  robot.clear();
  robot.run(3.0, stance({ModeKind::kStand}));
  SlopeTrial trial;
  trial.refuses = robot.command().legged.phase == LegPhase::kLying && robot.permit().causes == 0;
  if (trial.refuses) return trial;
  const auto walk = [&](double seconds, double ahead, double yaw) {
    Request request{.twist = {.linear = {ahead, 0, 0}, .angular = {0, 0, yaw}}, .posture = {}};
    for (double time = 0; time < seconds && robot.permit().causes == 0; time += 0.02) robot.run(0.02, request);
  };
  walk(3, 0.4, 0);
  walk(3, 0, 0.5);
  walk(2.5, 0, 0);
  trial.stands = robot.command().legged.phase == LegPhase::kStanding && robot.tilt_now() < 0.1;
  walk(1 + phase, 0.4, 0);
  trial.stopped = robot.permit().causes != 0;
  trial.causes = robot.causes();
  robot.fold();
  trial.turned_over = robot.tilt > 1;
  trial.tilt = robot.tilt;
  return trial;
}

}  // namespace robot_control
