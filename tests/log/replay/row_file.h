#pragma once
/// A process that writes the rows of a bus's nodes until it is asked to end, and the file that it wrote.

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <string>

#include "bus/bus.h"
#include "bus/ring.h"
#include "log/replay/recorded.h"
#include "log/rows/join.h"
#include "loop/cycles/trace_sink.h"
#include "rt/futex.h"
#include "support/anonymous_memory.h"
#include "support/child_process.h"

namespace robot_control {

/// The snapshots of one law.
class SnapshotSource {
 public:
  SnapshotSource(const std::string& bus, TraceRing ring)
      : channel_(bus, kSnapshotChannels[static_cast<std::size_t>(ring)]) {}

  void poll() {
    if (channel_.poll()) reader_.emplace(channel_.memory(), 0);
  }

  /// Takes the next snapshot, sealed; false: there is none yet.
  bool next(LawSnapshot& snapshot) {
    if (!reader_ || !reader_->read(snapshot)) return false;
    seal(snapshot);
    return true;
  }

 private:
  ForeignChannel<SnapshotRing> channel_;
  std::optional<SnapshotReader> reader_;
};

/// One trace ring.
template <class Row>
class RowSource {
 public:
  RowSource(const std::string& bus, TraceRing ring) : channel_(bus, kTraceChannels[static_cast<std::size_t>(ring)]) {}

  void drain(Join& join) {
    if (channel_.poll()) reader_.emplace(channel_.memory(), 0);
    while (reader_ && reader_->read(row_)) join.add(row_);
  }

 private:
  ForeignChannel<Ring<Row>> channel_;
  std::optional<RingReader<Row>> reader_;
  Row row_;
};

class RowFile {
 public:
  RowFile(const std::string& bus, const std::filesystem::path& folder)
      : folder_(folder), writer_([this, bus] { return write(bus); }) {
    new (end_.get()) std::atomic<int>(0);
  }

  /// Ends the writing.
  Recording end() {
    end_.get()->store(1);
    writer_.wait();
    Recording recording;
    read<RecordedRow>("rows", [&](const RecordedRow& row) { recording.rows.push_back(row); });
    read<LawSnapshot>("snapshots", [&](const LawSnapshot& snapshot) { recording.snapshots.push_back(snapshot); });
    return recording;
  }

 private:
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

  File open(const char* name, const char* mode) const {
    return {std::fopen((folder_ / name).c_str(), mode), &std::fclose};
  }

  template <class Item, class Add>
  void read(const char* name, Add add) const {
    const File file = open(name, "rb");
    const auto item = std::make_unique<Item>();
    while (file != nullptr && std::fread(item.get(), sizeof(Item), 1, file.get()) == 1) add(*item);
  }

  int write(const std::string& bus) {
    const File rows = open("rows", "wb");
    const File snapshots = open("snapshots", "wb");
    Join join(0.001, [&](const JoinedRow& row) {
      const RecordedRow copy(row);
      std::fwrite(&copy, sizeof(copy), 1, rows.get());
    });
    RowSource<DriverTrace> driver(bus, TraceRing::kDriver);
    RowSource<EstimatorTrace> estimator(bus, TraceRing::kEstimator);
    RowSource<ControllerTrace> controller(bus, TraceRing::kController);
    RowSource<MonitorTrace> monitor(bus, TraceRing::kMonitor);
    SnapshotSource sources[]{{bus, TraceRing::kDriver},
                             {bus, TraceRing::kEstimator},
                             {bus, TraceRing::kController},
                             {bus, TraceRing::kMonitor}};
    const auto snapshot = std::make_unique<LawSnapshot>();
    for (bool last = false; !last;) {
      last = end_.get()->load() != 0;
      driver.drain(join);
      estimator.drain(join);
      controller.drain(join);
      monitor.drain(join);
      for (SnapshotSource& source : sources) {
        source.poll();
        while (source.next(*snapshot)) std::fwrite(snapshot.get(), sizeof(LawSnapshot), 1, snapshots.get());
      }
      sleep_ns(5'000'000);
    }
    join.finish();
    return 0;
  }

  std::filesystem::path folder_;
  AnonymousMemory<std::atomic<int>> end_;
  ChildProcess writer_;
};

}  // namespace robot_control
