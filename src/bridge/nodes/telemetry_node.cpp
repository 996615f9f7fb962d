#include "bridge/nodes/telemetry_node.h"

#include <ros/ros.h>

#include <filesystem>
#include <numeric>

#include "bridge/reports/diagnostics.h"
#include "runtime/processes/telemetry_process.h"

namespace robot_control {
namespace {

constexpr std::int64_t kDrainPeriod = 10'000'000;         // ns; a ring holds 1 s at 2 kHz
constexpr std::int64_t kLockstepDrainPeriod = 1'000'000;  // ns; there, a full ring holds the loop up

class TelemetryNode final : public Node {
 public:
  explicit TelemetryNode(const Setup& setup)
      : lockstep_(setup.parameters.loop.clock == ClockMode::kLockstep),
        quota_(setup.parameters.telemetry.quota),
        process_(setup.parameters, setup.robot, setup.bus) {}

  void connect(ros::NodeHandle& /*handle*/) override {
    const std::string path = std::filesystem::absolute(process_.path()).lexically_normal().string();
    ROS_INFO("writing %s; telemetry.quota = %g GB", path.c_str(), quota_);
  }
  void poll() override { process_.poll(); }
  void publish() override {
    process_.drain();
    for (const std::string& path : process_.take_removed()) {
      ROS_WARN("removed %s, the oldest log: telemetry.quota = %g GB", path.c_str(), quota_);
    }
    if (process_.problem().empty() || reported_) return;
    reported_ = true;
    ROS_ERROR("%s. The loop goes on, its rows are counted and lost", process_.problem().c_str());
  }
  std::int64_t tick_ns() const override { return lockstep_ ? kLockstepDrainPeriod : kDrainPeriod; }
  bool finished() const override { return false; }
  std::vector<std::string> missing() const override { return process_.missing(); }
  std::vector<std::string> realtime_messages() const override { return {}; }

  void stop() override {
    process_.finish();
    const TelemetryCounts counts = process_.counts();
    ROS_INFO("%llu rows in %s, %llu dropped, %llu overwritten", static_cast<unsigned long long>(counts.join.emitted),
             process_.path().c_str(), static_cast<unsigned long long>(counts.dropped),
             static_cast<unsigned long long>(counts.overwritten));
  }

  void diagnose(DiagnosticReport& report) override {
    const TelemetryCounts counts = process_.counts();
    const auto sum = [](const auto& nodes) { return std::accumulate(nodes.begin(), nodes.end(), std::uint64_t{0}); };
    if (counts.dropped + counts.overwritten != 0) report.warn("rows were lost");
    if (!process_.problem().empty()) report.error(process_.problem());
    report.value("log", std::filesystem::absolute(process_.path()).string());  // identify.py reads it
    report.value("rows", counts.join.emitted);
    report.value("absent", sum(counts.join.absent));
    report.value("late", sum(counts.join.late));
    report.value("dropped", counts.dropped);
    report.value("overwritten", counts.overwritten);
    report.value("unwritten", process_.problem().empty() ? 0 : counts.unwritten);
  }

 private:
  bool lockstep_;
  double quota_;  ///< GB
  bool reported_ = false;
  TelemetryProcess process_;
};

}  // namespace

std::unique_ptr<Node> make_telemetry(const Setup& setup) {
  return std::make_unique<TelemetryNode>(setup);
}

}  // namespace robot_control
