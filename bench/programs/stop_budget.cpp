#include "bench/programs/stop_budget.h"

#include <cmath>
#include <filesystem>

#include "signals/names.h"

namespace robot_control::bench {
namespace {

constexpr double kTimeout = 6.0;         // s, after which a robot that still moves does not stop
constexpr double kSendInterval = 0.1;    // s
constexpr double kStandingSpeed = 0.01;  // m/s
constexpr double kBlow = 20.0;           // m/s², no motor brakes that hard

std::uint64_t cycles_of(double seconds, double period) {
  return static_cast<std::uint64_t>(std::llround(seconds / period));
}

double speed_of(const TruthFrame& truth) {
  return std::hypot(truth.twist_base.linear[0], truth.twist_base.linear[1]);
}

bool turning(const TruthFrame& truth) {
  return std::abs(truth.twist_base.angular[2]) > 0.05;  // rad/s: 12 mm/s at diffbot's wheels
}

/// The parameters for a scenario; scenes without a folder lie beside the parameter file's own.
Parameters parameters_of(const std::string& path, const StopScenario& scenario) {
  std::vector<Overlay> overlays = scenario.parameters;
  const std::filesystem::path scenes = std::filesystem::path(path).parent_path() / "../urdf/scenes";
  for (Overlay& overlay : overlays) {
    if (overlay.path == "mujoco_plant.scene") overlay.text = (scenes / overlay.text).string();
  }
  return read_parameters(path, overlays);
}

/// Adds the data of each cycle.
class Observer {
 public:
  Observer(StopMeasurement& measured, bool fact_known) : measured_(measured), fact_known_(fact_known) {}

  void add(const JoinedRow& row) {
    const TruthFrame& truth = row.driver->truth;
    const double speed = speed_of(truth);
    if (!fact_known_) await_blow(truth.head.cycle, speed, row);
    if (fact_known_) follow(row, speed);
    last_speed_ = speed;
    last_ = truth.pose_world.position;
  }

  bool done() const { return measured_.standing_cycle && standing_ > 100; }

 private:
  void await_blow(std::uint64_t cycle, double speed, const JoinedRow& row) {
    const bool stops = row.driver->gate.verdict == GateVerdict::kRamp;
    if (cycle < 100 || (std::abs(speed - last_speed_) < kBlow * measured_.period && !stops)) return;
    fact_known_ = true;
    measured_.fact_cycle = cycle;
    measured_.speed = last_speed_;
  }

  void follow(const JoinedRow& row, double speed) {
    const TruthFrame& truth = row.driver->truth;
    const std::uint64_t cycle = truth.head.cycle;
    if (!measured_.standing_cycle) {
      measured_.distance +=
          std::hypot(truth.pose_world.position[0] - last_[0], truth.pose_world.position[1] - last_[1]);
    }
    const bool stops =
        row.driver->gate.verdict == GateVerdict::kBrake || row.driver->gate.verdict == GateVerdict::kRamp;
    if (!stops) measured_.stopped_cycle.reset();
    if (stops && !measured_.stopped_cycle) {
      measured_.stopped_cycle = cycle;
      measured_.ramps = row.driver->gate.verdict == GateVerdict::kRamp;
    }
    if (row.monitor != nullptr && row.monitor->permit.causes != 0 && !measured_.latched_cycle) {
      measured_.latched_cycle = cycle;
      measured_.cause = row_of(kStopCauseNames, row.monitor->permit.first_cause)->name;
    }
    const bool stands = speed < kStandingSpeed && !turning(truth);
    standing_ = stands ? standing_ + 1 : 0;
    if (!stands) measured_.standing_cycle.reset();
    if (stands && !measured_.standing_cycle && measured_.stopped_cycle) measured_.standing_cycle = cycle;
  }

  StopMeasurement& measured_;
  bool fact_known_;
  double last_speed_ = 0;
  Vector3 last_{};
  std::uint64_t standing_ = 0;
};

Row row(const std::string& name, double value, const std::string& unit) {
  return {.name = name, .value = value, .unit = unit, .reference = 0, .reference_name = "none", .ratio = 0};
}

}  // namespace

std::optional<std::uint64_t> StopMeasurement::reaction() const {
  if (!latched_cycle || !stopped_cycle) return std::nullopt;
  return *stopped_cycle > *latched_cycle ? *stopped_cycle - *latched_cycle : 0;
}

StopMeasurement measure_stop(const std::string& path, const StopScenario& scenario) {
  const Parameters parameters = parameters_of(path, scenario);
  ClosedLoop loop(parameters);
  StopMeasurement measured;
  measured.fact = scenario.fact;
  measured.period = parameters.loop.period();
  const std::uint64_t begin = cycles_of(kFactTime, measured.period);
  const std::uint64_t end = begin + cycles_of(kTimeout, measured.period);
  const std::uint64_t interval = cycles_of(kSendInterval, measured.period);
  Observer before(measured, false);
  Observer after(measured, true);
  const bool announced = scenario.begin != nullptr;
  for (std::uint64_t k = 0; k < end; ++k) {
    if (k % interval == 1) loop.command({.linear = {scenario.linear, 0, 0}, .angular = {0, 0, scenario.angular}});
    if (k == begin && announced) {
      measured.fact_cycle = k;
      measured.speed = speed_of(loop.row().driver->truth);
      after.add(loop.row());
      measured.distance = 0;
      measured.standing_cycle.reset();
      measured.stopped_cycle.reset();
      scenario.begin(loop);
    }
    loop.step();
    if (announced && k >= begin) after.add(loop.row());
    if (!announced) before.add(loop.row());
    if ((announced ? after : before).done()) break;
  }
  return measured;
}

std::vector<Row> stop_rows(const std::vector<StopMeasurement>& measured) {
  std::vector<Row> rows;
  for (const StopMeasurement& stop : measured) {
    const std::string name = stop.fact + " (" + (stop.cause.empty() ? "no stop" : stop.cause) + ")";
    if (stop.stopped_cycle) {
      const double seconds = static_cast<double>(*stop.stopped_cycle - stop.fact_cycle) * stop.period;
      rows.push_back(row(name + (stop.ramps ? ": ramp" : ": brake"), seconds * 1e3, "ms"));
    }
    if (stop.reaction()) rows.push_back(row(name + ": from latch", static_cast<double>(*stop.reaction()), "cycles"));
    if (stop.standing_cycle) rows.push_back(row(name + ": way", stop.distance, "m"));
  }
  return rows;
}

}  // namespace robot_control::bench
