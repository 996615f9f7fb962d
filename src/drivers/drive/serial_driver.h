#pragma once
/// SerialDriver is the common part of all drivers of a board on one serial line, which is one drive with several
/// wheels. It holds the beginning, the frame of the joints, and the status that other threads read.
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
#include "drivers/drive/drive_status.h"
#include "drivers/driver.h"
#include "drivers/line/serial_line.h"
#include "drivers/position_difference.h"

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

/// Wheel: derived from CountedWheel.
template <class Wheel>
class SerialDriver : public Driver, protected DriveStateMachine {
 public:
  void start() override {
    stopped_ = false;
    restart();
  }
  void reset() noexcept override {
    if (status().state == DrivePhase::kFault) restart();
  }
  void read(SensorFrame& sensors) noexcept override;

 protected:
  /// The status for other threads.
  struct Published {
    DriveStatus drive{};
    std::uint64_t firmware = 0;
    bool operator==(const Published&) const = default;
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
  virtual bool is_fault_at_start(DriveCause cause) const noexcept = 0;

  bool obeys(std::span<const JointCommand> commands) const noexcept {
    return running() && !stopped_ && commands.size() == joint_count_;
  }
  void run() noexcept { set(DrivePhase::kRunning, DriveCause::kNone); }
  /// A fault, or before the board runs what it waits for.
  void evaluate(DriveCause cause, const char* subject = "", std::uint64_t code = 0, double found = 0,
                double expected = 0) noexcept {
    if (running() || is_fault_at_start(cause)) return fail(cause, subject, code, found, expected);
    set(DrivePhase::kStarting, cause, subject, code, found, expected);
  }
  /// Hands the bytes of one message to the line.
  void send(std::span<const std::uint8_t> bytes) noexcept {
    ++link_.sent;
    if (!line_->send(bytes)) ++link_.errors;
  }
  /// The status that was published last; any thread may call it.
  Published published() const {
    Published published;
    return published_.load(published) ? published : Published{.drive = {.cause = DriveCause::kNone}};
  }
  /// Returns it in words; "" while the board runs.
  std::string words(const std::string& name, const std::string& code) const {
    const DriveStatus drive = published().drive;
    return drive.cause == DriveCause::kNone ? "" : status_words(name + " on " + line_->name(), drive, code);
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
  std::uint64_t firmware_ = 0;  ///< its version, as the board reports it
  bool stopped_ = true;

 private:
  void restart() noexcept {
    forget();
    begin();
  }
  void publish() noexcept;

  LatestValue<Published> published_;
};

template <class Wheel>
void SerialDriver<Wheel>::read(SensorFrame& sensors) noexcept {
  now_ns_ = clock_();
  const bool silent = receive();
  if (silent) evaluate(DriveCause::kSilent, line_->connected() ? "message" : "device on the line");
  const bool faulty = status().state == DrivePhase::kFault;
  sensors.driver_state = faulty ? DriverState::kFault : running() ? DriverState::kRunning : DriverState::kStarting;
  sensors.faults = faulty ? std::uint64_t{fault_of(status().cause)} : 0;
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
                         .fault = faulty ? static_cast<std::uint32_t>(status().cause) : 0U};
  }
  add_measurements(sensors);
  link_.state = !line_->connected() || silent ? LinkState::kDown : running() ? LinkState::kUp : LinkState::kStarting;
  sensors.link_count = 1;
  sensors.links[0] = link_;
  publish();
}

template <class Wheel>
void SerialDriver<Wheel>::publish() noexcept {
  Published last;
  const Published now{.drive = status(), .firmware = firmware_};
  if (!published_.load(last) || !(last == now)) published_.store(now);
}

}  // namespace robot_control
