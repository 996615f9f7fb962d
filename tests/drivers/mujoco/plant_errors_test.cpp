/// Checks where the plant's errors, delays and faults act between state and `read`, and between command and torque.

#include <cmath>
#include <cstring>

#include "drivers/mujoco/plant_fixture.h"
#include "support/allocation_guard.h"

namespace robot_control::tests {

struct PlantErrors : PlantTest {
  PlantErrors() {
    parameters_.scene = kFlat;
    parameters_.sensor_errors = ErrorLevel::kDataSheet;
  }

  std::unique_ptr<MujocoPlant> erring() const {
    auto plant = std::make_unique<MujocoPlant>(read_drive_train(diffbot_urdf(), {}), parameters_, period_);
    plant->start();
    return plant;
  }

  static void inject(MujocoPlant& plant, FaultComponent component, FaultKind kind) {
    plant.inject({{{.component = component, .kind = kind}}});
  }

  /// Runs one cycle; returns the frame read before it.
  SensorFrame cycle(MujocoPlant& plant, const std::array<JointCommand, 2>& commands) const {
    const SensorFrame frame = sensors(plant);
    plant.write(commands);
    return frame;
  }

  static bool same_bits(const SensorFrame& one, const SensorFrame& two) {
    return std::memcmp(&one, &two, sizeof(SensorFrame)) == 0;
  }

  MujocoPlantParameters parameters_;
};

TEST_F(PlantErrors, TruthStandsBeforeThem) {
  auto erring_plant = erring();
  auto exact_plant = started();
  for (int i = 0; i < 500; ++i) {
    erring_plant->write(both(effort_command(0.3), effort_command(0.2)));
    exact_plant->write(both(effort_command(0.3), effort_command(0.2)));
  }
  const TruthFrame erring_truth = truth(*erring_plant), exact_truth = truth(*exact_plant);
  EXPECT_EQ(std::memcmp(&erring_truth, &exact_truth, sizeof(TruthFrame)), 0);
  const SensorFrame seen = sensors(*erring_plant);
  EXPECT_NE(seen.joints[0].position, erring_truth.joints[0].position);
  EXPECT_NEAR(seen.joints[0].position, erring_truth.joints[0].position, M_PI / 4096);
  EXPECT_EQ(seen.joints[0].effort, erring_truth.joints[0].effort);
}

TEST_F(PlantErrors, AreTheSameBitsForTheSameSeedAndAfterAnotherStart) {
  parameters_.seed = 11;
  auto first = erring(), second = erring();
  std::vector<SensorFrame> frames;
  for (int i = 0; i < 200; ++i) frames.push_back(cycle(*first, both(effort_command(0.3), effort_command(0.2))));
  for (const SensorFrame& frame : frames) {
    EXPECT_TRUE(same_bits(frame, cycle(*second, both(effort_command(0.3), effort_command(0.2)))));
  }
  first->start();
  for (const SensorFrame& frame : frames) {
    EXPECT_TRUE(same_bits(frame, cycle(*first, both(effort_command(0.3), effort_command(0.2)))));
  }
}

TEST_F(PlantErrors, AreThoseOfTheCycleHoweverOftenItIsRead) {
  auto plant = erring();
  inject(*plant, FaultComponent::kGyro, FaultKind::kGarbage);
  const SensorFrame once = sensors(*plant);
  EXPECT_TRUE(same_bits(once, sensors(*plant)));
}

TEST_F(PlantErrors, MakeActuatorsLate) {
  parameters_.actuator_delay = 5;
  auto plant = erring();
  for (int k = 0; k < 20; ++k) {
    plant->write(both(effort_command(1.25), effort_command(1.25)));
    EXPECT_EQ(truth(*plant).joints[0].effort == 1.25, k >= 5) << k << ": until the first command comes, brakes hold";
  }
}

TEST_F(PlantErrors, DoNotKeepAStopFromTheBrakes) {
  parameters_.actuator_delay = 100;
  auto plant = erring();
  hold(*plant, both(effort_command(0.5), effort_command(0.5)), 1);
  plant->stop();
  plant->write(both(effort_command(0.5), effort_command(0.5)));
  EXPECT_LT(truth(*plant).joints[0].effort, 0);
}

TEST_F(PlantErrors, EndTheTorqueOfMotorsAtTheNoLoadSpeed) {
  parameters_.no_load_speed = 60;
  parameters_.gear_ratio = 10;
  auto plant = erring();
  hold(*plant, both(effort_command(3.5), effort_command(3.5)), 3);
  const double speed = truth(*plant).joints[0].velocity;
  // Its approach has the time constant J·ω₀/L: of the 12 kg on wheels of 0.1 m 0.065 kg·m²·6/3.5 = 0.11 s.
  EXPECT_NEAR(speed, 6, 1e-6) << "nothing else holds it back";
}

TEST_F(PlantErrors, RefuseADelayThatIsTooLong) {
  parameters_.actuator_delay = 101;
  EXPECT_THROW(erring(), DriverError);
}

TEST_F(PlantErrors, AFaultShowsFromTheNextReadOnAndInTheFrame) {
  auto plant = erring();
  EXPECT_EQ(sensors(*plant).injected, InjectedFaults{});
  plant->write(brakes_);
  inject(*plant, FaultComponent::kAccelerometer, FaultKind::kOff);
  const SensorFrame frame = sensors(*plant);
  EXPECT_EQ(frame.valid, kValidGyro);
  EXPECT_EQ(fault_of(frame.injected, FaultComponent::kAccelerometer), FaultKind::kOff);
  EXPECT_TRUE(std::isfinite(truth(*plant).twist_base.linear[0]));
}

TEST_F(PlantErrors, AStartTakesFaultsBack) {
  auto plant = erring();
  inject(*plant, FaultComponent::kGyro, FaultKind::kOff);
  sensors(*plant);
  plant->start();
  EXPECT_EQ(sensors(*plant).injected, InjectedFaults{});
  EXPECT_EQ(sensors(*plant).valid, kValidGyro | kValidAccelerometer);
}

TEST_F(PlantErrors, AnEncoderFaultIsNoFaultOfTheSimulation) {
  auto plant = erring();
  inject(*plant, FaultComponent::kEncoder, FaultKind::kOff);
  for (int i = 0; i < 10; ++i) cycle(*plant, brakes_);
  const SensorFrame frame = sensors(*plant);
  EXPECT_TRUE(std::isnan(frame.joints[0].position));
  EXPECT_EQ(frame.driver_state, DriverState::kRunning);
  EXPECT_EQ(frame.faults, 0u);
}

TEST_F(PlantErrors, ABlockedMotorStopsItsWheelWhateverTheCommand) {
  auto plant = erring();
  speed_up(*plant, 5, 5);
  inject(*plant, FaultComponent::kMotor, FaultKind::kStuck);
  hold(*plant, both(velocity_command(5), velocity_command(5)), 0.1);
  const double angle = truth(*plant).joints[0].position;
  hold(*plant, both(velocity_command(5), velocity_command(5)), 1);
  // The tyre turns the blocked rotor by at most μ N r / k; 5 N·m would be 4 mrad (motor_faults.h).
  EXPECT_NEAR(truth(*plant).joints[0].position, angle, 0.004);
  EXPECT_GT(truth(*plant).twist_base.angular[2], 0.1);
}

TEST_F(PlantErrors, ReachBatteryAndButton) {
  parameters_.battery_voltage = 24;
  parameters_.battery_resistance = 0;
  auto plant = erring();
  inject(*plant, FaultComponent::kBattery, FaultKind::kWrong);
  EXPECT_NEAR(cycle(*plant, brakes_).battery_voltage, SensorFaults::kWrongVoltage * 24, 1e-9);
  inject(*plant, FaultComponent::kBattery, FaultKind::kOff);
  EXPECT_EQ(cycle(*plant, brakes_).valid & kValidBattery, 0u);
  inject(*plant, FaultComponent::kEStopButton, FaultKind::kWrong);
  EXPECT_EQ(cycle(*plant, brakes_).digital_inputs, kInputEmergencyStop);
  inject(*plant, FaultComponent::kEStopButton, FaultKind::kOk);
  EXPECT_EQ(cycle(*plant, brakes_).digital_inputs, 0u);
}

TEST_F(PlantErrors, AreNoneOfABatteryThatIsNotThere) {
  auto plant = erring();
  inject(*plant, FaultComponent::kBattery, FaultKind::kOff);
  const SensorFrame frame = cycle(*plant, brakes_);
  EXPECT_EQ(frame.valid & kValidBattery, 0u);
  EXPECT_EQ(frame.battery_voltage, 0);
}

TEST_F(PlantErrors, NeverAllocate) {
  parameters_.actuator_delay = parameters_.sensor_delay = 20;
  auto plant = erring();
  SensorFrame frame;
  const AllocationGuard guard;
  for (std::size_t kind = 0; kind < kFaultKinds; ++kind) {
    for (std::size_t component = 0; component < kFaultComponents; ++component) {
      inject(*plant, static_cast<FaultComponent>(component), static_cast<FaultKind>(kind));
      for (int i = 0; i < 20; ++i) {
        plant->read(frame);
        plant->write(brakes_);
      }
    }
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace robot_control::tests
