#pragma once
/// A writer in a process of its own writes as fast as it can. A reader reads as often as it can, and counts the
/// results. The memory is an object of /dev/shm, which each process maps for itself, the reader for reading only.

#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <string>

#include "bus/latest_frames.h"
#include "bus/ring.h"
#include "rt/clock.h"
#include "rt/shared_memory.h"
#include "support/processes/anonymous_memory.h"
#include "support/processes/child_process.h"

namespace robot_control {

/// 16 words: two cache lines. Every value is the cycle.
struct TortureFrame {
  FrameHead head;
  std::array<std::uint64_t, 11> values{};
};

/// As long; every value is the position.
struct TortureRow {
  std::array<std::uint64_t, 16> values{};
};

inline constexpr std::int64_t kTorturePatienceNs = 600'000'000'000;  // ends a hang

struct TortureCount {
  std::uint64_t written = 0;
  std::uint64_t read = 0;       ///< look-ups that found something; of a ring: rows
  std::uint64_t distinct = 0;   ///< different frames among them
  std::uint64_t overtaken = 0;  ///< look-ups in which the writer interfered kReadTries times
  std::uint64_t torn = 0;
  std::uint64_t reordered = 0;  ///< older than an earlier one, or not the requested one; of a ring: also lost
  double seconds = 0;

  std::uint64_t errors() const noexcept { return torn + reordered; }
};

/// A zeroed object of this test's own, which is removed at the end. Each process opens and maps it for itself.
template <class Object>
class TortureMemory {
 public:
  TortureMemory() : object_(*SharedMemory::create(name_)) { object_.reserve(sizeof(Object)); }
  TortureMemory(const TortureMemory&) = delete;
  TortureMemory& operator=(const TortureMemory&) = delete;
  ~TortureMemory() {
    if (getpid() == owner_) shm_unlink(name_.c_str());
  }

  MemoryMapping map(Access access) const { return SharedMemory::open(name_, access)->map(sizeof(Object)); }

 private:
  const pid_t owner_ = getpid();
  const std::string name_ = "/robot_control.torture." + std::to_string(owner_);
  SharedMemory object_;
};

/// Keeps this thread on one of the cores that it may use, while it lives. Writer and reader get two cores if there are
/// two; otherwise they would take turns instead of interfering.
class OnCore {
 public:
  explicit OnCore(int index) {
    sched_getaffinity(0, sizeof before_, &before_);
    index %= std::max(CPU_COUNT(&before_), 1);
    for (int core = 0; core < CPU_SETSIZE; ++core) {
      if (!CPU_ISSET(core, &before_) || index-- != 0) continue;
      cpu_set_t one;
      CPU_ZERO(&one);
      CPU_SET(core, &one);
      sched_setaffinity(0, sizeof one, &one);
    }
  }
  OnCore(const OnCore&) = delete;
  OnCore& operator=(const OnCore&) = delete;
  ~OnCore() { sched_setaffinity(0, sizeof before_, &before_); }

 private:
  cpu_set_t before_{};
};

struct TortureControl {
  std::atomic<std::uint64_t> written;
  std::atomic<bool> stop;
};

inline TortureFrame torture_frame(std::uint64_t cycle) {
  TortureFrame frame;
  frame.head.run = 7;
  frame.head.cycle = cycle;
  frame.values.fill(cycle);
  return frame;
}

template <class Values>
bool all_are(const Values& values, std::uint64_t number) {
  return std::ranges::all_of(values, [&](std::uint64_t value) { return value == number; });
}

/// Writes one frame after the other, without pause, until stopped.
inline int write_torture_frames(const TortureMemory<LatestFrames<TortureFrame>>& memory, TortureControl& control) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a benchmark that is interrupted leaves no writer behind
  const OnCore core(1);
  const MemoryMapping mapping = memory.map(Access::kReadWrite);
  FrameWriter<TortureFrame> writer(static_cast<LatestFrames<TortureFrame>*>(mapping.data()), Wake::kNone);
  for (std::uint64_t cycle = 0; !control.stop.load(std::memory_order_relaxed); ++cycle) {
    TortureFrame frame = torture_frame(cycle);
    writer.publish(frame);
    control.written.store(cycle + 1, std::memory_order_release);
  }
  return 0;
}

/// Looks the newest frame and an earlier one up in turn, until `frames` were written and as many look-ups found one. At
/// least every 100 000th of these has to find another frame, since on one core the two take turns. It also ends at the
/// first error.
inline TortureCount torture_frames(std::uint64_t frames) {
  const TortureMemory<LatestFrames<TortureFrame>> memory;
  const AnonymousMemory<TortureControl> control;
  ChildProcess writer([&] { return write_torture_frames(memory, *control.get()); });
  const OnCore core(0);
  const MemoryMapping mapping = memory.map(Access::kReadOnly);
  const FrameReader<TortureFrame> reader(static_cast<const LatestFrames<TortureFrame>*>(mapping.data()));
  TortureCount count;
  TortureFrame frame;
  std::uint64_t last = 0;
  const std::int64_t begin_ns = monotonic_ns();
  const auto written = [&] { return control->written.load(std::memory_order_acquire); };
  const auto enough = [&] { return count.read >= frames && written() >= frames && count.distinct >= frames / 100'000; };
  while (!enough() && count.errors() == 0 && monotonic_ns() < begin_ns + kTorturePatienceNs) {
    const Lookup newest = reader.newest(frame);
    if (newest == Lookup::kMissing) {
      count.overtaken += last == 0 ? 0 : 1;
      continue;
    }
    count.torn += newest == Lookup::kFrame && all_are(frame.values, frame.head.cycle) ? 0 : 1;
    count.reordered += frame.head.cycle < last ? 1 : 0;
    count.distinct += frame.head.cycle == last ? 0 : 1;
    last = frame.head.cycle;
    ++count.read;
    const std::uint64_t asked = last - std::min<std::uint64_t>(last, count.read % kFrameSlots);
    const Lookup found = reader.at(7, asked, frame);
    if (found == Lookup::kMissing) continue;  // overwritten by now
    count.torn += found == Lookup::kFrame && all_are(frame.values, frame.head.cycle) ? 0 : 1;
    count.reordered += frame.head.cycle == asked ? 0 : 1;
    ++count.read;
  }
  count.seconds = 1e-9 * static_cast<double>(monotonic_ns() - begin_ns);
  count.written = written();
  control->stop.store(true);
  writer.wait();
  return count;
}

/// Sends `rows` through a ring whose writer waits for room: each must come once, whole and in order. It uses any core:
/// the two wait for each other, and on two busy cores they would wait for their turns as well.
inline TortureCount torture_ring(std::uint64_t rows) {
  const TortureMemory<Ring<TortureRow>> memory;
  const AnonymousMemory<RingPositions> positions;
  std::atomic<std::uint64_t>& read = positions->read[0];
  ChildProcess other([&] {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const MemoryMapping mapping = memory.map(Access::kReadWrite);
    RingWriter<TortureRow> writer(static_cast<Ring<TortureRow>*>(mapping.data()));
    TortureRow row;
    for (std::uint64_t position = 0; position < rows; ++position) {
      row.values.fill(position);
      while (writer.full(&read)) sched_yield();
      if (!writer.append(row, &read)) return 1;
    }
    return 0;
  });
  const MemoryMapping mapping = memory.map(Access::kReadOnly);
  RingReader<TortureRow> reader(static_cast<const Ring<TortureRow>*>(mapping.data()), 0);
  TortureCount count;
  TortureRow row;
  const std::int64_t begin_ns = monotonic_ns();
  while (count.read < rows && count.errors() == 0 && monotonic_ns() < begin_ns + kTorturePatienceNs) {
    if (!reader.read(row)) {
      sched_yield();
      continue;
    }
    count.torn += all_are(row.values, row.values[0]) ? 0 : 1;
    count.reordered += row.values[0] == count.read ? 0 : 1;
    ++count.read;
    read.store(reader.position(), std::memory_order_release);
  }
  count.seconds = 1e-9 * static_cast<double>(monotonic_ns() - begin_ns);
  count.distinct = count.read;
  count.written = reader.position();
  count.reordered += reader.overwritten() + reader.dropped();
  if (count.read == rows && other.wait() != 0) ++count.reordered;
  return count;
}

}  // namespace robot_control
