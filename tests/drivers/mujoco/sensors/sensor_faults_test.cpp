/// Checks the output of every sensor under every kind of fault. In cycle k the healthy left wheel is at k mrad with k
/// mrad/s, and the right one at −k and −k. Gyro and accelerometer read (k, 2k, 3k)·10⁻³. The battery gives 24 V + k mV
/// and k mA, and the e-stop button is not pressed.

#include "drivers/mujoco/sensors/sensor_faults.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drivers/mujoco/two_wheels.h"
#include "signals/names.h"

namespace robot_control::tests {

constexpr std::uint64_t kOnset = 100;

Measurement healthy(std::uint64_t cycle) {
  const double value = 1e-3 * static_cast<double>(cycle);
  Measurement measurement;
  measurement.joints[kLeftWheel] = {.position = value, .velocity = value, .effort = 1, .temperature = 40};
  measurement.joints[kRightWheel] = {.position = -value, .velocity = -value, .effort = 2, .temperature = 41};
  measurement.joints[kSwivel] = {.position = 7, .velocity = 8};
  measurement.imu.angular_velocity = {value, 2 * value, 3 * value};
  measurement.imu.linear_acceleration = {value, 2 * value, 3 * value};
  measurement.battery = {.voltage = 24 + value, .current = value};
  return measurement;
}

struct SensorFaultsTest : testing::Test {
  /// Healthy until kOnset.
  SensorFaultsTest() {
    for (std::uint64_t cycle = 0; cycle < kOnset; ++cycle) step(FaultComponent::kGyro, FaultKind::kOk, cycle);
  }

  void step(FaultComponent component, FaultKind kind, std::uint64_t cycle, std::uint8_t index = 0) {
    const InjectedFaults faults{{{component, index, kind}}};
    seen_ = healthy(cycle);
    lost_ = faults_.step(faults, cycle, seen_);
  }

  const JointSample& left() const { return seen_.joints[kLeftWheel]; }
  const JointSample& right() const { return seen_.joints[kRightWheel]; }
  static JointSample left_at(std::uint64_t cycle) { return healthy(cycle).joints[kLeftWheel]; }
  static Vector3 axes_at(std::uint64_t cycle) { return healthy(cycle).imu.angular_velocity; }

  /// Everything but the left encoder is unchanged.
  void expect_rest_healthy(std::uint64_t cycle) const {
    const Measurement expected = healthy(cycle);
    EXPECT_EQ(right().position, expected.joints[kRightWheel].position);
    EXPECT_EQ(right().velocity, expected.joints[kRightWheel].velocity);
    EXPECT_EQ(left().effort, expected.joints[kLeftWheel].effort);
    EXPECT_EQ(left().temperature, expected.joints[kLeftWheel].temperature);
    EXPECT_EQ(seen_.joints[kSwivel].position, expected.joints[kSwivel].position);
    EXPECT_EQ(seen_.imu.angular_velocity, expected.imu.angular_velocity);
    EXPECT_EQ(seen_.imu.linear_acceleration, expected.imu.linear_acceleration);
    EXPECT_EQ(seen_.battery.voltage, expected.battery.voltage);
    EXPECT_EQ(seen_.battery.current, expected.battery.current);
    EXPECT_EQ(seen_.digital_inputs, 0u);
    EXPECT_EQ(lost_, 0u);
  }

  SensorFaults faults_{two_wheels(), 3};
  Measurement seen_;
  std::uint64_t lost_ = 0;
};

TEST_F(SensorFaultsTest, ChangeNothingWithoutAFault) {
  step(FaultComponent::kEncoder, FaultKind::kOk, kOnset);
  EXPECT_EQ(left().position, left_at(kOnset).position);
  EXPECT_EQ(left().velocity, left_at(kOnset).velocity);
  expect_rest_healthy(kOnset);
}

TEST_F(SensorFaultsTest, AnEncoderThatIsOffHasNoNumber) {
  for (std::uint64_t cycle = kOnset; cycle < kOnset + 20; ++cycle) {
    step(FaultComponent::kEncoder, FaultKind::kOff, cycle);
    EXPECT_TRUE(std::isnan(left().position));
    EXPECT_TRUE(std::isnan(left().velocity));
    expect_rest_healthy(cycle);
  }
}

TEST_F(SensorFaultsTest, AStuckEncoderStandsAtItsAngle) {
  for (std::uint64_t cycle = kOnset; cycle < kOnset + 50; ++cycle) {
    step(FaultComponent::kEncoder, FaultKind::kStuck, cycle);
    EXPECT_EQ(left().position, left_at(kOnset).position);
    EXPECT_EQ(left().velocity, 0);
    expect_rest_healthy(cycle);
  }
}

TEST_F(SensorFaultsTest, AGarbageEncoderIsAnywhereWithinATurn) {
  double lowest = 0, highest = 0;
  for (std::uint64_t cycle = kOnset; cycle < kOnset + 1000; ++cycle) {
    step(FaultComponent::kEncoder, FaultKind::kGarbage, cycle);
    const double angle = left().position - left_at(kOnset).position;
    EXPECT_LE(std::abs(angle), 2 * std::numbers::pi);
    EXPECT_LE(std::abs(left().velocity), SensorFaults::kGarbageSpeed);
    lowest = std::min(lowest, angle);
    highest = std::max(highest, angle);
    expect_rest_healthy(cycle);
  }
  // The chance that 1000 uniform numbers all miss the outer tenth at one end is 0.95¹⁰⁰⁰ = 5·10⁻²³.
  EXPECT_LT(lowest, -0.9 * 2 * std::numbers::pi);
  EXPECT_GT(highest, 0.9 * 2 * std::numbers::pi);
}

TEST_F(SensorFaultsTest, AWrongEncoderCountsBackwardsWithoutAJump) {
  for (std::uint64_t cycle = kOnset; cycle < kOnset + 50; ++cycle) {
    step(FaultComponent::kEncoder, FaultKind::kWrong, cycle);
    const double moved = left_at(cycle).position - left_at(kOnset).position;
    EXPECT_NEAR(left().position, left_at(kOnset).position - moved, 1e-15);
    EXPECT_EQ(left().velocity, -left_at(cycle).velocity);
    expect_rest_healthy(cycle);
  }
}

TEST_F(SensorFaultsTest, IsHealthyAgainAfterOk) {
  for (std::size_t component = 0; component < kFaultComponents; ++component) {
    for (std::size_t kind = 1; kind < kFaultKinds; ++kind) {
      step(static_cast<FaultComponent>(component), static_cast<FaultKind>(kind), 500);
      step(static_cast<FaultComponent>(component), FaultKind::kOk, 501);
      EXPECT_EQ(left().position, left_at(501).position);
      expect_rest_healthy(501);
    }
  }
}

TEST_F(SensorFaultsTest, EncodersFailEachForItself) {
  InjectedFaults injected{};
  set_fault(injected, {FaultComponent::kEncoder, kLeftWheel, FaultKind::kOff});
  set_fault(injected, {FaultComponent::kEncoder, kRightWheel, FaultKind::kStuck});
  Measurement seen;
  seen.joints[kRightWheel].velocity = 1;
  faults_.step(injected, 0, seen);
  EXPECT_TRUE(std::isnan(seen.joints[kLeftWheel].position));
  EXPECT_EQ(seen.joints[kRightWheel].position, 0);
  EXPECT_EQ(seen.joints[kRightWheel].velocity, 0);
}

/// Gyro and accelerometer.
struct InertialFaults : SensorFaultsTest, testing::WithParamInterface<FaultComponent> {
  bool is_gyro() const { return GetParam() == FaultComponent::kGyro; }
  const Vector3& axes() const { return is_gyro() ? seen_.imu.angular_velocity : seen_.imu.linear_acceleration; }
  const Vector3& other() const { return is_gyro() ? seen_.imu.linear_acceleration : seen_.imu.angular_velocity; }
  std::uint64_t valid_bit() const { return is_gyro() ? kValidGyro : kValidAccelerometer; }
  void inject(FaultKind kind, std::uint64_t cycle) {
    step(GetParam(), kind, cycle);
    EXPECT_EQ(other(), axes_at(cycle)) << "the other device is well";
    EXPECT_EQ(left().position, left_at(cycle).position);
  }
};

TEST_P(InertialFaults, OffIsNotValid) {
  inject(FaultKind::kOff, kOnset);
  EXPECT_EQ(lost_, valid_bit());
  for (const double axis : axes()) EXPECT_TRUE(std::isnan(axis));
}

TEST_P(InertialFaults, StuckStaysAndIsValid) {
  for (std::uint64_t cycle = kOnset; cycle < kOnset + 50; ++cycle) {
    inject(FaultKind::kStuck, cycle);
    EXPECT_EQ(axes(), axes_at(kOnset));
    EXPECT_EQ(lost_, 0u);
  }
}

TEST_P(InertialFaults, GarbageIsWithinTheRangeOfTheDevice) {
  const double range = is_gyro() ? SensorFaults::kGyroRange : SensorFaults::kAccelerometerRange;
  double square = 0;
  for (std::uint64_t cycle = kOnset; cycle < kOnset + 1000; ++cycle) {
    inject(FaultKind::kGarbage, cycle);
    for (const double axis : axes()) {
      EXPECT_LE(std::abs(axis), range);
      square += axis * axis / 3000;
    }
    EXPECT_EQ(lost_, 0u);
  }
  // Uniform within ±r: variance r²/3; that of its estimate from n is (4/45)·r⁴/n, relative deviation √(0.8/n).
  EXPECT_NEAR(square / (range * range / 3), 1, 5 * std::sqrt(0.8 / 3000));
}

TEST_P(InertialFaults, WrongHasTheOtherSign) {
  inject(FaultKind::kWrong, kOnset);
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(axes()[axis], -axes_at(kOnset)[axis]);
  EXPECT_EQ(lost_, 0u);
}

INSTANTIATE_TEST_SUITE_P(Devices, InertialFaults,
                         testing::Values(FaultComponent::kGyro, FaultComponent::kAccelerometer),
                         [](const auto& device) { return std::string(name_of(device.param)); });

struct BatteryFaults : SensorFaultsTest {
  void inject(FaultKind kind, std::uint64_t cycle) {
    step(FaultComponent::kBattery, kind, cycle);
    EXPECT_EQ(left().position, left_at(cycle).position);
    EXPECT_EQ(seen_.imu.angular_velocity, axes_at(cycle));
    EXPECT_EQ(seen_.digital_inputs, 0u);
  }
  const BatterySample& battery() const { return seen_.battery; }
  static BatterySample battery_at(std::uint64_t cycle) { return healthy(cycle).battery; }
};

TEST_F(BatteryFaults, OffIsNotValid) {
  inject(FaultKind::kOff, kOnset);
  EXPECT_EQ(lost_, kValidBattery);
  EXPECT_TRUE(std::isnan(battery().voltage));
  EXPECT_TRUE(std::isnan(battery().current));
}

TEST_F(BatteryFaults, StuckStays) {
  for (std::uint64_t cycle = kOnset; cycle < kOnset + 50; ++cycle) {
    inject(FaultKind::kStuck, cycle);
    EXPECT_EQ(battery().voltage, battery_at(kOnset).voltage);
    EXPECT_EQ(battery().current, battery_at(kOnset).current);
    EXPECT_EQ(lost_, 0u);
  }
}

TEST_F(BatteryFaults, WrongLooksEmpty) {
  inject(FaultKind::kWrong, kOnset);
  EXPECT_EQ(battery().voltage, SensorFaults::kWrongVoltage * battery_at(kOnset).voltage);
  EXPECT_EQ(battery().current, battery_at(kOnset).current);
  EXPECT_EQ(lost_, 0u);
}

TEST_F(BatteryFaults, GarbageIsAnythingUpToTwiceTheVoltage) {
  double lowest = 100, highest = 0;
  for (std::uint64_t cycle = kOnset; cycle < kOnset + 1000; ++cycle) {
    inject(FaultKind::kGarbage, cycle);
    const double part = battery().voltage / battery_at(cycle).voltage;
    lowest = std::min(lowest, part);
    highest = std::max(highest, part);
    EXPECT_GE(part, 0);
    EXPECT_LE(part, 2);
    EXPECT_LE(std::abs(battery().current), SensorFaults::kGarbageCurrent);
  }
  // As for the encoders: 1000 numbers do not all miss the outer tenth.
  EXPECT_LT(lowest, 0.2);
  EXPECT_GT(highest, 1.8);
}

struct ButtonFaults : SensorFaultsTest {
  /// Number of 500 cycles in which the button is pressed.
  int pressed(FaultKind kind) {
    int count = 0;
    for (std::uint64_t cycle = kOnset; cycle < kOnset + 500; ++cycle) {
      step(FaultComponent::kEStopButton, kind, cycle);
      count += seen_.digital_inputs == kInputEmergencyStop ? 1 : 0;
      seen_.digital_inputs = 0;
      expect_rest_healthy(cycle);
    }
    return count;
  }
};

TEST_F(ButtonFaults, PressItWhereItsWireIsCutOrItJams) {
  for (const FaultKind kind : {FaultKind::kOff, FaultKind::kStuck, FaultKind::kWrong}) EXPECT_EQ(pressed(kind), 500);
}

TEST_F(ButtonFaults, LeaveItAloneWhereTheyAreLate) {
  for (const FaultKind kind : {FaultKind::kSlow, FaultKind::kDelayed}) EXPECT_EQ(pressed(kind), 0);
}

TEST_F(ButtonFaults, PressAndReleaseItAtRandom) {
  for (const FaultKind kind : {FaultKind::kGarbage, FaultKind::kIntermittent}) {
    const int count = pressed(kind);
    EXPECT_GT(count, 50);
    EXPECT_LT(count, 450);
  }
}

}  // namespace robot_control::tests
