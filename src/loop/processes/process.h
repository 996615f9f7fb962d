#pragma once
/// A node without ROS: its channels and locks, its real-time thread, and what an ordinary thread does for it.
///
/// The constructor takes the locks of the channels that the node writes (BusError when another instance holds
/// them). Then an ordinary thread calls `poll` at 10 Hz. It maps the channels of the others as they appear, and
/// starts the real-time thread as soon as the node can run. It also detects replaced channels, another robot and
/// telemetry. The real-time thread touches nothing but frames, futexes and the clock.

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/latest_frames.h"
#include "configuration/loop_parameters.h"
#include "configuration/parameters.h"
#include "loop/cycles/cycle_clock.h"
#include "machine/machine_model.h"
#include "robots/robot.h"
#include "rt/clock.h"
#include "rt/realtime_thread.h"
#include "signals/robot_kinds.h"

namespace robot_control {

/// SCHED_FIFO, driver > monitor > estimator > controller: above the kernel's interrupt threads (50), below its own
/// watchdogs and migration threads (99).
enum class LoopPriority : int { kDriver = 83, kMonitor = 82, kEstimator = 81, kController = 80 };

class Process {
 public:
  /// Throws RealtimeError when realtime: required cannot be granted: at start-up, before the other nodes run.
  Process(const Parameters& parameters, const Robot& robot, LoopPriority priority, std::string thread_name);
  virtual ~Process() { stop(); }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Ordinary thread, at 10 Hz. Throws BusError: a channel is foreign, the driver runs another robot.
  void poll();

  /// Ends the real-time thread within 0.2 s. Called by every destructor below.
  void stop() noexcept;

  /// True once the loop has ended by itself (a simulator after `cycles`).
  bool finished() const noexcept { return finished_.load(); }

  /// The nodes that this node is waiting for, by name; empty if none. Only for the thread that polls.
  virtual std::vector<std::string> missing() const = 0;

  /// The same as of the last `poll`; any thread.
  std::vector<std::string> last_missing() const;

  /// The real-time thread; null before it started. Only for the thread that polls.
  const RealtimeThread* realtime_thread() const noexcept { return thread_.get(); }

  /// The privileges that the real-time thread was granted or refused, in words; empty before it started.
  std::vector<std::string> realtime_messages() const;

 protected:
  virtual void poll_channels() = 0;            ///< maps what appeared
  virtual bool ready() = 0;                    ///< may the real-time thread start?
  virtual void loop() noexcept = 0;            ///< its body; ends when `stopping()`
  virtual void announce_thread(int /*id*/) {}  ///< the real-time thread with this id (gettid(2)) has started

  /// The real-time thread was started. Only for the thread that polls.
  bool started() const noexcept { return thread_ != nullptr; }

  const std::atomic<bool>& stopping() const noexcept { return stopping_; }
  void finish() noexcept { finished_.store(true); }
  const LoopParameters& loop_parameters() const noexcept { return loop_; }
  bool lockstep() const noexcept { return loop_.clock == ClockMode::kLockstep; }

  /// The clock with which the cycles stamp their trace; null in lockstep, where time stands still.
  Now clock() const noexcept { return lockstep() ? nullptr : &monotonic_ns; }

  const MachineModel robot_;  ///< identified
  const Programs programs_;

 private:
  RealtimeParameters thread_parameters() const;

  LoopParameters loop_;
  LoopPriority priority_;
  std::string thread_name_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> finished_{false};
  std::unique_ptr<RealtimeThread> thread_;
  mutable std::mutex missing_mutex_;
  std::vector<std::string> last_missing_;
};

/// A channel of another node, and the reader that the real-time thread uses.
template <class Frame>
struct Input {
  Input(const std::string& bus, const char* name) : channel(bus, name) {}

  void poll() {
    if (channel.poll()) reader.remap(channel.memory());
  }

  ForeignChannel<LatestFrames<Frame>> channel;
  FrameReader<Frame> reader;
};

/// A channel of this node; `reader` is for the ordinary threads that publish what was written.
template <class Frame>
struct Output {
  Output(const std::string& bus, const char* name)
      : channel(bus, name), writer(channel.memory()), reader(channel.memory()) {}

  OwnedChannel<LatestFrames<Frame>> channel;
  FrameWriter<Frame> writer;
  FrameReader<Frame> reader;
};

/// Returns the machine with rate and clock in its hash and source. The driver announces the hash in the head of the
/// sensors channel, and every other node compares it with its own. So a node of another rate or clock refuses to start.
MachineModel identified(MachineModel machine, const LoopParameters& loop);

}  // namespace robot_control
