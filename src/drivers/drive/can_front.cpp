#include "drivers/drive/can_front.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

namespace robot_control {

namespace {

/// Returns the devices' ends; those of the driver go to `driver_ends` where the lines are in virtual time.
CanSockets devices_ends(std::optional<LineEnd> line, std::size_t buses, CanSockets& driver_ends) {
  if (line) return std::get<CanSockets>(std::move(*line));
  CanSockets devices;
  for (std::size_t i = 0; i < buses; ++i) {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0)
      throw DriverError(std::string("no socket for the line to the simulated drives: ") + std::strerror(errno));
    driver_ends.push_back(CanSocket::line_end(ends[0]));
    devices.push_back(CanSocket::line_end(ends[1]));
  }
  return devices;
}

}  // namespace

CanFront::Bus::Bus(const CanDriveFile& file, std::string bus_address, CanSocket socket, std::uint64_t seed)
    : address(std::move(bus_address)),
      can(file.bus.bit_rate, seed, file.bus.data_rate),
      line(std::move(socket)),
      host(can.join([this](const can_frame& frame, std::int64_t now_ns) { carry(frame, now_ns); })),
      random(seed) {}

CanFront::CanFront(const CanDriveFile& file, FrontSetup setup)
    : period_ns_(std::llround(1.0e9 * file.request().period())), joints_(file.request().joints) {
  const DriveSet drives = file.drives();
  is_absolute_ = drives[0].drive_parameters().is_absolute;
  const std::vector<std::string>& addresses = drives.buses();
  CanSockets ends = devices_ends(std::move(setup.line), addresses.size(), driver_ends_);
  for (std::size_t i = 0; i < addresses.size(); ++i)
    buses_.emplace_back(file, addresses[i], std::move(ends[i]), setup.seed + i);
}

VirtualCan& CanFront::bus(const std::string& address) {
  return std::ranges::find(buses_, address, &Bus::address)->can;
}

void CanFront::Bus::carry(can_frame frame, std::int64_t now_ns) {
  if (fault == AnswerFault::kLost) return;
  const unsigned bytes = std::max<unsigned>(frame.len, CAN_MAX_DLEN);
  const auto bit = static_cast<unsigned>(fault == AnswerFault::kDamaged ? random() % (8 * bytes) : 8 * bytes);
  if (bit / 8 < frame.len) frame.data[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  if (fault == AnswerFault::kShifted) std::rotate(frame.data, frame.data + bytes - 1, frame.data + bytes);
  answers.push_back({frame, now_ns + (fault == AnswerFault::kLate ? kLateAnswerNs : 0)});
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
  const std::int64_t begin_ns = now_ns();
  for (Bus& bus : buses_) {
    for (bool more = true; more;) {
      const ReceivedFrames received = bus.line.receive({.time_ns = begin_ns, .utc_ns = begin_ns});
      for (const ReceivedFrame& each : received.frames) {
        bus.can.send(bus.host, each.frame);
        if (bus.has_second_writer) bus.carry(each.frame, begin_ns);
      }
      more = received.more;
    }
  }
  run_devices(joints);
  for (Bus& bus : buses_) {
    std::vector<can_frame> arrived;
    for (; !bus.answers.empty() && bus.answers.front().due_ns <= begin_ns + period_ns_; bus.answers.pop_front())
      arrived.push_back(bus.answers.front().frame);
    bus.line.send(arrived);
  }
}

/// Meanwhile the joints move on with their velocity.
void CanFront::run_devices(std::span<const JointSample> joints) {
  const std::int64_t begin_ns = now_ns();
  const std::int64_t until_ns = begin_ns + period_ns_;
  const auto seconds = [](std::int64_t ns) { return 1.0e-9 * static_cast<double>(ns); };
  std::ranges::fill(torques_, 0);
  const auto advance = [this](std::int64_t to_ns) {
    std::ranges::for_each(buses_, [to_ns](Bus& bus) { bus.can.advance(to_ns); });
  };
  for (std::int64_t now_ns = begin_ns; now_ns < until_ns;) {
    advance(now_ns);
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
  advance(until_ns);
}

void CanFront::Bus::inject(std::string_view kind, std::int64_t period_ns) {
  const bool disturbed = kind == "disturbed";
  fault = answer_fault(kind);
  has_second_writer = kind == "second_writer";
  can.connect(host, kind != "off");
  can.lose(kind == "lossy" || disturbed ? kFrameLoss : 0);
  can.delay(disturbed ? period_ns : 0);
}

std::string CanFront::inject(std::string_view component, std::string_view kind) {
  constexpr std::array<std::string_view, 5> kBusFaults{"ok", "off", "lossy", "disturbed", "second_writer"};
  const std::vector<Word> words = words_of(DeviceFault());
  const auto word = std::ranges::find(words, kind, &Word::text);
  const auto joint = std::ranges::find(joints_, component);
  const bool of_bus =
      std::ranges::find(kBusFaults, kind) != kBusFaults.end() || answer_fault(kind) != AnswerFault::kNone;
  bool done = false;
  for (Bus& bus : buses_) {
    if (!of_bus || (component != "bus" && component != bus.address)) continue;
    bus.inject(kind, period_ns_);
    done = true;
  }
  if (done) return "";
  if (joint != joints_.end() && word != words.end()) {
    const auto index = static_cast<std::size_t>(joint - joints_.begin());
    devices_.at(device_of_.at(index))->inject(static_cast<DeviceFault>(word->value));
    return "";
  }
  std::string problem = "component must be bus";
  for (const Bus& bus : buses_) problem += buses_.size() > 1 ? ", " + bus.address : "";
  problem += std::string(" (with ok, off, lossy, disturbed, second_writer, ") + kAnswerFaultWords + ")";
  for (const std::string& name : joints_) problem += ", " + name;
  problem += "; kind";
  for (const Word& each : words) problem += " " + std::string(each.text);
  return problem;
}

}  // namespace robot_control
