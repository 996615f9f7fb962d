#include "drivers/drive/drive_set.h"

#include <algorithm>

namespace robot_control {

std::size_t bus_index(std::vector<std::string>& buses, const std::string& address) {
  const auto found = std::ranges::find(buses, address);
  const auto index = static_cast<std::size_t>(found - buses.begin());
  if (found == buses.end()) buses.push_back(address);
  return index;
}

DriveSet::DriveSet(std::vector<std::unique_ptr<Drive>> drives, std::vector<std::unique_ptr<BusHost>> hosts)
    : drives_(std::move(drives)), hosts_(std::move(hosts)) {
  for (const auto& drive : drives_) bus_of_.push_back(bus_index(buses_, drive->drive_parameters().bus));
}

void DriveSet::receive(const can_frame& frame, std::int64_t now_ns, std::size_t bus) noexcept {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (bus_of_[i] == bus) drives_[i]->receive(frame, now_ns);
  }
}

void DriveSet::judge_silence(std::int64_t now_ns) noexcept {
  for (const auto& drive : drives_) drive->judge_silence(now_ns);
}

void DriveSet::step(std::span<const DriveCommand> commands, std::int64_t now_ns, std::span<FrameBatch> send) noexcept {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    drives_[i]->step(i < commands.size() ? commands[i] : DriveCommand{}, now_ns, send[bus_of_[i]]);
  }
  for (std::size_t bus = 0; bus < hosts_.size(); ++bus) hosts_[bus]->step(now_ns, send[bus]);
}

std::vector<PlannedFrames> DriveSet::plan(std::size_t bus) const {
  std::vector<PlannedFrames> plan = bus < hosts_.size() ? hosts_[bus]->plan() : std::vector<PlannedFrames>();
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (bus_of_[i] != bus) continue;
    for (const PlannedFrames& frames : drives_[i]->plan()) plan.push_back(frames);
  }
  return plan;
}

}  // namespace robot_control
