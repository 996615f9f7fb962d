// Random reports: the conditions of gate and machine report what a model says that is written from their headers.

#include <gtest/gtest.h>

#include <random>

#include "safety/conditions/common/gate_conditions.h"
#include "safety/conditions/common/machine_conditions.h"

namespace robot_control::tests {

using Causes = std::map<std::uint64_t, std::pair<double, double>>;  // cause → value, limit

Causes causes_of(const ActiveCauses& active) {
  Causes causes;
  for (const CauseEvidence& each : active.measurements()) causes[each.cause] = {each.value, each.limit};
  return causes;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  bool chance(double share) { return std::uniform_real_distribution<>(0, 1)(engine_) < share; }
  std::uint64_t below(std::uint64_t count) { return engine_() % count; }

 private:
  std::mt19937 engine_;
};

/// The laws of gate_conditions.h in one run.
class GateModel {
 public:
  GateModel(std::uint64_t loss_cycles, std::uint64_t second) : loss_cycles_(loss_cycles), second_(second) {}

  Causes step(const SensorFrame& sensors) {
    const std::uint64_t frame = sensors.head.cycle, tick = sensors.gate.cycle;
    if (frame == 0) return {};
    const bool out_of_place = tick >= frame || (begun_ && tick < frame_);
    const bool braked =
        sensors.gate.verdict == GateVerdict::kBrake && (sensors.gate.reasons & kGateControllerBrake) == 0;
    const bool refused = (braked || sensors.gate.refused > refused_) && allowed(tick, tick);
    const std::uint64_t ticks = !begun_ || out_of_place ? 1 : tick - tick_;
    in_a_row_ = refused ? in_a_row_ + ticks : 0;
    last_.insert(last_.end(), ticks, refused);
    const std::size_t kept = std::min<std::size_t>(last_.size(), second_);
    const auto in_second =
        static_cast<std::uint64_t>(std::count(last_.end() - static_cast<std::ptrdiff_t>(kept), last_.end(), true));
    Causes causes;
    if (in_a_row_ >= loss_cycles_) {
      causes[kCauseGateRefuses] = {static_cast<double>(in_a_row_), static_cast<double>(loss_cycles_)};
    } else if (2 * in_second > second_) {
      causes[kCauseGateRefuses] = {static_cast<double>(in_second), static_cast<double>(second_) / 2};
    }
    if (sensors.gate.verdict != GateVerdict::kBrake && (out_of_place || disobeys(sensors.gate)))
      causes[kCauseGateDisobeys] = {1, 0};
    begun_ = true;
    frame_ = frame;
    tick_ = out_of_place ? frame - 1 : tick;
    refused_ = sensors.gate.refused;
    return causes;
  }

  void remember(const Permit& permit, std::uint64_t cycle) { given_.push_back({cycle, permit}); }

 private:
  struct Given {
    std::uint64_t cycle;
    Permit permit;
  };

  /// The newest permit of a cycle below `before` allows motion in `tick`.
  bool allowed(std::uint64_t before, std::uint64_t tick) const {
    const Given* const newest = newest_before(before);
    return newest != nullptr && alive(*newest, tick);
  }
  const Given* newest_before(std::uint64_t cycle) const {
    for (auto given = given_.rbegin(); given != given_.rend(); ++given)
      if (given->cycle < cycle) return &*given;
    return nullptr;
  }
  static bool alive(const Given& given, std::uint64_t tick) {
    const bool moves = given.permit.action == PermitAction::kDrive ||
                       (given.permit.action == PermitAction::kRamp && tick <= given.permit.ramp_until);
    return moves && tick - given.cycle <= 4;
  }
  bool disobeys(const GateReport& report) const {
    if (report.permit_cycle >= report.cycle || report.cycle - report.permit_cycle > 4) return true;
    const Given* const used = newest_before(report.permit_cycle + 1);
    return used != nullptr && (used->cycle != report.permit_cycle || !alive(*used, report.cycle));
  }

  std::uint64_t loss_cycles_, second_, frame_ = 0, tick_ = 0, refused_ = 0, in_a_row_ = 0;
  bool begun_ = false;
  std::vector<Given> given_;
  std::vector<bool> last_;
};

TEST(GateModels, RandomReportsOfAGateAreJudgedAsTheHeaderSaysInEveryRun) {
  std::map<std::uint64_t, int> seen;
  for (unsigned seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const std::uint64_t loss = 5 + random.below(20), second = 20 + random.below(100);
    GateConditions conditions(loss, 1.0 / static_cast<double>(second));
    for (int run = 0; run < 3; ++run) {
      GateModel model(loss, second);
      std::uint64_t cycle = random.below(3);
      std::uint64_t refused = 0;
      double braking = 0, late = 0;
      PermitAction action = PermitAction::kDrive;
      for (int k = 0; k < 800; ++k) {
        if (k % 40 == 0) {
          braking = random.chance(0.5) ? 0 : random.chance(0.3) ? 1 : 0.55;
          late = random.chance(0.7) ? 0 : 0.3;
          action = std::array{PermitAction::kDrive, PermitAction::kDrive, PermitAction::kRamp,
                              PermitAction::kBrake}[random.below(4)];
        }
        SensorFrame sensors;
        sensors.head.cycle = cycle;
        GateReport& gate = sensors.gate;
        gate.cycle =
            cycle == 0 ? 0 : cycle - 1 - (random.chance(late) ? random.below(std::min<std::uint64_t>(cycle, 3)) : 0);
        if (random.chance(0.01)) gate.cycle = cycle + random.below(2);
        gate.permit_cycle = gate.cycle - std::min(gate.cycle, 1 + (random.chance(0.1) ? random.below(5) : 0));
        if (random.chance(0.02)) gate.permit_cycle = gate.cycle;
        gate.verdict =
            random.chance(braking) || action == PermitAction::kBrake ? GateVerdict::kBrake : GateVerdict::kPassed;
        if (random.chance(0.02)) gate.verdict = GateVerdict::kPassed;
        gate.reasons = random.chance(0.02) ? std::uint64_t{kGateControllerBrake} : 0;
        refused += random.chance(0.02) ? 1 : 0;
        gate.refused = refused;
        ActiveCauses active;
        conditions.step(sensors, active);
        const Causes expected = model.step(sensors);
        ASSERT_EQ(causes_of(active), expected) << "seed " << seed << " run " << run << " step " << k;
        for (const auto& [cause, values] : expected) ++seen[cause];
        Permit permit;
        permit.action = action;
        permit.ramp_until = cycle + random.below(3);
        conditions.remember(permit, cycle);
        model.remember(permit, cycle);
        cycle += random.chance(0.1) ? 1 + random.below(5) : 1;
      }
      conditions.enter_run();
    }
  }
  EXPECT_EQ(seen.size(), 2U);
}

/// The laws of machine_conditions.h in one run, for causes that need no persistence.
class MachineConditionsModel {
 public:
  MachineConditionsModel(const SafetyParameters& parameters, double period)
      : parameters_(parameters), period_(period), mark_(static_cast<std::uint64_t>(std::lround(0.1 / period))) {}

  Causes step(const SensorFrame& sensors, std::uint64_t elapsed) {
    Causes causes;
    const bool starting = sensors.driver_state == DriverState::kStarting;
    starting_ = starting ? starting_ + elapsed : 0;
    const double seconds = static_cast<double>(starting_) * period_;
    if (seconds >= parameters_.start_timeout) causes[kCauseMachineNotReady] = {seconds, parameters_.start_timeout};
    ready_ = ready_ || !starting;
    const bool joint = std::ranges::any_of(sensors.joints, [](const JointSample& each) { return each.fault != 0; });
    if (sensors.driver_state == DriverState::kFault || sensors.faults != 0 || joint || (starting && ready_))
      causes[kCauseDriverFault] = {0, 0};

    // Overruns at each tenth of a second since the first step, with the first count for all before.
    if (tenths_.empty()) tenths_.assign(10, sensors.overruns);
    const std::uint64_t before = tenths_[tenths_.size() - 10];
    const double growth = sensors.overruns < before ? 0 : static_cast<double>(sensors.overruns - before);
    for (total_ += std::min(elapsed, 10 * mark_); total_ >= mark_; total_ -= mark_) tenths_.push_back(sensors.overruns);
    const double limit = std::min(*parameters_.overruns.limit, 0.5 / period_);
    if (growth > limit) causes[kCauseOverruns] = {growth, limit};

    if ((sensors.valid & kValidBattery) != 0) {
      const double voltage = sensors.battery_voltage;
      if (voltage < *parameters_.battery_low.limit)
        causes[kCauseBatteryLow] = {voltage, *parameters_.battery_low.limit};
      if (voltage < *parameters_.battery_empty.limit)
        causes[kCauseBatteryEmpty] = {voltage, *parameters_.battery_empty.limit};
    }
    return causes;
  }
  bool starting() const { return starting_ > 0; }

 private:
  const SafetyParameters& parameters_;
  double period_;
  std::uint64_t mark_, starting_ = 0, total_ = 0;
  bool ready_ = false;
  std::vector<std::uint64_t> tenths_;
};

TEST(GateModels, RandomReportsOfAMachineAreJudgedAsTheHeaderSaysInEveryRun) {
  std::map<std::uint64_t, int> seen;
  for (unsigned seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const double period = seed % 2 == 0 ? 0.01 : 0.05;
    SafetyParameters parameters;
    parameters.start_timeout = 1 + 0.1 * static_cast<double>(random.below(10));
    parameters.overruns = {
        .limit = 3.0 + static_cast<double>(random.below(12)), .persistence = 0, .reaction = Reaction::kWarn};
    parameters.battery_low = {.limit = 22, .persistence = 0, .reaction = Reaction::kSlow};
    parameters.battery_empty = {.limit = 20, .persistence = 0, .reaction = Reaction::kRamp};
    MachineConditions conditions(parameters, period);
    for (int run = 0; run < 3; ++run) {
      MachineConditionsModel model(parameters, period);
      SensorFrame sensors;
      sensors.overruns = random.below(5);
      sensors.joint_count = 4;
      double late = 0;
      for (int k = 0; k < 1000; ++k) {
        if (k % 100 == 0) {
          late = random.chance(0.5) ? 0 : 0.4;
          sensors.driver_state = random.chance(run == 0 ? 0.5 : 0.2) ? DriverState::kStarting : DriverState::kRunning;
          sensors.battery_voltage = 18.0 + static_cast<double>(random.below(8));
          sensors.valid = random.chance(0.7) ? std::uint64_t{kValidBattery} : 0;
        }
        const std::uint64_t elapsed = random.chance(0.05) ? 1 + random.below(30) : 1;
        sensors.overruns = random.chance(0.002) ? 0 : sensors.overruns + (random.chance(late) ? 1 : 0);
        sensors.faults = random.chance(0.01) ? 1 : 0;
        sensors.joints[3].fault = random.chance(0.01) ? 1 : 0;
        ActiveCauses active;
        conditions.step(sensors, elapsed, active);
        const Causes expected = model.step(sensors, elapsed);
        ASSERT_EQ(causes_of(active), expected) << "seed " << seed << " run " << run << " step " << k;
        ASSERT_EQ(conditions.starting(), model.starting());
        for (const auto& [cause, values] : expected) ++seen[cause];
      }
      conditions.enter_run();
    }
  }
  EXPECT_EQ(seen.size(), 5U);
}

}  // namespace robot_control::tests
