#pragma once
/// The drives of one robot in the order of its joints, on one or more buses. A host may send frames to a whole bus.

#include <memory>
#include <span>
#include <string>
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
  /// `hosts`: none, or one for each of `buses`.
  explicit DriveSet(std::vector<std::unique_ptr<Drive>> drives, std::vector<std::unique_ptr<BusHost>> hosts = {});

  std::size_t size() const noexcept { return drives_.size(); }
  Drive& operator[](std::size_t joint) noexcept { return *drives_[joint]; }
  const Drive& operator[](std::size_t joint) const noexcept { return *drives_[joint]; }

  /// Returns the addresses of the buses, in the order of their first joints. There is at least one.
  const std::vector<std::string>& buses() const noexcept { return buses_; }

  void receive(const can_frame& frame, std::int64_t now_ns, std::size_t bus = 0) noexcept;

  void judge_silence(std::int64_t now_ns) noexcept;

  /// Runs one cycle, with one command per joint and one batch per bus.
  void step(std::span<const DriveCommand> commands, std::int64_t now_ns, std::span<FrameBatch> send) noexcept;

  /// Returns all frames that are regularly on the bus.
  std::vector<PlannedFrames> plan(std::size_t bus = 0) const;

 private:
  std::vector<std::unique_ptr<Drive>> drives_;
  std::vector<std::string> buses_;
  std::vector<std::size_t> bus_of_;              // each drive
  std::vector<std::unique_ptr<BusHost>> hosts_;  // of each bus; none: they send nothing
};

/// Returns the number of the address among `buses`, to which a new one is added.
std::size_t bus_index(std::vector<std::string>& buses, const std::string& address);

/// Returns one drive per joint. `period` is that of the loop in s.
template <class DriveType, class Parameters>
DriveSet drives_of(const std::vector<Parameters>& joints, double period) {
  std::vector<std::unique_ptr<Drive>> drives;
  for (const Parameters& joint : joints) drives.push_back(std::make_unique<DriveType>(joint, period));
  return DriveSet(std::move(drives));
}

}  // namespace robot_control
