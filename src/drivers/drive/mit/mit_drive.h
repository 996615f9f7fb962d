#pragma once
/// A MitDrive is the state machine of one motor in MIT mode, which closes the impedance of its joint.
///
///   set-up → first position → ready → enable → running
///
/// The motor answers each frame. So it is sent one frame in each cycle: a request to release it, a request of the
/// set-up, or an order. Before `running` it is released, whatever an earlier program ordered. A request of the set-up
/// is repeated kTries times.
///
/// An angle counts from the zero of the motor. Some motors know it within one turn of the rotor only. Their angle is
/// off by 2π/(gear of the motor · gear) where they were turned while they were off, which start_angle finds.
///
/// In a fault it is ordered a damping, which needs no measurement of this program.

#include <cstdint>
#include <optional>

#include "drivers/drive/drive.h"
#include "drivers/drive/mit/mit_joint.h"
#include "drivers/drive/mit/motion_scale.h"

namespace robot_control {

class MitDrive : public Drive {
 public:
  static constexpr std::int64_t kRetryNs = 20'000'000;     ///< between requests of the set-up, or to clear errors
  static constexpr unsigned kTries = 10;                   ///< of a request of the set-up
  static constexpr std::int64_t kEnterNs = 1'000'000'000;  ///< in which a motor that is enabled says so

 protected:
  MitDrive(const MitJoint& joint, double period);

  /// Forgets what was learned of the motor.
  virtual void forget_motor() noexcept = 0;
  virtual bool is_set_up() const noexcept = 0;
  /// Returns the next request of the set-up.
  virtual can_frame set_up() noexcept = 0;
  /// The request was repeated kTries times.
  virtual void end_unanswered() noexcept = 0;
  virtual bool is_on() const noexcept = 0;
  virtual bool in_error() const noexcept = 0;
  /// Returns the state of the motor as the code of a status.
  virtual std::uint64_t state_code() const noexcept = 0;
  /// Returns whether a start may clear the error without the operator's reset.
  virtual bool starts_from_error() const noexcept { return false; }
  virtual can_frame clear() noexcept = 0;
  virtual can_frame enable() noexcept = 0;
  virtual can_frame release() noexcept = 0;
  virtual can_frame order(const MitCommand& command) noexcept = 0;

  /// The motor answered the request of the set-up.
  void accept_answer() noexcept {
    tries_ = 0;
    next_request_ns_ = 0;
  }
  bool setting_up() const noexcept { return phase_ == Phase::kSetup; }
  /// Fails if the motor's own number is another one than that of the drive file.
  void compare(const char* name, double found, double expected) noexcept;
  /// Takes a sample of a motor whose ranges cannot be read, before it is accepted. Fails if its scale is wrong.
  void check_scale(double position, double velocity, std::int64_t now_ns) noexcept;
  /// The motor states its gear; numbers below 1 and NaN count as 1.
  void set_motor_gear(double gear) noexcept { motor_gear_ = gear > 1 ? gear : 1; }

  std::uint64_t node() const noexcept { return drive_parameters().node; }
  const MitRanges& ranges() const noexcept { return ranges_; }

 private:
  static constexpr double kTolerance = 1.0e-3;  // of a range, which the maker's tool rounds

  enum class Phase : std::uint8_t { kSetup, kPosition, kReady, kEnable, kRunning };

  void restart(bool reset, std::int64_t now_ns) noexcept override;
  void advance(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept override;
  void add_details(DriveStatus& /*status*/) const noexcept override {}

  can_frame next_frame(const DriveCommand& command, std::int64_t now_ns) noexcept;
  can_frame request_set_up(std::int64_t now_ns) noexcept;
  can_frame clear_error(std::int64_t now_ns) noexcept;
  void check_start_angle() noexcept;

  MitRanges ranges_;
  MotionScale scale_;
  std::optional<double> start_angle_;
  double motor_gear_;
  Phase phase_ = Phase::kSetup;
  bool reset_ = false;
  unsigned tries_ = 0;
  std::int64_t next_request_ns_ = 0;
  std::int64_t deadline_ns_ = 0;
};

}  // namespace robot_control
