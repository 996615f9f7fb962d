#pragma once
/// What the three nodes have in common that a frame wakes: state_estimator, diff_drive_controller,
/// safety_monitor.
///
/// Such a node writes one channel (`output`), always reads the sensors, and is woken by the sensors or by another
/// input. It starts once a living driver has announced the robot that it was itself started with.

#include <cstdint>
#include <string>

#include "runtime/command_script.h"
#include "runtime/cycle_clock.h"
#include "runtime/process.h"
#include "runtime/trace_sink.h"

namespace robot_control {

/// The script of the parameters; an empty one where none is named. Throws ParameterError.
CommandScript load_script(const LoopParameters& loop);

/// What the cycles stamp their trace with: nothing in lockstep, where time stands still.
Now clock_of(const LoopParameters& loop);

/// What a consumer is called in its thread, its channel and its ring.
struct ConsumerNames {
  LoopPriority priority;
  const char* thread;
  const char* channel;
  TraceRing ring;
};

template <class Frame, class Row>
class ConsumerProcess : public Process {
 public:
  const FrameReader<SensorFrame>& sensors() const noexcept { return sensors_.reader; }

  /// What this node published.
  const FrameReader<Frame>& output() const noexcept { return output_.reader; }

 protected:
  /// Longest wait before the end of the loop is noticed, ns.
  static constexpr std::int64_t kStopCheck = 100'000'000;

  ConsumerProcess(const Parameters& parameters, const RobotModel& robot, const std::string& bus,
                  const ConsumerNames& names)
      : Process(parameters.loop, names.priority, names.thread),
        output_(bus, names.channel),
        sensors_(bus, ChannelNames::kSensors),
        trace_(bus, names.ring, lockstep()),
        robot_(robot) {}

  bool driver_lives() const { return sensors_.channel.locked(); }

  void poll_channels() override {
    sensors_.poll();
    trace_.poll();
    robot_agrees_ = sensors_.reader.memory() != nullptr && driver_lives() &&
                    same_robot(sensors_.reader.memory()->head, robot_.hash, robot_.source);
  }

  bool ready() override { return robot_agrees_ && (!loop_parameters().wait_for_telemetry || trace_.reader_present()); }

  /// The loop: the frame that is there first, then one step per wake. `silence` is called when no frame came
  /// within `wait_ns`.
  template <class Cycle, class Waking, class Silence>
  void consume(Cycle& cycle, const FrameReader<Waking>& wake, std::int64_t wait_ns, Silence silence) noexcept {
    while (!stopping().load(std::memory_order_relaxed)) {
      const std::uint32_t seen = wake.sequence();
      attach();
      if (cycle.step()) trace_.append(cycle.trace(), stopping());
      if (!wake.wait(seen, wait_ns)) silence();
    }
  }

  Output<Frame> output_;
  Input<SensorFrame> sensors_;

 private:
  /// Tells the driver that this node waits on the sensors of its current run.
  void attach() noexcept {
    const auto* memory = sensors_.reader.memory();
    if (memory != nullptr) attach_to_run(output_.writer.memory()->head, attached_run(memory->head));
  }

  TraceSink<Row> trace_;
  RobotModel robot_;
  bool robot_agrees_ = false;
};

}  // namespace robot_control
