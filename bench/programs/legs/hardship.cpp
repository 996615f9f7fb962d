#include <random>

#include "bench/programs/legs/loop_rows.h"
#include "control/legged/walk/gait_table.h"
#include "machine/bodies/rigid_bodies.h"

namespace robot_control::bench {
namespace {

constexpr double kBegin = 5, kDisturbed = 5;  // s

Request trot(double speed, double lateral = 0) {
  return {.twist = {.linear = {speed, lateral, 0}, .angular = {}},
          .posture = {},
          .mode = {ModeKind::kGait, gait_named("trot")}};
}

constexpr int kDirections = 8, kPushPhases = 24;
constexpr double kPushTime = 0.1;  // s

/// A push of `force` N in one of kDirections, at one of kPushPhases of the gait.
void push_at(Parameters& parameters, const Gait& gait, std::uint64_t phase, int direction, double force) {
  const double angle = 2 * kPi * direction / kDirections;
  parameters.plant.push_x = force * std::cos(angle);
  parameters.plant.push_y = force * std::sin(angle);
  parameters.plant.push_start = kBegin + gait.period * static_cast<double>(phase % kPushPhases) / kPushPhases;
  parameters.plant.push_duration = kPushTime;
}

double stopped(const QuadrupedLoop& robot) {
  return robot.permit().causes != 0 || robot.command().legged.phase != LegPhase::kWalking ? 1 : 0;
}

/// Low passes of the true and of the requested speed, of which the second follows the twist as the walk does.
struct Speeds {
  static constexpr double kTime = 0.5;   // s
  static constexpr double kSlow = 0.08;  // m/s, below which no dip is judged

  void step(const QuadrupedLoop& robot, double lag) {
    requested += robot.period() / lag * (robot.command().twist_limited.linear[0] - requested);
    limited += robot.period() / kTime * (requested - limited);
    measured += robot.period() / kTime * (robot.truth().twist_base.linear[0] - measured);
    if (limited > kSlow) dip = std::max(dip, 1 - measured / limited);
  }

  double requested = 0, limited = 0, measured = 0, dip = 0;
};

/// The machine has `factor` of the masses that its laws know. Motors that give a part of their torque move it as if all
/// masses were divided by this part.
class HeavierQuadruped final : public Quadruped {
 public:
  HeavierQuadruped(const Parameters& parameters, const LegModel& known, double factor)
      : Quadruped(parameters, known), actual_(known) {
    auto bodies = std::make_shared<RigidBodies>(*known.bodies);
    for (RigidBody& body : bodies->bodies) {
      body.mass *= factor;
      body.inertia *= factor;
    }
    actual_.bodies = std::move(bodies);
    actual_.mass *= factor;
  }
  const LegModel& machine() const noexcept override { return actual_; }

 private:
  LegModel actual_;
};

/// A trot of 0.3 m/s on a machine with these parameters and this factor of its masses.
void disturbed(const LegModel& model, const Parameters& parameters, const std::string& name, WorstValues& worst,
               double masses = 1) {
  constexpr double kSpeed = 0.3;  // m/s
  QuadrupedLoop robot(std::make_shared<HeavierQuadruped>(parameters, model, masses), parameters);
  robot.wait(0.3);
  robot.run(kBegin, trot(kSpeed));
  robot.clear();
  double sum = 0, count = 0;
  robot.after_step = [&] { sum += robot.truth().twist_base.linear[0], count += 1; };
  robot.run(kDisturbed, trot(kSpeed));
  worst.add("speed off, " + name, std::abs(sum / count / kSpeed - 1), "of it");
  worst.add("largest tilt, " + name, robot.tilt, "rad");
  worst.add("stops, " + name, stopped(robot), "");
}

}  // namespace

void switches(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  constexpr int kSwitches = 100;
  std::mt19937_64 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) / 9007199254740992.0;
  };
  QuadrupedLoop robot(model, walking_parameters(seed));
  robot.wait(0.3);
  robot.run(kBegin, trot(0.3));
  robot.clear();
  Speeds speeds{.requested = 0.3, .limited = 0.3, .measured = 0.3};
  double period = 0;
  robot.after_step = [&] {
    period = kGaits[robot.command().legged.gait].scaled(model.leg_length()).period;
    speeds.step(robot, period / 2);
  };
  for (int i = 0; i < kSwitches; ++i) {
    Request request = trot(between(0.1, 0.6));
    request.mode = {ModeKind::kGait, 1 + static_cast<std::uint64_t>(between(0, kGaits.size() - 1.0))};
    robot.run(between(0.3, 2), request);
  }
  worst.add("tilt while gaits change", robot.tilt, "rad");
  worst.add("dip of the speed while gaits change", speeds.dip, "of it");
  worst.add("stops, gaits that change", stopped(robot), "");
  if (robot.permit().causes != 0)
    std::fprintf(stderr, "%s, seed %llu: stopped by %s\n", model.name.c_str(), static_cast<unsigned long long>(seed),
                 robot.causes().c_str());
}

void disturbances(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  constexpr double kForce = 150;  // N on a robot of 12.7 kg
  const Gait gait = kGaits[gait_named("trot")].scaled(model.leg_length());
  for (int i = 0; i < kDirections; ++i) {
    Parameters parameters = walking_parameters(seed);
    push_at(parameters, gait, seed, i, kForce * model.mass / 12.7);
    QuadrupedLoop robot(model, parameters);
    robot.wait(0.3);
    robot.run(kBegin + 3, trot(0.3));
    const double fallen = robot.tilt > kTurnedOver ? 1 : 0;
    worst.average("pushed over", fallen, "of the pushes");
    worst.average("stopped by a push, " + std::to_string(45 * i) + " deg", stopped(robot), "of the pushes");
  }
  const double far = 0.1 * model.leg_length();
  Parameters payload = walking_parameters(seed), ice = walking_parameters(seed), late = walking_parameters(seed);
  payload.plant.payload = 0.2 * model.mass;
  payload.plant.payload_x = payload.plant.payload_y = far;
  payload.plant.payload_z = far;
  disturbed(model, payload, "payload", worst);
  ice.plant.ground_friction = 0.3;
  disturbed(model, ice, "friction 0.3", worst);
  late.plant.actuator_delay = static_cast<std::uint64_t>(std::lround(0.005 * late.loop.rate));
  disturbed(model, late, "motors 5 ms late", worst);
  const Parameters usual = walking_parameters(seed);
  disturbed(model, usual, "motors at 0.8 of their torque", worst, 1 / 0.8);
  disturbed(model, usual, "masses 5 % less", worst, 0.95);
  disturbed(model, usual, "masses 5 % more", worst, 1.05);
}

void kicks(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  constexpr double kImpulse = 20;  // N·s on a robot of 12.7 kg
  const Gait gait = kGaits[gait_named("trot")].scaled(model.leg_length());
  for (const double speed : {0.3, 1.0}) {
    const std::string name = "kicks at " + std::to_string(speed).substr(0, 3) + " m/s";
    for (int i = 0; i < kDirections; ++i) {
      Parameters parameters = walking_parameters(seed);
      parameters.plant.sensor_errors = ErrorLevel::kField;
      push_at(parameters, gait, seed, i, kImpulse / kPushTime * model.mass / 12.7);
      QuadrupedLoop robot(model, parameters);
      robot.wait(0.3);
      robot.run(kBegin + 3, trot(speed));
      const bool over = robot.tilt > kTurnedOver, stops = stopped(robot) != 0;
      worst.average("turned over, " + name, over ? 1 : 0, "of the kicks");
      worst.average("not caught, " + name, over || stops ? 1 : 0, "of the kicks");
      if (over || stops)
        std::fprintf(stderr, "%s, %.1f m/s, %d deg, seed %llu: %s\n", model.name.c_str(), speed, 45 * i,
                     static_cast<unsigned long long>(seed), robot.causes().c_str());
    }
  }
}

void push_limits(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  constexpr int kSteps = 10;
  constexpr double kStep = 5;  // N·s on a robot of 12.7 kg
  struct Walk {
    std::uint64_t gait;
    double speed;  // m/s
  };
  for (const Walk& each : {Walk{gait_named("trot"), 0.3}, Walk{gait_named("trot"), 1.0},
                           Walk{gait_named("walking_trot"), 0.3}, Walk{gait_named("crawl"), 0.15}}) {
    const Gait gait = kGaits[each.gait].scaled(model.leg_length());
    Request walk = trot(each.speed);
    walk.mode = {ModeKind::kGait, each.gait};
    for (int i = 0; i < kDirections; ++i) {
      Parameters parameters = walking_parameters(seed);
      const double step = kStep * model.mass / 12.7;
      double taken = 0;
      for (int k = 1; k <= kSteps; ++k) {
        push_at(parameters, gait, seed, i, k * step / kPushTime);
        QuadrupedLoop robot(model, parameters);
        robot.wait(0.3);
        robot.run(kBegin + 2.5, walk);
        if (robot.tilt > kTurnedOver || stopped(robot) != 0) break;
        taken = k * step;
      }
      worst.add_least("push taken, " + std::string(gait.name.data()) + " of " +
                          std::to_string(each.speed).substr(0, 4) + " m/s, " + std::to_string(45 * i) + " deg",
                      taken, "N s");
    }
  }
}

void walking_silent(const LegModel& model, std::uint64_t seed, WorstValues& worst) {
  constexpr int kLosses = 200, kMin = 5, kMax = 19;  // cycles
  const double period = kGaits[gait_named("trot")].scaled(model.leg_length()).period;
  for (const std::string node : {"controller", "estimator", "monitor"}) {
    QuadrupedLoop robot(model, walking_parameters(seed));
    robot.wait(0.3);
    robot.run(kBegin, trot(1.0));
    robot.clear();
    for (int i = 0; i < kLosses && stopped(robot) == 0; ++i) {
      const int silent = kMin + i % (kMax - kMin + 1);
      robot.loop.request(trot(1.0));
      robot.loop.inject_fault(node, "off");
      robot.wait(robot.period() * silent);
      robot.loop.inject_fault(node, "ok");
      robot.run(0.6 + period * i / kLosses, trot(1.0));
      if (stopped(robot) != 0)
        std::fprintf(stderr, "%s, seed %llu, %s silent for %d cycles: %s\n", model.name.c_str(),
                     static_cast<unsigned long long>(seed), node.c_str(), silent, robot.causes().c_str());
    }
    worst.add("tilt with a silent " + node, robot.tilt, "rad");
    worst.add("stops, silent " + node, stopped(robot), "");
  }
}

}  // namespace robot_control::bench
