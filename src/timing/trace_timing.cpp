#include "timing/trace_timing.h"

#include <optional>
#include <vector>

#include "bus/bus.h"
#include "bus/ring.h"

namespace robot_control {
struct TraceTiming::Rings {
  /// The identity and the timing of a row.
  struct Mark {
    std::uint64_t run = 0;
    std::uint64_t cycle = 0;
    CycleTiming timing;
  };

  template <class Row>
  class RingSource {
   public:
    RingSource(const std::string& bus, Role role) : channel_(bus, kTraceChannels[static_cast<std::size_t>(role)]) {}

    /// Calls `use(row)` with each row since the last call. After a ring was mapped again, the next row is its first.
    template <class Use>
    void read(Use use) {
      if (channel_.poll()) reader_.emplace(channel_.memory());
      while (reader_ && reader_->read(row_)) use(row_);
    }

   private:
    ForeignChannel<Ring<Row>> channel_;
    std::optional<RingReader<Row>> reader_;
    Row row_;
  };

  template <class Row>
  static Mark mark_of(const Row& row) noexcept {
    return {head_of(row).run, head_of(row).cycle, row.timing};
  }

  /// Keeps the newest as many as a ring has, by cycle.
  template <class Times>
  class Table {
   public:
    void store(const Times& times) { rows_[times.cycle % kRingRows] = times; }
    const Times* find(std::uint64_t run, std::uint64_t cycle) const {
      const Times& times = rows_[cycle % kRingRows];
      return times.run == run && times.cycle == cycle ? &times : nullptr;
    }

   private:
    std::vector<Times> rows_ = std::vector<Times>(kRingRows);
  };

  Rings(const std::string& bus, Role role) {
    driver.emplace(bus, Role::kDriver);
    if (role == Role::kEstimator || role == Role::kController) estimator.emplace(bus, Role::kEstimator);
    if (role == Role::kController) controller.emplace(bus, Role::kController);
    if (role == Role::kMonitor) monitor.emplace(bus, Role::kMonitor);
    if (role == Role::kController) states = std::make_unique<Table<Mark>>();
  }

  std::optional<RingSource<DriverTrace>> driver;
  std::optional<RingSource<EstimatorTrace>> estimator;
  std::optional<RingSource<ControllerTrace>> controller;
  std::optional<RingSource<MonitorTrace>> monitor;
  Table<DriverTimes> sensors;
  std::unique_ptr<Table<Mark>> states;
  std::vector<Mark> own;
};

TraceTiming::TraceTiming(const std::string& bus, Role role)
    : role_(role), durations_({role}), rings_(std::make_unique<Rings>(bus, role)) {}

TraceTiming::~TraceTiming() = default;

void TraceTiming::poll() {
  // The own ring is read first: what woke a row is then in the other rings.
  Rings& rings = *rings_;
  rings.own.clear();
  const auto keep = [&](const auto& row) { rings.own.push_back(Rings::mark_of(row)); };
  if (role_ == Role::kEstimator) rings.estimator->read(keep);
  if (rings.controller) rings.controller->read(keep);
  if (rings.monitor) rings.monitor->read(keep);
  if (rings.states) rings.estimator->read([&](const EstimatorTrace& row) { rings.states->store(Rings::mark_of(row)); });
  rings.driver->read([&](const DriverTrace& row) {
    rings.sensors.store(times_of(row));
    if (role_ == Role::kDriver) keep(row);
  });
  rows_ += rings.own.size();
  for (const Rings::Mark& mark : rings.own) {
    const DriverTimes* driver = rings.sensors.find(mark.run, mark.cycle);
    if (driver == nullptr) continue;
    CycleTimes times{.driver = *driver, .timing = {driver->timing}};
    if (rings.states) {
      if (const Rings::Mark* state = rings.states->find(mark.run, mark.cycle)) times.timing[1] = state->timing;
    }
    times.timing[static_cast<std::size_t>(role_)] = mark.timing;
    durations_.add(times);
  }
}

}  // namespace robot_control
