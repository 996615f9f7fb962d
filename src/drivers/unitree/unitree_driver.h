#pragma once
/// A legged robot of Unitree at its low level as a Driver. Each `write` sends one LowCmd, and each `read` takes what
/// the robot sent. Robot states what differs between the robots: Go1 (unitree_legged/go1.h), Go2 (unitree_go/go2.h).
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
/// sample. In a cycle without a new state each joint moves on with its velocity. An angle that is held would
/// show that the body stops (docs/evidence/leg_drives.md). The frame has the robot's IMU, the temperatures of its
/// motors, and its battery with the sum of the cells. It has the emergency stop while L2 and B of the remote are
/// pressed. The raw numbers of the feet's sensors are not newton, so the frame has no contacts.
///
/// kStarting lasts until the first state, or kFewest datagrams that are none. Faults stay until the operator's reset.
/// After max_silence without a new state the cause is what came instead, in the second half of that time:
///
///   silence         nothing
///   checksum        wrong check sums
///   stale           states with the tick of the last one
///   restart         states with older ticks only; a few of them are datagrams that were overtaken
///   differs         datagrams of another length or beginning
///   not finite      numbers that no robot can have
///
/// Other causes need no time: a state with another serial number, or a position that the joint cannot reach within its
/// velocity limit. With a motor above max_temperature and with a charge below min_charge the motors obey further, so
/// that the robot can lie down. With all other causes they get the brake. `Robot::obstacle` may name further causes,
/// for which a driver that starts waits.

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bus/latest_value.h"
#include "drivers/drive/drive_status.h"
#include "drivers/driver.h"
#include "drivers/line/datagram_line.h"
#include "drivers/unitree/unitree_parameters.h"
#include "signals/formatted_text.h"

namespace robot_control {

template <class Robot>
class UnitreeDriver final : public Driver, private DriveStateMachine {
 public:
  static constexpr double kSpeedMargin = 1.5;  ///< of the velocity limit, above which a position jumped
  static constexpr std::uint64_t kFewest = 5;
  using State = typename Robot::State;

  /// The motors move the first joints of the robot. `clock` states the present time in ns and is called in each cycle.
  UnitreeDriver(UnitreeParameters<Robot> parameters, const DriveMotors& motors, double period,
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
    typename Robot::Notice notice{};
    std::array<std::uint32_t, 2> serial_number{};
    bool operator==(const Published&) const = default;
  };

  void restart() noexcept;
  void receive() noexcept;
  void hold(const LegObstacle& obstacle) noexcept;
  void reject(const Rejected& rejected) noexcept;
  void accept(const State& state) noexcept;
  bool is_possible(const State& state) noexcept;
  void judge_silence() noexcept;
  void fill_joint(std::size_t i, JointSample& sample) const noexcept;
  void fill_robot(SensorFrame& sensors) const noexcept;
  unitree::MotorCommand motor_command(std::size_t i, const JointCommand& command) const noexcept;
  void send(std::span<const JointCommand> commands) noexcept;
  double position_of(std::size_t i, const State& state) const noexcept;
  bool fresh() const noexcept { return has_state_ && now_ns_ - state_ns_ <= max_silence_ns_; }

  UnitreeParameters<Robot> parameters_;
  Robot robot_{parameters_.line};
  std::vector<Brake> brakes_;
  const std::size_t joint_count_;
  const std::int64_t period_ns_;
  const std::int64_t max_silence_ns_;
  const std::unique_ptr<DatagramLine> line_;
  const std::function<std::int64_t()> clock_;
  State state_;        // the newest one
  Rejected rejected_;  // the last datagram since then that was not used
  std::int64_t rejected_ns_ = 0;
  std::uint64_t rejections_ = 0;
  bool has_state_ = false;     // since the start or the reset
  std::int64_t state_ns_ = 0;  // when it came; without one, when the first datagram came that was not used
  std::int64_t now_ns_ = 0;
  LinkStatus link_;
  bool stopped_ = true;
  LatestValue<Published> published_;
};

template <class Robot>
UnitreeDriver<Robot>::UnitreeDriver(UnitreeParameters<Robot> parameters, const DriveMotors& motors, double period,
                                    std::unique_ptr<DatagramLine> line, std::function<std::int64_t()> clock)
    : parameters_(std::move(parameters)),
      brakes_(motors.brakes),
      joint_count_(motors.joint_count),
      period_ns_(std::llround(1.0e9 * period)),
      max_silence_ns_(std::llround(1.0e9 * parameters_.line.max_silence)),
      line_(std::move(line)),
      clock_(std::move(clock)) {}

template <class Robot>
void UnitreeDriver<Robot>::start() {
  stopped_ = false;
  link_ = {};
  restart();
}

template <class Robot>
void UnitreeDriver<Robot>::reset() noexcept {
  if (status().state == DrivePhase::kFault) restart();
}

template <class Robot>
void UnitreeDriver<Robot>::restart() noexcept {
  forget();
  has_state_ = false;
  rejected_ = {};
  rejections_ = 0;
}

template <class Robot>
void UnitreeDriver<Robot>::receive() noexcept {
  std::array<std::uint8_t, kMaxDatagram> bytes;
  for (int i = 0; i < kDatagramsPerCycle; ++i) {
    const std::size_t size = line_->receive(bytes);
    if (size == 0) return;
    const std::span<const std::uint8_t> message =
        robot_.opened(std::span(bytes).first(std::min(size, bytes.size())), now_ns_);
    if (message.empty()) continue;
    State state;
    switch (Robot::decode(message, state)) {
      case unitree::Flaw::kNone:
        accept(state);
        break;
      case unitree::Flaw::kLength:
        reject({DriveCause::kDiffers, Robot::kOtherLength, static_cast<double>(message.size()), Robot::kStateBytes});
        break;
      case unitree::Flaw::kHead:
        reject({DriveCause::kDiffers, "beginning of its states"});
        break;
      case unitree::Flaw::kCheck:
        reject({DriveCause::kCheckSum, has_state_ ? "" : Robot::kNeverRight});
        break;
      case unitree::Flaw::kValue:
        reject({DriveCause::kNotFinite, "or a number beyond its range"});
        break;
    }
  }
}

template <class Robot>
void UnitreeDriver<Robot>::hold(const LegObstacle& obstacle) noexcept {
  if (obstacle.cause == DriveCause::kNone) return;
  if (obstacle.is_fault || running())
    return fail(obstacle.cause, obstacle.subject, 0, obstacle.found, obstacle.expected);
  set(DrivePhase::kStarting, obstacle.cause, obstacle.subject);
}

template <class Robot>
void UnitreeDriver<Robot>::reject(const Rejected& rejected) noexcept {
  if (!has_state_ && rejected_.cause == DriveCause::kNone) state_ns_ = now_ns_;
  rejected_ = rejected;
  rejected_ns_ = now_ns_;
  ++rejections_;
  const bool in_order = rejected.cause != DriveCause::kRestarted && rejected.cause != DriveCause::kStale;
  ++(in_order ? link_.errors : link_.late);
}

template <class Robot>
void UnitreeDriver<Robot>::accept(const State& state) noexcept {
  if (has_state_) {
    if (state.head.serial_number != state_.head.serial_number)
      return fail(DriveCause::kOtherDevice, "its serial number");
    const auto newer = static_cast<std::int32_t>(state.tick - state_.tick);
    if (newer == 0) return reject({DriveCause::kStale, "state"});
    if (newer < 0) return reject({DriveCause::kRestarted});
    if (!is_possible(state)) return;
  }
  state_ = state;
  state_ns_ = now_ns_;
  has_state_ = true;
  rejected_ = {};
  rejections_ = 0;
  if (robot_.obstacle(now_ns_).cause == DriveCause::kNone) set(DrivePhase::kRunning, DriveCause::kNone);
  for (std::size_t i = 0; i < parameters_.joints.size(); ++i) {
    const UnitreeJoint<Robot>& joint = parameters_.joints[i];
    const double temperature = state.motors[joint.motor].temperature;
    if (temperature > joint.max_temperature) fail(DriveCause::kHot, "motor", i, temperature, joint.max_temperature);
  }
  const double charge = state.battery.charge;
  if (charge < parameters_.line.min_charge)
    fail(DriveCause::kUnderVoltage, "charge in %", 0, charge, parameters_.line.min_charge);
}

template <class Robot>
double UnitreeDriver<Robot>::position_of(std::size_t i, const State& state) const noexcept {
  const UnitreeJoint<Robot>& joint = parameters_.joints[i];
  return static_cast<double>(joint.direction) * double{state.motors[joint.motor].q} + joint.offset;
}

template <class Robot>
bool UnitreeDriver<Robot>::is_possible(const State& state) noexcept {
  const std::int64_t late_ns = std::max(period_ns_, Robot::kPublishNs);  // both states may arrive together
  const double elapsed = 1.0e-9 * static_cast<double>(now_ns_ - state_ns_ + late_ns);
  for (std::size_t i = 0; i < parameters_.joints.size(); ++i) {
    const double moved = position_of(i, state) - position_of(i, state_);
    const double maximum = kSpeedMargin * parameters_.joints[i].velocity_limit * elapsed;
    if (std::abs(moved) <= maximum) continue;
    fail(DriveCause::kPositionJump, "position", i, moved, maximum);
    return false;
  }
  return true;
}

template <class Robot>
void UnitreeDriver<Robot>::judge_silence() noexcept {
  if ((!has_state_ && rejections_ < kFewest) || now_ns_ - state_ns_ <= max_silence_ns_) return;
  if (rejected_.cause == DriveCause::kNone || now_ns_ - rejected_ns_ > max_silence_ns_ / 2)
    return fail(DriveCause::kSilent, "state");
  fail(rejected_.cause, rejected_.subject, 0, rejected_.found, rejected_.expected);
}

template <class Robot>
void UnitreeDriver<Robot>::read(SensorFrame& sensors) noexcept {
  now_ns_ = clock_();
  const bool waits = has_state_;
  const std::int64_t last_ns = state_ns_;
  receive();
  if (waits && state_ns_ == last_ns && now_ns_ - state_ns_ >= Robot::kPublishNs) ++link_.lost;
  hold(robot_.obstacle(now_ns_));
  judge_silence();
  const bool running = this->running();
  const bool faulty = status().state == DrivePhase::kFault;
  sensors.driver_state = faulty ? DriverState::kFault : running ? DriverState::kRunning : DriverState::kStarting;
  sensors.faults = faulty ? std::uint64_t{fault_of(status().cause)} : 0;
  sensors.joint_count = joint_count_;
  for (std::size_t i = 0; i < joint_count_; ++i) {
    sensors.joints[i] = {};
    if (i < parameters_.joints.size()) fill_joint(i, sensors.joints[i]);
  }
  fill_robot(sensors);
  link_.state = fresh() ? LinkState::kUp : has_state_ ? LinkState::kDown : LinkState::kStarting;
  sensors.link_count = 1;
  sensors.links[0] = link_;
  Published last;
  const Published now{.drive = status(), .notice = robot_.notice(), .serial_number = state_.head.serial_number};
  if (!published_.load(last) || !(last == now)) published_.store(now);
}

template <class Robot>
void UnitreeDriver<Robot>::fill_joint(std::size_t i, JointSample& sample) const noexcept {
  const UnitreeJoint<Robot>& joint = parameters_.joints[i];
  const auto& motor = state_.motors[joint.motor];
  const auto direction = static_cast<double>(joint.direction);
  const double velocity = direction * double{motor.dq};
  const std::int64_t age_ns = now_ns_ - state_ns_;
  sample = {.position = position_of(i, state_) + 1.0e-9 * velocity * static_cast<double>(age_ns),
            .velocity = velocity,
            .effort = direction * motor.tau,
            .temperature = static_cast<double>(motor.temperature),
            .age_ns = age_ns,
            .valid = fresh() ? kValidMotion | kValidTemperature : 0U};
  const bool names_joint = status().cause == DriveCause::kHot || status().cause == DriveCause::kPositionJump;
  if (names_joint && status().code == i) sample.fault = static_cast<std::uint32_t>(status().cause);
}

template <class Robot>
void UnitreeDriver<Robot>::fill_robot(SensorFrame& sensors) const noexcept {
  sensors.valid = 0;
  sensors.digital_inputs = 0;
  sensors.contact_count = 0;
  if (!fresh()) return;
  const auto& imu = state_.imu;
  sensors.valid = kValidGyro | kValidAccelerometer | kValidOrientation;
  std::ranges::copy(imu.gyroscope, sensors.imu.angular_velocity.begin());
  std::ranges::copy(imu.accelerometer, sensors.imu.linear_acceleration.begin());
  const auto& [w, x, y, z] = imu.quaternion;
  sensors.imu.orientation = {x, y, z, w};
  sensors.battery_voltage = Robot::voltage(state_);
  sensors.battery_current = -1.0e-3 * state_.battery.current;
  if (sensors.battery_voltage > 0) sensors.valid |= kValidBattery;
  if (unitree::requests_stop(state_.remote)) sensors.digital_inputs = kInputEmergencyStop;
}

template <class Robot>
unitree::MotorCommand UnitreeDriver<Robot>::motor_command(std::size_t i, const JointCommand& command) const noexcept {
  const UnitreeJoint<Robot>& joint = parameters_.joints[i];
  unitree::MotorCommand motor{.mode = Robot::kServo, .dq = 0, .kd = brakes_[i].damping};
  if (!finite(command) || command.mode == JointMode::kBrake || !accepts(command.mode)) return motor;
  const auto direction = static_cast<double>(joint.direction);
  const bool holds = command.mode == JointMode::kImpedance;
  if (holds) motor.q = static_cast<float>(direction * (command.position - joint.offset));
  motor.dq = static_cast<float>(direction * command.velocity);
  motor.tau = direction * std::clamp(command.effort, -joint.torque_limit, joint.torque_limit);
  motor.kp = holds ? std::fmax(0, command.stiffness) : 0;
  motor.kd = command.mode == JointMode::kEffort ? 0 : std::fmax(0, command.damping);
  return motor;
}

template <class Robot>
void UnitreeDriver<Robot>::send(std::span<const JointCommand> commands) noexcept {
  typename Robot::Command message;
  for (std::size_t i = 0; i < parameters_.joints.size(); ++i) {
    message.motors[parameters_.joints[i].motor] = motor_command(i, i < commands.size() ? commands[i] : JointCommand{});
  }
  std::array<std::uint8_t, Robot::kCommandBytes> bytes;
  const bool exact = Robot::encode(message, std::span(bytes));
  ++link_.sent;
  if (!line_->send(bytes) || !exact) ++link_.errors;
}

template <class Robot>
void UnitreeDriver<Robot>::write(std::span<const JointCommand> commands) noexcept {
  const bool obeys = status().state >= DrivePhase::kRunning && !disabled() && !stopped_;
  send(obeys && commands.size() == joint_count_ ? commands : std::span<const JointCommand>());
}

template <class Robot>
void UnitreeDriver<Robot>::stop() noexcept {
  stopped_ = true;
  send({});
}

template <class Robot>
std::string UnitreeDriver<Robot>::description() const {
  std::string text = std::string(Robot::kName) + " at its low level on " + line_->name();
  if (Published now; published_.load(now) && now.drive.cause != DriveCause::kFirstFrame)
    text += formatted(", serial number %u-%u", now.serial_number[0], now.serial_number[1]);
  return text + "; on silence it " + described(parameters_.line.on_silence) + " (stated in the drive file)";
}

template <class Robot>
std::string UnitreeDriver<Robot>::warning() const {
  Published now;
  if (!published_.load(now) || now.drive.cause == DriveCause::kNone) return "";
  const DriveCause cause = now.drive.cause;
  const bool names_joint = cause == DriveCause::kHot || cause == DriveCause::kPositionJump;
  const std::string detail =
      names_joint ? "of " + parameters_.joints.at(now.drive.code).joint : Robot::detail(cause, now.notice);
  return status_words(std::string(Robot::kName) + " on " + line_->name(), now.drive, detail) + Robot::remedy(cause);
}

}  // namespace robot_control
