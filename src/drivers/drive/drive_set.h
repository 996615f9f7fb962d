#pragma once
/// The drives of one bus, in the order of the robot's joints, and what their host sends to all of them.

#include <memory>
#include <optional>
#include <vector>

#include "drivers/drive/can_parameters.h"
#include "drivers/cia402/canopen_host.h"
#include "drivers/drive/drive.h"

namespace robot_control {

class DriveSet {
 public:
  /// `period` is that of the loop in s.
  DriveSet(const CanParameters& parameters, double period);

  std::size_t size() const noexcept { return drives_.size(); }
  Drive& operator[](std::size_t joint) noexcept { return *drives_[joint]; }
  const Drive& operator[](std::size_t joint) const noexcept { return *drives_[joint]; }

  void receive(const can_frame& frame, std::int64_t now_ns) noexcept;
  /// Runs one cycle, with one command per joint.
  void step(std::span<const DriveCommand> commands, std::int64_t now_ns, FrameBatch& send) noexcept;

  /// Returns all frames that are regularly on the bus.
  std::vector<PlannedFrames> plan() const;

 private:
  void add(const std::vector<odrive::OdriveParameters>& joints, double period);
  void add(const std::vector<cia402::Cia402Parameters>& joints, double period);
  void add(const std::vector<vesc::VescParameters>& joints, double period);

  std::uint8_t host_node_;
  std::vector<std::unique_ptr<Drive>> drives_;
  std::optional<canopen::CanopenHost> canopen_;
};

}  // namespace robot_control
