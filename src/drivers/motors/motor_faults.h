#pragma once
/// Motors with injected faults, each side's wheels together; the effect on a command's torque τ, by kind:
///
///   off           0, the brake too: a drive without power, the wheel runs free
///   stuck         the rotor is blocked where it was when the fault began
///   garbage       uniform within ±limit, new in every cycle, the brake too: a drive out of control
///   wrong         −τ: a motor wired the wrong way round. The brake brakes: shorted windings know no polarity
///   slow          the drive takes a command every 10 cycles, the brake too
///   delayed       the command of 10 cycles ago, the brake too
///   intermittent  as off, and healthy, at random
///
/// When and how long, see faults/faulty_output.h. Friction, damping and inertia of the joint stay as they are.
///
/// A blocked rotor is a stiff spring and damper between wheel and body, q* the angle at the beginning:
///
///   τ = k·(q* − q) − d·q̇      k = J/(4 h²)      d = J/(2 h)
///
/// with the wheel's inertia J and the simulation's step h: a = d h/J = 1/2 and b = k h²/J = 1/4 in the stability
/// polynomial of joint_law.h, 2a + b = 1.25 of 4. For J = 0.005 kg·m² and h = 1 ms a torque of 5 N·m turns it by
/// 4 mrad.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "faults/faulty_output.h"
#include "robot/robot_model.h"
#include "signals/joint.h"

namespace robot_control {

class MotorFaults {
 public:
  /// `step`: h, s, of the simulation.
  MotorFaults(const RobotModel& robot, std::uint64_t seed, double step);

  /// Without faults, as at the start.
  void reset() noexcept;

  /// Once per cycle: the commands as they were sent, one per joint; back come those that the drives follow. The result
  /// is valid until the next call. Real-time safe.
  std::span<const JointCommand> receive(const InjectedFaults& faults, std::uint64_t cycle,
                                        std::span<const JointCommand> commands) noexcept;

  /// In every step of the simulation: what the motor of this joint gives instead of `effort`, the drive's law for the
  /// received command at this position and velocity.
  double effort(std::size_t joint, JointMode mode, double effort, double position, double velocity) noexcept;

 private:
  using WheelCommands = std::array<JointCommand, kMaxWheels>;

  /// Of one side.
  struct Motors {
    std::vector<std::size_t> joints;
    FaultyOutput<WheelCommands> output;
    FaultKind kind = FaultKind::kOk;
  };
  /// What a joint's motor does in this cycle.
  enum class State : std::uint8_t { kHealthy, kDead, kBlocked, kRandom, kReversed };
  struct Drive {
    State state = State::kHealthy;
    double random_effort = 0;  ///< N·m, kRandom
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
