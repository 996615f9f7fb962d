#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <functional>

#include "bench/programs/legs/loop_rows.h"
#include "control/legged/walk/gait_table.h"
#include "estimation/legged/legged_estimator.h"
#include "support/robots/quadruped_trials.h"

namespace robot_control::bench {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kWalk = 0.5;   // m/s
constexpr double kCrawl = 0.2;  // m/s
constexpr double kStand = 3;    // s, before and after the walk
constexpr double kTurn = 0.5;   // rad/s
constexpr double kSide = 10;    // s, of the square
constexpr double kCircle = 20;  // s, of the eight

struct Course {
  std::string name;
  double seconds;
  std::function<std::array<double, 2>(double)> speed;  ///< m/s and rad/s at a time
  std::uint64_t gait = gait_named("trot");
  TerrainParameters terrain = {};
};

std::vector<Course> courses() {
  constexpr double kCorner = kPi / 2 / kTurn;
  const auto square = [](double speed) {
    return [speed](double t) {
      return std::fmod(t, kSide + kCorner) < kSide ? std::array{speed, 0.0} : std::array{0.0, kTurn};
    };
  };
  const double round = 4 * (kSide + kCorner);
  return {{"straight", 40,
           [](double) {
             return std::array{kWalk, 0.0};
           }},
          {"square", round, square(kWalk)},
          {"eight", 2 * kCircle,
           [](double t) {
             return std::array{kWalk, (t < kCircle ? 2 : -2) * kPi / kCircle};
           }},
          {"crawl", round, square(kCrawl), gait_named("crawl")},
          {"walking trot", round, square(kWalk), gait_named("walking_trot")},
          {"tiles",
           43,
           [](double t) {
             return t < 3 ? std::array{kWalk, 0.0} : std::array{0.8 * kTurn, kTurn};
           },
           gait_named("trot"),
           {.kind = TerrainKind::kRough, .height = 0.04, .length = 0.25, .count = 16}}};
}

Request walk(const std::array<double, 2>& speed, const Mode& mode = {}) {
  Request request = stance(mode);
  request.twist.linear[0] = speed[0];
  request.twist.angular[2] = speed[1];
  return request;
}

Quaterniond turn_of(const Quaternion& q) {
  return {q[3], q[0], q[1], q[2]};
}

Vector3d vector_of(const Vector3& v) {
  return {v[0], v[1], v[2]};
}

/// The difference of an estimate from the truth, with the covariance of the estimate.
struct Difference {
  Eigen::Matrix<double, 6, 1> pose;
  Vector3d speed;
  double pose_nees, speed_nees;

  Difference(const BaseState& base, const TruthFrame& truth) {
    const Eigen::AngleAxisd turn(turn_of(base.pose_odom.orientation) *
                                 turn_of(truth.pose_world.orientation).conjugate());
    pose << vector_of(base.pose_odom.position) - vector_of(truth.pose_world.position), turn.angle() * turn.axis();
    speed = vector_of(base.twist_base.linear) - vector_of(truth.twist_base.linear);
    using Matrix = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
    const Eigen::Map<const Matrix> of_pose(base.pose_covariance.data()), of_twist(base.twist_covariance.data());
    pose_nees = pose.dot(of_pose.ldlt().solve(pose)) / 6;
    speed_nees = speed.dot(of_twist.topLeftCorner<3, 3>().ldlt().solve(speed)) / 3;
  }
};

/// The zeros of the encoders: as a maker calibrates them, or set by hand.
struct Zeros {
  std::string name;
  double deviation;  ///< rad
};
const std::array kZeros{Zeros{"", 0}, Zeros{"set by hand, ", 0.01}};

Parameters in_the_field(std::uint64_t seed, const Zeros& zeros) {
  Parameters parameters = QuadrupedLoop::parameters(seed, ErrorLevel::kField);
  parameters.plant.contact_sensors = false;
  parameters.plant.gyro_bias = 0.02;
  parameters.plant.accelerometer_bias = 0.2;
  parameters.plant.joint_offset = zeros.deviation;
  return parameters;
}

void drive(const LegModel& model, const Course& course, std::uint64_t seed, const Zeros& zeros, WorstValues& worst) {
  Parameters parameters = in_the_field(seed, zeros);
  parameters.plant.terrain = course.terrain;
  parameters.plant.terrain.height *= model.leg_length() / kReferenceLeg;
  QuadrupedLoop robot(model, parameters);
  LeggedEstimator beside(model, parameters.loop.period());  // its plain estimate alone counts
  StateFrame unused;
  robot.after_step = [&] { beside.step(robot.loop.row().driver->sensors, unused); };
  stand_up(robot);
  robot.run(kStand, {});
  Vector3d before = vector_of(robot.truth().pose_world.position);
  double travelled = 0, squares = 0, cycles = 0, pose_nees = 0, speed_nees = 0;
  const auto run = [&](double seconds, const std::function<Request(double)>& request) {
    for (double t = 0; t < seconds; t += 0.02) {
      robot.loop.request(request(t));
      robot.wait(0.02);
      const Vector3d now = vector_of(robot.truth().pose_world.position);
      travelled += (now - before).head<2>().norm();
      before = now;
      const Difference difference(robot.state().base, robot.truth());
      squares += difference.speed.squaredNorm();
      pose_nees += difference.pose_nees;
      speed_nees += difference.speed_nees;
      cycles += 1;
    }
  };
  run(course.seconds, [&](double t) { return walk(course.speed(t), {ModeKind::kGait, course.gait}); });
  run(kStand, [](double) { return Request{}; });
  if (robot.permit().causes != 0)
    std::fprintf(stderr, "%s, seed %llu: stopped by %s\n", course.name.c_str(), static_cast<unsigned long long>(seed),
                 robot.causes().c_str());
  const Difference end(robot.state().base, robot.truth());
  const double error = 100 * end.pose.head<2>().norm() / travelled;
  const Vector3d plain = vector_of(beside.state().plain.position) - vector_of(robot.truth().pose_world.position);
  const double plain_error = 100 * plain.head<2>().norm() / travelled;
  worst.add_p95(zeros.name + "error of the way, " + course.name, error, "%");
  worst.add(zeros.name + "error of yaw, " + course.name, std::abs(end.pose[5]) * 180 / kPi, "deg");
  worst.add_p95(zeros.name + "drift of height, " + course.name, 1000 * std::abs(end.pose[2]) / travelled, "mm/m");
  worst.add(zeros.name + "RMS of the speed, " + course.name, std::sqrt(squares / cycles), "m/s");
  worst.average(zeros.name + "mean error of the way, " + course.name, error, "%");
  worst.average(zeros.name + "mean error of the plain estimate, " + course.name, plain_error, "%");
  worst.add(zeros.name + "error beyond 1.1 of the plain estimate, " + course.name,
            std::max(0.0, error - 1.1 * plain_error), "%");
  worst.average(zeros.name + "NEES of the pose, " + course.name, pose_nees / cycles, "");
  worst.average(zeros.name + "NEES of the speed, " + course.name, speed_nees / cycles, "");
  worst.add(zeros.name + "stopped or degraded, " + course.name,
            robot.permit().causes != 0 || robot.state().base.degraded != 0, "runs");
}

/// A floor that begins to rise by `slope` rad 1.5 m ahead.
std::string ramp(const TemporaryFolder& folder, double slope) {
  constexpr double kAhead = 1.5, kHalf = 8, kThick = 0.1;  // m
  const auto number = [](double value) { return std::to_string(value) + " "; };
  return folder.write("ramp.xml",
                      "<mujoco><compiler angle=\"radian\"/><worldbody><geom type=\"plane\" size=\"50 50 1\"/>"
                      "<geom type=\"box\" size=\"" +
                          number(kHalf) + number(kHalf) + number(kThick) + "\" pos=\"" +
                          number(kAhead + kHalf * std::cos(slope) + kThick * std::sin(slope)) + "0 " +
                          number(kHalf * std::sin(slope) - kThick * std::cos(slope)) + "\" euler=\"0 " +
                          number(-slope) + "0\"/><site name=\"start\"/></worldbody></mujoco>");
}

/// Climbs 1 m: on a ramp, or on a slope on which it stood up. There it turns once on the spot first, which shows the
/// bias of the accelerometer.
void climb(const LegModel& model, double degrees, bool on_ramp, std::uint64_t seed, const Zeros& zeros,
           WorstValues& worst) {
  const TemporaryFolder folder;
  const double slope = degrees * kPi / 180;
  Parameters parameters = in_the_field(seed, zeros);
  parameters.plant.scene = on_ramp ? ramp(folder, slope) : sloping_scene(folder, slope, 0);
  QuadrupedLoop robot(model, parameters);
  stand_up(robot);
  const auto place = [&] { return vector_of(robot.truth().pose_world.position); };
  const Vector3d begin = place();
  const double tilted = on_ramp ? 0 : slope;
  const Vector3d up(std::sin(tilted), 0, std::cos(tilted));  // axes of the scene
  const double known = robot.state().base.pose_odom.position[2];
  if (!on_ramp) robot.run(2 * kPi / kTurn, walk({0, kTurn}));
  const auto climbed = [&] { return up.dot(place() - begin); };
  for (double t = 0; climbed() < 1 && t < 2 / (kWalk * std::sin(slope)); t += 0.1)
    robot.run(0.1, walk({kWalk, -yaw_of(robot.truth().pose_world.orientation) * (on_ramp ? kTurn : 0)}));
  const double error = std::abs(robot.state().base.pose_odom.position[2] - known - climbed());
  const std::string name = "a climb of 1 m on a " + std::string(on_ramp ? "ramp" : "slope") + " of " +
                           std::to_string(std::lround(degrees)) + " deg";
  worst.add_p95(zeros.name + "error of " + name, error, "m");
  worst.average(zeros.name + "mean error of " + name, error, "m");
  worst.add(zeros.name + "stopped or degraded, " + name, climbed() < 1 || robot.permit().causes != 0, "runs");
}

}  // namespace

void odometry(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  for (const Zeros& zeros : kZeros) {
    for (const Course& course : courses()) drive(model, course, seed, zeros, worst);
    for (const double degrees : {5, 10})
      for (const bool on_ramp : {true, false}) climb(model, degrees, on_ramp, seed, zeros, worst);
  }
}

void contact(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  constexpr double kAir = 0.04, kInTime = 0.015, kBounce = 0.01;  // s; a foot that lands bounces for less
  constexpr double kTouches = 1;                                  // N
  constexpr double kSeconds = 10;
  struct Walk {
    std::uint64_t gait;
    double speed;
  };
  for (const Walk& chosen :
       {Walk{gait_named("trot"), 0.5}, Walk{gait_named("trot"), 1.0}, Walk{gait_named("crawl"), 0.2}}) {
    Parameters parameters = QuadrupedLoop::parameters(seed, ErrorLevel::kField);
    parameters.plant.contact_sensors = false;
    QuadrupedLoop robot(model, parameters);
    stand_up(robot);
    const std::uint64_t aloft = robot.cycles(kAir), limit = robot.cycles(kInTime), bounce = robot.cycles(kBounce);
    std::array<std::uint64_t, kLegs> air{}, since{};
    std::array<bool, kLegs> waits{};
    double touchdowns = 0, found = 0, swing = 0, wrong = 0;
    const Request request = walk({chosen.speed, 0}, {ModeKind::kGait, chosen.gait});
    for (std::uint64_t k = 0; k < robot.cycles(kSeconds); ++k) {
      if (k % robot.cycles(0.02) == 0) robot.loop.request(request);
      robot.step();
      for (std::size_t leg = 0; leg < kLegs; ++leg) {
        const bool touches = robot.truth().normal_force[leg] > kTouches;
        const bool said = robot.state().contacts[leg].probability >= 0.5;
        if (touches && air[leg] > aloft) waits[leg] = true, since[leg] = 0;
        const bool in_time = since[leg] <= limit;
        if (waits[leg] && (said || !in_time)) touchdowns += 1, found += in_time ? 1 : 0, waits[leg] = false;
        since[leg] += 1;
        air[leg] = touches ? 0 : air[leg] + 1;
        const bool swings = air[leg] > bounce;
        swing += swings ? 1 : 0;
        wrong += swings && said ? 1 : 0;
      }
    }
    const std::string name = std::string(kGaits[chosen.gait].name.data()) + (chosen.speed == 1.0 ? " 1.0 m/s" : "");
    worst.add("touchdowns not found in 15 ms, " + name, 100 * (1 - found / touchdowns), "%");
    worst.add("swing taken for a stance, " + name, 100 * wrong / swing, "%");
    worst.add("no touchdown, " + name, touchdowns > 20 ? 0 : 1, "runs");
  }
}

}  // namespace robot_control::bench
