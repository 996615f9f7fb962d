#include "bench/programs/legs/loop_rows.h"
#include "control/legged/walk/gait_table.h"
#include "control/legged/walk/twist_limiter.h"

namespace robot_control::bench {
namespace {

constexpr double kStart = 5, kMeasured = 7, kSend = 0.02;  // s

/// A request to walk, with the name of its figures.
struct Walk {
  std::string name;
  std::array<double, 3> twist;
  std::uint64_t gait = gait_named("trot");
};

Request request_of(const Walk& walk) {
  return {.twist = {.linear = {walk.twist[0], walk.twist[1], 0}, .angular = {0, 0, walk.twist[2]}},
          .posture = {},
          .mode = {ModeKind::kGait, walk.gait}};
}

/// Stands up, walks, and measures the mean of the true twist, angles, joints and clamps.
void walk(QuadrupedLoop& robot, const Walk& walk, WorstValues& worst) {
  robot.wait(0.3);
  robot.run(kStart, request_of(walk));
  robot.clear();
  std::array<double, 3> mean{};
  double roll = 0, pitch = 0, fastest = 0, clamps = 0, count = 0;
  const LegModel& model = robot.robot();
  for (double time = 0; time < kMeasured; time += kSend) {
    robot.loop.request(request_of(walk));
    for (std::uint64_t k = 0; k < robot.cycles(0.02); ++k, ++count) {
      robot.step();
      const TruthFrame& truth = robot.truth();
      const Quaternion& q = truth.pose_world.orientation;
      mean[0] += truth.twist_base.linear[0];
      mean[1] += truth.twist_base.linear[1];
      mean[2] += truth.twist_base.angular[2];
      roll += std::pow(std::atan2(2 * (q[3] * q[0] + q[1] * q[2]), 1 - 2 * (q[0] * q[0] + q[1] * q[1])), 2);
      pitch += std::pow(std::asin(std::clamp(2 * (q[3] * q[1] - q[2] * q[0]), -1.0, 1.0)), 2);
      if (robot.gate().verdict != GateVerdict::kPassed) ++clamps;
      for (std::size_t i = 0; i < kLegsJoints; ++i)
        fastest = std::max(fastest, std::abs(truth.joints[i].velocity) / model.joints[i].velocity_limit);
    }
  }
  double off = 0, size = 0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    off = std::max(off, std::abs(mean[i] / count - walk.twist[i]));
    size = std::max(size, std::abs(walk.twist[i]));
  }
  worst.add("speed off, " + walk.name, off / size, "of it");
  worst.add("roll RMS, " + walk.name, std::sqrt(roll / count), "rad");
  worst.add("pitch RMS, " + walk.name, std::sqrt(pitch / count), "rad");
  worst.add("largest tilt, " + walk.name, robot.tilt, "rad");
  worst.add("joint speed, " + walk.name, fastest, "of the limit");
  worst.add("cycles not passed, " + walk.name, clamps, "");
  worst.add("stops, " + walk.name, robot.permit().causes != 0 ? 1 : 0, "");
}

/// Ends the walk with a zero, and measures time and way until the robot stands.
void end_walk(QuadrupedLoop& robot, const Walk& walk, WorstValues& worst) {
  double time = 0;
  const Vector3 from = robot.truth().pose_world.position;
  robot.loop.request({});
  while (robot.command().legged.phase == LegPhase::kWalking && time < 5) {
    robot.step();
    time += robot.period();
  }
  worst.add("stands after, " + walk.name, time, "s");
  const double speed = walk.twist[0];
  if (walk.twist != std::array{speed, 0.0, 0.0}) return;
  const Vector3& to = robot.truth().pose_world.position;
  const double walked = std::hypot(to[0] - from[0], to[1] - from[1]);
  const double predicted =
      walking_stop_distance(robot.parameters_.leg_control, robot.robot().leg_length(), speed, false);
  worst.add("way after zero from the predicted one, " + walk.name, std::abs(walked - predicted), "m");
}

}  // namespace

void trot(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  for (const Walk& each : {Walk{"0.25 m/s", {0.25, 0, 0}}, Walk{"0.5 m/s", {0.5, 0, 0}}, Walk{"1.0 m/s", {1, 0, 0}},
                           Walk{"1.5 m/s", {1.5, 0, 0}}, Walk{"sideways", {0, 0.3, 0}}, Walk{"turn", {0, 0, 1.5}},
                           Walk{"all axes", {0.5, 0.2, 0.5}}}) {
    QuadrupedLoop robot(model, walking_parameters(seed));
    walk(robot, each, worst);
    end_walk(robot, each, worst);
  }
}

void gaits(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  for (const Walk& each : {Walk{"crawl", {0.2, 0, 0}, gait_named("crawl")},
                           Walk{"walking trot", {0.5, 0, 0}, gait_named("walking_trot")}}) {
    QuadrupedLoop robot(model, walking_parameters(seed));
    walk(robot, each, worst);
  }
  Parameters own = walking_parameters(seed);
  own.leg_control.gaits[0] = {
      .name = "pace", .period = 0.3, .duty = 0.8, .phases = NumberList<4>{0.5, 0, 0.5, 0}, .lift = 0.06};
  QuadrupedLoop robot(model, own);
  walk(robot, {"pace", {0.5, 0, 0}, kGaits.size()}, worst);
}

void robots(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  QuadrupedLoop robot(model, walking_parameters(seed));
  walk(robot, {"trot", {0.5, 0, 0}}, worst);
}

void walking_stop(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  constexpr std::uint64_t kPhases = 40;
  for (const Walk& each :
       {Walk{"0.5 m/s", {0.5, 0, 0}}, Walk{"1.0 m/s", {1, 0, 0}}, Walk{"1.5 m/s", {1.5, 0, 0}},
        Walk{"crawl", {0.2, 0, 0}, gait_named("crawl")}, Walk{"sideways", {0, 0.3, 0}}, Walk{"turn", {0, 0, 1.5}}}) {
    const double period = kGaits[each.gait].scaled(model.leg_length()).period / kPhases;
    QuadrupedLoop robot(model, walking_parameters(seed));
    robot.wait(0.3);
    robot.run(kStart + period * static_cast<double>(seed % kPhases), request_of(each));
    const Vector3 from = robot.truth().pose_world.position;
    const QuadrupedLoop::Fold fold = robot.fold();
    const Vector3& to = robot.truth().pose_world.position;
    worst.add("tilt of a stop, " + each.name, robot.tilt, "rad");
    worst.add("rest of a stop, " + each.name, fold.rest_at, "s");
    worst.add("way of a stop, " + each.name, std::hypot(to[0] - from[0], to[1] - from[1]), "m");
    worst.add("turned over, " + each.name, robot.tilt_now() > kPi / 3 ? 1 : 0, "runs");
  }
}

}  // namespace robot_control::bench
