#pragma once
/// MotorFaults injects faults into the motors of joints. Each kind has this effect on a command's torque τ:
///
///   off           0, also for the brake: a drive without power, the joint moves freely
///   stuck         the rotor is blocked at its angle when the fault began
///   garbage       uniform within ±limit, new in every cycle, also for the brake: a drive out of control
///   wrong         −τ: a motor with reversed wires. The brake works: shorted windings have no polarity
///   slow          the drive takes a command every 10 cycles, also that of the brake
///   delayed       the command of 10 cycles ago, also that of the brake
///   intermittent  as off, and healthy, at random
///
/// simulation/faults/faulty_output.h defines when a fault acts. Friction, damping and inertia of the joint do not
/// change.
///
/// A blocked rotor is a stiff spring and damper between the joint's two bodies, where q* is the angle at the beginning:
///
///   τ = k·(q* − q) − d·q̇      k = J/(4 h²)      d = J/(2 h)
///
/// J is the joint's inertia (brake_limits.h) and h the simulation's step. In the stability condition of brake_law.h a =
/// d h/J is 1/2 and b = k h²/J is 1/4, so 2a + b = 1.25 of 4. For J = 0.005 kg·m² and h = 1 ms a torque of 5 N·m turns
/// the joint by 4 mrad.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "signals/joint.h"
#include "simulation/faults/faulty_output.h"

namespace robot_control {

class MotorFaults {
 public:
  /// Adds the motor of a joint: its inertia J in kg·m² (or kg), its effort limit in N·m (or N). `step` is the
  /// simulation's time step h in s.
  void add(std::size_t joint, double inertia, double effort_limit, std::uint64_t seed, double step);

  /// Removes all faults.
  void reset() noexcept;

  /// Returns the commands that the drives follow instead of `commands`, one per joint; is called once per cycle. The
  /// result is valid until the next call. The function is real-time safe.
  std::span<const JointCommand> receive(const InjectedFaults& faults, std::uint64_t cycle,
                                        std::span<const JointCommand> commands) noexcept;

  /// Returns the torque of a motor, by the order of `add`, instead of `effort`, which the drive's law computed at this
  /// position and velocity. It is called in every step of the simulation.
  double effort(std::size_t index, JointMode mode, double effort, double position, double velocity) noexcept;

 private:
  /// The state of a motor in this cycle.
  enum class State : std::uint8_t { kHealthy, kDead, kBlocked, kRandom, kReversed };
  struct Motor {
    std::size_t joint = 0;
    double limit = 0;  ///< N·m
    double stiffness = 0, damping = 0;
    FaultyOutput<JointCommand> output;
    State state = State::kHealthy;
    double random_effort = 0;  ///< N·m, for kRandom
    bool anchored = false;
    double anchor = 0;  ///< rad, q*
  };

  void step(Motor& motor, FaultKind kind, std::uint64_t cycle) noexcept;

  std::vector<Motor> motors_;
  bool failing_ = false;  ///< any component failed in the last cycle
  std::array<JointCommand, kMaxJoints> received_{};
};

}  // namespace robot_control
