#pragma once
/// A DriveSetup reads and writes the objects of one axis, one after the other, by SDO. It compares what it reads with
/// the drive file, and learns from it what the file leaves to the drive.
///
///   1018                      identity
///   6040, 6071, 60FF          no torque, no speed
///   6502, 6060, 6061          mode
///   6076, 6072, 6087          torque
///   608F, 6091, 6092, 60C2    position, period of the loop
///   1017, 1016, 1029          heartbeats of the drive and of the host
///   6007, 605A, 605E          reactions on a loss and on a fault
///   1400, 1600, 1800, 1A00    PDOs, written and read back, or read alone
///   60A9, 1801, 1A01          unit and PDO of the velocity
///
/// Objects that are optional in CiA 402 may be absent. With VelocityPdo::kDerived those of the velocity are optional,
/// too. The velocity follows from the position where one of them is absent, refused or different.

#include <cstdint>
#include <vector>

#include "drivers/cia402/cia402_parameters.h"
#include "drivers/cia402/drive_objects.h"
#include "drivers/cia402/drive_units.h"
#include "drivers/cia402/sdo_client.h"

namespace robot_control::cia402 {

struct SetupProblem {
  DriveCause cause = DriveCause::kNone;
  const char* subject = "";
  std::uint64_t code = 0;
  double found = 0, expected = 0;
};

class DriveSetup {
 public:
  enum class Result : std::uint8_t { kPending, kDone, kRefused, kNoAnswer };

  /// `host` is the node number whose heartbeat the drive is to expect; `period` is the loop's in s.
  DriveSetup(const Cia402Parameters& parameters, std::uint8_t host, double period);

  void restart() noexcept;
  void receive(const can_frame& frame) noexcept { client_.receive(frame); }
  Result step(std::int64_t now_ns, FrameBatch& send) noexcept;

  /// Index << 8 | sub-index of the object that it waits for.
  std::uint64_t object() const noexcept;
  const SetupProblem& problem() const noexcept { return problem_; }
  bool answered() const noexcept { return next_ > 0; }

  // Valid when it is done:
  const AxisPdos& pdos() const noexcept { return pdos_; }
  const DriveUnits& units() const noexcept { return units_; }
  Mode mode() const noexcept { return mode_; }
  SilenceReaction on_silence() const noexcept;
  VelocitySource velocity_source() const noexcept { return velocity_; }

 private:
  enum class Use : std::uint8_t {
    kNone,
    kEqual,
    kModes,
    kMode,
    kRated,
    kMaximum,
    kSlope,
    kIncrements,
    kRevolutions,
    kMotorTurns,
    kShaftTurns,
    kFeed,
    kFeedTurns,
    kConsumer,
    kAbortOption,
    kQuickStop,
    kFaultReaction,
    kPresentCobId,
    kCobId,
    kMappingCount,
    kMappingEntry,
    kUnit,
    kSyncs,
  };
  enum class Kind : std::uint8_t { kRead, kWrite };
  struct Step {
    canopen::SdoWrite write{};
    Use use = Use::kNone;
    Kind kind = Kind::kRead;
    bool optional = false;
    const char* subject = "";
    std::uint8_t pdo = 0;
  };

  void read(const ObjectAddress& object, Use use, bool optional, const char* subject, std::uint32_t expected = 0);
  void write(const ObjectAddress& object, std::uint32_t value, std::uint8_t bytes, Use use, bool optional,
             const char* subject);
  void add_motor_steps(double period);
  void add_silence_steps(std::uint8_t host);
  void add_pdo_steps(std::uint8_t index, const char* subject);

  void begin(const Step& step) noexcept;
  void evaluate(const Step& step, bool present, std::uint32_t value) noexcept;
  void judge_modes(bool present, std::uint32_t modes) noexcept;
  /// Returns the ratio of the last numerator to this number; 0: the drive has no such objects.
  double quotient(bool present, std::uint32_t denominator) const noexcept {
    return present && denominator != 0 ? numerator_ / denominator : 0;
  }
  void judge_counts() noexcept;
  void judge_torque(const Step& step, bool present, std::uint32_t value) noexcept;
  void judge_silence(const Step& step, bool present, std::uint32_t value) noexcept;
  void judge_mapping(const Step& step, std::uint32_t value) noexcept;
  void judge_velocity_unit(bool present, std::uint32_t value) noexcept;
  /// A velocity that is derived is left out where its set-up failed.
  void leave_velocity_out() noexcept;
  void judge_pdos() noexcept;
  /// `complete`: every entry that was found needs a value of this driver.
  void judge_pdo(Pdo& found, const Pdo& needed, bool complete) noexcept;
  void refuse(DriveCause cause, const char* subject, std::uint64_t code = 0, double found = 0,
              double expected = 0) noexcept;
  Pdo& pdo(std::uint8_t index) noexcept {
    return index == 0 ? pdos_.command : index == 1 ? pdos_.state : pdos_.velocity;
  }
  ObjectAddress own(const ObjectAddress& object) const noexcept {
    return on_axis(object, static_cast<unsigned>(parameters_.axis));
  }

  Cia402Parameters parameters_;
  std::vector<Step> steps_;
  std::size_t next_ = 0;
  canopen::SdoClient client_;
  SetupProblem problem_;
  AxisPdos pdos_;
  DriveUnits units_;
  Mode mode_ = Mode::kCyclicTorque;
  VelocitySource velocity_ = VelocitySource::kDrive;
  double numerator_ = 0;                      // of the ratio that is being read
  double encoder_ = 0, gear_ = 0, feed_ = 0;  // ScalingObjects
  std::uint32_t present_cob_id_ = 0;
  std::uint8_t mapped_ = 0;
  unsigned repeats_ = 0;
  bool expects_host_ = false;
  std::int64_t abort_option_ = -1, quick_stop_ = -1, fault_reaction_ = -1;  // −1: the drive has no such object
};

}  // namespace robot_control::cia402
