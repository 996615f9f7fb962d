#include "drivers/drive/drive_set.h"

#include <algorithm>

#include "drivers/cia402/cia402_drive.h"
#include "drivers/odrive/odrive_drive.h"
#include "drivers/vesc/vesc_drive.h"

namespace robot_control {

DriveSet::DriveSet(const CanParameters& parameters, double period)
    : host_node_(static_cast<std::uint8_t>(parameters.bus.host_node)) {
  std::visit([&](const auto& joints) { add(joints, period); }, parameters.joints);
}

void DriveSet::add(const std::vector<odrive::OdriveParameters>& joints, double period) {
  for (const auto& joint : joints) drives_.push_back(std::make_unique<odrive::OdriveDrive>(joint, period));
}

void DriveSet::add(const std::vector<cia402::Cia402Parameters>& joints, double period) {
  std::vector<cia402::Cia402Drive*> added;
  double timeout = joints.empty() ? 1 : joints[0].host_timeout;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    auto drive = std::make_unique<cia402::Cia402Drive>(joints[i], host_node_, period);
    for (std::size_t j = 0; j < i; ++j) {
      if (joints[j].drive.node != joints[i].drive.node) continue;
      const bool second = joints[i].axis != 0;
      cia402::Cia402Drive::join(second ? *added[j] : *drive, second ? *drive : *added[j]);
    }
    added.push_back(drive.get());
    drives_.push_back(std::move(drive));
    timeout = std::min(timeout, joints[i].host_timeout);
  }
  canopen_.emplace(host_node_, timeout);
}

void DriveSet::add(const std::vector<vesc::VescParameters>& joints, double period) {
  for (const auto& joint : joints) drives_.push_back(std::make_unique<vesc::VescDrive>(joint, period));
}

void DriveSet::receive(const can_frame& frame, std::int64_t now_ns) noexcept {
  for (const auto& drive : drives_) drive->receive(frame, now_ns);
}

void DriveSet::step(std::span<const DriveCommand> commands, std::int64_t now_ns, FrameBatch& send) noexcept {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    drives_[i]->step(i < commands.size() ? commands[i] : DriveCommand{}, now_ns, send);
  }
  if (canopen_) canopen_->step(now_ns, send);
}

std::vector<PlannedFrames> DriveSet::plan() const {
  std::vector<PlannedFrames> plan;
  for (const auto& drive : drives_) {
    for (const PlannedFrames& frames : drive->plan()) plan.push_back(frames);
  }
  if (canopen_) {
    plan.push_back(canopen::CanopenHost::planned_sync());
    plan.push_back(canopen_->planned_heartbeat());
  }
  return plan;
}

}  // namespace robot_control
