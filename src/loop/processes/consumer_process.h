#pragma once
/// The common part of the three nodes that a frame wakes: estimator, controller and monitor.
///
/// Such a node writes one channel (`output`), always reads the sensors, and is woken by the sensors or by another
/// input. It starts once a living driver has announced the robot that it was itself started with.

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "loop/cycles/cycle_clock.h"
#include "loop/cycles/trace_sink.h"
#include "loop/processes/process.h"
#include "robots/robot.h"
#include "signals/roles.h"

namespace robot_control {

/// The names of a consumer: thread, channel and ring.
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

  /// Any thread: returns whether this frame is of the present run of a living driver, instead of an earlier one.
  bool is_current(const FrameHead& head) const noexcept {
    return robot_agrees_.load() && current(sensors_.reader, head, robot_.hash);
  }

  /// The channel that this node publishes.
  const FrameReader<Frame>& output() const noexcept { return output_.reader; }

  /// The driver, and before cycle 0 the telemetry that was asked for. Later the loop goes on without one.
  std::vector<std::string> missing() const override {
    std::vector<std::string> names;
    if (!sensors_.channel.locked()) names.emplace_back(program_of(Role::kDriver, programs_));
    if (waits_for_telemetry()) names.emplace_back(program_of(Role::kTelemetry));
    return names;
  }

 protected:
  /// Longest wait before the end of the loop is noticed, ns.
  static constexpr std::int64_t kStopCheck = 100'000'000;

  ConsumerProcess(const Parameters& parameters, const Robot& robot, const std::string& bus, const ConsumerNames& names)
      : Process(parameters, robot, names.priority, names.thread),
        output_(bus, names.channel),
        sensors_(bus, ChannelNames::kSensors),
        trace_(bus, names.ring, lockstep()) {}

  void poll_channels() override {
    sensors_.poll();
    trace_.poll();
    robot_agrees_ = sensors_.reader.memory() != nullptr && sensors_.channel.locked() && same_robot_as_driver();
  }

  void announce_thread(int id) override { trace_.announce_thread(id); }
  bool ready() override { return robot_agrees_ && !waits_for_telemetry(); }

  /// The loop: the frame that is there first, then one step per wake-up. `silence` is called when nothing woke it for
  /// `wait_ns`; like a step, it returns whether there is a row. A driver that starts, or an object that is mapped
  /// again, wakes the loop and restarts the wait. So silence alone does not show whether the driver was interrupted.
  template <class Cycle, class Waking, class Silence>
  void consume(Cycle& cycle, const FrameReader<Waking>& wake, std::int64_t wait_ns, Silence silence) noexcept {
    const auto append = [&] { trace_.append(cycle.trace(), cycle.snapshot(), stopping()); };
    while (!stopping().load(std::memory_order_relaxed)) {
      const std::uint32_t seen = wake.sequence();
      attach();
      if (cycle.step()) append();
      if (!wake.wait(seen, wait_ns) && silence()) append();
    }
  }

  Output<Frame> output_;
  Input<SensorFrame> sensors_;

 private:
  bool waits_for_telemetry() const {
    if (!loop_parameters().wait_for_telemetry || trace_.reader_present()) return false;
    SensorFrame first;
    return sensors_.reader.newest(first) != Lookup::kFrame || !current(sensors_.reader, first.head, robot_.hash);
  }

  /// Throws BusError at the second poll that finds the same other robot. The first one may find the robot of an earlier
  /// driver, which the one that has just locked the channel clears right afterwards.
  bool same_robot_as_driver() {
    const ChannelHead& head = sensors_.reader.memory()->head;
    const std::uint64_t announced = announced_robot(head).hash;
    if (announced != robot_.hash && std::exchange(announced_, announced) != announced) return false;
    return same_robot(head, robot_.hash, robot_.source);
  }

  /// Publishes for the driver that this node waits on the sensors of its current run.
  void attach() noexcept {
    const auto* memory = sensors_.reader.memory();
    if (memory != nullptr) attach_to_run(output_.writer.memory()->head, attached_run(memory->head));
  }

  TraceSink<Row> trace_;
  std::uint64_t announced_ = 0;            ///< hash of another robot that the last poll found
  std::atomic<bool> robot_agrees_{false};  ///< the driver lives, on this robot
};

}  // namespace robot_control
