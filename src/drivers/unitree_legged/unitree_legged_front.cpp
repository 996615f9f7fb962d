#include "drivers/unitree_legged/unitree_legged_front.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "drivers/unitree_legged/unitree_legged_file.h"

namespace robot_control {
namespace {

constexpr std::uint8_t kCharge = 80;  // %
constexpr std::uint8_t kCell = 120;   // 3.84 V
constexpr std::size_t kCells = 6;
constexpr std::int32_t kCurrent = -3000;  // mA
constexpr std::int8_t kWarm = 40;         // °C
constexpr std::int8_t kHot = 110;
constexpr std::uint32_t kTickNs = 1000;

}  // namespace

UnitreeLeggedFront::UnitreeLeggedFront(UnitreeLeggedParameters parameters, double period, std::uint64_t seed,
                                       std::unique_ptr<DatagramLine> true_line)
    : parameters_(std::move(parameters)),
      period_ns_(std::llround(1.0e9 * period)),
      true_line_(std::move(true_line)),
      torques_(parameters_.joints.size()) {
  if (!true_line_) virtual_line_ = std::make_unique<VirtualDatagrams>(seed);
  state_.head.serial_number = {1, 1};
  state_.battery.charge = kCharge;
  state_.battery.current = kCurrent;
  std::fill_n(state_.battery.cells.begin(), kCells, kCell);
  for (unitree::MotorState& motor : state_.motors) motor.temperature = kWarm;
}

void UnitreeLeggedFront::sense(const ImuSample& imu) {
  const auto narrow = [](double value) { return static_cast<float>(value); };
  std::ranges::transform(imu.angular_velocity, state_.imu.gyroscope.begin(), narrow);
  std::ranges::transform(imu.linear_acceleration, state_.imu.accelerometer.begin(), narrow);
  const Quaternion& q = imu.orientation;
  state_.imu.quaternion = {narrow(q[3]), narrow(q[0]), narrow(q[1]), narrow(q[2])};
}

void UnitreeLeggedFront::take_commands() {
  std::array<std::uint8_t, kMaxDatagram> bytes;
  for (std::size_t size = robot_line().receive(bytes); size > 0; size = robot_line().receive(bytes)) {
    if (fault_ == Fault::kOff || now_ns_ < boots_ns_) continue;
    if (decode(std::span(bytes).first(std::min(size, bytes.size())), command_) != unitree::Flaw::kNone) continue;
    command_ns_ = now_ns_;
    if (answer_ns_ < 0) answer_ns_ = now_ns_ + kAnswerNs;
  }
}

void UnitreeLeggedFront::answer() {
  answer_ns_ = -1;
  if (fault_ == Fault::kOff || now_ns_ < boots_ns_) return;
  if (fault_ != Fault::kFrozen) state_.tick = static_cast<std::uint32_t>((now_ns_ - boots_ns_) / kTickNs);
  std::array<std::uint8_t, unitree::kStateBytes> bytes;
  encode(state_, bytes);
  if (not_finite_) {
    std::fill_n(bytes.begin() + 76, 4, std::uint8_t{0xFF});  // the position of the first motor
    const std::uint32_t sum = unitree::check_sum(std::span(bytes).first(unitree::kStateBytes - 4));
    for (std::size_t i = 0; i < 4; ++i) bytes[unitree::kStateBytes - 4 + i] = static_cast<std::uint8_t>(sum >> (8 * i));
  }
  if (fault_ == Fault::kEncrypted) bytes.back() ^= 0x5A;
  robot_line().send(bytes);
}

double UnitreeLeggedFront::motor_torque(std::size_t joint) const {
  if (fault_ == Fault::kOff || now_ns_ < boots_ns_) return 0;
  const unitree::MotorState& motor = state_.motors[parameters_.joints[joint].motor];
  const unitree::MotorCommand& command = command_.motors[parameters_.joints[joint].motor];
  double torque = -kSilentDamping * double{motor.dq};
  if (now_ns_ - command_ns_ <= kSilenceNs && command.mode == unitree::kServo) {
    torque = command.tau;
    if (command.q < unitree::kNoPosition) torque += command.kp * (double{command.q} - double{motor.q});
    if (command.dq < unitree::kNoVelocity) torque += command.kd * (double{command.dq} - double{motor.dq});
  }
  const double limit = parameters_.joints[joint].torque_limit;
  return std::clamp(torque, -limit, limit);
}

void UnitreeLeggedFront::run(std::span<const JointSample> joints) {
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
      const UnitreeLeggedJoint& joint = parameters_.joints[i];
      const auto direction = static_cast<double>(joint.direction);
      unitree::MotorState& motor = state_.motors[joint.motor];
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

bool UnitreeLeggedFront::inject_robot(std::string_view kind) {
  constexpr std::array<std::string_view, 8> kKinds{"ok",        "off",         "reset",       "frozen",
                                                   "encrypted", "other_robot", "low_battery", "e_stop"};
  if (std::ranges::find(kKinds, kind) == kKinds.end()) return false;
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

bool UnitreeLeggedFront::inject_motor(std::string_view kind) {
  if (kind != "ok" && kind != "hot" && kind != "not_finite") return false;
  state_.motors[parameters_.joints.front().motor].temperature = kind == "hot" ? kHot : kWarm;
  not_finite_ = kind == "not_finite";
  return true;
}

std::string UnitreeLeggedFront::inject(std::string_view component, std::string_view kind) {
  if (component == "robot" && inject_robot(kind)) return "";
  if (component == "motor" && inject_motor(kind)) return "";
  if (component == "line" && virtual_line_) {
    if (const std::optional<DatagramFaults> faults = datagram_faults(kind)) {
      virtual_line_->faults() = *faults;
      return "";
    }
  }
  return std::string(
             "component must be robot (with ok, off, reset, frozen, encrypted, other_robot, low_battery, e_stop), "
             "motor "
             "(with ok, hot, not_finite) or line (with ") +
         kDatagramFaultWords + ", " + kAnswerFaultWords + ")";
}

std::unique_ptr<DeviceFront> make_unitree_legged_front(const DriveFile& file, FrontSetup setup) {
  std::unique_ptr<DatagramLine> line;
  if (setup.line) line = std::get<std::unique_ptr<DatagramLine>>(std::move(*setup.line));
  return std::make_unique<UnitreeLeggedFront>(dynamic_cast<const UnitreeLeggedFile&>(file).parameters(),
                                              file.request().period(), setup.seed, std::move(line));
}

}  // namespace robot_control
