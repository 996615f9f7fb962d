#pragma once
/// The cost of one cycle of a CanDriver with two drives: its `read` and its `write`. The reference is bare system calls
/// that carry as many frames over such a socket.

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/programs/rows.h"
#include "drivers/drive/can_driver.h"
#include "drivers/table/simulated_front.h"
#include "gate/wheeled/wheel_stop.h"
#include "rt/clock.h"
#include "support/allocation_guard.h"

namespace robot_control::bench {

class Line {
 public:
  Line() {
    if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends_.data()) != 0)
      throw std::runtime_error("no socket");
  }
  int end(std::size_t i) const { return ends_.at(i); }

 private:
  std::array<int, 2> ends_{};
};

/// Sends and receives frames by one system call each.
class BareFrames {
 public:
  BareFrames() {
    for (std::size_t i = 0; i < kFrames; ++i) {
      parts_[i] = {.iov_base = &frames_[i], .iov_len = kFrameBytes};
      heads_[i].msg_hdr.msg_iov = &parts_[i];
      heads_[i].msg_hdr.msg_iovlen = 1;
    }
  }
  void send(int descriptor, std::uint64_t count) {
    sendmmsg(descriptor, heads_.data(), static_cast<unsigned>(count), MSG_DONTWAIT);
  }
  void receive(int descriptor) { recvmmsg(descriptor, heads_.data(), kFrames, MSG_DONTWAIT, nullptr); }

 private:
  static constexpr unsigned kFrames = 32;
  std::array<can_frame, kFrames> frames_{};
  std::array<iovec, kFrames> parts_{};
  std::array<mmsghdr, kFrames> heads_{};
};

/// Adds the rows of one drive file.
inline void add_can_cycle(std::vector<Row>& rows, const std::string& name, const CanDriveFile& can,
                          const DriveTrain& robot, double period) {
  constexpr int kCycles = 20'000;
  constexpr int kStart = 3'000;  // until the drives run
  const Line line, bare_line;
  const DriveMotors motors = drive_motors(robot, brakes_of_slow_drives(robot, period));
  const auto sockets = [](int descriptor) {
    CanSockets one;
    one.emplace_back(descriptor);
    return one;
  };
  const auto front = make_front(can, {.motors = motors, .line = sockets(line.end(1))});
  DeviceFront& devices = *front;
  CanDriver driver(can.bus, can.drives(), motors.brakes, devices.size(), period, sockets(line.end(0)),
                   [&devices] { return CanTime{.time_ns = devices.now_ns(), .utc_ns = devices.now_ns()}; });
  BareFrames bare;
  SensorFrame sensors;
  const std::vector<JointSample> joints(devices.size());
  const std::vector<JointCommand> commands(devices.size(), {.mode = JointMode::kEffort, .effort = 0.5});
  std::vector<double> own_ns, bare_ns;
  std::uint64_t allocations = 0;
  driver.start();
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    const CanCounts before = driver.bus().counts();
    const std::int64_t start_ns = monotonic_ns();
    {
      const AllocationGuard guard;
      driver.read(sensors);
      driver.write(commands);
      if (cycle >= kStart) allocations += guard.count();
    }
    const std::int64_t end_ns = monotonic_ns();
    const CanCounts& after = driver.bus().counts();
    devices.run(joints);
    bare.send(bare_line.end(1), after.received - before.received);
    const std::int64_t bare_start_ns = monotonic_ns();
    bare.receive(bare_line.end(0));
    bare.send(bare_line.end(0), after.sent - before.sent);
    const std::int64_t bare_end_ns = monotonic_ns();
    bare.receive(bare_line.end(1));
    if (cycle < kStart) continue;
    own_ns.push_back(static_cast<double>(end_ns - start_ns));
    bare_ns.push_back(static_cast<double>(bare_end_ns - bare_start_ns));
  }
  if (sensors.driver_state != DriverState::kRunning) throw std::runtime_error(name + ": the drives do not run");
  rows.push_back({name + " cycle of two drives", median(own_ns), "ns", median(bare_ns),
                  "bare system calls of its frames", median_ratio(own_ns, bare_ns)});
  rows.push_back({name + " cycle beside them", median(own_ns) - median(bare_ns), "ns", 20'000, "what is allowed",
                  (median(own_ns) - median(bare_ns)) / 20'000});
  rows.push_back({name + " allocations", static_cast<double>(allocations), "per 17000 cycles", 0, "none", 0});
  close(bare_line.end(0));
  close(bare_line.end(1));
}

}  // namespace robot_control::bench
