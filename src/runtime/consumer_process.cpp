#include "runtime/consumer_process.h"

#include "rt/clock.h"
#include "runtime/start_check.h"

namespace robot_control {
namespace {

constexpr std::int64_t kStopCheck = 100'000'000;  // ns; longest wait before `stopping` is looked at

CommandScript load_script(const LoopParameters& loop) {
  return loop.command_script.empty() ? CommandScript() : CommandScript(loop.command_script);
}

Now clock_of(const LoopParameters& loop) {
  return loop.clock == ClockMode::kLockstep ? nullptr : &monotonic_ns;
}

/// Has the living driver announced this robot? Throws BusError when it runs another one.
bool robot_agrees(const Input<SensorFrame>& sensors, const RobotModel& robot) {
  if (sensors.reader.memory() == nullptr || !sensors.channel.locked()) return false;
  return same_robot(sensors.reader.memory()->head, robot.hash, robot.source);
}

/// Tells the driver that this node waits on the sensors of its current run.
template <class Frame>
void attach(const FrameReader<SensorFrame>& sensors, FrameWriter<Frame>& own) noexcept {
  const auto* memory = sensors.memory();
  if (memory != nullptr) attach_to_run(own.memory()->head, attached_run(memory->head));
}

/// The loop of every consumer: the frame that is there first, then one step per wake.
template <class Cycle, class Frame, class Sink, class Attach, class Silence>
void consume(Cycle& cycle, const FrameReader<Frame>& wake, std::int64_t wait_ns, Sink& trace,
             const std::atomic<bool>& stopping, Attach attach_now, Silence silence) noexcept {
  while (!stopping.load(std::memory_order_relaxed)) {
    const std::uint32_t seen = wake.sequence();
    attach_now();
    if (cycle.step()) trace.append(cycle.trace(), stopping);
    if (!wake.wait(seen, wait_ns)) silence();
  }
}

constexpr auto kKeepWaiting = []() noexcept {};

}  // namespace

EstimatorProcess::EstimatorProcess(const Parameters& parameters, const RobotModel& robot, const std::string& bus)
    : Process(parameters.loop, LoopPriority::kEstimator, "state_estimator"),
      robot_(robot),
      state_(bus, ChannelNames::kState),
      sensors_(bus, ChannelNames::kSensors),
      trace_(bus, TraceRing::kEstimator, lockstep()),
      cycle_(parameters.estimator, robot, parameters.loop.period(), sensors_.reader, state_.writer,
             clock_of(parameters.loop)) {}

std::vector<std::string> EstimatorProcess::missing() const {
  if (!sensors_.channel.locked()) return {"mujoco_plant"};
  return {};
}

void EstimatorProcess::poll_channels() {
  sensors_.poll();
  trace_.poll();
  robot_agrees_ = robot_agrees(sensors_, robot_);
}

bool EstimatorProcess::ready() {
  return robot_agrees_ && (!loop_parameters().wait_for_telemetry || trace_.reader_present());
}

void EstimatorProcess::loop() noexcept {
  consume(
      cycle_, sensors_.reader, kStopCheck, trace_, stopping(), [this] { attach(sensors_.reader, state_.writer); },
      kKeepWaiting);
}

ControllerProcess::ControllerProcess(const Parameters& parameters, const RobotModel& robot, const std::string& bus)
    : Process(parameters.loop, LoopPriority::kController, "drive_control"),
      robot_(robot),
      command_(bus, ChannelNames::kCommand),
      sensors_(bus, ChannelNames::kSensors),
      state_(bus, ChannelNames::kState),
      permit_(bus, ChannelNames::kPermit),
      trace_(bus, TraceRing::kController, lockstep()),
      cycle_(parameters.controller, robot, parameters.loop.period(),
             {&sensors_.reader, &state_.reader, &permit_.reader, command_.writer}, load_script(parameters.loop),
             clock_of(parameters.loop)) {
  require_drivable(parameters, robot);
}

std::vector<std::string> ControllerProcess::missing() const {
  std::vector<std::string> names;
  if (!sensors_.channel.locked()) names.emplace_back("mujoco_plant");
  if (!state_.channel.locked()) names.emplace_back("state_estimator");
  if (!permit_.channel.locked()) names.emplace_back("safety_monitor");
  return names;
}

void ControllerProcess::poll_channels() {
  sensors_.poll();
  state_.poll();
  permit_.poll();
  trace_.poll();
  robot_agrees_ = robot_agrees(sensors_, robot_);
}

bool ControllerProcess::ready() {
  return robot_agrees_ && state_.reader.memory() != nullptr && permit_.reader.memory() != nullptr &&
         (!loop_parameters().wait_for_telemetry || trace_.reader_present());
}

void ControllerProcess::loop() noexcept {
  consume(
      cycle_, state_.reader, kStopCheck, trace_, stopping(), [this] { attach(sensors_.reader, command_.writer); },
      kKeepWaiting);
}

MonitorProcess::MonitorProcess(const Parameters& parameters, const RobotModel& robot, const std::string& bus)
    : Process(parameters.loop, LoopPriority::kMonitor, "safety_monitor"),
      robot_(robot),
      permit_(bus, ChannelNames::kPermit),
      sensors_(bus, ChannelNames::kSensors),
      state_(bus, ChannelNames::kState),
      command_(bus, ChannelNames::kCommand),
      trace_(bus, TraceRing::kMonitor, lockstep()),
      cycle_(parameters.safety, robot, parameters.loop.period(),
             {&sensors_.reader, &state_.reader, &command_.reader, permit_.writer}, load_script(parameters.loop),
             clock_of(parameters.loop)) {}

std::vector<std::string> MonitorProcess::missing() const {
  std::vector<std::string> names;
  if (!sensors_.channel.locked()) names.emplace_back("mujoco_plant");
  if (!state_.channel.locked()) names.emplace_back("state_estimator");
  if (!command_.channel.locked()) names.emplace_back("diff_drive_controller");
  return names;
}

void MonitorProcess::poll_channels() {
  sensors_.poll();
  state_.poll();
  command_.poll();
  trace_.poll();
  robot_agrees_ = robot_agrees(sensors_, robot_);
}

bool MonitorProcess::ready() {
  const bool all = state_.reader.memory() != nullptr && command_.reader.memory() != nullptr;
  return robot_agrees_ && (all || !loop_parameters().wait_for_nodes) &&
         (!loop_parameters().wait_for_telemetry || trace_.reader_present());
}

void MonitorProcess::loop() noexcept {
  const auto attach_now = [this] { attach(sensors_.reader, permit_.writer); };
  const std::int64_t wait_ns = lockstep() ? kStopCheck : kDriverLossPeriods * loop_parameters().period_ns();
  if (lockstep()) {
    consume(cycle_, sensors_.reader, wait_ns, trace_, stopping(), attach_now, kKeepWaiting);
  } else {
    consume(cycle_, sensors_.reader, wait_ns, trace_, stopping(), attach_now, [this] { cycle_.silence(); });
  }
}

}  // namespace robot_control
