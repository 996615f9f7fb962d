#pragma once
/// A RoboClaw with two motors on a serial line as a Driver. The board closes the loop of each wheel's speed; torques
/// are neither taken nor measured.
///
/// One exchange runs at a time: the driver sends a request in `write`, and takes its answer in a later `read`. After
/// kAnswerNs the answer counts as lost. In turn it orders the speeds and asks a question. Most questions are for both
/// encoders, and each kSlowEvery-th one for battery, temperature or status. A loop of 200 Hz and more thus orders 100
/// times per second. The counts are those of the middle between request and answer; their speed brings them to the time
/// of `read`.
///
/// An order is repeated until the board acknowledges it, and no question is asked before, because each one restarts
/// the board's timeout. A question is repeated at most kRepeats − 1 times: then it waits behind the next order. After
/// kRepeats lost answers the driver pauses for kPauseNs, because a board that holds a stray byte takes each request
/// from there. It also pauses until no byte came for kPauseNs that nothing awaits: answers that are late would count
/// as those of later questions. In a pause the board's timeout runs.
///
/// `read` reports kStarting until version, gains and QPPS of both motors were read, and its serial timeout, which is
/// set to kTimeoutNs. It is refused with gains or a QPPS of zero: such a board answers a speed with full power. Until
/// then, and after a fault of the counts, the order is a duty of zero. Otherwise the board brakes with the speed zero,
/// which it keeps at rest. Faults stay until the operator's reset. Meanwhile each joint carries the cause as its fault
/// word, because a board that restarts counts from zero. The causes are:
///
///   silence         no new counts for kRoboclawSilence, after which a board without requests has stopped by itself
///   error           of the board's status
///   position jump   counts that the joint cannot reach within its velocity limit
///   no counts       Samples came, kBlindWay was ordered, and not one count moved: the encoder is unplugged, or the
///                   wheel is blocked.

#include <array>
#include <functional>
#include <memory>
#include <string>

#include "drivers/drive/serial_driver.h"
#include "drivers/drive_speed.h"
#include "drivers/roboclaw/roboclaw_parameters.h"
#include "drivers/roboclaw/roboclaw_protocol.h"

namespace robot_control {

struct RoboclawWheel : CountedWheel {
  double blind = 0;    ///< rad, ordered since the last count
  double ordered = 0;  ///< rad/s
};

class RoboclawDriver final : public SerialDriver<RoboclawWheel> {
 public:
  static constexpr std::int64_t kTimeoutNs = 100'000'000;  ///< of the board, its shortest one
  static constexpr std::int64_t kAnswerNs = 8'000'000;     ///< 3 ms of jitter each way, and the board's own time
  static constexpr std::int64_t kPauseNs = roboclaw::kPacketNs + 1'000'000;
  static constexpr unsigned kRepeats = 2;
  static constexpr unsigned kSlowEvery = 4;
  static constexpr double kSpeedMargin = 1.5;  ///< of the velocity limit, above which a position jumped
  static constexpr double kBlindWay = 0.5;     ///< rad

  /// The wheels move the first joints of a robot that has `joint_count`. `clock` states the present time in ns.
  RoboclawDriver(const RoboclawParameters& parameters, std::size_t joint_count, double period,
                 std::unique_ptr<SerialLine> line, std::function<std::int64_t()> clock);

  void write(std::span<const JointCommand> commands) noexcept override;
  /// The next orders brake.
  void stop() noexcept override { stopped_ = true; }

  bool accepts(JointMode mode) const noexcept override { return accepted(mode, true); }
  bool measures(MachineInput input) const noexcept override { return input == MachineInput::kJointMotion; }
  std::string description() const override;
  std::string warning() const override;

 private:
  using Command = roboclaw::PacketCommand;
  /// Two samples of the counts give the first speed.
  static constexpr std::array kSetup{Command::kVersion,    Command::kVelocityPid1, Command::kVelocityPid2,
                                     Command::kSetTimeout, Command::kGetTimeout,   Command::kEncoders,
                                     Command::kEncoders};
  static constexpr std::array kSlowReadings{Command::kBattery, Command::kTemperature, Command::kStatus};

  void begin() noexcept override;
  bool receive() noexcept override;
  void add_measurements(SensorFrame& sensors) noexcept override;
  bool is_fault_at_start(DriveCause cause) const noexcept override { return cause != DriveCause::kSilent; }
  void take_bytes() noexcept;
  bool answered() noexcept;
  void accept() noexcept;
  void accept_gains(unsigned motor) noexcept;
  void accept_counts() noexcept;
  Command next() const noexcept;
  void request(Command command) noexcept;
  bool counts_are_trusted() const noexcept;

  RoboclawParameters parameters_;
  std::array<std::int32_t, 2> speeds_{};  // counts per s, of the motors
  roboclaw::Packet asked_, received_;
  Command command_ = Command::kVersion;
  bool pending_ = false;
  unsigned unanswered_ = 0;  // requests since the last answer or pause
  std::int64_t sent_ns_ = 0;
  std::int64_t arrived_ns_ = 0;
  std::int64_t stray_ns_ = -kPauseNs;  // when a byte came that no request awaits
  std::size_t setup_ = 0;              // next one of kSetup; its size: running
  unsigned turn_ = 0;                  // questions since the start
  bool ordered_ = false;               // The board acknowledged an order, so that a question may follow.
  bool has_counts_ = false;
  std::uint64_t valid_ = 0;  // kValidBattery, once it was read
  double battery_ = 0;       // V
  double temperature_ = 0;   // °C
  bool has_temperature_ = false;
};

}  // namespace robot_control
