#include "safety/conditions/machine_conditions.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

MachineConditions::MachineConditions(const SafetyParameters& parameters, double period) noexcept
    : overruns_(kCauseOverruns, parameters.overruns, period),
      battery_low_(kCauseBatteryLow, parameters.battery_low, period),
      battery_empty_(kCauseBatteryEmpty, parameters.battery_empty, period),
      mark_cycles_(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(1.0 / (kMarks * period))))) {}

void MachineConditions::enter_run() noexcept {
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
  since_mark_ += std::min(elapsed, kMarks * mark_cycles_);
  for (; since_mark_ >= mark_cycles_; since_mark_ -= mark_cycles_) {
    marks_[oldest_] = overruns;
    oldest_ = (oldest_ + 1) % kMarks;
  }
  return growth;
}

void MachineConditions::step(const SensorFrame& sensors, std::uint64_t elapsed, ActiveCauses& out) noexcept {
  const std::size_t faulty = first_faulty_joint(sensors);
  if (sensors.driver_state == DriverState::kFault || sensors.faults != 0 || faulty < kMaxJoints) {
    out.add(kCauseDriverFault, Reaction::kBrake, {.joint = faulty});
  }

  const auto overruns = static_cast<double>(overruns_of_the_last_second(sensors.overruns, elapsed));
  const double limit = overruns_.limit();
  out.update(overruns_, {.beyond = overruns > limit, .value = overruns, .limit = limit}, elapsed);

  const bool reported = (sensors.valid & kValidBattery) != 0;
  const double voltage = sensors.battery_voltage;
  for (ConditionWatch* watch : {&battery_low_, &battery_empty_}) {
    const double least = watch->limit();
    out.update(*watch, {.beyond = reported && voltage < least, .value = voltage, .limit = least}, elapsed);
  }
}

}  // namespace robot_control
