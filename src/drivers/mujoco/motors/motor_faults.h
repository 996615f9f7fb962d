#pragma once
/// MotorFaults injects faults into the motors of one side's wheels together. Each kind has this effect on a command's
/// torque τ:
///
///   off           0, also for the brake: a drive without power, the wheel runs free
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
/// A blocked rotor is a stiff spring and damper between wheel and body, where q* is the angle at the beginning:
///
///   τ = k·(q* − q) − d·q̇      k = J/(4 h²)      d = J/(2 h)
///
/// J is the wheel's inertia and h the simulation's step. In the stability condition of brake_law.h a = d h/J is 1/2 and
/// b = k h²/J is 1/4, so 2a + b = 1.25 of 4. For J = 0.005 kg·m² and h = 1 ms a torque of 5 N·m turns the wheel by
/// 4 mrad.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "machine/wheeled/drive_train.h"
#include "signals/joint.h"
#include "simulation/faults/faulty_output.h"

namespace robot_control {

class MotorFaults {
 public:
  /// `step` is the simulation's time step h in s.
  MotorFaults(const DriveTrain& robot, std::uint64_t seed, double step);

  /// Removes all faults.
  void reset() noexcept;

  /// Returns the commands that the drives follow instead of `commands`, one per joint; is called once per cycle. The
  /// result is valid until the next call. The function is real-time safe.
  std::span<const JointCommand> receive(const InjectedFaults& faults, std::uint64_t cycle,
                                        std::span<const JointCommand> commands) noexcept;

  /// Returns the torque of this joint's motor instead of `effort`, which the drive's law computed at this position and
  /// velocity. It is called in every step of the simulation.
  double effort(std::size_t joint, JointMode mode, double effort, double position, double velocity) noexcept;

 private:
  using WheelCommands = std::array<JointCommand, kMaxWheels>;

  /// The motors of one side.
  struct Motors {
    std::vector<std::size_t> joints;
    FaultyOutput<WheelCommands> output;
    FaultKind kind = FaultKind::kOk;
  };
  /// The state of a joint's motor in this cycle.
  enum class State : std::uint8_t { kHealthy, kDead, kBlocked, kRandom, kReversed };
  struct Drive {
    State state = State::kHealthy;
    double random_effort = 0;  ///< N·m, for kRandom
    bool anchored = false;
    double anchor = 0;  ///< rad, q*
    double limit = 0;   ///< N·m
    double stiffness = 0, damping = 0;
  };

  void step(Motors& side, FaultKind kind, std::uint64_t cycle) noexcept;

  Motors left_, right_;
  std::array<Drive, kMaxJoints> drives_{};
  std::array<JointCommand, kMaxJoints> received_{};
};

}  // namespace robot_control
