// Random drives beyond every limit: the conditions of wheels report what a model says that is written from their
// headers. Wheel speeds, targets, standstill, planned torque and scrub have tests of their own and are taken as they
// are.

#include <cmath>
#include <numbers>
#include <random>

#include "machine/wheeled/scrub.h"
#include "safety/conditions/wheeled/wheeled_conditions.h"
#include "safety/monitor_fixture.h"

namespace robot_control::tests {

constexpr double kModelPeriod = 2e-3;  // s
constexpr double kModelQuantum = 2 * std::numbers::pi / 4096;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Two wheels a side that scrub in a turn; the joints of one side count backwards.
DriveTrain four_wheels() {
  DriveTrain robot = two_wheels();
  robot.joints.assign(4, {.name = "wheel", .child_link = "wheel", .effort_limit = 8, .velocity_limit = 12});
  robot.wheels.clear();
  for (std::size_t i = 0; i < 4; ++i) {
    const bool right = i >= 2;
    robot.wheels.push_back({.joint = i,
                            .centre_base = {i % 2 == 0 ? 0.2 : -0.2, right ? -0.25 : 0.25, 0},
                            .radius = 0.1,
                            .width = 0.04,
                            .sign = right ? -1.0 : 1.0,
                            .inertia = 0.01,
                            .side = right ? Side::kRight : Side::kLeft});
  }
  robot.yaw_inertia = 0.8;
  robot.wheel_base_multiplier = 1.4;
  return robot;
}

/// A condition of the model: what is active, and since how many cycles its quantity is beyond the limit.
struct Watched {
  std::uint64_t count = 0;

  bool step(bool beyond, const Condition& condition, std::uint64_t cycles) {
    count = beyond ? count + cycles : 0;
    return beyond && static_cast<double>(count) * kModelPeriod >= condition.persistence - 1e-9;
  }
};

struct Quantity {
  double value = 0, limit = kNever;
  std::uint64_t joint = kMaxJoints;

  bool beyond() const { return value > limit; }
  std::uint64_t weight() const {
    return beyond() && value >= 3 * limit ? static_cast<std::uint64_t>(std::min(value / limit, 50.0)) : 1;
  }
};

Quantity worst(const std::vector<Quantity>& all) {
  Quantity result;
  for (const Quantity& each : all)
    if (each.value - each.limit > result.value - result.limit) result = each;
  return result;
}

/// All that a step reads.
struct Facts {
  SensorFrame sensors;
  std::optional<CommandFrame> command;
  double speed_limit = kNoSpeedLimit;
  double yaw_excess = 0;
  std::uint64_t elapsed = 1;
};

/// The measurements and targets that the conditions get.
struct Measured {
  WheelMotion motion;
  WheelTargets targets;
  JointStandstill standstill;

  Measured(const DriveTrain& robot, const SafetyParameters& parameters)
      : motion(robot.wheels.size(), kModelPeriod),
        targets(robot.wheels.size()),
        standstill(parameters.standstill_speed, kModelPeriod) {}

  void step(const Facts& facts) {
    motion.step(facts.sensors);
    standstill.step(motion, facts.sensors.head.cycle);
    targets.step({.sensors = &facts.sensors, .command = facts.command ? &*facts.command : nullptr});
  }
};

/// The laws of wheel_limits.h, wheel_excess.h, stall.h, wheeled_conditions.h and torque_oscillation.h in one run.
class Model {
 public:
  Model(const DriveTrain& robot, const SafetyParameters& parameters)
      : robot_(robot), parameters_(parameters), planned_(robot), scrub_(robot), wheels_(robot.wheels.size()) {}

  std::map<StopCause, Quantity> step(const Facts& facts, const Measured& measured) {
    active_.clear();
    limits(facts, measured);
    following(facts, measured);
    oscillation(facts, measured);
    return active_;
  }

 private:
  struct Ripple {
    double slow = 0, square = 0;
    void step(double value, double dt) {
      slow += (1 - std::exp(-2 * std::numbers::pi * 5 * dt)) * (value - slow);
      square += (1 - std::exp(-dt / 0.5)) * ((value - slow) * (value - slow) - square);
    }
  };
  struct Wheel {
    std::optional<double> runaway_mark, wrong_mark;
    Watched runaway, wrong;
    double missed = 0, travel = 0, excused = 0, mark = 0, peak = -kNever, level = 0;
    std::optional<double> last_target;
    Ripple measured, commanded, planned;
    double command = 0;
  };

  void evaluate(StopCause cause, Watched& watched, const Condition& condition, const Quantity& quantity,
                std::uint64_t cycles) {
    if (watched.step(quantity.beyond(), condition, cycles)) active_.try_emplace(cause, quantity);
  }

  void limits(const Facts& facts, const Measured& m) {
    // The largest limit of whole windows of ramp_time, the present one included.
    since_ += facts.elapsed;
    largest_now_ = std::max(largest_now_, facts.speed_limit);
    if (since_ >= static_cast<std::uint64_t>(std::lround(parameters_.ramp_time / kModelPeriod))) {
      since_ = 0;
      largest_last_ = largest_now_;
      largest_now_ = facts.speed_limit;
    }
    const double in_force = std::max(largest_last_, largest_now_);
    std::vector<Quantity> speeds, accelerations, efforts;
    Quantity power{.value = 0, .limit = *parameters_.power.limit};
    for (std::size_t i = 0; i < m.motion.wheels(); ++i) {
      const double slowed = (1.2 * in_force + 0.05) / robot_.wheels[i].radius;
      const double effort = facts.sensors.joints[i].effort;
      speeds.push_back({std::abs(m.motion.speed(i)),
                        std::min(*parameters_.wheel_speed.limit, slowed) + m.motion.speed_tolerance(i), i});
      accelerations.push_back({std::abs(m.motion.acceleration(i)),
                               *parameters_.wheel_acceleration.limit + m.motion.acceleration_tolerance(i), i});
      efforts.push_back({std::abs(effort) / robot_.joints[i].effort_limit, *parameters_.wheel_effort.limit, i});
      power.value += std::max(0.0, effort * m.motion.speed(i));
      power.limit += std::abs(effort) * m.motion.speed_tolerance(i);
    }
    const bool known = m.motion.speed_known();
    const Quantity speed = known ? worst(speeds) : Quantity{};
    evaluate(kCauseWheelSpeed, speed_, parameters_.wheel_speed, speed, facts.elapsed * speed.weight());
    evaluate(kCauseWheelAcceleration, acceleration_, parameters_.wheel_acceleration,
             m.motion.acceleration_known() ? worst(accelerations) : Quantity{}, facts.elapsed);
    evaluate(kCauseWheelEffort, effort_, parameters_.wheel_effort,
             m.motion.sampled() && m.targets.passed() ? worst(efforts) : Quantity{}, facts.elapsed);
    evaluate(kCausePower, power_, parameters_.power, known ? power : Quantity{}, facts.elapsed);
  }

  void excess(StopCause cause, Watched& watched, std::optional<double>& mark, const Condition& condition,
              const Quantity& quantity, double speed, double progress, std::uint64_t cycles) {
    if (!quantity.beyond()) {
      mark.reset();
      watched.count = 0;
      return;
    }
    if (!mark) {
      mark = speed;
    } else if (speed < *mark - progress && quantity.value <= 1.5 * quantity.limit) {
      mark = speed;
      watched.count = 0;
      return;
    }
    evaluate(cause, watched, condition, quantity, cycles);
  }

  void following(const Facts& facts, const Measured& m) {
    const double dt = static_cast<double>(facts.elapsed) * kModelPeriod;
    const bool known = m.motion.speed_known();
    for (std::size_t i = 0; i < wheels_.size(); ++i) {
      Wheel& wheel = wheels_[i];
      if (!known || !m.targets.has(i)) {
        wheel.runaway_mark = wheel.wrong_mark = std::nullopt;
        wheel.runaway.count = wheel.wrong.count = 0;
        continue;
      }
      const double target = m.targets[i], tolerance = m.motion.speed_tolerance(i);
      const double along = target < 0 ? -m.motion.speed(i) : m.motion.speed(i);
      const double fast = target == 0 ? std::abs(along) : along;
      const Quantity away{fast - std::abs(target), *parameters_.runaway.limit + tolerance, i};
      excess(kCauseRunaway, wheel.runaway, wheel.runaway_mark, parameters_.runaway, away, fast, 0.1 + tolerance,
             facts.elapsed * away.weight());
      const double back = target == 0 ? 0 : -along;
      excess(kCauseWrongDirection, wheel.wrong, wheel.wrong_mark, parameters_.wrong_direction,
             {back, *parameters_.wrong_direction.limit + tolerance, i}, back, 0.1 + tolerance, facts.elapsed);
    }
    planned_.step(m.targets, dt);
    evaluate(kCauseStall, stall_, parameters_.stall, known ? stalled(facts, m, dt) : Quantity{}, facts.elapsed);
    evaluate(kCauseNotStopping, not_stopping_, parameters_.not_stopping,
             known ? moving_on(m, facts.elapsed) : Quantity{}, facts.elapsed);
  }

  Quantity stalled(const Facts& facts, const Measured& m, double dt) {
    const double limit = *parameters_.stall.limit;
    std::array<double, kMaxWheels> wanted{};
    for (std::size_t i = 0; i < wheels_.size(); ++i) wanted[i] = m.targets.has(i) ? m.targets[i] : 0;
    const std::array<double, kMaxWheels> scrubbing = scrub_.efforts(wanted);
    std::vector<Quantity> all;
    for (std::size_t i = 0; i < wheels_.size(); ++i) {
      Wheel& wheel = wheels_[i];
      const JointModel& joint = robot_.joints[i];
      const double sign = m.targets[i] < 0 ? -1 : 1;
      const double fastest = joint.velocity_limit > 0 ? joint.velocity_limit : kNever;
      const double demand = std::min(std::abs(wanted[i]), fastest);
      const double speed = sign * m.motion.speed(i), torque = facts.sensors.joints[i].effort;
      const double level = std::max(0.5 * joint.effort_limit,
                                    std::min(0.9 * joint.effort_limit, 1.2 * (joint.friction + scrub_.max_effort(i))));
      if (std::abs(speed) >= 0.2 * demand || speed > wheel.mark + 0.1 + m.motion.speed_tolerance(i)) {
        wheel.missed = wheel.travel = wheel.excused = wheel.level = 0;
        wheel.mark = speed;
        wheel.peak = -kNever;
      } else {
        wheel.travel += demand * dt;
        const bool pushes =
            wheel.travel > m.motion.quantum(i) && std::abs(torque) > level && std::abs(torque - planned_[i]) > level;
        bool excused = false;
        if (wheel.excused < 0.5 * limit && scrubbing[i] != 0) {
          const double held = std::min(level, joint.friction + 3 * std::abs(scrubbing[i]));
          if (sign * torque <= held) {
            if (sign * torque > wheel.peak + 0.01 * held) {
              wheel.peak = sign * torque;
              wheel.level = 0;
            }
            wheel.level += dt;
            excused = wheel.level <= 0.03;
          }
        }
        const double per_yaw = robot_.effective_wheel_base() / robot_.wheels[i].radius;
        (excused ? wheel.excused : wheel.missed) +=
            std::max({demand, pushes ? 2.0 : 0.0, facts.yaw_excess * per_yaw}) * dt;
      }
      all.push_back({wheel.missed, limit + m.motion.quantum(i), i});
    }
    return worst(all);
  }

  Quantity moving_on(const Measured& m, std::uint64_t elapsed) {
    rested_ = m.standstill.moving() ? 0 : rested_ + elapsed;
    if (!m.targets.commanded_to_stand() || static_cast<double>(rested_) * kModelPeriod >= 0.5) {
      moved_ = 0;
    } else if (m.standstill.moving()) {
      moved_ += elapsed;
    }
    return {static_cast<double>(moved_) * kModelPeriod, *parameters_.not_stopping.limit};
  }

  void oscillation(const Facts& facts, const Measured& m) {
    const double dt = static_cast<double>(facts.elapsed) * kModelPeriod;
    std::vector<Quantity> all;
    for (std::size_t i = 0; i < wheels_.size(); ++i) {
      Wheel& wheel = wheels_[i];
      if (facts.command) wheel.command = facts.command->joints[i].effort;
      const double torque = facts.sensors.joints[i].effort;
      if (!m.motion.sampled() || !m.targets.has(i) || !std::isfinite(torque) || !std::isfinite(wheel.command)) {
        wheel.last_target.reset();
        wheel.measured = wheel.commanded = wheel.planned = {};
        continue;
      }
      if (!wheel.last_target) {
        wheel.measured.slow = torque;
        wheel.commanded.slow = wheel.command;
      } else {
        wheel.measured.step(torque, dt);
        wheel.commanded.step(wheel.command, dt);
        wheel.planned.step(inertia(i) * (m.targets[i] - *wheel.last_target) / dt, dt);
      }
      wheel.last_target = m.targets[i];
      const double effort_limit = robot_.joints[i].effort_limit;
      const double ripple = std::sqrt(std::min(wheel.measured.square, wheel.commanded.square));
      const double explained = 2 * std::sqrt(wheel.planned.square) + parameters_.count_ripple[i] * m.motion.quantum(i);
      all.push_back({ripple / effort_limit, *parameters_.torque_oscillation.limit + explained / effort_limit, i});
    }
    const Quantity quantity = worst(all);
    Condition announced = parameters_.torque_oscillation;
    announced.persistence *= 0.5;
    evaluate(kCauseTorqueOscillation, oscillation_, parameters_.torque_oscillation, quantity, facts.elapsed);
    evaluate(kCauseTorqueOscillation, announced_, announced, quantity, facts.elapsed);
  }

  double inertia(std::size_t i) const {
    const double beside = static_cast<double>(wheels_.size()) / 2,
                 square = robot_.wheels[i].radius * robot_.wheels[i].radius / beside;
    return robot_.wheels[i].inertia +
           std::max(0.5 * robot_.mass * square,
                    2 * robot_.yaw_inertia * square / (robot_.wheel_base * robot_.effective_wheel_base()));
  }

  const DriveTrain& robot_;
  const SafetyParameters& parameters_;
  PlannedTorque planned_;
  Scrub scrub_;
  std::vector<Wheel> wheels_;
  std::map<StopCause, Quantity> active_;
  Watched speed_, acceleration_, effort_, power_, stall_, not_stopping_, oscillation_, announced_;
  std::uint64_t since_ = 0, moved_ = 0, rested_ = 0;
  double largest_last_ = kNoSpeedLimit, largest_now_ = kNoSpeedLimit;
};

/// A robot whose wheels do for a while what its command says, or something else.
class RandomDrive {
 public:
  RandomDrive(std::size_t wheels, unsigned seed) : wheels_(wheels), random_(seed), speed_(wheels), target_(wheels) {
    facts_.sensors.joint_count = wheels;
    set_joints_valid(facts_.sensors, kValidMotion);
  }

  const Facts& step() {
    if (left_ == 0) choose();
    --left_;
    facts_.elapsed = chance(0.05) ? 2 + pick(4) : 1;
    SensorFrame& sensors = facts_.sensors;
    sensors.head.cycle += facts_.elapsed;
    for (std::size_t i = 0; i < wheels_; ++i) {
      speed_[i] += 0.05 * (aim_[i] - speed_[i]);
      angle_[i] += speed_[i] * static_cast<double>(facts_.elapsed) * kModelPeriod;
      JointSample& joint = sensors.joints[i];
      joint.position = kModelQuantum * std::floor(angle_[i] / kModelQuantum);
      joint.effort =
          torque_[i] + shake_ * (1 + 0.1 * static_cast<double>(i)) * (sensors.head.cycle / 3 % 2 == 0 ? 1 : -1);
      if (grows_) torque_[i] += 0.02 * between(0, 1) * (target_[i] < 0 ? -1 : 1);
    }
    set_joints_valid(sensors, chance(0.01) ? 0 : kValidMotion);
    sensors.gate.verdict = braked_ ? GateVerdict::kBrake : GateVerdict::kPassed;
    if (chance(0.02)) {
      facts_.command.reset();
      return facts_;
    }
    CommandFrame command;
    command.joint_count = wheels_;
    for (std::size_t i = 0; i < wheels_; ++i)
      command.joints[i] = {.mode = stands_ ? JointMode::kBrake : JointMode::kEffort,
                           .velocity = target_[i] + (drifts_ ? 0.3 * std::sin(0.02 * static_cast<double>(left_)) : 0),
                           .effort = sensors.joints[i].effort};
    facts_.command = command;
    return facts_;
  }

  void enter_run() {
    facts_.sensors.head.cycle = 0;
    ++facts_.sensors.head.run;
  }

 private:
  double between(double lower, double upper) { return std::uniform_real_distribution<>(lower, upper)(random_); }
  bool chance(double share) { return between(0, 1) < share; }
  std::uint64_t pick(std::uint64_t count) { return random_() % count; }

  void choose() {
    left_ = 20 + pick(150);
    braked_ = chance(0.1);
    stands_ = chance(0.15);
    drifts_ = chance(0.3);
    grows_ = chance(0.5);
    shake_ = chance(0.3) ? between(0, 4) : 0;
    facts_.yaw_excess = chance(0.2) ? between(0, 1) : 0;
    facts_.speed_limit = chance(0.5) ? kNoSpeedLimit : between(0, 1.5);
    const bool turns = chance(0.5);
    const double pace = chance(0.2) ? 0 : between(-14, 14);
    for (std::size_t i = 0; i < wheels_; ++i) {
      target_[i] = turns && i >= wheels_ / 2 ? -pace : pace;
      const double choice = between(0, 1);
      aim_[i] = choice < 0.4 ? target_[i] : choice < 0.6 ? 0 : choice < 0.8 ? between(-40, 40) : -target_[i];
      torque_[i] = between(-10, 10) * (chance(0.5) ? 1 : 0.2);
    }
  }

  std::size_t wheels_;
  std::mt19937 random_;
  Facts facts_;
  std::vector<double> speed_, target_;
  std::array<double, kMaxWheels> angle_{}, aim_{}, torque_{};
  std::uint64_t left_ = 0;
  double shake_ = 0;
  bool braked_ = false, stands_ = false, drifts_ = false, grows_ = false;
};

SafetyParameters drawn(std::mt19937& random, const DriveTrain& robot) {
  const auto between = [&](double lower, double upper) {
    return std::uniform_real_distribution<>(lower, upper)(random);
  };
  SafetyParameters parameters;
  parameters.yaw_rate.reaction = Reaction::kOff;
  parameters.ramp_time = between(0.05, 0.4);
  const auto set = [&](Condition& condition, double lower, double upper) {
    condition = {.limit = between(lower, upper), .persistence = between(0, 0.1), .reaction = Reaction::kBrake};
  };
  set(parameters.wheel_speed, 5, 20);
  set(parameters.wheel_acceleration, 20, 300);
  set(parameters.wheel_effort, 0.3, 1.5);
  set(parameters.power, 10, 100);
  set(parameters.runaway, 0.5, 6);
  set(parameters.wrong_direction, 0.5, 6);
  set(parameters.stall, 0.2, 1.5);
  set(parameters.not_stopping, 0.05, 0.6);
  set(parameters.torque_oscillation, 0.03, 0.3);
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) parameters.count_ripple[i] = between(0, 200);
  return parameters;
}

TEST(WheelModels, RandomDrivesAreJudgedAsTheHeadersSayInEveryRun) {
  std::map<StopCause, int> seen;
  for (unsigned seed = 0; seed < 24; ++seed) {
    std::mt19937 random(seed);
    DriveTrain robot = seed % 2 == 0 ? two_wheels() : four_wheels();
    for (JointModel& joint : robot.joints) joint.friction = 0.2 * (seed % 3);
    if (seed % 5 == 0) robot.joints[0].velocity_limit = 0;
    const SafetyParameters parameters = drawn(random, robot);
    ConditionList<WheelLimits, WheelExcess<kCauseRunaway>, WheelExcess<kCauseWrongDirection>,
                  WatchedCondition<kCauseStall, Stall>, WatchedCondition<kCauseNotStopping, NotStopping>,
                  TorqueOscillation>
        conditions(parameters, robot, kModelPeriod);
    const BodyMotion body(robot, {}, kModelPeriod);
    SpeedLimitInForce in_force(parameters.ramp_time, kModelPeriod);
    std::array<WheelNumbers, kMaxWheels> wheels{};
    for (std::size_t i = 0; i < robot.wheels.size(); ++i)
      wheels[i] = {robot.wheels[i].radius, robot.joints[i].effort_limit};
    RandomDrive drive(robot.wheels.size(), seed);
    for (int run = 0; run < 3; ++run) {
      Measured measured(robot, parameters);
      Model model(robot, parameters);
      for (int k = 0; k < 1500; ++k) {
        const Facts& facts = drive.step();
        measured.step(facts);
        ActiveCauses out;
        const MonitorInput input{.sensors = &facts.sensors, .command = facts.command ? &*facts.command : nullptr};
        const double dt = static_cast<double>(facts.elapsed) * kModelPeriod;
        const bool efforts_measured = joints_have(facts.sensors, robot.wheels.size(), kValidEffort);
        conditions.step(WheeledMeasurements{{input, facts.elapsed, dt, body, body.attitude().vertical()},
                                            wheels,
                                            measured.motion,
                                            measured.standstill,
                                            measured.targets,
                                            efforts_measured,
                                            in_force.step(facts.speed_limit, facts.elapsed),
                                            {.beyond = facts.yaw_excess > 0, .value = facts.yaw_excess}},
                        out);
        const std::map<StopCause, Quantity> expected = model.step(facts, measured);
        std::map<StopCause, Quantity> reported;
        for (const CauseEvidence& each : out.measurements())
          reported.try_emplace(static_cast<StopCause>(each.cause), Quantity{each.value, each.limit, each.joint});
        for (const auto& [cause, quantity] : reported)
          ASSERT_TRUE(expected.contains(cause)) << cause << " seed " << seed << " run " << run << " step " << k;
        for (const auto& [cause, quantity] : expected) {
          const auto found = reported.find(cause);
          ASSERT_NE(found, reported.end()) << cause << " seed " << seed << " step " << k;
          ASSERT_NEAR(found->second.value, quantity.value, 1e-9 * (1 + quantity.value)) << cause << " step " << k;
          ASSERT_NEAR(found->second.limit, quantity.limit, 1e-9 * (1 + quantity.limit)) << cause << " step " << k;
          ASSERT_EQ(found->second.joint, quantity.joint) << cause << " seed " << seed << " step " << k;
          ++seen[cause];
        }
      }
      conditions.enter_run();
      in_force.enter_run();
      drive.enter_run();
    }
  }
  EXPECT_EQ(seen.size(), 9U) << "every condition was active";
}

}  // namespace robot_control::tests
