#pragma once
/// A Unitree Go1 at its low level as a Driver. Each `write` sends one LowCmd to the robot, and each `read` takes what
/// it answered (legged_messages.h).
///
/// The motors close the loop of an impedance themselves. With s the direction and o the offset of the drive file, the
/// joint is at q = s q_motor + o, and a command is
///
///   kImpedance  q_motor* = s (position − o), q̇_motor* = s velocity, kp = stiffness, kd = damping, τ = s effort
///   kVelocity   the same with kp = 0
///   kEffort     the same with kp = kd = 0
///   kBrake      kd = damping of the robot's brake, q̇_motor* = 0: it damps, and does not hold a load
///
/// The effort is clamped to torque_limit; the motor limits the sum. `stop` sends the brake as the last datagram.
///
/// `read` takes all states that arrived and uses the one with the newest tick. Its arrival counts as the time of the
/// sample. The frame has the robot's IMU, the temperatures of its motors, and its battery with the sum of the cells. It
/// has the emergency stop while L2 and B of the remote are pressed. The raw numbers of the feet's sensors are not
/// newton, so the frame has no contacts.
///
/// kStarting lasts until the first state, or kFewest datagrams that are none. Faults stay until the operator's reset.
/// After max_silence without a new state the cause is what came instead, in the second half of that time:
///
///   silence         nothing
///   checksum        wrong check sums; if none was ever right, the firmware encrypts them, which is refused
///   stale           states with the tick of the last one
///   restart         states with older ticks only; a few of them are datagrams that were overtaken
///   differs         datagrams of another length or beginning, as those of A1 and Aliengo
///   not finite      numbers that no robot can have
///
/// Other causes need no time: a state with another serial number, or a position that the joint cannot reach within its
/// velocity limit. With a motor above max_temperature and with a charge below min_charge the motors obey further, so
/// that the robot can lie down. With all other causes they get the brake.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bus/latest_value.h"
#include "drivers/drive/drive_status.h"
#include "drivers/driver.h"
#include "drivers/line/datagram_line.h"
#include "drivers/unitree_legged/unitree_legged_parameters.h"

namespace robot_control {

class UnitreeLeggedDriver final : public Driver, private DriveStateMachine {
 public:
  static constexpr double kSpeedMargin = 1.5;  ///< of the velocity limit, above which a position jumped
  static constexpr std::uint64_t kFewest = 5;

  /// The motors move the first joints of the robot. `clock` states the present time in ns and is called in each cycle.
  UnitreeLeggedDriver(UnitreeLeggedParameters parameters, const DriveMotors& motors, double period,
                      std::unique_ptr<DatagramLine> line, std::function<std::int64_t()> clock);

  void start() override;
  void read(SensorFrame& sensors) noexcept override;
  void write(std::span<const JointCommand> commands) noexcept override;
  void stop() noexcept override;
  void reset() noexcept override;
  std::string description() const override;
  std::string warning() const override;
  bool accepts(JointMode mode) const noexcept override { return mode <= JointMode::kImpedance; }
  bool measures(MachineInput input) const noexcept override { return input != MachineInput::kContacts; }

 private:
  /// Why a datagram is not used.
  struct Rejected {
    DriveCause cause = DriveCause::kNone;
    const char* subject = "";
    double found = 0;
    double expected = 0;
  };
  /// The status for other threads.
  struct Published {
    DriveStatus drive{};
    std::array<std::uint32_t, 2> serial_number{};
    bool operator==(const Published&) const = default;
  };

  void restart() noexcept;
  void receive() noexcept;
  void reject(const Rejected& rejected) noexcept;
  void accept(const unitree::LowState& state) noexcept;
  bool is_possible(const unitree::LowState& state) noexcept;
  void judge_silence() noexcept;
  void fill_joint(std::size_t i, JointSample& sample) const noexcept;
  void fill_robot(SensorFrame& sensors) const noexcept;
  unitree::MotorCommand motor_command(std::size_t i, const JointCommand& command) const noexcept;
  void send(std::span<const JointCommand> commands) noexcept;
  double position_of(std::size_t i, const unitree::LowState& state) const noexcept;
  bool fresh() const noexcept { return has_state_ && now_ns_ - state_ns_ <= max_silence_ns_; }

  UnitreeLeggedParameters parameters_;
  std::vector<Brake> brakes_;
  const std::size_t joint_count_;
  const std::int64_t period_ns_;
  const std::int64_t max_silence_ns_;
  const std::unique_ptr<DatagramLine> line_;
  const std::function<std::int64_t()> clock_;
  unitree::LowState state_;  // the newest one
  Rejected rejected_;        // the last datagram since then that was not used
  std::int64_t rejected_ns_ = 0;
  std::uint64_t rejections_ = 0;
  bool has_state_ = false;     // since the start or the reset
  std::int64_t state_ns_ = 0;  // when it came; without one, when the first datagram came that was not used
  std::int64_t now_ns_ = 0;
  LinkStatus link_;
  bool stopped_ = true;
  LatestValue<Published> published_;
};

}  // namespace robot_control
