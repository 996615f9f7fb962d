#pragma once
/// The laws with other parameters, on the inputs of the log. This is open loop: the robot of the log does not move
/// differently for it.
///
/// The controller takes its limits and gains over where the log begins, as from ~set_parameters. The estimator and the
/// monitor begin at the first beginning of a run in the log.

#include <cstdint>
#include <memory>

#include "robots/robot.h"
#include "signals/law_calls.h"

namespace robot_control {

/// The output of one law in one cycle, beside that with other parameters. Those of other laws are null.
struct VariedRow {
  std::int64_t run = 0;  ///< JoinedRow::run
  std::uint64_t cycle = 0;
  const StateFrame* state = nullptr;
  const StateFrame* varied_state = nullptr;
  const CommandFrame* command = nullptr;
  const CommandFrame* varied_command = nullptr;
  const Permit* permit = nullptr;
  const Permit* varied_permit = nullptr;
};

class Variant {
 public:
  /// `robot` is that of the log, composed with the other parameters.
  explicit Variant(const Robot& robot);

  /// The output of one cycle. Null: the law has not begun.
  const StateFrame* step(const EstimatorCalls& calls, const SensorFrame& sensors) noexcept;

  /// `law` has the state of the log before this step.
  const CommandFrame* step(const ControllerCalls& calls, const ControlInput& input, const ControllerLaw& law) noexcept;

  const Permit* step(const MonitorCalls& calls, const MonitorInput& input) noexcept;

 private:
  std::unique_ptr<EstimatorLaw> estimator_;
  std::unique_ptr<ControllerLaw> controller_;
  std::unique_ptr<MonitorLaw> monitor_;
  LiveTuning tuning_;
  LawSnapshot snapshot_;
  bool controls_ = false;
  bool estimates_ = false;
  std::uint64_t process_ = 0;  ///< whose estimates they are
  bool monitors_ = false;
  StateFrame state_;
  CommandFrame command_;
  Permit permit_;
};

}  // namespace robot_control
