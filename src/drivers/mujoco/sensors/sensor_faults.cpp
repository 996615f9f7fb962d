#include "drivers/mujoco/sensors/sensor_faults.h"

#include <limits>
#include <numbers>

#include "drivers/mujoco/motors/wheel_joints.h"

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

SensorFaults::SensorFaults(const DriveTrain& robot, std::uint64_t seed)
    : left_{wheel_joints(robot, Side::kLeft), FaultyOutput<Readings>(fault_seed(seed, FaultComponent::kLeftEncoder))},
      right_{wheel_joints(robot, Side::kRight),
             FaultyOutput<Readings>(fault_seed(seed, FaultComponent::kRightEncoder))},
      gyro_(fault_seed(seed, FaultComponent::kGyro)),
      accelerometer_(fault_seed(seed, FaultComponent::kAccelerometer)),
      battery_(fault_seed(seed, FaultComponent::kBattery)),
      button_(fault_seed(seed, FaultComponent::kEStopButton)) {}

void SensorFaults::reset() noexcept {
  left_.output.reset();
  right_.output.reset();
  gyro_.reset();
  accelerometer_.reset();
  battery_.reset();
  button_.reset();
  failing_ = false;
}

void SensorFaults::step_encoders(Encoders& encoders, FaultKind kind, std::uint64_t cycle,
                                 Measurement& measurement) noexcept {
  Readings readings{};
  for (std::size_t i = 0; i < encoders.joints.size(); ++i) {
    const JointSample& joint = measurement.joints[encoders.joints[i]];
    readings[i] = {joint.position, joint.velocity};
  }
  const Readings& began = encoders.output.held();
  const auto distort = [&began](FaultKind how, Readings& distorted, FaultRandom& random) {
    for (std::size_t i = 0; i < distorted.size(); ++i) {
      if (how == FaultKind::kWrong) {
        distorted[i] = {2 * began[i].position - distorted[i].position, -distorted[i].velocity};
      } else {
        distorted[i] = {began[i].position + random.within(2 * std::numbers::pi), random.within(kGarbageSpeed)};
      }
    }
  };
  const bool sampled =
      encoders.output.step(kind, cycle, readings, distort) == Emission::kValue || kind == FaultKind::kSlow;
  for (std::size_t i = 0; i < encoders.joints.size(); ++i) {
    JointSample& joint = measurement.joints[encoders.joints[i]];
    joint.position = sampled ? readings[i].position : kNaN;
    joint.velocity = sampled ? readings[i].velocity : kNaN;
    if (kind == FaultKind::kStuck) joint.velocity = 0;
  }
}

std::uint64_t SensorFaults::step(const InjectedFaults& faults, std::uint64_t cycle, Measurement& measurement) noexcept {
  const bool failing = faults != InjectedFaults{};
  if (!failing && !failing_) return 0;
  failing_ = failing;
  step_encoders(left_, fault_of(faults, FaultComponent::kLeftEncoder), cycle, measurement);
  step_encoders(right_, fault_of(faults, FaultComponent::kRightEncoder), cycle, measurement);
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
