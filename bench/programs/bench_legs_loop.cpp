/// bench_legs_loop ROW SEEDS URDF…: measures robots on legs in the closed loop, on the simulated machine.
///
/// ROW is one of
///   postures  lying → standing → lying, with the default sensor errors, SEEDS seeds per robot
///   pose      the body follows sines of 0.5 Hz on each axis
///   circle    each foot draws a circle of 5 cm radius in 2 s while the others stand
///   stop      an e-stop while the robot stands, sways, and has one foot in the air
///   rest      10 minutes without power in the joints, after lying down
///   silent    the controller is silent for 5 … 19 cycles while the robot sways
///
/// A value is the worst one of all seeds. bench/legs.py judges it.

#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bench/programs/rows.h"
#include "support/quadruped_loop.h"

namespace robot_control::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSway = 0.5;  // Hz

/// The worst values of one robot, by name.
class Worst {
 public:
  void add(const std::string& name, double value, const std::string& unit) {
    auto& [worst, its_unit] = values_[name];
    worst = std::max(worst, std::isfinite(value) ? value : std::numeric_limits<double>::max());
    its_unit = unit;
  }
  void write(const std::string& robot, std::vector<Row>& rows) const {
    for (const auto& [name, value] : values_) {
      Row row;
      row.name = robot + ": " + name;
      row.value = value.first;
      row.unit = value.second;
      rows.push_back(row);
    }
  }

 private:
  std::map<std::string, std::pair<double, std::string>> values_;
};

double height(const QuadrupedLoop& robot) {
  return robot.truth().pose_world.position[2];
}

void stand_up(QuadrupedLoop& robot, double seconds = 2.5) {
  robot.wait(0.3);
  robot.run(seconds, stance(kStanceStand));
  robot.run(0.5, {});
  robot.clear();
}

/// Height of the standing body above the lying one that the robot was given, in m.
double nominal_rise(const LegModel& robot) {
  const LegGeometry& first = robot.legs[0].kinematics.geometry();
  return leg_tuning(robot).height - first.hip.z() - first.upper.z() + robot.belly + robot.legs[0].foot_radius;
}

void postures(const LegModel& model, std::uint64_t seed, Worst& worst) {
  QuadrupedLoop robot(model, seed, ErrorLevel::kField);
  robot.wait(0.3);
  const double lying = height(robot);
  robot.clear();
  robot.run(2.0, stance(kStanceStand));
  worst.add("effort of the limit", robot.effort, "");
  worst.add("height after 2 s", std::abs(height(robot) - lying - nominal_rise(model)), "m");
  worst.add("tilt after 2 s", robot.tilt_now(), "rad");
  robot.run(3.0, {});
  const Vector3 before = robot.truth().pose_world.position;
  robot.run(6.0, {});
  const Vector3& after = robot.truth().pose_world.position;
  worst.add("creep", 10 * std::hypot(after[0] - before[0], after[1] - before[1]), "m/min");
  robot.run(4.0, stance(kStanceLie));
  worst.add("not lying", (robot.command().reasons & kReasonHolding) != 0 ? 0 : 1, "");
  worst.add("stops", robot.permit().causes == 0 ? 0 : 1, "");
}

std::array<double, 6> pose(const QuadrupedLoop& robot) {
  const Pose& p = robot.truth().pose_world;
  return {p.position[0],          p.position[1],           p.position[2],
          roll_of(p.orientation), pitch_of(p.orientation), yaw_of(p.orientation)};
}

void body_pose(const LegModel& model, std::uint64_t seed, Worst& worst) {
  QuadrupedLoop robot(model, seed);
  stand_up(robot);
  const double length = model.leg_length(), omega = 2 * kPi * kSway;
  const double sizes[6] = {0.1 * length, 0.1 * length, 0.15 * length, 0.25, 0.25, 0.25};
  for (std::size_t axis = 0; axis < 6; ++axis) {
    robot.run(1.0, {});
    const std::array<double, 6> begin = pose(robot);
    robot.clear();
    double sum = 0;
    for (int k = 0; k < 4000; ++k) {
      Request request;
      double* const values[6] = {&request.posture.x,    &request.posture.y,     &request.posture.height,
                                 &request.posture.roll, &request.posture.pitch, &request.posture.yaw};
      *values[axis] = sizes[axis] * std::sin(omega * k * 0.001);
      robot.loop.request(request);
      robot.step();
      sum += std::pow(pose(robot)[axis] - begin[axis] - *values[axis], 2);
    }
    worst.add(axis < 3 ? "RMS of the place" : "RMS of the angle", std::sqrt(sum / 4000), axis < 3 ? "m" : "rad");
    worst.add("slip of a foot", *std::max_element(robot.slipped.begin(), robot.slipped.end()), "m");
  }
  worst.add("stops", robot.permit().causes == 0 ? 0 : 1, "");
}

void circle(const LegModel& model, std::uint64_t seed, Worst& worst) {
  QuadrupedLoop robot(model, seed);
  stand_up(robot);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    Request up = stance(kStanceLift + leg);
    up.posture.height = leg_tuning(model).lift;
    robot.clear();
    robot.run(2.0, up);
    const auto foot = [&]() -> Eigen::Vector3d {
      std::array<double, kLegsJoints> angles{};
      for (std::size_t i = 0; i < kLegsJoints; ++i) angles[i] = robot.truth().joints[i].position;
      return rotation_of(robot.truth().pose_world.orientation) *
             robot.robot().legs[leg].kinematics.position(LegModel::angles_of(angles, leg));
    };
    const Eigen::Vector3d begin = foot();
    double sum = 0;
    constexpr double kRadius = 0.05;  // m
    for (int k = 0; k < 2000; ++k) {
      const double turn = kPi * k * 0.001;
      Request request = up;
      request.posture.x = kRadius * std::sin(turn);
      request.posture.height += kRadius * (1 - std::cos(turn));
      robot.loop.request(request);
      robot.step();
      sum += (foot() - begin - kRadius * Eigen::Vector3d(std::sin(turn), 0, 1 - std::cos(turn))).squaredNorm();
    }
    const std::string name = name_of(static_cast<LegPlace>(leg));
    worst.add("RMS of foot " + name, std::sqrt(sum / 2000), "m");
    worst.add("tilt with foot " + name, robot.tilt, "rad");
    robot.run(2.5, {});
  }
  worst.add("stops", robot.permit().causes == 0 ? 0 : 1, "");
}

void stop(const LegModel& model, std::uint64_t seed, Worst& worst) {
  for (const std::string situation : {"standing", "swaying", "one foot up"}) {
    QuadrupedLoop robot(model, seed);
    stand_up(robot);
    if (situation == "swaying") {
      for (int k = 0; k < 1250; ++k) {
        Request request;
        request.posture.y = 0.1 * model.leg_length() * std::sin(2 * kPi * kSway * k * 0.001);
        robot.loop.request(request);
        robot.step();
      }
    } else if (situation == "one foot up") {
      Request up = stance(kStanceLift + seed % kLegs);
      up.posture.height = leg_tuning(model).lift;
      robot.run(2.0, up);
    }
    const double tilted = robot.tilt_now();
    robot.clear();
    robot.loop.e_stop();
    int braked = 0;
    while (robot.gate().verdict != GateVerdict::kBrake && braked < 100) {
      robot.step();
      ++braked;
    }
    double rested = 0, rest_at = 0;
    for (double t = 0; t < 3; t += 0.001) {
      robot.step();
      rested = robot.speed() < 0.01 ? rested + 0.001 : 0;
      if (rested < 0.001) rest_at = t;
    }
    worst.add("rest, " + situation, rest_at, "s");
    worst.add("acceleration, " + situation, robot.shock, "m/s^2");
    worst.add("tilt, " + situation, std::max(robot.tilt, tilted), "rad");
    worst.add("cycles to the brake, " + situation, braked, "");
  }
}

void rest(const LegModel& model, std::uint64_t seed, Worst& worst) {
  QuadrupedLoop robot(model, seed);
  stand_up(robot);
  robot.loop.e_stop();
  robot.wait(3);
  const auto joints = robot.truth().joints;
  robot.wait(600);
  double moved = 0;
  for (std::size_t i = 0; i < kLegsJoints; ++i)
    moved = std::max(moved, std::abs(robot.truth().joints[i].position - joints[i].position));
  worst.add("way of a joint in 10 min", moved, "rad");
}

void silent(const LegModel& model, std::uint64_t seed, Worst& worst) {
  for (int cycles = 5; cycles < 20; ++cycles) {
    QuadrupedLoop robot(model, seed);
    stand_up(robot);
    const auto sway = [&](int k) {
      Request request;
      request.posture.y = 0.05 * model.leg_length() * std::sin(2 * kPi * kSway * k * 0.001);
      robot.loop.request(request);
      robot.step();
    };
    int k = 0;
    for (; k < 500; ++k) sway(k);
    const Vector3 before = robot.truth().pose_world.position;
    robot.loop.inject_fault("controller", "off");
    for (int end = k + cycles; k < end; ++k) sway(k);
    robot.loop.inject_fault("controller", "ok");
    double moved = 0;
    for (int end = k + 100; k < end; ++k) {
      sway(k);
      moved = std::max(moved, std::abs(robot.truth().pose_world.position[2] - before[2]));
    }
    worst.add("way of the body", moved, "m");
    worst.add("stops", robot.permit().causes == 0 ? 0 : 1, "");
  }
}

using Measure = void (*)(const LegModel&, std::uint64_t, Worst&);

}  // namespace
}  // namespace robot_control::bench

int main(int argc, char** argv) {
  using namespace robot_control;
  using namespace robot_control::bench;
  const std::map<std::string, Measure> measures{{"postures", postures}, {"pose", body_pose}, {"circle", circle},
                                                {"stop", stop},         {"rest", rest},      {"silent", silent}};
  const auto found = argc > 3 ? measures.find(argv[1]) : measures.end();
  if (found == measures.end()) {
    std::fprintf(stderr, "usage: bench_legs_loop postures|pose|circle|stop|rest|silent SEEDS URDF...\n");
    return 1;
  }
  std::vector<Row> rows;
  for (int i = 3; i < argc; ++i) {
    const LegModel model = read_legs(load_description(argv[i]), {}, {});
    Worst worst;
    for (std::uint64_t seed = 0; seed < std::strtoull(argv[2], nullptr, 10); ++seed) found->second(model, seed, worst);
    worst.write(model.name, rows);
  }
  print("legs", rows);
  return 0;
}
