#include "bench/programs/legs/loop_rows.h"

namespace robot_control::bench {
namespace {

/// Returns the centre of a foot from the base, in m of the world's axes.
Eigen::Vector3d foot_from_base(const QuadrupedLoop& robot, std::size_t leg) {
  std::array<double, kLegsJoints> angles{};
  for (std::size_t i = 0; i < kLegsJoints; ++i) angles[i] = robot.truth().joints[i].position;
  return rotation_of(robot.truth().pose_world.orientation) *
         robot.robot().legs[leg].kinematics.position(LegModel::angles_of(angles, leg));
}

/// Returns the height of the base above the ground on which its four feet stand, in m.
double height(const QuadrupedLoop& robot) {
  double sum = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg)
    sum += robot.robot().legs[leg].foot_radius - foot_from_base(robot, leg).z();
  return sum / kLegs;
}

std::array<double, 6> pose(const QuadrupedLoop& robot) {
  const Pose& p = robot.truth().pose_world;
  return {p.position[0],          p.position[1],           p.position[2],
          roll_of(p.orientation), pitch_of(p.orientation), yaw_of(p.orientation)};
}

}  // namespace

void postures(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  QuadrupedLoop robot(model, seed, ErrorLevel::kField);
  robot.wait(0.3);
  robot.clear();
  robot.run(2.0, stance({ModeKind::kStand}));
  worst.add("effort of the limit", robot.effort, "");
  worst.add("height after 2 s", std::abs(height(robot) - (nominal_height(model) - model.belly)), "m");
  worst.add("tilt after 2 s", robot.tilt_now(), "rad");
  robot.run(3.0, {});
  const Vector3 before = robot.truth().pose_world.position;
  robot.run(6.0, {});
  const Vector3& after = robot.truth().pose_world.position;
  worst.add("creep", 10 * std::hypot(after[0] - before[0], after[1] - before[1]), "m/min");
  robot.run(4.0, stance({ModeKind::kLie}));
  worst.add("not lying at the end", (robot.command().reasons & kReasonHolding) != 0 ? 0 : 1, "runs");
  worst.add("stops", robot.permit().causes == 0 ? 0 : 1, "runs");
}

void body_pose(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  QuadrupedLoop robot(model, seed);
  stand_up(robot);
  const double length = model.leg_length(), omega = 2 * kPi * kSway;
  const double sizes[6] = {0.1 * length, 0.1 * length, 0.15 * length, 0.25, 0.25, 0.25};
  for (std::size_t axis = 0; axis < 6; ++axis) {
    robot.run(1.0, {});
    const std::array<double, 6> begin = pose(robot);
    robot.clear();
    double sum = 0;
    const std::uint64_t cycles = robot.cycles(4);
    for (std::uint64_t k = 0; k < cycles; ++k) {
      Request request;
      double* const values[6] = {&request.posture.x,    &request.posture.y,     &request.posture.height,
                                 &request.posture.roll, &request.posture.pitch, &request.posture.yaw};
      *values[axis] = sizes[axis] * std::sin(omega * robot.period() * static_cast<double>(k));
      robot.loop.request(request);
      robot.step();
      sum += std::pow(pose(robot)[axis] - begin[axis] - *values[axis], 2);
    }
    worst.add(axis < 3 ? "RMS of the place" : "RMS of the angle", std::sqrt(sum / static_cast<double>(cycles)),
              axis < 3 ? "m" : "rad");
    worst.add("slip of a foot", *std::max_element(robot.slipped.begin(), robot.slipped.end()), "m");
  }
  worst.add("stops", robot.permit().causes == 0 ? 0 : 1, "runs");
}

void circle(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  QuadrupedLoop robot(model, seed);
  stand_up(robot);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    Request up = stance({ModeKind::kLift, leg});
    up.posture.height = leg_tuning(model).lift;
    robot.clear();
    robot.run(2.0, up);
    const auto foot = [&]() -> Eigen::Vector3d {
      return Eigen::Vector3d(robot.truth().pose_world.position.data()) + foot_from_base(robot, leg);
    };
    const Eigen::Vector3d begin = foot();
    double sum = 0;
    constexpr double kRadius = 0.05;  // m
    const std::uint64_t cycles = robot.cycles(2);
    for (std::uint64_t k = 0; k < cycles; ++k) {
      const double turn = kPi * robot.period() * static_cast<double>(k);
      Request request = up;
      request.posture.x = kRadius * std::sin(turn);
      request.posture.height += kRadius * (1 - std::cos(turn));
      robot.loop.request(request);
      robot.step();
      sum += (foot() - begin - kRadius * Eigen::Vector3d(std::sin(turn), 0, 1 - std::cos(turn))).squaredNorm();
    }
    const std::string name = name_of(static_cast<LegPlace>(leg));
    worst.add("RMS of foot " + name, std::sqrt(sum / static_cast<double>(cycles)), "m");
    worst.add("tilt with foot " + name, robot.tilt, "rad");
    robot.run(2.5, {});
  }
  worst.add("stops", robot.permit().causes == 0 ? 0 : 1, "runs");
}

}  // namespace robot_control::bench
