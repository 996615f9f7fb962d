#include "timing/loop_durations.h"

#include <algorithm>

namespace robot_control {
namespace {

std::size_t index(Role role) noexcept {
  return static_cast<std::size_t>(role);
}

bool follows(const DriverTimes& next, std::uint64_t run, std::uint64_t cycle) noexcept {
  return next.run == run && next.cycle == cycle + 1;
}

}  // namespace

std::string_view name_of(Quantity quantity) noexcept {
  constexpr std::array<std::string_view, 5> kNames{"period", "wake_up", "execution", "sensor_to_command",
                                                   "sensor_to_torque"};
  return kNames[static_cast<std::size_t>(quantity)];
}

LoopDurations::LoopDurations(const std::vector<Role>& roles) {
  using enum Quantity;
  for (const Role role : roles) {
    for (const Quantity quantity : {kCyclePeriod, kWakeUp, kExecution}) entries_.push_back({role, quantity, {}});
    if (role == Role::kController) entries_.push_back({role, kSensorToCommand, {}});
    if (role == Role::kDriver) entries_.push_back({role, kSensorToTorque, {}});
  }
}

std::optional<std::int64_t> LoopDurations::measure(Role role, Quantity quantity,
                                                   const CycleTimes& times) const noexcept {
  const DriverTimes& driver = times.driver;
  const CycleTiming& own = *times.timing[index(role)];
  const auto& waker = times.timing[index(waker_of(role))];
  const Last& last = last_[index(role)];
  const DriverTimes& sampled = marks_[driver.command_cycle.value_or(0) % kRememberedCycles];
  const bool next = follows(driver, driver_.run, driver_.cycle);
  const auto paused_since = [&](const DriverTimes& before) { return driver.held_ns != before.held_ns; };
  switch (quantity) {
    case Quantity::kCyclePeriod:
      if (!follows(driver, last.run, last.cycle) || !next || paused_since(driver_)) return std::nullopt;
      return driver.due_ns + own.woke_ns - last.woke_ns;
    case Quantity::kWakeUp:
      if (role == Role::kDriver) return own.woke_ns + (next ? driver.slipped_ns - driver_.slipped_ns : 0);
      if (!waker || own.woke_ns < waker->published_ns) return std::nullopt;
      return own.woke_ns - waker->published_ns;
    case Quantity::kExecution:
      return own.published_ns - own.woke_ns;
    case Quantity::kSensorToCommand:
      return own.published_ns - driver.timing.woke_ns;
    case Quantity::kSensorToTorque:
      if (!driver.command_cycle || sampled.run != driver.run || sampled.cycle != *driver.command_cycle ||
          paused_since(sampled)) {
        return std::nullopt;
      }
      return driver.due_ns + own.published_ns - sampled.due_ns - sampled.timing.woke_ns;
  }
  return std::nullopt;
}

void LoopDurations::add(const CycleTimes& times) noexcept {
  const DriverTimes& driver = times.driver;
  const auto repeats = [&](std::size_t role) {
    return last_[role].run == driver.run && last_[role].cycle >= driver.cycle && last_[role].woke_ns != 0;
  };
  for (Entry& entry : entries_) {
    if (!times.timing[index(entry.role)] || repeats(index(entry.role))) continue;
    if (const auto duration = measure(entry.role, entry.quantity, times)) entry.durations.add(*duration, driver.due_ns);
  }
  overruns_ += driver.overruns - (driver.run == driver_.run ? std::min(driver_.overruns, driver.overruns) : 0);
  for (std::size_t i = 0; i < kLoopRoles; ++i) {
    if (!times.timing[i] || repeats(i)) continue;
    Last& last = last_[i];
    if (last.run == driver.run && driver.cycle > last.cycle + 1) skipped_[i] += driver.cycle - last.cycle - 1;
    last = {driver.run, driver.cycle, driver.due_ns + times.timing[i]->woke_ns};
  }
  driver_ = driver;
  marks_[driver.cycle % kRememberedCycles] = driver;
}

}  // namespace robot_control
