#include "safety/conditions/common/machine_conditions.h"

#include <algorithm>
#include <cmath>

namespace robot_control {
namespace {

constexpr double kMaxOverruns = 0.5;  // of all cycles

}  // namespace

MachineConditions::MachineConditions(const SafetyParameters& parameters, double period) noexcept
    : period_(period),
      start_timeout_(parameters.start_timeout),
      overruns_(kCauseOverruns, parameters.overruns, period),
      battery_low_(kCauseBatteryLow, parameters.battery_low, period),
      battery_empty_(kCauseBatteryEmpty, parameters.battery_empty, period),
      mark_cycles_(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(1.0 / (kSlots * period))))) {}

void MachineConditions::enter_run() noexcept {
  starting_ = 0;
  was_ready_ = false;
  overruns_.reset();
  battery_low_.reset();
  battery_empty_.reset();
  marked_ = false;
}

std::uint64_t MachineConditions::overruns_of_the_last_second(std::uint64_t overruns, std::uint64_t elapsed) noexcept {
  if (!marked_) {
    marks_.fill(overruns);
    since_mark_ = oldest_ = 0;
    marked_ = true;
  }
  const std::uint64_t growth = overruns - std::min(overruns, marks_[oldest_]);
  since_mark_ += std::min(elapsed, kSlots * mark_cycles_);
  for (; since_mark_ >= mark_cycles_; since_mark_ -= mark_cycles_) {
    marks_[oldest_] = overruns;
    oldest_ = (oldest_ + 1) % kSlots;
  }
  return growth;
}

void MachineConditions::evaluate_start(bool starting, std::uint64_t elapsed, ActiveCauses& out) noexcept {
  starting_ = starting ? starting_ + elapsed : 0;
  was_ready_ |= !starting;
  const double seconds = static_cast<double>(starting_) * period_;
  if (seconds >= start_timeout_)
    out.add(kCauseMachineNotReady, Reaction::kBrake, {.beyond = true, .value = seconds, .limit = start_timeout_});
}

void MachineConditions::step(const SensorFrame& sensors, std::uint64_t elapsed, ActiveCauses& out) noexcept {
  const std::size_t faulty = first_faulty_joint(sensors);
  const bool is_starting = sensors.driver_state == DriverState::kStarting;
  evaluate_start(is_starting, elapsed, out);
  const bool fell_back = is_starting && was_ready_;
  if (sensors.driver_state == DriverState::kFault || sensors.faults != 0 || faulty < kMaxJoints || fell_back) {
    out.add(kCauseDriverFault, Reaction::kBrake, {.joint = faulty});
  }

  const auto overruns = static_cast<double>(overruns_of_the_last_second(sensors.overruns, elapsed));
  const double limit = std::min(overruns_.limit(), kMaxOverruns / period_);
  out.update(overruns_, {.beyond = overruns > limit, .value = overruns, .limit = limit}, elapsed);

  const bool reported = (sensors.valid & kValidBattery) != 0;
  const double voltage = sensors.battery_voltage;
  for (ConditionWatch* watch : {&battery_low_, &battery_empty_}) {
    const double least = watch->limit();
    out.update(*watch, {.beyond = reported && voltage < least, .value = voltage, .limit = least}, elapsed);
  }
}

}  // namespace robot_control
