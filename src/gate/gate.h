#pragma once
/// The last check before the motors. It checks in this order, and brakes at the first check that fails:
///   1. the permit is whole (checksum) and has not expired: the monitor is running
///   2. the permit allows motion
///   3. the command is whole and of a recent cycle: the controller is running
///   4. the command fits the robot, and all its numbers are finite
/// Then it clamps the command. Up to 3 missed commands the last one is held; after that the gate brakes, which is
/// counted and not latched.
///
/// Conditions in tick k. `cycle`, `expiry` … are fields of the frame; frames of another run than the driver's count as
/// missing. Permits and commands are valid for 4 cycles (kPermitLife in permit.h, kCommandLife in command_frame.h).
///   permit   cycle < k  ∧  k ≤ min(expiry, cycle + kPermitLife), and no newer permit was found in an earlier tick: a
///            revoked permit does not become valid again
///   action   kDrive; or kRamp while k ≤ ramp_until, and for at most GateParameters::longest_ramp cycles in a row
///   command  k − kCommandLife ≤ cycle ≤ k − 1; one of cycle k − 1 is on time, an older one is *held*
///   numbers  every field of every joint is finite, every mode is a JointMode, joint_count is that of the robot, which
///            has the stop profile. The position sample of a joint that is to move and has a speed limit or end stops
///            is finite, too
///   clamps   joint_clamp.h, in this order: |effort| ≤ limit; gains ≥ 0; |Δeffort| ≤ effort_rate·Δt; kDriveVelocity:
///            |Δvelocity| ≤ acceleration·Δt; speed limit; end stops
///
/// The torque of a brake is the driver's and may be large. When a brake ends, its torque is removed at once. The first
/// effort command after it may therefore lie between the torque measured last and zero, ± effort_rate·Δt. The first
/// kDriveVelocity command may lie between the measured speed and zero, ± acceleration·Δt.
///
/// Tick 0 brakes. A brake orders the stop action of every joint (stop_action.h). They are those of the profile that the
/// last command which moved a joint named, or of the first profile. A command that itself requests the brake on every
/// joint is applied as JointCommand{}, whatever their stop actions are. But a move that the gate has begun goes on: it
/// is completed after a short stop, too. GateReport counts: `refused` frames (checksum, future cycle, joint count,
/// finiteness, mode, profile), `missed` ticks in which the permit was good and the command missing.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bus/latest_frames.h"
#include "gate/gate_parameters.h"
#include "gate/joint_speed.h"
#include "signals/command_frame.h"
#include "signals/fixed_vector.h"
#include "signals/gate_report.h"
#include "signals/joint.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"

namespace robot_control {

struct GateInput {
  std::uint64_t run = 0;
  std::uint64_t cycle = 0;  ///< k
  Lookup permit_found = Lookup::kMissing;
  const Permit* permit = nullptr;  ///< never null; meaningful when found
  Lookup command_found = Lookup::kMissing;
  const CommandFrame* command = nullptr;  ///< never null; meaningful when found
  const SensorFrame* sensors = nullptr;   ///< never null; of this tick
};

class Gate {
 public:
  static constexpr std::size_t kMaxProfiles = 4;

  /// One entry per joint; `period` > 0, s. Throws std::invalid_argument for more than kMaxJoints joints, and for a
  /// limit, a number of a stop action or a period out of range. A profile that has not one stop action for each joint
  /// is refused, too. Throws std::length_error for more than kMaxProfiles profiles.
  Gate(const std::vector<JointLimits>& limits, const GateParameters& parameters, double period);

  /// A new run: counters restart.
  void enter_run() noexcept;

  /// The commands for the driver in tick k, one per joint. `report()` holds the verdict and its reasons.
  std::span<const JointCommand> step(const GateInput& input) noexcept;

  const GateReport& report() const noexcept { return report_; }

 private:
  /// The state of one joint between two ticks.
  struct JointMemory {
    JointSpeed speed;
    JointStop stop = {};
    bool driven = false;   ///< a command moved it in the last tick
    double effort = 0;     ///< the effort that it got then
    bool follows = false;  ///< it was driven with kDriveVelocity
    double velocity = 0;   ///< the velocity that it got then
  };

  void read_samples(const GateInput& input) noexcept;
  /// Returns the cycles since the last tick, 1 at the first one.
  std::uint64_t elapsed_at(std::uint64_t cycle) const noexcept {
    return last_cycle_ && cycle > *last_cycle_ ? cycle - *last_cycle_ : 1;
  }
  /// All checks; false: brake. Else `commands_` is the clamped command and the verdict is set.
  bool check_and_clamp(const GateInput& input) noexcept;
  bool finds_command(const GateInput& input) const noexcept;
  bool permit_is_alive(const GateInput& input) noexcept;
  bool permit_allows_motion(const Permit& permit, std::uint64_t cycle) noexcept;
  bool command_is_fresh(const GateInput& input) noexcept;
  bool command_is_valid(const CommandFrame& command) noexcept;
  bool samples_suffice(const CommandFrame& command) noexcept;
  bool has_position(std::size_t joint) const noexcept {
    return joint < samples_.size() && robot_control::has_position(samples_[joint]);
  }
  void clamp(double elapsed) noexcept;
  void stop(std::uint64_t elapsed, bool by_command) noexcept;
  void remember() noexcept;

  FixedVector<JointLimits, kMaxJoints> limits_;
  std::uint64_t longest_ramp_;
  double period_;
  FixedVector<FixedVector<StopAction, kMaxJoints>, kMaxProfiles> profiles_;
  FixedVector<JointMemory, kMaxJoints> memory_;
  std::span<const JointSample> samples_;     ///< of the last tick; empty: missing
  std::optional<std::uint64_t> last_cycle_;  ///< of the last tick
  std::uint64_t newest_permit_ = 0;          ///< cycle of the newest permit seen in this run
  bool ramping_ = false;                     ///< the last permit that had not expired was a ramp
  std::uint64_t profile_ = 0;                ///< of the last command that moved a joint
  std::uint64_t ramp_began_ = 0;             ///< the tick of its first permit
  std::array<JointCommand, kMaxJoints> commands_{};
  GateReport report_;
};

}  // namespace robot_control
