#include "bench/programs/legs/loop_rows.h"
#include "control/legged/walk/gait_table.h"

namespace robot_control::bench {
namespace {

constexpr double kHealthy = 4, kNamed = 0.3, kAfter = 2.5;  // s
constexpr std::uint64_t kPhases = 20;
constexpr std::uint64_t kNoNames = kCauseFootSlip | kCauseFootLoad;  // of a joint: they name the knee of each foot

struct Fault {
  std::string component, kind;
  std::size_t joint = kLegsJoints;  ///< kLegsJoints: that of no joint
};

std::vector<Fault> faults_of(const LegModel& model) {
  std::vector<Fault> faults;
  for (const std::string kind : {"off", "stuck", "garbage", "wrong", "slow", "delayed", "intermittent"}) {
    for (std::size_t i = 0; i < kLegsJoints; ++i)
      for (const std::string part : {"encoder", "motor"})
        faults.push_back({model.joints[i].name + "_" + part, kind, i});
    for (const std::string part : {"gyro", "accelerometer"}) faults.push_back({part, kind});
  }
  return faults;
}

std::string part_of(const Fault& fault) {
  return fault.component.substr(fault.component.rfind('_') + 1);  // npos + 1 is 0
}

/// Returns whether the permit names the faulty part: its joint, or the IMU.
bool names(const Permit& permit, const Fault& fault) {
  if (permit.causes == 0) return false;
  constexpr std::uint64_t kOfImu =
      kCauseImuLost | kCauseImuStuck | kCauseImuJump | kCauseImuReversed | kCauseBodyTurn | kCauseNotFinite;
  if (fault.joint == kLegsJoints) return (permit.first_cause & kOfImu) != 0;
  return (permit.first_cause & kNoNames) == 0 && permit.evidence[0].joint == fault.joint;
}

void faults_on(const LegModel& model, const Parameters& parameters, const std::string& ground, std::uint64_t seed,
               WorstValues& worst) {
  const double period = kGaits[gait_named("trot")].scaled(model.leg_length()).period;
  Request trot = stance({ModeKind::kGait, gait_named("trot")});
  trot.twist.linear[0] = 0.5;
  for (const Fault& fault : faults_of(model)) {
    QuadrupedLoop robot(model, parameters);
    robot.wait(0.3);
    robot.run(kHealthy + period * static_cast<double>(seed % kPhases) / kPhases, trot);
    robot.clear();
    robot.loop.inject_fault(fault.component, fault.kind);
    double stopped = kAfter;
    for (double t = 0; t < kAfter; t += 0.02) {
      robot.run(0.02, trot);
      if (robot.permit().causes != 0) stopped = std::min(stopped, t + 0.02);
    }
    const bool walks = robot.permit().causes == 0 && robot.command().legged.phase == LegPhase::kWalking;
    const bool is_named = names(robot.permit(), fault) && stopped <= kNamed;
    const bool over = robot.tilt_now() > kTurnedOver;
    worst.average("turned over by a fault" + ground, over ? 1 : 0, "of the faults");
    worst.average("neither named nor walked through" + ground, walks || is_named ? 0 : 1, "of the faults");
    worst.average("neither, " + part_of(fault) + " " + fault.kind + ground, walks || is_named ? 0 : 1, "of the faults");
    if (over || !(walks || is_named))
      std::fprintf(stderr, "%s%s, seed %llu, %s %s: %s, first %s of joint %d, after %.2f s, tilt %.2f rad\n",
                   model.name.c_str(), ground.c_str(), static_cast<unsigned long long>(seed), fault.component.c_str(),
                   fault.kind.c_str(), over ? "turned over" : "upright",
                   names_of(kStopCauseNames, robot.permit().first_cause).c_str(),
                   static_cast<int>(robot.permit().evidence[0].joint), stopped, robot.tilt);
  }
}

}  // namespace

void faults(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  faults_on(model, walking_parameters(seed), "", seed, worst);
}

void faults_uneven(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  Parameters slope = walking_parameters(seed), tiles = slope;
  slope.plant.slope = kPi / 18;
  slope.plant.slope_heading = kPi / 4 * static_cast<double>(seed % 8);
  tiles.plant.terrain = {
      .kind = TerrainKind::kRough, .height = 0.06 * model.leg_length() / kReferenceLeg, .length = 0.25, .count = 24};
  faults_on(model, slope, ", slope of 10 deg", seed, worst);
  faults_on(model, tiles, ", tiles of 3 cm", seed, worst);
}

}  // namespace robot_control::bench
