#include "drivers/mujoco/sensors/sensor_faults.h"

#include <limits>
#include <numbers>

namespace robot_control {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Returns false if there is no sample.
bool step_axes(FaultyOutput<Vector3>& output, FaultKind kind, std::uint64_t cycle, double range,
               Vector3& value) noexcept {
  const auto distort = [range](FaultKind how, Vector3& axes, FaultRandom& random) {
    for (double& axis : axes) axis = how == FaultKind::kWrong ? -axis : random.within(range);
  };
  if (output.step(kind, cycle, value, distort) == Emission::kValue || kind == FaultKind::kSlow) return true;
  value.fill(kNaN);
  return false;
}

bool step_battery(FaultyOutput<BatterySample>& output, FaultKind kind, std::uint64_t cycle,
                  BatterySample& battery) noexcept {
  const auto distort = [](FaultKind how, BatterySample& distorted, FaultRandom& random) {
    if (how == FaultKind::kWrong) {
      distorted.voltage *= SensorFaults::kWrongVoltage;
    } else {
      distorted.voltage *= 2 * random.unit();
      distorted.current = random.within(SensorFaults::kGarbageCurrent);
    }
  };
  if (output.step(kind, cycle, battery, distort) == Emission::kValue || kind == FaultKind::kSlow) return true;
  battery = {.voltage = kNaN, .current = kNaN};
  return false;
}

bool pressed(FaultyOutput<bool>& button, FaultKind kind, std::uint64_t cycle) noexcept {
  bool pressed = kind == FaultKind::kStuck;
  const auto distort = [](FaultKind how, bool& value, FaultRandom& random) {
    value = how == FaultKind::kWrong || random.unit() < 0.5;
  };
  return (button.step(kind, cycle, pressed, distort) == Emission::kNothing && kind != FaultKind::kSlow) || pressed;
}

}  // namespace

SensorFaults::SensorFaults(const MachineModel& machine, std::uint64_t seed)
    : gyro_(fault_seed(seed, FaultComponent::kGyro)),
      accelerometer_(fault_seed(seed, FaultComponent::kAccelerometer)),
      battery_(fault_seed(seed, FaultComponent::kBattery)),
      button_(fault_seed(seed, FaultComponent::kEStopButton)) {
  for (const std::size_t joint : actuated_joint_indices(machine)) {
    encoders_.push_back({joint, FaultyOutput<Reading>(fault_seed(seed, FaultComponent::kEncoder, joint))});
  }
}

void SensorFaults::reset() noexcept {
  for (Encoder& encoder : encoders_) encoder.output.reset();
  gyro_.reset();
  accelerometer_.reset();
  battery_.reset();
  button_.reset();
  failing_ = false;
}

void SensorFaults::step_encoder(Encoder& encoder, FaultKind kind, std::uint64_t cycle, JointSample& joint) noexcept {
  const Reading& began = encoder.output.held();
  const auto distort = [&began](FaultKind how, Reading& distorted, FaultRandom& random) {
    if (how == FaultKind::kWrong) {
      distorted = {2 * began.position - distorted.position, -distorted.velocity};
    } else {
      distorted = {began.position + random.within(2 * std::numbers::pi), random.within(kGarbageSpeed)};
    }
  };
  Reading reading{joint.position, joint.velocity};
  const bool sampled =
      encoder.output.step(kind, cycle, reading, distort) == Emission::kValue || kind == FaultKind::kSlow;
  joint.position = sampled ? reading.position : kNaN;
  joint.velocity = sampled ? reading.velocity : kNaN;
  if (kind == FaultKind::kStuck) joint.velocity = 0;
}

std::uint64_t SensorFaults::step(const InjectedFaults& faults, std::uint64_t cycle, Measurement& measurement) noexcept {
  const bool failing = any_fault(faults);
  if (!failing && !failing_) return 0;
  failing_ = failing;
  for (Encoder& encoder : encoders_) {
    step_encoder(encoder, fault_of(faults, FaultComponent::kEncoder, encoder.joint), cycle,
                 measurement.joints[encoder.joint]);
  }
  std::uint64_t lost = 0;
  ImuSample& imu = measurement.imu;
  if (!step_axes(gyro_, fault_of(faults, FaultComponent::kGyro), cycle, kGyroRange, imu.angular_velocity)) {
    lost |= kValidGyro;
  }
  if (!step_axes(accelerometer_, fault_of(faults, FaultComponent::kAccelerometer), cycle, kAccelerometerRange,
                 imu.linear_acceleration)) {
    lost |= kValidAccelerometer;
  }
  const bool has_battery = measurement.battery.voltage > 0;
  if (has_battery && !step_battery(battery_, fault_of(faults, FaultComponent::kBattery), cycle, measurement.battery)) {
    lost |= kValidBattery;
  }
  if (pressed(button_, fault_of(faults, FaultComponent::kEStopButton), cycle)) {
    measurement.digital_inputs |= kInputEmergencyStop;
  }
  return lost;
}

}  // namespace robot_control
