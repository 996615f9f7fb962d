#pragma once
/// A CanFront is the simulated drives of a drive file behind a CAN bus.
///
/// `inject` takes a joint or `bus` as the component. The kinds of the bus are ok, off, lossy and disturbed. Off means
/// that the driver's cable is out, lossy that 5 % of the frames are lost. On a disturbed bus the others are late as
/// well, by up to one period. With a word of AnswerFault this happens to the frames to the driver.

#include <deque>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "drivers/line/can_bus.h"
#include "drivers/line/answer_faults.h"
#include "drivers/drive/device_front.h"
#include "drivers/drive/simulated_drives.h"

namespace robot_control {

class CanFront final : public DeviceFront {
 public:
  /// `brakes`: one per joint, that of a drive which brakes by itself. `period` is the loop's in s. `socket` is the end
  /// of the line that is not the driver's.
  CanFront(const CanParameters& parameters, std::span<const Brake> brakes, double period, std::uint64_t seed,
           CanSocket socket);

  std::size_t size() const override { return drives_.size(); }
  std::int64_t now_ns() const override { return drives_.bus().now_ns(); }
  void run(std::span<const JointSample> joints) override;
  double torque(std::size_t joint) const override { return drives_.torque(joint); }
  std::string inject(std::string_view component, std::string_view kind) override;

 private:
  struct Answer {
    can_frame frame{};
    std::int64_t due_ns = 0;
  };

  void carry(can_frame frame, std::int64_t now_ns);

  SimulatedDrives drives_;
  CanBus line_;
  std::int64_t period_ns_;
  std::vector<std::string> joints_;
  std::size_t host_;            // the driver's party on the simulated bus
  std::deque<Answer> answers_;  // on their way to the driver
  AnswerFault fault_ = AnswerFault::kNone;
  std::mt19937_64 random_;
};

}  // namespace robot_control
