#pragma once
/// The state machine of one Damiao motor in MIT mode, which closes the impedance of its joint.
///
///   registers → first position → ready → enable → running
///
/// It answers each frame. So it is sent one frame in each cycle: a request to release it, a request for a register, or
/// an order. Before `running` it is released, whatever an earlier program ordered.
///
/// The registers are compared with the drive file: a wrong range would scale every number. The timeout is written where
/// it differs, and read back: a motor that receives no order for that time releases itself. The start clears the error
/// of an earlier such time (kCommunicationLost).
///
/// An angle counts from the zero of the motor. Some motors know it within one turn of the rotor only. Their angle is
/// off by 2π/(gear of the motor · gear) where they were turned while they were off, which start_angle finds.
///
/// In a fault it is ordered a damping, which needs no measurement of this program.

#include <array>
#include <cstdint>
#include <optional>

#include "drivers/damiao/damiao_messages.h"
#include "drivers/damiao/damiao_parameters.h"
#include "drivers/drive/drive.h"

namespace robot_control::damiao {

class DamiaoDrive final : public Drive {
 public:
  static constexpr std::int64_t kRetryNs = 20'000'000;     ///< between requests for one register, or to clear errors
  static constexpr unsigned kTries = 10;                   ///< of a register
  static constexpr std::int64_t kEnterNs = 1'000'000'000;  ///< in which a motor that is enabled says so
  static constexpr double kRangeTolerance = 1.0e-3;        ///< of a range, which the maker's tool rounds

  DamiaoDrive(const DamiaoParameters& parameters, double period);

  void receive(const can_frame& frame, std::int64_t now_ns) noexcept override;
  std::vector<PlannedFrames> plan() const override;

 private:
  enum class Phase : std::uint8_t { kRegisters, kPosition, kReady, kEnable, kRunning };

  void restart(bool reset, std::int64_t now_ns) noexcept override;
  void advance(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept override;
  void add_details(DriveStatus& /*status*/) const noexcept override {}
  std::string code_words(const DriveStatus& status) const override;

  void receive_register(const RegisterAccess& answer) noexcept;
  void compare(const char* name, double found, double expected) noexcept;
  bool in_error() const noexcept { return state_ > State::kOn; }
  can_frame next_frame(const DriveCommand& command, std::int64_t now_ns) noexcept;
  can_frame request_register(std::int64_t now_ns) noexcept;
  can_frame clear_error(std::int64_t now_ns) noexcept;
  void check_start_angle() noexcept;
  can_frame order(const DriveCommand& command) const noexcept;
  can_frame release() const noexcept { return encode(node(), Request::kRelease); }
  std::uint64_t node() const noexcept { return drive_parameters().node; }

  DamiaoParameters parameters_;
  std::uint32_t timeout_;  // units of kTimeoutUnit
  Phase phase_ = Phase::kRegisters;
  bool reset_ = false;
  State state_ = State::kOff;
  std::size_t asked_ = 0;  // place of the awaited register among those that are read
  Operation operation_ = Operation::kRead;
  bool written_ = false;
  unsigned tries_ = 0;
  std::int64_t next_request_ns_ = 0;
  std::int64_t deadline_ns_ = 0;
  double motor_gear_ = 1;
};

}  // namespace robot_control::damiao
