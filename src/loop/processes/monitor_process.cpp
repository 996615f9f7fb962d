#include "loop/processes/monitor_process.h"

#include "loop/mint_number.h"
#include "signals/names.h"
#include "signals/robot_kinds.h"

namespace robot_control {
namespace {

/// Returns the text that an earlier monitor has left; a channel that is taken over announces no robot.
std::string left_source(const ChannelHead& head) {
  std::string text;
  for (const std::atomic<char>& byte : head.robot_source) {
    const char c = byte.load(std::memory_order_acquire);
    if (c == '\0') break;
    text += c;
  }
  return text;
}

/// A stop that is latched in the channel belongs to the robot that it stopped. If that was another one, it ends here.
FrameWriter<Permit> owned_by(const MachineModel& robot, Output<Permit>& output) {
  ChannelHead& head = output.writer.memory()->head;
  const std::string owner = std::to_string(stop_owner(robot));
  const std::string stopped = left_source(head);
  if (!stopped.empty() && stopped != owner) {
    Permit none;
    none.head.run = MonitorCycle::kRunBeforeDriver;
    output.writer.publish(none);
  }
  announce_robot(head, stop_owner(robot), owner);
  return output.writer;
}

}  // namespace

MonitorProcess::MonitorProcess(const Parameters& parameters, const Robot& robot, const std::string& bus)
    : ConsumerProcess(parameters, robot, bus,
                      {LoopPriority::kMonitor, "monitor", ChannelNames::kPermit, TraceRing::kMonitor}),
      state_(bus, ChannelNames::kState),
      command_(bus, ChannelNames::kCommand),
      latch_file_(parameters.latch_file),
      loss_ns_(static_cast<std::int64_t>(parameters.safety.loss_cycles) * parameters.loop.period_ns()),
      cycle_(robot.make_monitor(), robot_.hash, loss_ns_,
             {&sensors_.reader, &state_.reader, &command_.reader, owned_by(robot_, output_)},
             load_script(parameters.loop.command_script), clock(),
             {.causes = latch_file_.found().causes, .first_cause = latch_file_.found().first_cause}),
      inherited_(cycle_.permit()) {
  cycle_.set_process(mint_number());
  if (inherited_.causes == 0) return;
  const std::string& since = latch_file_.found().since;
  restored_ = "latched since " + (since.empty() ? "before this start" : since) + ": " +
              names_of(kStopCauseNames, inherited_.causes, ", ") +
              "; the robot brakes until e_stop_reset is called (rosservice call e_stop_reset)";
}

MonitorProcess::~MonitorProcess() {
  stop();
  with_latched([this](std::uint64_t causes, std::uint64_t first) { latch_file_.finish(causes, first); });
}

/// Calls `keep` with the causes that are latched now, and the first of them.
template <class Keep>
void MonitorProcess::with_latched(Keep keep) const {
  Permit permit;
  const std::uint64_t run = cycle_.published_run();
  if (run == 0) {
    keep(inherited_.causes, inherited_.first_cause);  // the real-time thread has published nothing yet
  } else if (output_.reader.newest(permit) == Lookup::kFrame && permit.head.run == run) {
    keep(permit.causes, permit.first_cause);
  }
}

std::vector<std::string> MonitorProcess::missing() const {
  std::vector<std::string> names = ConsumerProcess::missing();
  if (!state_.channel.locked()) names.emplace_back(program_of(Role::kEstimator));
  if (!command_.channel.locked()) names.emplace_back(program_of(Role::kController, programs_));
  return names;
}

void MonitorProcess::poll_channels() {
  state_.poll();
  command_.poll();
  ConsumerProcess::poll_channels();
  if (!started()) cycle_.idle();
  with_latched([this](std::uint64_t causes, std::uint64_t first) { latch_file_.update(causes, first); });
}

/// With wait_for_nodes, every channel is mapped before the first cycle. Otherwise the monitor reports a missing node.
bool MonitorProcess::ready() {
  const bool all = state_.reader.memory() != nullptr && command_.reader.memory() != nullptr;
  return ConsumerProcess::ready() && (all || !loop_parameters().wait_for_nodes);
}

void MonitorProcess::loop() noexcept {
  if (lockstep()) {
    consume(cycle_, sensors_.reader, kStopCheck, [this] { return cycle_.idle(); });
  } else {
    consume(cycle_, sensors_.reader, loss_ns_, [this] { return cycle_.time_out(); });
  }
}

}  // namespace robot_control
