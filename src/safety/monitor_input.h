#pragma once
/// All inputs of one step of the monitor.

#include <cstdint>

#include "signals/command_frame.h"
#include "signals/law_calls.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"
#include "signals/velocity_command.h"

namespace robot_control {

/// The latch of an earlier monitor.
struct InheritedLatch {
  const Permit* permit = nullptr;  ///< the last permit in the channel; null: the channel holds none
  std::uint64_t causes = 0;        ///< StopCause bits of another record of that stop, for instance latch_file
  std::uint64_t first_cause = 0;   ///< one bit of `causes`; 0: unknown
};

/// Every pointer is valid during the step. The default is a step without a sensor frame in which nothing happened.
struct MonitorInput {
  const SensorFrame* sensors = nullptr;  ///< of a cycle that no earlier step received; null: no such frame arrived
  SensorSilence silence = SensorSilence::kNone;  ///< why `sensors` is null

  // The inputs of cycle k-1; they are used together with `sensors` of cycle k.
  const CommandFrame* command = nullptr;  ///< null: missing
  const StateFrame* state = nullptr;      ///< null: missing

  /// Wrong checksums. With `sensors`: 1 if an input was corrupt since the last frame. Without: the number of attempts
  /// in a row that read a corrupt sensor frame, at most FrameConditions::kPersistence.
  std::uint64_t corrupt = 0;

  OperatorInput operator_input{};
  const InheritedLatch* inherited = nullptr;  ///< given to the first step of a monitor; null in all others
};

}  // namespace robot_control
