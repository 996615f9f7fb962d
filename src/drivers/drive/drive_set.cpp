#include "drivers/drive/drive_set.h"

namespace robot_control {

void DriveSet::step(std::span<const DriveCommand> commands, std::int64_t now_ns, FrameBatch& send) noexcept {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    drives_[i]->step(i < commands.size() ? commands[i] : DriveCommand{}, now_ns, send);
  }
  if (host_) host_->step(now_ns, send);
}

std::vector<PlannedFrames> DriveSet::plan() const {
  std::vector<PlannedFrames> plan = host_ ? host_->plan() : std::vector<PlannedFrames>();
  for (const auto& drive : drives_) {
    for (const PlannedFrames& frames : drive->plan()) plan.push_back(frames);
  }
  return plan;
}

}  // namespace robot_control
