/// The voltage under load, from the law alone and in the plant.

#include "drivers/mujoco/motors/battery.h"

#include "drivers/mujoco/plant_fixture.h"
#include "support/message_of.h"

namespace robot_control::tests {

constexpr double kVoltage = 24, kResistance = 0.5;
constexpr double kVoltRounding = 1e-12;

TEST(Battery, IdlesJustBelowItsOpenVoltage) {
  const BatterySample idle = battery_under_load(kVoltage, kResistance, 0);
  EXPECT_NEAR(idle.voltage, kVoltage - kResistance * kIdleCurrent, kVoltRounding);
  EXPECT_NEAR(idle.current, kIdleCurrent, kVoltRounding);
}

TEST(Battery, SagsByItsResistanceTimesItsCurrent) {
  for (const double power : {-50.0, 1.0, 100.0, 250.0}) {
    const BatterySample sample = battery_under_load(kVoltage, kResistance, power);
    EXPECT_NEAR(sample.voltage, kVoltage - kResistance * sample.current, 1e-9);
    EXPECT_NEAR(sample.voltage * (sample.current - kIdleCurrent), power, 1e-9);
  }
}

TEST(Battery, IsChargedByMotorsThatBrake) {
  EXPECT_LT(battery_under_load(kVoltage, kResistance, -100).current, 0);
  EXPECT_GT(battery_under_load(kVoltage, kResistance, -100).voltage, kVoltage);
}

TEST(Battery, KeepsItsVoltageWithoutResistance) {
  EXPECT_NEAR(battery_under_load(kVoltage, 0, 1000).voltage, kVoltage, kVoltRounding);
}

TEST(Battery, GivesHalfItsVoltageAtItsGreatestPowerAndBeyond) {
  const double half = (kVoltage - kResistance * kIdleCurrent) / 2;
  EXPECT_NEAR(battery_under_load(kVoltage, kResistance, half * half / kResistance).voltage, half, 1e-6);
  EXPECT_NEAR(battery_under_load(kVoltage, kResistance, 1e6).voltage, half, kVoltRounding);
}

struct BatteryOfThePlant : PlantTest {
  BatteryOfThePlant() {
    parameters_.scene = kFlat;
    parameters_.sensor_errors = ErrorLevel::kIdeal;
    parameters_.battery_voltage = kVoltage;
    parameters_.battery_resistance = kResistance;
  }
  std::unique_ptr<MujocoPlant> fed() const {
    auto plant = std::make_unique<MujocoPlant>(read_drive_train(diffbot_urdf(), {}), parameters_, period_);
    plant->start();
    return plant;
  }

  MujocoPlantParameters parameters_;
};

TEST_F(BatteryOfThePlant, IsReported) {
  const SensorFrame frame = sensors(*fed());
  EXPECT_NE(frame.valid & kValidBattery, 0u);
  EXPECT_NEAR(frame.battery_voltage, kVoltage - kResistance * kIdleCurrent, 1e-6);
}

// Both wheels at 5 rad/s with 1 N·m each: 10 W.
TEST_F(BatteryOfThePlant, FeedsTheMechanicalPowerOfTheWheels) {
  auto plant = fed();
  for (int i = 0; i < 1000; ++i) {
    const double speed = truth(*plant).joints[0].velocity;
    plant->write(both(effort_command(1), effort_command(1)));
    const SensorFrame frame = sensors(*plant);
    // The bound is the difference between the two wheels, and within a period: 1 N·m · 0.1 rad/s.
    ASSERT_NEAR((frame.battery_current - kIdleCurrent) * frame.battery_voltage, 2 * speed, 0.1);
  }
  EXPECT_GT(truth(*plant).joints[0].velocity, 5);
}

TEST_F(BatteryOfThePlant, IsRefusedWithMoreResistanceThanItsVoltageBears) {
  parameters_.battery_resistance = 25;
  const std::string message = message_of<DriverError>([&] { fed(); });
  EXPECT_NE(message.find("battery_resistance is 25 ohm"), std::string::npos) << message;
  EXPECT_NE(message.find("more than 24 ohm"), std::string::npos) << message;
}

}  // namespace robot_control::tests
