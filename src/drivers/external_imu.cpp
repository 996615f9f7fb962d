#include "drivers/external_imu.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace robot_control {
namespace {

bool all_finite(const Vector3& vector) noexcept {
  return std::ranges::all_of(vector, [](double value) { return std::isfinite(value); });
}

}  // namespace

ExternalImu::ExternalImu(std::unique_ptr<Driver> machine, std::shared_ptr<const ImuInbox> inbox,
                         std::function<std::int64_t()> clock, bool exists)
    : machine_(std::move(machine)), inbox_(std::move(inbox)), clock_(std::move(clock)), exists_(exists) {}

void ExternalImu::read(SensorFrame& sensors) noexcept {
  machine_->read(sensors);
  inbox_->load(sample_);
  sensors.valid &= ~std::uint64_t{kValidGyro | kValidAccelerometer | kValidOrientation};
  if (sample_.time_ns < 0) {
    if (sensors.driver_state == DriverState::kRunning) sensors.driver_state = DriverState::kStarting;
    return;
  }
  if (clock_() - sample_.time_ns > kImuLife) return;
  sensors.imu = sample_.imu;
  if (all_finite(sample_.imu.angular_velocity)) sensors.valid |= sample_.valid & kValidGyro;
  if (all_finite(sample_.imu.linear_acceleration)) sensors.valid |= sample_.valid & kValidAccelerometer;
}

std::string ExternalImu::warning() const {
  const std::string machine = machine_->warning();
  ExternalImuSample newest;
  if (!inbox_->load(newest) || newest.time_ns >= 0) return machine;
  return machine + (machine.empty() ? "" : "; ") + "no valid message on imu/input: start the node of the IMU";
}

}  // namespace robot_control
