#pragma once
/// The last check before the motors. It checks in this order, and brakes at the first check that fails:
///   1. the permit has not expired (safety_monitor is running)
///   2. the permit allows motion
///   3. the command is of a recent cycle (diff_drive_controller is running)
///   4. all numbers are finite and all checksums are right
/// Then it clamps the command. Up to 3 missed commands the last one is held; after that the gate brakes, which is
/// counted and not latched.
///
/// At tick k (all of the driver's present run, else the frame counts as missing):
///   permit   cycle < k  ∧  k ≤ min(expiry, cycle + kPermitLife)  ∧  cycle not before that of an earlier tick's permit,
///            so a revoked permit does not come back
///   action   kDrive, or kRamp while k ≤ ramp_until and for at most longest_ramp cycles in a row, whatever its
///            ramp_until says
///   command  k − kCommandLife ≤ cycle ≤ k − 1; older than k − 1 is *held*
///   numbers  every field of every joint finite, every mode a JointMode, joint_count that of the robot; the samples of
///            the joints that are to move finite, if a clamp needs them
///   clamps   joint_clamp.h, in this order:
///            |effort| ≤ limit · |Δeffort| ≤ effort_rate·Δt · speed limit · end stops
/// When a brake ends, the driver's brake torque ends at once. The first effort after it may therefore lie anywhere
/// between the torque of the brake and zero, plus one step of effort_rate·Δt.
///
/// Tick 0 brakes. A brake is JointCommand{} on every joint; under FailAction::kCoast kEffort 0 on wheels, unless the
/// command itself requests the brake on every joint. `refused` counts frames that arrived and failed a check; `missed`
/// counts ticks in which only the command was missing.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/gate_parameters.h"
#include "hal/joint_speed.h"
#include "rt/latest_frames.h"
#include "signals/command_frame.h"
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
  /// One entry per joint; `period` > 0, s. Throws std::invalid_argument: limits that are none, more than kMaxJoints.
  Gate(std::vector<JointLimits> limits, const GateParameters& parameters, double period);

  /// A new run: counters restart.
  void reset() noexcept;

  /// The commands for the driver in tick k, one per joint. `report()` holds the verdict and its reasons.
  std::span<const JointCommand> step(const GateInput& input) noexcept;

  const GateReport& report() const noexcept { return report_; }

 private:
  /// Of one joint, from tick to tick.
  struct JointMemory {
    JointSpeed speed;
    bool driven = false;  ///< in the last tick, by a command
    double effort = 0;    ///< that it then got
  };

  void observe(const GateInput& input) noexcept;
  bool permitted(const GateInput& input) noexcept;
  bool allowed(const Permit& permit, std::uint64_t cycle) noexcept;
  bool fresh(const GateInput& input) noexcept;
  bool sound(const CommandFrame& command) noexcept;
  bool sensed(const CommandFrame& command) noexcept;
  bool usable(std::size_t joint) const noexcept;
  bool passes(const GateInput& input) noexcept;
  void clamp(double elapsed) noexcept;
  void brake(FailAction wheels) noexcept;
  void remember() noexcept;

  std::vector<JointLimits> limits_;
  GateParameters parameters_;
  double period_;
  std::vector<JointMemory> memory_;
  std::span<const JointSample> samples_;     ///< of this tick; empty: missing
  std::optional<std::uint64_t> last_cycle_;  ///< of the last tick
  std::uint64_t newest_permit_ = 0;          ///< cycle of the newest permit seen in this run
  bool ramping_ = false;                     ///< the last living permit was a ramp
  std::uint64_t ramp_began_ = 0;             ///< in this tick
  std::array<JointCommand, kMaxJoints> commands_{};
  GateReport report_;
};

}  // namespace robot_control
