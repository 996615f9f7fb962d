#include "loop/processes/telemetry_process.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "loop/cycles/trace_sink.h"
#include "loop/log_header.h"
#include "rt/clock.h"
#include "signals/robot_kinds.h"
#include "signals/roles.h"

namespace robot_control {
namespace {

static_assert(kLawNames.size() == kTraceRings);  // each law writes one ring, in the same order

std::int64_t bytes_of(double gigabytes) {
  return std::llround(gigabytes * 1.0e9);
}

}  // namespace

/// One ring.
template <class Row>
class TelemetryProcess::Source {
 public:
  Source(const std::string& bus, TraceRing ring)
      : channel_(bus, kTraceChannels[static_cast<std::size_t>(ring)]),
        snapshot_channel_(bus, kSnapshotChannels[static_cast<std::size_t>(ring)]) {}

  void poll(std::atomic<std::uint64_t>& read) {
    if (snapshot_channel_.poll()) snapshots_.emplace(snapshot_channel_.memory(), 0);
    if (!channel_.poll()) return;
    retire();
    reader_.emplace(channel_.memory());
    begun_ = false;
    dropped_before_ = reader_->dropped();
    read.store(reader_->position(), std::memory_order_release);
  }

  /// `drain` takes the rows that are written now.
  void mark() { written_ = reader_ ? reader_->written() : 0; }

  /// `keep(snapshot)` comes before the row to which it belongs: a node appends it first.
  /// `store(row)` is called with each row before the join gets it.
  template <class Keep, class Store>
  std::size_t drain(Join& join, std::atomic<std::uint64_t>& read, Keep keep, Store store) {
    std::size_t rows = 0;
    if (!begun_) begin();
    // One ring's worth at most, so that a writer that is faster than this does not hold the others up.
    while (begun_ && rows < kRingRows) {
      batch_.clear();
      while (batch_.size() < kBatch && reader_->position() < written_ && reader_->read(row_)) batch_.push_back(row_);
      if (batch_.empty()) break;
      while (snapshots_ && snapshots_->read(snapshot_)) keep(snapshot_);
      for (const Row& row : batch_) store(row);
      for (const Row& row : batch_) join.add(row);
      rows += batch_.size();
      read.store(reader_->position(), std::memory_order_release);
    }
    if (reader_) read.store(reader_->position(), std::memory_order_release);
    return rows;
  }

  /// Returns the id of the thread that writes the ring; 0: it is not known.
  int thread() const {
    return alive() ? static_cast<int>(channel_.memory()->thread.load(std::memory_order_acquire)) : 0;
  }

  bool mapped() const { return reader_.has_value(); }
  bool alive() const { return mapped() && channel_.locked(); }

  void count(TelemetryCounts& counts) const {
    counts.dropped += dropped_ + (reader_ ? reader_->dropped() - dropped_before_ : 0);
    counts.overwritten += overwritten_ + (reader_ ? reader_->overwritten() : 0);
  }

 private:
  static constexpr std::size_t kBatch = 64;

  /// Begins with the rows of the present writer that are there: a snapshot of its law is among them (law_snapshot.h).
  /// Some room is left for the rows that it writes meanwhile. Only a row appended since the ring was mapped proves that
  /// its writer lives and that `began` is its own. A writer that starts holds the lock before it has stored `began`.
  void begin() {
    constexpr std::uint64_t kBack = kRingRows - kRingRows / 8;
    if (!reader_ || reader_->written() == reader_->position()) return;
    const std::uint64_t mapped_at = reader_->position();
    reader_.emplace(channel_.memory(), std::max(reader_->began(), mapped_at - std::min(mapped_at, kBack)));
    begun_ = true;
  }

  void retire() {
    if (!reader_) return;
    dropped_ += reader_->dropped() - dropped_before_;
    overwritten_ += reader_->overwritten();
  }

  ForeignChannel<Ring<Row>> channel_;
  std::optional<RingReader<Row>> reader_;
  bool begun_ = false;  ///< rows are taken
  std::uint64_t written_ = 0;
  std::uint64_t dropped_before_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint64_t overwritten_ = 0;
  Row row_;
  std::vector<Row> batch_;
  ForeignChannel<SnapshotRing> snapshot_channel_;
  std::optional<SnapshotReader> snapshots_;
  LawSnapshot snapshot_;
};

struct TelemetryProcess::Sources {
  explicit Sources(const std::string& bus)
      : driver(bus, TraceRing::kDriver),
        estimator(bus, TraceRing::kEstimator),
        controller(bus, TraceRing::kController),
        monitor(bus, TraceRing::kMonitor) {}

  /// `visit(source, index)` in the order of TraceRing.
  template <class Visit>
  void each(Visit visit) {
    visit(driver, 0);
    visit(estimator, 1);
    visit(controller, 2);
    visit(monitor, 3);
  }

  Source<DriverTrace> driver;
  Source<EstimatorTrace> estimator;
  Source<ControllerTrace> controller;
  Source<MonitorTrace> monitor;
};

TelemetryProcess::TelemetryProcess(const Parameters& parameters, const Robot& robot, const std::string& bus)
    : programs_(programs_of(parameters, robot.kind())),
      positions_(bus, ChannelNames::kTraceRead),
      folder_(parameters.telemetry.directory, bytes_of(parameters.telemetry.quota)),
      lockstep_(parameters.loop.clock == ClockMode::kLockstep),
      permit_(bus, ChannelNames::kPermit),
      timing_(lockstep_ ? nullptr : std::make_unique<TimingSummary>(programs_)),
      join_(parameters.loop.period(),
            [this](const JoinedRow& row) {
              if (timing_ != nullptr) timing_->add(row);
              if (bag_ != nullptr) write_to_bag([&] { bag_->write(row); });
            }),
      sources_(std::make_unique<Sources>(bus)) {
  // First: it notices another telemetry in this folder, whose logs are not to be renamed.
  if (parameters.telemetry.black_box > 0 && !lockstep_) {
    black_box_ =
        std::make_unique<BlackBoxKeeper>((std::filesystem::path(parameters.telemetry.directory) / "black_box").string(),
                                         static_cast<std::size_t>(bytes_of(parameters.telemetry.black_box)),
                                         parameters.telemetry.incidents, log_header(parameters, robot));
    black_box_path_ = black_box_->path();
  }
  if (parameters.telemetry.record != RecordMode::kOff) {
    bag_ = std::make_unique<BagLog>(folder_, log_header(parameters, robot), parameters.telemetry);
    bag_path_ = folder_.path();
  }
  positions_.memory()->head.attached_run.store(0);
}

TelemetryProcess::~TelemetryProcess() {
  positions_.memory()->head.attached_run.store(0);
}

void TelemetryProcess::poll() {
  bool all = true;
  sources_->each([&](auto& source, std::size_t ring) {
    source.poll(positions_.memory()->read[ring]);
    all = all && source.mapped();
  });
  if (all) positions_.memory()->head.attached_run.store(1);
  const TelemetryCounts counted = counts();
  const std::uint64_t lost = counted.dropped + counted.overwritten;
  const std::int64_t now_ns = monotonic_ns();
  if (black_box_ != nullptr) {
    permit_.poll();
    black_box_->set_state(utc_ns() - now_ns, lost);
    black_box_->poll(now_ns);
  }
  if (bag_ == nullptr) return;
  bag_->set_lost(lost);
  if (!lockstep_) bag_->set_time_offset(utc_ns() - now_ns);
  if (timing_ != nullptr && timing_->due(now_ns)) bag_->write(summary(now_ns));
  write_to_bag([&] { bag_->poll(now_ns); });
  if (!bag_->broken()) problem_.clear();
}

TraceSummary TelemetryProcess::summary(std::int64_t now_ns) const {
  std::array<int, kLoopRoles> threads{};
  sources_->each([&](const auto& source, std::size_t ring) { threads[ring] = source.thread(); });
  return timing_->summary(now_ns, threads);
}

/// A row before it is joined.
template <class Row>
void TelemetryProcess::receive(const Row& row, std::size_t ring) {
  const std::uint64_t process = row.calls.law.process;
  if (std::exchange(law_processes_[ring], process) != process) ++parameter_changes_;
  if constexpr (requires { row.tuning; }) {
    if (std::exchange(tuning_, row.tuning) != row.tuning) ++parameter_changes_;
  }
  if (black_box_ == nullptr) return;
  black_box_->add(row);
  if constexpr (requires { row.permit; }) {
    if (!permit_seen_) black_box_->watch(row.permit.causes, monotonic_ns());
  }
}

void TelemetryProcess::set_header(const LogHeader& header) {
  if (bag_ != nullptr) bag_->set_header(header);
  if (black_box_ != nullptr) black_box_->set_header(header);
}

std::size_t TelemetryProcess::drain() {
  std::size_t rows = 0;
  const auto keep = [this](const LawSnapshot& snapshot) {
    if (black_box_ != nullptr) black_box_->add(snapshot);
    if (bag_ != nullptr) bag_->write(snapshot);
  };
  sources_->each([](auto& source, std::size_t /*ring*/) { source.mark(); });
  sources_->each([&](auto& source, std::size_t ring) {
    rows += source.drain(join_, positions_.memory()->read[ring], keep, [&](const auto& row) { receive(row, ring); });
  });
  if (black_box_ != nullptr) {
    black_box_->flush();
    check_permit();
  }
  return rows;
}

void TelemetryProcess::check_permit() {
  Permit permit;
  if (permit_.reader.newest(permit) != Lookup::kFrame) return;
  black_box_->watch(permit.causes, monotonic_ns());
  permit_seen_ = true;
}

std::vector<std::string> TelemetryProcess::take_notes() {
  return black_box_ == nullptr ? std::vector<std::string>() : black_box_->take_notes();
}

void TelemetryProcess::finish() {
  positions_.memory()->head.attached_run.store(0);
  drain();
  join_.finish();
  if (bag_ != nullptr) {
    write_to_bag([this] {
      if (timing_ != nullptr) bag_->write_last(summary(monotonic_ns()));
      bag_->close();
    });
  }
  // Last: a stop that is to be saved takes seconds, and roslaunch kills a node that takes 15 s to end.
  constexpr std::int64_t kSavingNs = 5'000'000'000;
  const std::int64_t end_ns = monotonic_ns() + kSavingNs;
  if (black_box_ != nullptr) black_box_->finish([end_ns] { return monotonic_ns() >= end_ns; });
  if (bag_ == nullptr || bag_->unwritten() == 0) return;
  throw LogError(std::to_string(bag_->unwritten()) + " rows are missing in " + bag_path_ + " or the files before it: " +
                 (problem_.empty() ? "the disk did not accept them for a while" : problem_));
}

template <class Act>
void TelemetryProcess::write_to_bag(Act act) {
  try {
    act();
  } catch (const LogError& error) {
    problem_ = error.what();
  }
}

std::vector<std::string> TelemetryProcess::missing() const {
  std::vector<std::string> names;
  sources_->each([&](const auto& source, std::size_t ring) {
    if (!source.alive()) names.emplace_back(program_of(static_cast<Role>(ring), programs_));
  });
  return names;
}

TelemetryCounts TelemetryProcess::counts() const {
  TelemetryCounts counts{.join = join_.counts()};
  if (bag_ != nullptr) {
    counts.bag_rows = bag_->rows();
    counts.bag_unwritten = bag_->unwritten();
  }
  if (black_box_ != nullptr) counts.incidents = black_box_->saved();
  sources_->each([&](const auto& source, std::size_t) { source.count(counts); });
  return counts;
}

}  // namespace robot_control
