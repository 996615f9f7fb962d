#pragma once
/// SerialDriver is the common part of all drivers of a board on one serial line. It holds the beginning, the fault that
/// stays, the frame of the joints, and the status that other threads read.
///
/// `read` takes the bytes, and then reports state, joints and link. Samples have their own time, and their velocity
/// brings them to the time of `read`. The first fault stays until the operator's reset. A board that restarts counts
/// from zero, so what a wheel travels during a fault is unknown. Each joint then carries the cause as its fault word.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "bus/latest_value.h"
#include "drivers/driver.h"
#include "drivers/position_difference.h"
#include "drivers/line/serial_line.h"

namespace robot_control {

/// The counts of a wheel's encoder and what follows from them.
struct CountedWheel {
  double rad_per_count = 0;
  std::uint32_t counts = 0;
  std::int64_t total = 0;  ///< counts since the first sample
  double position = 0;     ///< rad, of the joint
  double velocity = 0;     ///< rad/s
  PositionDifference difference;

  /// Takes the position of `total` at this time.
  void measure(std::int64_t time_ns) noexcept {
    position = rad_per_count * static_cast<double>(total);
    difference.add(position, time_ns);
    velocity = difference.velocity();
  }
};

/// Cause: an enumeration with kNone, kNoAnswer (none yet) and kSilent. Wheel: derived from CountedWheel.
template <class Cause, class Wheel>
class SerialDriver : public Driver {
 public:
  void start() override {
    stopped_ = false;
    restart();
  }
  void reset() noexcept override {
    if (status_.state == DriverState::kFault) restart();
  }
  void read(SensorFrame& sensors) noexcept override;

 protected:
  struct Status {
    DriverState state = DriverState::kStarting;
    Cause cause = Cause::kNoAnswer;
    std::uint64_t detail = 0;  ///< of the cause
    std::uint64_t firmware = 0;
    std::uint64_t connected = 0;
    bool operator==(const Status&) const = default;
  };

  /// The wheels move the first joints of a robot that has `joint_count`. A velocity is that over `samples`. `clock`
  /// states the present time in ns.
  template <class WheelParameters>
  SerialDriver(const std::vector<WheelParameters>& wheels, std::size_t samples, std::size_t joint_count, double period,
               std::unique_ptr<SerialLine> line, std::function<std::int64_t()> clock)
      : joint_count_(joint_count),
        period_ns_(std::llround(1.0e9 * period)),
        line_(std::move(line)),
        clock_(std::move(clock)),
        wheels_(wheels.size()) {
    for (std::size_t i = 0; i < wheels.size(); ++i) {
      const double turn = static_cast<double>(wheels[i].direction) * 2 * std::numbers::pi;
      wheels_[i].rad_per_count = turn / wheels[i].counts_per_turn;
      wheels_[i].difference = PositionDifference(samples);
    }
  }

  /// Forgets what was learned of the board.
  virtual void begin() noexcept = 0;
  /// Takes the bytes that arrived. Returns whether the board is silent.
  virtual bool receive() noexcept = 0;
  /// Adds the measurements of the board to a frame whose joints have position, velocity, age and fault.
  virtual void add_measurements(SensorFrame& sensors) noexcept = 0;
  /// Returns whether this cause is a fault also before the board runs.
  virtual bool is_fault_at_start(Cause cause) const noexcept = 0;

  bool running() const noexcept { return status_.state == DriverState::kRunning; }
  bool obeys(std::span<const JointCommand> commands) const noexcept {
    return running() && !stopped_ && commands.size() == joint_count_;
  }
  void run() noexcept {
    status_.state = DriverState::kRunning;
    status_.cause = Cause::kNone;
  }
  void fail(Cause cause, std::uint64_t detail = 0) noexcept;
  /// Hands the bytes of one message to the line.
  void send(std::span<const std::uint8_t> bytes) noexcept {
    ++link_.sent;
    if (!line_->send(bytes)) ++link_.errors;
  }
  /// The status that was published last; any thread may call it.
  Status published() const {
    Status status;
    return published_status_.load(status) ? status : Status{.cause = Cause::kNone};
  }

  const std::size_t joint_count_;
  const std::int64_t period_ns_;
  const std::unique_ptr<SerialLine> line_;
  const std::function<std::int64_t()> clock_;
  std::vector<Wheel> wheels_;    ///< in the order of the joints
  std::int64_t sample_ns_ = 0;   ///< when the newest counts were latched
  std::int64_t max_age_ns_ = 0;  ///< for which a position moves on with its velocity
  std::int64_t now_ns_ = 0;
  LinkStatus link_;
  Status status_;
  bool stopped_ = true;

 private:
  void restart() noexcept {
    status_.state = DriverState::kStarting;
    status_.cause = Cause::kNoAnswer;
    begin();
  }
  void publish() noexcept;

  LatestValue<Status> published_status_;
};

template <class Cause, class Wheel>
void SerialDriver<Cause, Wheel>::fail(Cause cause, std::uint64_t detail) noexcept {
  if (status_.state == DriverState::kFault) return;  // the first one stays
  status_.cause = cause;
  status_.detail = detail;
  if (running() || is_fault_at_start(cause)) status_.state = DriverState::kFault;
}

template <class Cause, class Wheel>
void SerialDriver<Cause, Wheel>::read(SensorFrame& sensors) noexcept {
  now_ns_ = clock_();
  const bool silent = receive();
  if (silent) fail(Cause::kSilent);
  const bool faulty = status_.state == DriverState::kFault;
  sensors.driver_state = status_.state;
  sensors.faults = 0;
  if (faulty) sensors.faults = status_.cause == Cause::kSilent ? kFaultLink : kFaultDrive;
  sensors.valid = 0;
  sensors.digital_inputs = 0;
  sensors.joint_count = joint_count_;
  const std::int64_t age_ns = now_ns_ - sample_ns_;
  const double age = 1.0e-9 * static_cast<double>(std::clamp<std::int64_t>(age_ns, 0, max_age_ns_));
  for (std::size_t i = wheels_.size(); i < joint_count_; ++i) sensors.joints[i] = {};
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    sensors.joints[i] = {.position = wheels_[i].position + wheels_[i].velocity * age,
                         .velocity = wheels_[i].velocity,
                         .effort = std::numeric_limits<double>::quiet_NaN(),
                         .age_ns = age_ns,
                         .valid = running() ? std::uint32_t{kValidKinematics} : 0U,
                         .fault = faulty ? static_cast<std::uint32_t>(status_.cause) : 0U};
  }
  add_measurements(sensors);
  link_.state = !line_->connected() || silent ? LinkState::kDown : running() ? LinkState::kUp : LinkState::kStarting;
  sensors.link_count = 1;
  sensors.links[0] = link_;
  publish();
}

template <class Cause, class Wheel>
void SerialDriver<Cause, Wheel>::publish() noexcept {
  Status last;
  status_.connected = line_->connected() ? 1 : 0;
  if (!published_status_.load(last) || !(last == status_)) published_status_.store(status_);
}

}  // namespace robot_control
