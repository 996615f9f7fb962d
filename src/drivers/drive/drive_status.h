#pragma once
/// A DriveStateMachine is the state of one drive: of a motor drive on CAN, or of a board with all its motors.
///
///   starting ──set up and compared──▶ ready ──enabled──▶ running ──error, silence, jump …──▶ fault
///
/// The first fault stays until the operator's reset.

#include <array>
#include <cstdint>
#include <string>

#include "drivers/drive_parameters.h"
#include "signals/sensor_frame.h"

namespace robot_control {

enum class DrivePhase : std::uint8_t { kStarting, kReady, kRunning, kFault };

/// Why a drive is not running.
enum class DriveCause : std::uint8_t {
  kNone,
  // The drive waits:
  kFirstFrame,   ///< for any sign of life of the drive
  kIdentity,     ///< for version, serial number and configuration
  kSetup,        ///< for an object to be written or read; code: index << 8 | sub-index
  kFirstSample,  ///< for the first position
  kMessage,      ///< for the message `subject`, which it has to send by itself
  kEnable,       ///< for the command that enables the motor
  kPower,        ///< for the state in which the motor has torque; code: the present state
  // The drive is in fault:
  kSilent,            ///< no frame of `subject` in time
  kDriveError,        ///< The drive reports an error; code: its code.
  kReleased,          ///< The drive left the state with torque without an error; code: its state.
  kRestarted,         ///< The drive was switched on again.
  kPositionJump,      ///< The position moved faster than the joint can, as after another zero.
  kNotFinite,         ///< The drive sent NaN or infinity.
  kHot,               ///< found: °C, expected: the limit
  kUnderVoltage,      ///< found: V, expected: the limit
  kForeignCommander,  ///< Another program commands this drive; code: identifier of the frame.
  kDiffers,           ///< `subject` is `found` in the drive and `expected` in the drive file.
  kLacks,             ///< The drive has no `subject`, which is needed; code: abort code or 0.
  kRefused,           ///< The drive refused to set `subject`; code: abort code.
  kNoAnswer,          ///< The drive did not answer a request for `subject`.
  kStaysOff,          ///< The motor was requested, and has no torque; code: the present state.
  kTwoDrives,         ///< Two drives have this node number.
  kOtherAxis,         ///< The other axis of the drive is in fault.
  kUnknownWatchdog,   ///< The reaction of the drive on silence is unknown, and that is not accepted.
  kOwnBrake,          ///< The drive braked by itself, because it received no order in time.
  kNoCounts,          ///< The motor was driven, and its encoder did not move; code: number of the motor.
  kCheckSum,          ///< The check sums of its messages are wrong.
  kStale,             ///< It sends its last message again and again.
  kOtherDevice,       ///< States of another robot come, which `subject` shows.
  kBridge,            ///< The program between the driver and the drive sends nothing.
  kMotionService,     ///< A controller of the maker commands the same motors.
};

/// How the reaction on silence is known.
enum class ReactionEvidence : std::uint8_t {
  kNone,
  kRead,       ///< read from the drive, or written and read back
  kConfirmed,  ///< stated by the user in the drive file
};

/// The origin of a joint's velocity, or why it follows from the positions.
enum class VelocitySource : std::uint8_t {
  kDrive,         ///< The drive sends it.
  kNotRequested,  ///< The drive file does not want it.
  kNoRoom,        ///< It would overload the bus.
  kNoUnit,        ///< Its unit is not known.
  kNotMapped,     ///< The drive does not map it.
  kNotSent,       ///< The drive maps it, and has not sent it yet.
};

struct KnownReaction {
  SilenceReaction reaction = SilenceReaction::kUnknown;
  ReactionEvidence evidence = ReactionEvidence::kNone;

  bool operator==(const KnownReaction&) const = default;
};

/// A copy of it may be put into words by another thread.
struct DriveStatus {
  DrivePhase state = DrivePhase::kStarting;
  DriveCause cause = DriveCause::kFirstFrame;
  const char* subject = "";  ///< a literal
  std::uint64_t code = 0;
  double found = 0;
  double expected = 0;
  std::array<std::uint64_t, 5> details{};  ///< of an error, as the dialect counts them
  KnownReaction on_silence{};
  VelocitySource velocity = VelocitySource::kDrive;  ///< known from `ready` on

  bool operator==(const DriveStatus&) const = default;
};

/// Returns `name`, state, cause with its code in words, and the remedy. Any thread may put a copy of a status into
/// words.
std::string status_words(const std::string& name, const DriveStatus& status, const std::string& code);

/// Returns the bit of SensorFrame::faults.
DriverFault fault_of(DriveCause cause) noexcept;

class DriveStateMachine {
 public:
  const DriveStatus& status() const noexcept { return status_; }

 protected:
  ~DriveStateMachine() = default;

  bool running() const noexcept { return status_.state == DrivePhase::kRunning; }
  /// Leaves every state, a fault included.
  void forget() noexcept { status_ = {}; }
  void set(DrivePhase state, DriveCause cause, const char* subject = "", std::uint64_t code = 0, double found = 0,
           double expected = 0) noexcept;
  void fail(DriveCause cause, const char* subject = "", std::uint64_t code = 0, double found = 0,
            double expected = 0) noexcept;

  /// Returns whether the motor is to have no torque because of a fault. A running drive that is hot, has a low voltage
  /// or a second commander obeys further, because it can brake the joint.
  bool disabled() const noexcept { return status_.state == DrivePhase::kFault && !may_brake_; }
  /// Returns whether a drive that is disabled had torque when its fault came.
  bool brakes_by_itself() const noexcept { return disabled() && had_torque_; }

 private:
  DriveStatus status_;
  bool may_brake_ = false;
  bool had_torque_ = false;
};

}  // namespace robot_control
