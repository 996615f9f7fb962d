#pragma once
/// The drives of one bus, in the order of the robot's joints, and what their host sends to all of them.

#include <memory>
#include <utility>
#include <vector>

#include "drivers/drive/drive.h"

namespace robot_control {

/// A BusHost sends frames in each cycle, beside the commands of the drives.
class BusHost {
 public:
  virtual ~BusHost() = default;
  virtual void step(std::int64_t now_ns, FrameBatch& send) noexcept = 0;
  virtual std::vector<PlannedFrames> plan() const = 0;
};

class DriveSet {
 public:
  explicit DriveSet(std::vector<std::unique_ptr<Drive>> drives, std::unique_ptr<BusHost> host = nullptr)
      : drives_(std::move(drives)), host_(std::move(host)) {}

  std::size_t size() const noexcept { return drives_.size(); }
  Drive& operator[](std::size_t joint) noexcept { return *drives_[joint]; }
  const Drive& operator[](std::size_t joint) const noexcept { return *drives_[joint]; }

  void receive(const can_frame& frame, std::int64_t now_ns) noexcept {
    for (const auto& drive : drives_) drive->receive(frame, now_ns);
  }
  /// Runs one cycle, with one command per joint.
  void step(std::span<const DriveCommand> commands, std::int64_t now_ns, FrameBatch& send) noexcept;

  /// Returns all frames that are regularly on the bus.
  std::vector<PlannedFrames> plan() const;

 private:
  std::vector<std::unique_ptr<Drive>> drives_;
  std::unique_ptr<BusHost> host_;  // null: it sends nothing
};

/// Returns one drive per joint. `period` is that of the loop in s.
template <class DriveType, class Parameters>
DriveSet drives_of(const std::vector<Parameters>& joints, double period) {
  std::vector<std::unique_ptr<Drive>> drives;
  for (const Parameters& joint : joints) drives.push_back(std::make_unique<DriveType>(joint, period));
  return DriveSet(std::move(drives));
}

}  // namespace robot_control
