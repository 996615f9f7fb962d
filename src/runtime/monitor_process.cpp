#include "runtime/monitor_process.h"

#include "runtime/safety_limits.h"

namespace robot_control {

MonitorProcess::MonitorProcess(const Parameters& parameters, const RobotModel& robot, const std::string& bus)
    : ConsumerProcess(parameters, robot, bus,
                      {LoopPriority::kMonitor, "safety_monitor", ChannelNames::kPermit, TraceRing::kMonitor}),
      state_(bus, ChannelNames::kState),
      command_(bus, ChannelNames::kCommand),
      cycle_(safety_limits(parameters, robot_), robot_, parameters.loop.period(),
             {&sensors_.reader, &state_.reader, &command_.reader, output_.writer},
             load_script(parameters.loop.command_script), clock_of(parameters.loop)) {}

std::vector<std::string> MonitorProcess::missing() const {
  std::vector<std::string> names = missing_anywhere();
  if (!state_.channel.locked()) names.emplace_back("state_estimator");
  if (!command_.channel.locked()) names.emplace_back("diff_drive_controller");
  return names;
}

void MonitorProcess::poll_channels() {
  state_.poll();
  command_.poll();
  ConsumerProcess::poll_channels();
}

/// Waiting for nodes, the first cycle must find every channel mapped; otherwise a missing node is a fact that
/// the monitor reports.
bool MonitorProcess::ready() {
  const bool all = state_.reader.memory() != nullptr && command_.reader.memory() != nullptr;
  return ConsumerProcess::ready() && (all || !loop_parameters().wait_for_nodes);
}

void MonitorProcess::loop() noexcept {
  if (lockstep()) {
    consume(cycle_, sensors_.reader, kStopCheck, [this] { cycle_.idle(); });
  } else {
    consume(cycle_, sensors_.reader, kDriverLossPeriods * loop_parameters().period_ns(), [this] { cycle_.silence(); });
  }
}

}  // namespace robot_control
