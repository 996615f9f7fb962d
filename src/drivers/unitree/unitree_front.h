#pragma once
/// A UnitreeFront is a simulated Robot at its low level, before the motors of a simulated machine. It answers each
/// LowCmd with a LowState kAnswerNs later, or sends one every kPublishNs. A program between both is the Device of
/// Robot. A motor gives torque = tau + kp (q − q_motor) + kd (dq − q̇_motor), within the torque_limit of the drive file.
/// After kSilenceNs without a command it damps: an assumption, because what the robot does is not documented.
///
/// `inject` takes `robot`, `motor` or `line` as the component; the line has faults in virtual time alone.
///
///   robot  ok | off | reset (silent for kBootNs; the tick starts again) | frozen (its last state again and again)
///          | encrypted (wrong check sums) | other_robot (another serial number) | low_battery | e_stop (L2 and B)
///   motor  ok | hot | not_finite; of the first joint
///   line   kDatagramFaultWords, kAnswerFaultWords
///
/// Robot::Device may take a further component.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "drivers/drive/device_front.h"
#include "drivers/unitree/unitree_parameters.h"
#include "drivers/unitree/virtual_datagrams.h"

namespace robot_control {

template <class Robot>
class UnitreeFront final : public DeviceFront {
 public:
  using Command = typename Robot::Command;
  using State = typename Robot::State;
  static constexpr std::int64_t kStepNs = 250'000;    ///< between two steps of the motors
  static constexpr std::int64_t kAnswerNs = 250'000;  ///< from a command to its answer
  static constexpr std::int64_t kSilenceNs = 20'000'000;
  static constexpr std::int64_t kBootNs = 300'000'000;
  static constexpr double kSilentDamping = 2;      ///< N·m·s/rad
  static constexpr std::uint8_t kCharge = 80;      ///< %
  static constexpr std::int32_t kCurrent = -3000;  ///< mA
  static constexpr std::int8_t kWarm = 40;         ///< °C
  static constexpr std::int8_t kHot = 110;

  /// `true_line`: null for a line in virtual time, with this seed.
  UnitreeFront(UnitreeParameters<Robot> parameters, double period, std::uint64_t seed,
               std::unique_ptr<DatagramLine> true_line);

  std::size_t size() const override { return torques_.size(); }
  std::int64_t now_ns() const override { return now_ns_; }
  LineEnd driver_end() override { return virtual_line_->driver_end(); }
  bool is_absolute() const override { return true; }
  bool reports_imu() const override { return true; }
  void sense(const ImuSample& imu) override;
  void run(std::span<const JointSample> joints) override;
  double torque(std::size_t joint) const override { return torques_.at(joint); }
  std::string inject(std::string_view component, std::string_view kind) override;

  /// Returns the last command that came.
  const Command& command() const { return command_; }
  /// Returns the next state; a test may set what `run` and `sense` do not.
  State& state() { return state_; }
  /// Returns the line in virtual time.
  VirtualDatagrams& line() { return *virtual_line_; }

 private:
  using Device = typename Robot::Device;
  enum class Fault { kNone, kOff, kFrozen, kEncrypted };

  bool has_power() const noexcept { return fault_ != Fault::kOff && now_ns_ >= boots_ns_; }
  DatagramLine& robot_line() { return virtual_line_ ? virtual_line_->device_end() : *true_line_; }
  void take_commands();
  void answer();
  double motor_torque(std::size_t joint) const;
  bool inject_robot(std::string_view kind);
  bool inject_motor(std::string_view kind);

  UnitreeParameters<Robot> parameters_;
  std::int64_t period_ns_;
  std::unique_ptr<DatagramLine> true_line_;
  std::unique_ptr<VirtualDatagrams> virtual_line_;  // null: the true one
  Device device_;
  Command command_;
  State state_;
  std::vector<double> torques_;  // N·m, of the joints, means of the period
  std::int64_t now_ns_ = 0;
  std::int64_t command_ns_ = -kSilenceNs;                    // when the last command came
  std::int64_t answer_ns_ = Robot::kPublishNs > 0 ? 0 : -1;  // when the next state is due; -1: after a command
  std::int64_t boots_ns_ = 0;
  Fault fault_ = Fault::kNone;
  bool not_finite_ = false;
};

template <class Robot>
UnitreeFront<Robot>::UnitreeFront(UnitreeParameters<Robot> parameters, double period, std::uint64_t seed,
                                  std::unique_ptr<DatagramLine> true_line)
    : parameters_(std::move(parameters)),
      period_ns_(std::llround(1.0e9 * period)),
      true_line_(std::move(true_line)),
      torques_(parameters_.joints.size()) {
  if (!true_line_) virtual_line_ = std::make_unique<VirtualDatagrams>(seed);
  state_.head.serial_number = {1, 1};
  state_.battery.charge = kCharge;
  state_.battery.current = kCurrent;
  Robot::set_voltage(state_);
  for (auto& motor : state_.motors) motor.temperature = kWarm;
}

template <class Robot>
void UnitreeFront<Robot>::sense(const ImuSample& imu) {
  const auto narrow = [](double value) { return static_cast<float>(value); };
  std::ranges::transform(imu.angular_velocity, state_.imu.gyroscope.begin(), narrow);
  std::ranges::transform(imu.linear_acceleration, state_.imu.accelerometer.begin(), narrow);
  const Quaternion& q = imu.orientation;
  state_.imu.quaternion = {narrow(q[3]), narrow(q[0]), narrow(q[1]), narrow(q[2])};
}

template <class Robot>
void UnitreeFront<Robot>::take_commands() {
  std::array<std::uint8_t, kMaxDatagram> bytes;
  for (std::size_t size = robot_line().receive(bytes); size > 0; size = robot_line().receive(bytes)) {
    if (!has_power() || !device_.forwards) continue;
    if (Robot::decode(std::span(bytes).first(std::min(size, bytes.size())), command_) != unitree::Flaw::kNone) continue;
    command_ns_ = now_ns_;
    if (answer_ns_ < 0) answer_ns_ = now_ns_ + kAnswerNs;
  }
}

template <class Robot>
void UnitreeFront<Robot>::answer() {
  answer_ns_ = Robot::kPublishNs > 0 ? answer_ns_ + Robot::kPublishNs : -1;
  std::array<std::uint8_t, Device::kHeadBytes + Robot::kStateBytes> datagram;
  const std::span<std::uint8_t> head = std::span(datagram).first(Device::kHeadBytes);
  if (!device_.write_head(head)) return;
  if (!has_power()) {
    if (!head.empty()) robot_line().send(head);
    return;
  }
  if (fault_ != Fault::kFrozen) state_.tick = static_cast<std::uint32_t>((now_ns_ - boots_ns_) / Robot::kTickNs);
  const auto bytes = std::span(datagram).template subspan<Device::kHeadBytes>();
  Robot::encode(state_, bytes);
  if (not_finite_) {
    std::fill_n(bytes.begin() + Robot::kFirstPosition, 4, std::uint8_t{0xFF});
    const std::uint32_t sum = unitree::check_sum(std::span(bytes).first(bytes.size() - 4));
    for (std::size_t i = 0; i < 4; ++i) bytes[bytes.size() - 4 + i] = static_cast<std::uint8_t>(sum >> (8 * i));
  }
  if (fault_ == Fault::kEncrypted) bytes.back() ^= 0x5A;
  robot_line().send(datagram);
}

template <class Robot>
double UnitreeFront<Robot>::motor_torque(std::size_t joint) const {
  if (!has_power()) return 0;
  const auto& motor = state_.motors[parameters_.joints[joint].motor];
  const unitree::MotorCommand& command = command_.motors[parameters_.joints[joint].motor];
  double torque = -kSilentDamping * double{motor.dq};
  if (now_ns_ - command_ns_ <= kSilenceNs && command.mode == Robot::kServo) {
    torque = command.tau;
    if (command.q < unitree::kNoPosition) torque += command.kp * (double{command.q} - double{motor.q});
    if (command.dq < unitree::kNoVelocity) torque += command.kd * (double{command.dq} - double{motor.dq});
  }
  const double limit = parameters_.joints[joint].torque_limit;
  return std::clamp(torque, -limit, limit);
}

template <class Robot>
void UnitreeFront<Robot>::run(std::span<const JointSample> joints) {
  std::ranges::fill(torques_, 0);
  const std::int64_t begin_ns = now_ns_;
  const std::int64_t end_ns = begin_ns + period_ns_;
  while (now_ns_ < end_ns) {
    const std::int64_t next_ns = std::min(now_ns_ + kStepNs, end_ns);
    const double elapsed = 1.0e-9 * static_cast<double>(now_ns_ - begin_ns);
    const double share = static_cast<double>(next_ns - now_ns_) / static_cast<double>(period_ns_);
    if (virtual_line_) virtual_line_->advance(now_ns_);
    take_commands();
    for (std::size_t i = 0; i < torques_.size(); ++i) {
      const UnitreeJoint<Robot>& joint = parameters_.joints[i];
      const auto direction = static_cast<double>(joint.direction);
      auto& motor = state_.motors[joint.motor];
      motor.q = static_cast<float>(direction * (joints[i].position + joints[i].velocity * elapsed - joint.offset));
      motor.dq = static_cast<float>(direction * joints[i].velocity);
      motor.mode = command_.motors[joint.motor].mode;
      motor.tau = motor_torque(i);
      torques_[i] += share * direction * motor.tau;
    }
    now_ns_ = next_ns;
    if (answer_ns_ >= 0 && now_ns_ >= answer_ns_) {
      if (virtual_line_) virtual_line_->advance(now_ns_);
      answer();
    }
  }
  if (virtual_line_) virtual_line_->advance(now_ns_);
}

template <class Robot>
bool UnitreeFront<Robot>::inject_robot(std::string_view kind) {
  constexpr std::array<std::string_view, 8> kKnownKinds{"ok",        "off",         "reset",       "frozen",
                                                        "encrypted", "other_robot", "low_battery", "e_stop"};
  if (std::ranges::find(kKnownKinds, kind) == kKnownKinds.end()) return false;
  if (kind == "reset" || (fault_ == Fault::kOff && kind != "off")) boots_ns_ = now_ns_ + kBootNs;
  fault_ = kind == "off"         ? Fault::kOff
           : kind == "frozen"    ? Fault::kFrozen
           : kind == "encrypted" ? Fault::kEncrypted
                                 : Fault::kNone;
  state_.head.serial_number[0] = kind == "other_robot" ? 2 : 1;
  state_.battery.charge = kind == "low_battery" ? 1 : kCharge;
  state_.remote = {};
  if (kind == "e_stop") {
    state_.remote[2] = 0x20;
    state_.remote[3] = 0x02;
  }
  return true;
}

template <class Robot>
bool UnitreeFront<Robot>::inject_motor(std::string_view kind) {
  if (kind != "ok" && kind != "hot" && kind != "not_finite") return false;
  state_.motors[parameters_.joints.front().motor].temperature = kind == "hot" ? kHot : kWarm;
  not_finite_ = kind == "not_finite";
  return true;
}

template <class Robot>
std::string UnitreeFront<Robot>::inject(std::string_view component, std::string_view kind) {
  if (component == "robot" && inject_robot(kind)) return "";
  if (component == "motor" && inject_motor(kind)) return "";
  if (device_.inject(component, kind)) return "";
  if (component == "line" && virtual_line_) {
    if (const std::optional<DatagramFaults> faults = datagram_faults(kind)) {
      virtual_line_->faults() = *faults;
      return "";
    }
  }
  return std::string(
             "component must be robot (with ok, off, reset, frozen, encrypted, other_robot, low_battery, e_stop), "
             "motor (with ok, hot, not_finite)") +
         Device::kWords + " or line (with " + kDatagramFaultWords + ", " + kAnswerFaultWords + ")";
}

}  // namespace robot_control
