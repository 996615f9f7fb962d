#pragma once
/// SpoiledJoint is a driver around another one. It spoils the sample of one joint on request.

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>

#include "drivers/driver.h"

namespace robot_control {

/// How the sample of a joint is spoiled.
enum class Spoiled : std::uint32_t { kNot, kMissing, kStale, kFaulty };

/// The request to spoil a joint; it may lie in memory that processes share.
struct SpoilRequest {
  std::atomic<std::uint32_t> joint{0};
  std::atomic<Spoiled> how{Spoiled::kNot};
};

class SpoiledJoint final : public Simulator {
 public:
  SpoiledJoint(std::unique_ptr<Simulator> driver, const SpoilRequest& request, std::int64_t period_ns)
      : driver_(std::move(driver)), request_(request), period_ns_(period_ns) {}

  void start() override { driver_->start(); }
  void read(SensorFrame& sensors) noexcept override {
    driver_->read(sensors);
    const Spoiled how = request_.how.load();
    JointSample& sample = sensors.joints[request_.joint.load()];
    if (how == Spoiled::kNot) {
      good_ = sample;
    } else if (how == Spoiled::kMissing) {
      sample.valid = 0;
    } else if (how == Spoiled::kStale) {
      good_.age_ns += period_ns_;
      sample = good_;
    } else {
      sample.fault = 1;
    }
  }
  void write(std::span<const JointCommand> commands) noexcept override { driver_->write(commands); }
  void stop() noexcept override { driver_->stop(); }
  bool accepts(JointMode mode) const noexcept override { return driver_->accepts(mode); }
  bool measures(MachineInput input) const noexcept override { return driver_->measures(input); }
  void truth(TruthFrame& truth) noexcept override { driver_->truth(truth); }
  void inject(const InjectedFaults& faults) noexcept override { driver_->inject(faults); }

 private:
  std::unique_ptr<Simulator> driver_;
  const SpoilRequest& request_;
  std::int64_t period_ns_;
  JointSample good_;  ///< the last sample that was not spoiled
};

}  // namespace robot_control
