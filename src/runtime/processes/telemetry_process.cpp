#include "runtime/processes/telemetry_process.h"

#include <optional>

#include "runtime/cycles/trace_sink.h"

namespace robot_control {
namespace {

constexpr const char* kNodes[kTraceRings] = {"mujoco_plant", "state_estimator", "diff_drive_controller",
                                             "safety_monitor"};

std::vector<std::string> joint_names(const RobotModel& robot) {
  std::vector<std::string> names;
  for (const JointModel& joint : robot.joints) names.push_back(joint.name);
  return names;
}

std::int64_t bytes_of(double gigabytes) {
  return static_cast<std::int64_t>(gigabytes * 1.0e9);
}

}  // namespace

/// One ring.
template <class Row>
class TelemetryProcess::Source {
 public:
  Source(const std::string& bus, TraceRing ring) : channel_(bus, kTraceChannels[static_cast<std::size_t>(ring)]) {}

  void poll(std::atomic<std::uint64_t>& read) {
    if (!channel_.poll()) return;
    retire();
    reader_.emplace(channel_.memory());
    dropped_before_ = reader_->dropped();
    read.store(reader_->position(), std::memory_order_release);
  }

  std::size_t drain(Join& join, std::atomic<std::uint64_t>& read) {
    std::size_t rows = 0;
    // One ring's worth at most, so that a writer that is faster than this does not hold the others up.
    while (reader_ && rows < kRingRows && reader_->take(row_)) {
      join.add(row_);
      if (++rows % kPublishRows == 0) read.store(reader_->position(), std::memory_order_release);
    }
    if (reader_) read.store(reader_->position(), std::memory_order_release);
    return rows;
  }

  bool mapped() const { return reader_.has_value(); }
  bool alive() const { return mapped() && channel_.locked(); }

  void count(TelemetryCounts& counts) const {
    counts.dropped += dropped_ + (reader_ ? reader_->dropped() - dropped_before_ : 0);
    counts.overwritten += overwritten_ + (reader_ ? reader_->overwritten() : 0);
  }

 private:
  static constexpr std::size_t kPublishRows = 64;

  void retire() {
    if (!reader_) return;
    dropped_ += reader_->dropped() - dropped_before_;
    overwritten_ += reader_->overwritten();
  }

  ForeignChannel<Ring<Row>> channel_;
  std::optional<RingReader<Row>> reader_;
  std::uint64_t dropped_before_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint64_t overwritten_ = 0;
  Row row_;
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

TelemetryProcess::TelemetryProcess(const Parameters& parameters, const RobotModel& robot, const std::string& bus)
    : positions_(bus, ChannelNames::kTraceRead),
      folder_(parameters.telemetry.directory, bytes_of(parameters.telemetry.quota)),
      path_(folder_.begin()),
      csv_(path_, log_columns(joint_names(robot), parameters.loop.clock == ClockMode::kWall),
           [this](std::int64_t bytes) { return folder_.make_room(bytes); }),
      join_(parameters.loop.period(), [this](const JoinedRow& row) { write_down([&] { csv_.write(row); }); }),
      sources_(std::make_unique<Sources>(bus)) {
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
  write_down([this] { csv_.flush(); });
}

std::size_t TelemetryProcess::drain() {
  std::size_t rows = 0;
  sources_->each([&](auto& source, std::size_t ring) { rows += source.drain(join_, positions_.memory()->read[ring]); });
  return rows;
}

void TelemetryProcess::finish() {
  positions_.memory()->head.attached_run.store(0);
  drain();
  join_.finish();
  write_down([this] { csv_.close(); });
  if (!problem_.empty()) throw LogError(problem_ + "; " + std::to_string(counts().unwritten) + " rows are not in it");
}

template <class Act>
void TelemetryProcess::write_down(Act act) {
  try {
    act();
  } catch (const LogError& error) {
    problem_ = error.what();
  }
}

std::vector<std::string> TelemetryProcess::missing() const {
  std::vector<std::string> names;
  sources_->each([&](const auto& source, std::size_t ring) {
    if (!source.alive()) names.emplace_back(kNodes[ring]);
  });
  return names;
}

TelemetryCounts TelemetryProcess::counts() const {
  TelemetryCounts counts{.join = join_.counts()};
  counts.unwritten = counts.join.emitted - csv_.rows();
  sources_->each([&](const auto& source, std::size_t) { source.count(counts); });
  return counts;
}

}  // namespace robot_control
