#include "drivers/drive/can_front.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

namespace robot_control {

namespace {

/// Returns the devices' end; that of the driver goes to `driver_end` where the line is in virtual time.
CanSocket devices_end(std::optional<LineEnd> line, std::optional<CanSocket>& driver_end) {
  if (line) return std::get<CanSocket>(std::move(*line));
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw DriverError(std::string("no socket for the line to the simulated drives: ") + std::strerror(errno));
  driver_end.emplace(CanSocket::line_end(ends[0]));
  return CanSocket::line_end(ends[1]);
}

}  // namespace

CanFront::CanFront(const CanDriveFile& file, FrontSetup setup)
    : bus_(file.bus.bit_rate, setup.seed),
      line_(devices_end(std::move(setup.line), driver_end_)),
      period_ns_(std::llround(1.0e9 * file.request().period())),
      joints_(file.request().joints),
      host_(bus_.join([this](const can_frame& frame, std::int64_t now_ns) { carry(frame, now_ns); })),
      random_(setup.seed) {}

void CanFront::carry(can_frame frame, std::int64_t now_ns) {
  if (fault_ == AnswerFault::kLost) return;
  const auto bit = static_cast<unsigned>(fault_ == AnswerFault::kDamaged ? random_() % 64 : 64);
  if (bit / 8 < frame.len) frame.data[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  if (fault_ == AnswerFault::kShifted) std::rotate(frame.data, frame.data + 7, frame.data + 8);
  answers_.push_back({frame, now_ns + (fault_ == AnswerFault::kLate ? kLateAnswerNs : 0)});
}

DeviceMotor& CanFront::add_motor(const DriveParameters& joint) {
  to_motor_.push_back(static_cast<double>(joint.direction) * joint.gear);
  torques_.push_back(0);
  return *motors_.emplace_back(std::make_unique<DeviceMotor>());
}

void CanFront::add_device(std::unique_ptr<Device> device, std::span<const std::size_t> joints) {
  device_of_.resize(motors_.size());
  for (const std::size_t joint : joints) device_of_[joint] = devices_.size();
  devices_.push_back(std::move(device));
}

void CanFront::run(std::span<const JointSample> joints) {
  const std::int64_t now_ns = bus_.now_ns();
  for (bool more = true; more;) {
    const ReceivedFrames received = line_.receive({.time_ns = now_ns, .utc_ns = now_ns});
    for (const ReceivedFrame& each : received.frames) bus_.send(host_, each.frame);
    more = received.more;
  }
  run_devices(joints);
  std::vector<can_frame> arrived;
  for (; !answers_.empty() && answers_.front().due_ns <= now_ns + period_ns_; answers_.pop_front())
    arrived.push_back(answers_.front().frame);
  line_.send(arrived);
}

/// Meanwhile the joints move on with their velocity.
void CanFront::run_devices(std::span<const JointSample> joints) {
  const std::int64_t begin_ns = bus_.now_ns();
  const std::int64_t until_ns = begin_ns + period_ns_;
  const auto seconds = [](std::int64_t ns) { return 1.0e-9 * static_cast<double>(ns); };
  std::ranges::fill(torques_, 0);
  for (std::int64_t now_ns = begin_ns; now_ns < until_ns;) {
    bus_.advance(now_ns);
    for (std::size_t i = 0; i < motors_.size(); ++i) {
      motors_[i]->position = to_motor_[i] * (joints[i].position + joints[i].velocity * seconds(now_ns - begin_ns));
      motors_[i]->velocity = to_motor_[i] * joints[i].velocity;
    }
    for (const auto& device : devices_) device->step(now_ns);
    const std::int64_t next_ns = std::min(now_ns + kStepNs, until_ns);
    const double share = seconds(next_ns - now_ns) / seconds(until_ns - begin_ns);
    for (std::size_t i = 0; i < motors_.size(); ++i) torques_[i] += share * to_motor_[i] * motors_[i]->torque;
    now_ns = next_ns;
  }
  bus_.advance(until_ns);
}

std::string CanFront::inject(std::string_view component, std::string_view kind) {
  const std::vector<Word> words = words_of(DeviceFault());
  const auto word = std::ranges::find(words, kind, &Word::text);
  const auto joint = std::ranges::find(joints_, component);
  const AnswerFault answers = answer_fault(kind);
  const auto is = [kind](auto... of_bus) { return ((kind == of_bus) || ...); };
  if (component == "bus" && (is("ok", "off", "lossy", "disturbed") || answers != AnswerFault::kNone)) {
    fault_ = answers;
    bus_.connect(host_, kind != "off");
    bus_.lose(is("lossy", "disturbed") ? kFrameLoss : 0);
    bus_.delay(is("disturbed") ? period_ns_ : 0);
    return "";
  }
  if (joint != joints_.end() && word != words.end()) {
    const auto index = static_cast<std::size_t>(joint - joints_.begin());
    devices_.at(device_of_.at(index))->inject(static_cast<DeviceFault>(word->value));
    return "";
  }
  std::string problem =
      std::string("component must be bus (with ok, off, lossy, disturbed, ") + kAnswerFaultWords + ")";
  for (const std::string& name : joints_) problem += ", " + name;
  problem += "; kind";
  for (const Word& each : words) problem += " " + std::string(each.text);
  return problem;
}

}  // namespace robot_control
