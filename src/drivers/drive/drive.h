#pragma once
/// A Drive is the state machine of one motor drive on CAN. Each dialect derives from it.
/// Frames that were received, the time and the command go in; frames to send, a status and a sample come out. Nothing
/// reads a clock. After construction nothing allocates or throws, except `words`.
///
/// In each cycle a drive is sent its order, whatever it answers: no order to brake waits behind an answer. A drive that
/// had torque when its fault came brakes with what it has of its own, without the driver's measurements. Any other one
/// gets no torque.
///
/// In `starting` a drive may be absent for any time. In `ready` the motor has no torque. A position that jumps before
/// `running` is that of another zero, and the joint's continues; that of an absolute drive is a fault. A fault is left
/// by the operator's reset alone, with which the start-up begins again. One reset is one attempt: the drive is asked at
/// most kMaxClears times to clear its errors. A fault that remains waits for the next reset. Position, velocity and
/// torque belong to the joint: motor angle = direction · gear · joint angle, motor torque = direction · joint torque /
/// gear.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/drive/drive_status.h"
#include "drivers/drive/late_position.h"
#include "drivers/drive_parameters.h"
#include "drivers/line/can_frame.h"
#include "drivers/line/can_load.h"
#include "drivers/position_difference.h"
#include "signals/joint.h"

namespace robot_control {

struct DriveCommand {
  bool enabled = false;  ///< The motor shall have torque.
  bool reset = false;    ///< The operator resets; its rising edge counts.
  double torque = 0;     ///< N·m or N, of the joint; applied in `running` alone; a drive that takes speeds may add it
  double speed = 0;      ///< rad/s or m/s, of the joint, for a drive that takes speeds; the same
  double brake_torque = 0, brake_damping = 0;  ///< N·m, N·m·s/rad, of the joint, of a drive that brakes by itself

  /// The impedance of a drive that closes it (max_stiffness). It adds τ = stiffness · (position − q) + damping ·
  /// (speed − q̇) to `torque`. Units are N·m/rad, rad, N·m·s/rad and rad/s, of the joint.
  double stiffness = 0, position = 0, damping = 0;
};

struct DriveSample {
  JointSample joint{};
  bool valid = false;         ///< position and velocity
  bool effort_valid = false;  ///< The last measurement of the torque is not older than 5 · max_silence.
  std::int64_t stamp_ns = 0;  ///< when the position was received
  double voltage = 0;         ///< V, of the drive's supply; 0: unknown
};

/// Returns the sample at another time: the position moves on with the velocity.
JointSample at_time(const DriveSample& sample, std::int64_t now_ns) noexcept;

/// The frames of one cycle. Frames beyond its size are counted and dropped.
class FrameBatch {
 public:
  void add(const can_frame& frame) noexcept;
  void clear() noexcept { count_ = 0; }
  std::span<const can_frame> frames() const noexcept { return {frames_.data(), count_}; }
  std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  std::array<can_frame, 512> frames_{};
  std::size_t count_ = 0;
  std::uint64_t dropped_ = 0;
};

/// Some drives measure the torque more rarely than in each cycle (`effort_is_rare`). The effort of their samples is the
/// torque that was ordered in the last cycle. This holds while the last measurement lay among the orders of kOrders
/// cycles, with a tolerance of kEffortTolerance times the limit. Otherwise the effort is that measurement.
class Drive : public DriveStateMachine {
 public:
  static constexpr std::size_t kOrders = 8;
  static constexpr double kEffortTolerance = 0.1;
  static constexpr unsigned kMaxClears = 3;  ///< requests; all are lost once in 10⁴ at a loss of 5 %

  /// `period` is that of the loop in s.
  Drive(DriveParameters parameters, double period);
  virtual ~Drive() = default;
  Drive(const Drive&) = delete;
  Drive& operator=(const Drive&) = delete;

  /// Takes a frame that was received from any party of the bus; `now_ns` is the time of its reception.
  virtual void receive(const can_frame& frame, std::int64_t now_ns) noexcept = 0;

  /// Fails if the last sample of a motor in `running` is older than max_silence. `step` begins with the same.
  void judge_silence(std::int64_t now_ns) noexcept;

  /// Runs one cycle after all frames were received, and adds the frames to send.
  void step(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept;

  /// Returns the status with its details.
  DriveStatus full_status() const noexcept;
  const DriveSample& sample() const noexcept { return sample_; }
  const DriveParameters& drive_parameters() const noexcept { return drive_; }

  /// Known from `ready` on.
  const KnownReaction& on_silence() const noexcept { return on_silence_; }

  /// Returns a full status in words; any thread may call it.
  std::string words(const DriveStatus& status) const;
  std::string words() const { return words(full_status()); }

  /// Returns the frames that are on the bus in `running`, with those of the drive, to compute the load.
  virtual std::vector<PlannedFrames> plan() const = 0;

 protected:
  /// Forgets what was learned of the drive. `reset`: the operator asks to clear its errors.
  virtual void restart(bool reset, std::int64_t now_ns) noexcept = 0;
  /// Runs one cycle. Torque and speed are finite and within their limits.
  virtual void advance(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept = 0;
  virtual void add_details(DriveStatus& status) const noexcept = 0;
  virtual VelocitySource velocity_source() const noexcept { return VelocitySource::kDrive; }
  /// Uses nothing but the status and the parameters.
  virtual std::string code_words(const DriveStatus& status) const = 0;

  /// Begins again, as after a reset of the operator if `reset` is true.
  void begin(bool reset, std::int64_t now_ns) noexcept;
  /// Counts a request to clear errors. Returns false if none is left since the operator's reset.
  bool may_clear() noexcept { return clears_ < kMaxClears && ++clears_ > 0; }
  /// Motor position in rad, velocity in rad/s. A late frame is moved on (late_position.h). A drive that closes an
  /// impedance takes it as it arrives, also of a wheel. A joint of a leg changes its speed within the lateness.
  void accept_position(double position, double velocity, std::int64_t now_ns) noexcept;
  /// The same of a drive that sends no velocity. It follows from the positions, so late frames move the joint.
  void accept_position(double position, std::int64_t now_ns) noexcept;
  /// A velocity that comes after the position of its cycle, rad/s.
  void accept_velocity(double velocity) noexcept;
  void accept_motor_torque(double torque, std::int64_t now_ns) noexcept;
  void accept_temperature(double celsius) noexcept;
  void accept_voltage(double voltage) noexcept;
  double motor_torque(double joint_torque) const noexcept { return to_joint_ * joint_torque; }
  double motor_speed(double joint_speed) const noexcept { return joint_speed / to_joint_; }
  double motor_position(double joint_position) const noexcept { return (joint_position - zero_) / to_joint_; }
  double motor_gain(double joint_gain) const noexcept { return joint_gain * to_joint_ * to_joint_; }
  std::int64_t sample_period_ns() const noexcept;
  std::int64_t max_silence_ns() const noexcept {
    return static_cast<std::int64_t>(drive_.max_silence) * sample_period_ns();
  }

  void know_reaction(SilenceReaction reaction, ReactionEvidence evidence) noexcept {
    on_silence_ = {reaction, evidence};
  }
  /// Takes the user's word where nothing was read. Fails if nothing is known and that is not accepted.
  void settle_reaction() noexcept;

  const std::int64_t period_ns_;

 private:
  bool accept_motion(double position, double velocity, std::int64_t now_ns) noexcept;  ///< Returns whether it is valid.
  bool is_possible(double velocity) noexcept;                                          ///< Fails if it is not.
  void note_order(double torque) noexcept;

  DriveParameters drive_;
  double to_joint_;  // joint angle = to_joint_ · motor angle, motor torque = to_joint_ · joint torque
  DriveSample sample_;
  double zero_ = 0;                // of the joint, where the drive reports 0
  LatePosition position_;          // of the joint
  PositionDifference difference_;  // of the motor
  KnownReaction on_silence_;
  std::int64_t effort_ns_ = 0;
  std::array<double, kOrders> ordered_{};  // N·m, of the joint, in the last cycles; the newest one first
  bool follows_ = false;                   // the last measurement was among them
  bool reset_before_ = false;
  unsigned clears_ = 0;  // requests since the operator's reset
};

}  // namespace robot_control
