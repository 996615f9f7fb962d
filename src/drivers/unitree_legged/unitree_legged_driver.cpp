#include "drivers/unitree_legged/unitree_legged_driver.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "signals/formatted_text.h"

namespace robot_control {

using unitree::Flaw;
using unitree::LowState;

UnitreeLeggedDriver::UnitreeLeggedDriver(UnitreeLeggedParameters parameters, const DriveMotors& motors, double period,
                                         std::unique_ptr<DatagramLine> line, std::function<std::int64_t()> clock)
    : parameters_(std::move(parameters)),
      brakes_(motors.brakes),
      joint_count_(motors.joint_count),
      period_ns_(std::llround(1.0e9 * period)),
      max_silence_ns_(std::llround(1.0e9 * parameters_.line.max_silence)),
      line_(std::move(line)),
      clock_(std::move(clock)) {}

void UnitreeLeggedDriver::start() {
  stopped_ = false;
  link_ = {};
  restart();
}

void UnitreeLeggedDriver::reset() noexcept {
  if (status().state == DrivePhase::kFault) restart();
}

void UnitreeLeggedDriver::restart() noexcept {
  forget();
  has_state_ = false;
  rejected_ = {};
  rejections_ = 0;
}

void UnitreeLeggedDriver::receive() noexcept {
  std::array<std::uint8_t, kMaxDatagram> bytes;
  for (int i = 0; i < kDatagramsPerCycle; ++i) {
    const std::size_t size = line_->receive(bytes);
    if (size == 0) return;
    LowState state;
    switch (decode(std::span(bytes).first(std::min(size, bytes.size())), state)) {
      case Flaw::kNone:
        accept(state);
        break;
      case Flaw::kLength:
        reject({DriveCause::kDiffers, "length of its states, like an A1 or Aliengo", static_cast<double>(size),
                unitree::kStateBytes});
        break;
      case Flaw::kHead:
        reject({DriveCause::kDiffers, "beginning of its states"});
        break;
      case Flaw::kCheck:
        reject({DriveCause::kCheckSum,
                has_state_ ? "" : "without exception: its firmware encrypts them, which is not supported"});
        break;
      case Flaw::kValue:
        reject({DriveCause::kNotFinite, "or a number beyond its range"});
        break;
    }
  }
}

void UnitreeLeggedDriver::reject(const Rejected& rejected) noexcept {
  if (!has_state_ && rejected_.cause == DriveCause::kNone) state_ns_ = now_ns_;
  rejected_ = rejected;
  rejected_ns_ = now_ns_;
  ++rejections_;
  const bool in_order = rejected.cause != DriveCause::kRestarted && rejected.cause != DriveCause::kStale;
  ++(in_order ? link_.errors : link_.late);
}

void UnitreeLeggedDriver::accept(const LowState& state) noexcept {
  if (has_state_) {
    if (state.head.serial_number != state_.head.serial_number) return fail(DriveCause::kOtherDevice, "serial number");
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
  set(DrivePhase::kRunning, DriveCause::kNone);
  for (std::size_t i = 0; i < parameters_.joints.size(); ++i) {
    const UnitreeLeggedJoint& joint = parameters_.joints[i];
    const double temperature = state.motors[joint.motor].temperature;
    if (temperature > joint.max_temperature) fail(DriveCause::kHot, "motor", i, temperature, joint.max_temperature);
  }
  const double charge = state.battery.charge;
  if (charge < parameters_.line.min_charge)
    fail(DriveCause::kUnderVoltage, "charge in %", 0, charge, parameters_.line.min_charge);
}

double UnitreeLeggedDriver::position_of(std::size_t i, const LowState& state) const noexcept {
  const UnitreeLeggedJoint& joint = parameters_.joints[i];
  return static_cast<double>(joint.direction) * double{state.motors[joint.motor].q} + joint.offset;
}

bool UnitreeLeggedDriver::is_possible(const LowState& state) noexcept {
  const double elapsed = 1.0e-9 * static_cast<double>(now_ns_ - state_ns_ + period_ns_);
  for (std::size_t i = 0; i < parameters_.joints.size(); ++i) {
    const double moved = position_of(i, state) - position_of(i, state_);
    const double maximum = kSpeedMargin * parameters_.joints[i].velocity_limit * elapsed;
    if (std::abs(moved) <= maximum) continue;
    fail(DriveCause::kPositionJump, "position", i, moved, maximum);
    return false;
  }
  return true;
}

void UnitreeLeggedDriver::judge_silence() noexcept {
  if ((!has_state_ && rejections_ < kFewest) || now_ns_ - state_ns_ <= max_silence_ns_) return;
  if (rejected_.cause == DriveCause::kNone || now_ns_ - rejected_ns_ > max_silence_ns_ / 2)
    return fail(DriveCause::kSilent, "state");
  fail(rejected_.cause, rejected_.subject, 0, rejected_.found, rejected_.expected);
}

void UnitreeLeggedDriver::read(SensorFrame& sensors) noexcept {
  now_ns_ = clock_();
  const bool waits = has_state_;
  const std::int64_t last_ns = state_ns_;
  receive();
  if (waits && state_ns_ == last_ns) ++link_.lost;
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
  const Published now{.drive = status(), .serial_number = state_.head.serial_number};
  if (!published_.load(last) || !(last == now)) published_.store(now);
}

void UnitreeLeggedDriver::fill_joint(std::size_t i, JointSample& sample) const noexcept {
  const UnitreeLeggedJoint& joint = parameters_.joints[i];
  const unitree::MotorState& motor = state_.motors[joint.motor];
  const auto direction = static_cast<double>(joint.direction);
  sample = {.position = position_of(i, state_),
            .velocity = direction * double{motor.dq},
            .effort = direction * motor.tau,
            .temperature = static_cast<double>(motor.temperature),
            .age_ns = now_ns_ - state_ns_,
            .valid = fresh() ? kValidMotion | kValidTemperature : 0U};
  const bool names_joint = status().cause == DriveCause::kHot || status().cause == DriveCause::kPositionJump;
  if (names_joint && status().code == i) sample.fault = static_cast<std::uint32_t>(status().cause);
}

void UnitreeLeggedDriver::fill_robot(SensorFrame& sensors) const noexcept {
  sensors.valid = 0;
  sensors.digital_inputs = 0;
  sensors.contact_count = 0;
  if (!fresh()) return;
  const unitree::LegImu& imu = state_.imu;
  sensors.valid = kValidGyro | kValidAccelerometer | kValidOrientation;
  std::ranges::copy(imu.gyroscope, sensors.imu.angular_velocity.begin());
  std::ranges::copy(imu.accelerometer, sensors.imu.linear_acceleration.begin());
  const auto& [w, x, y, z] = imu.quaternion;
  sensors.imu.orientation = {x, y, z, w};
  const auto& cells = state_.battery.cells;
  sensors.battery_voltage = unitree::kCellVoltage * std::accumulate(cells.begin(), cells.end(), 0.0);
  sensors.battery_current = -1.0e-3 * state_.battery.current;
  if (sensors.battery_voltage > 0) sensors.valid |= kValidBattery;
  if (unitree::requests_stop(state_.remote)) sensors.digital_inputs = kInputEmergencyStop;
}

unitree::MotorCommand UnitreeLeggedDriver::motor_command(std::size_t i, const JointCommand& command) const noexcept {
  const UnitreeLeggedJoint& joint = parameters_.joints[i];
  unitree::MotorCommand motor{.mode = unitree::kServo, .dq = 0, .kd = brakes_[i].damping};
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

void UnitreeLeggedDriver::send(std::span<const JointCommand> commands) noexcept {
  unitree::LowCmd message;
  for (std::size_t i = 0; i < parameters_.joints.size(); ++i) {
    message.motors[parameters_.joints[i].motor] = motor_command(i, i < commands.size() ? commands[i] : JointCommand{});
  }
  std::array<std::uint8_t, unitree::kCommandBytes> bytes;
  const bool exact = encode(message, bytes);
  ++link_.sent;
  if (!line_->send(bytes) || !exact) ++link_.errors;
}

void UnitreeLeggedDriver::write(std::span<const JointCommand> commands) noexcept {
  const bool obeys = status().state >= DrivePhase::kRunning && !disabled() && !stopped_;
  send(obeys && commands.size() == joint_count_ ? commands : std::span<const JointCommand>());
}

void UnitreeLeggedDriver::stop() noexcept {
  stopped_ = true;
  send({});
}

std::string UnitreeLeggedDriver::description() const {
  std::string text = "Go1 at its low level on " + line_->name();
  if (Published now; published_.load(now) && now.drive.cause != DriveCause::kFirstFrame)
    text += formatted(", serial number %u-%u", now.serial_number[0], now.serial_number[1]);
  return text + "; on silence it " + described(parameters_.line.on_silence) + " (stated in the drive file)";
}

std::string UnitreeLeggedDriver::warning() const {
  Published now;
  if (!published_.load(now) || now.drive.cause == DriveCause::kNone) return "";
  const DriveCause cause = now.drive.cause;
  const bool names_joint = cause == DriveCause::kHot || cause == DriveCause::kPositionJump;
  const std::string words = status_words("Go1 on " + line_->name(), now.drive,
                                         names_joint ? "of " + parameters_.joints.at(now.drive.code).joint : "");
  if (cause != DriveCause::kFirstFrame) return words;
  return words + "; put the robot into its low level with the remote: L2 and A, L2 and B, then L1, L2 and Start";
}

}  // namespace robot_control
