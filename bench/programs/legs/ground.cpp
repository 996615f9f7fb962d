#include <Eigen/Geometry>

#include "bench/programs/legs/loop_rows.h"
#include "control/legged/walk/gait.h"

namespace robot_control::bench {
namespace {

constexpr double kSend = 0.02;                             // s
constexpr double kSlow = 3;                                // times the time that the way takes at the requested speed
constexpr double kHeadings[] = {-0.4, -0.2, 0, 0.2, 0.4};  // rad, of the course from the robot
constexpr std::size_t kPlaces = std::size(kHeadings);

/// How a robot crossed a course.
struct Crossing {
  bool reached = false, stopped = false, turned_over = false;
  double speed = 0;         // of the request, its mean along the course
  double height_error = 0;  // m, of the estimate at the end
  std::string causes;
};

/// Walks straight ahead at `speed` m/s until `distance` m of the course are behind. A pilot corrects heading and side
/// by the estimate.
Crossing cross(const LegModel& model, const Parameters& parameters, double speed, double distance) {
  QuadrupedLoop robot(model, parameters);
  stand_up(robot);
  const Vector3 begin = robot.truth().pose_world.position, known = robot.state().base.pose_odom.position;
  distance /= std::cos(parameters.plant.terrain.heading);
  Crossing crossing;
  double time = 0;
  while (time < kSlow * distance / speed && !crossing.reached && robot.permit().causes == 0) {
    const Pose& pose = robot.state().base.pose_odom;
    const double yaw = yaw_of(pose.orientation), beside = std::clamp(pose.position[1] - known[1], -0.1, 0.1);
    const Eigen::Vector2d twist = Eigen::Rotation2Dd(-yaw) * Eigen::Vector2d(speed, -beside);
    robot.run(kSend, {.twist = {.linear = {twist.x(), twist.y(), 0}, .angular = {0, 0, -yaw}}, .posture = {}});
    time += kSend;
    crossing.reached = robot.truth().pose_world.position[0] - begin[0] >= distance;
  }
  const double climbed = robot.truth().pose_world.position[2] - begin[2];
  crossing.height_error = std::abs(robot.state().base.pose_odom.position[2] - known[2] - climbed);
  crossing.speed = distance / (time * speed);
  crossing.stopped = robot.permit().causes != 0;
  crossing.causes = robot.causes();
  robot.run(3, {});
  crossing.stopped = crossing.stopped || robot.permit().causes != 0;
  crossing.turned_over = robot.tilt > kTurnedOver;
  return crossing;
}

void add(const LegModel& model, const std::string& name, std::uint64_t seed, const Crossing& crossing,
         WorstValues& worst) {
  const bool passed = crossing.reached && !crossing.stopped && !crossing.turned_over;
  worst.average("crossed, " + name, passed ? 1 : 0, "of the runs");
  worst.average("turned over, " + name, crossing.turned_over ? 1 : 0, "of the runs");
  if (passed) worst.average("speed, " + name, crossing.speed, "of the request");
  if (passed) worst.add_p95("error of height, " + name, crossing.height_error, "m");
  if (!passed)
    std::fprintf(stderr, "%s, %s, seed %llu: %s%s%s\n", model.name.c_str(), name.c_str(),
                 static_cast<unsigned long long>(seed), crossing.causes.c_str(), crossing.reached ? "" : " not reached",
                 crossing.turned_over ? " turned over" : "");
}

/// The seed chooses errors, tiles and one of kPlaces headings; lengths are those of a leg of kReferenceLeg.
Parameters on(const LegModel& model, std::uint64_t seed, TerrainParameters terrain) {
  Parameters parameters = walking_parameters(seed / kPlaces);
  parameters.plant.sensor_errors = ErrorLevel::kField;
  const double scale = model.leg_length() / kReferenceLeg;
  terrain.height *= scale;
  terrain.distance = 0.75 + 0.1 * static_cast<double>(seed % kPlaces);
  terrain.heading = kHeadings[seed % kPlaces];
  parameters.plant.terrain = terrain;
  return parameters;
}

constexpr double kCrossing = 0.4;  // m/s

}  // namespace

void steps(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  for (const double height : {0.05, 0.10, 0.12}) {
    const Parameters parameters = on(model, seed, {.kind = TerrainKind::kStairs, .height = height, .count = 1});
    const std::string name = "step of " + std::to_string(std::lround(100 * height)) + " cm";
    const double edge = parameters.plant.terrain.distance;
    add(model, name + " up", seed, cross(model, parameters, kCrossing, edge + 0.8), worst);
    add(model, name + " up and down", seed, cross(model, parameters, kCrossing, edge + 3), worst);
  }
}

void stairs(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  for (const double height : {0.05, 0.10}) {
    const Parameters parameters = on(model, seed, {.kind = TerrainKind::kStairs, .height = height});
    const std::string name = "five stairs of " + std::to_string(std::lround(100 * height)) + " cm";
    const double edge = parameters.plant.terrain.distance;
    add(model, name + " up", seed, cross(model, parameters, kCrossing, edge + 2.2), worst);
    add(model, name + " up and down", seed, cross(model, parameters, kCrossing, edge + 5.5), worst);
  }
}

void terrain(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  const auto over = [&](const std::string& name, const TerrainParameters& terrain, double length) {
    const Parameters parameters = on(model, seed, terrain);
    add(model, name, seed, cross(model, parameters, kCrossing, parameters.plant.terrain.distance + length), worst);
  };
  over("rough 3 cm", {.kind = TerrainKind::kRough, .height = 0.06, .length = 0.25, .count = 12}, 3.5);
  over("rough 5 cm", {.kind = TerrainKind::kRough, .height = 0.10, .length = 0.25, .count = 12}, 3.5);
  over("bars of 8 cm", {.kind = TerrainKind::kBars, .height = 0.08, .length = 0.6, .count = 4}, 3);
  over("gap of 10 cm", {.kind = TerrainKind::kGap, .length = 0.1}, 1);
  over("ice", {.kind = TerrainKind::kIce, .length = 1}, 2);
}

}  // namespace robot_control::bench
