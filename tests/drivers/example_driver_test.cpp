#include "drivers/example_driver.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "drivers/ideal_drive.h"

namespace robot_control {
namespace {

/// The healthy machine, turning at 1 N·m.
class ExampleDriverTest : public testing::Test {
 protected:
  void SetUp() override {
    machine_.driver->start();
    cycles(100);
  }

  SensorFrame cycles(int count) {
    SensorFrame frame;
    for (int i = 0; i < count; ++i) {
      machine_.driver->read(frame);
      machine_.driver->write(commands_);
    }
    return frame;
  }

  ExampleMachine machine_ = example_machine();
  const std::array<JointCommand, 2> commands_{JointCommand{.mode = JointMode::kEffort, .effort = 0.1},
                                              JointCommand{.mode = JointMode::kEffort, .effort = 0.1}};
};

TEST_F(ExampleDriverTest, ThreeLateStatusesAreBorneTheFourthIsAFault) {
  machine_.drives[1]->silent = true;
  const SensorFrame late = cycles(3);
  EXPECT_EQ(late.faults, 0u);
  EXPECT_EQ(late.joints[0].age_ns, 0);
  EXPECT_EQ(late.joints[1].age_ns, 3'000'000);
  const SensorFrame frame = cycles(1);
  EXPECT_EQ(frame.faults, kFaultLink);
  EXPECT_EQ(frame.driver_state, DriverState::kFault);
  EXPECT_EQ(frame.joints[0].valid, 0u);
}

TEST_F(ExampleDriverTest, AFaultBrakesEveryJointUntilTheNextStart) {
  machine_.drives[0]->joint.fault = 0x40;
  const SensorFrame frame = cycles(1);
  EXPECT_EQ(frame.faults, kFaultDrive);
  EXPECT_EQ(frame.joints[0].fault, 0x40u);
  EXPECT_EQ(frame.joints[1].fault, 0u);
  machine_.drives[0]->joint.fault = 0;
  cycles(1000);
  EXPECT_LT(std::abs(machine_.drives[1]->joint.velocity), 0.05);
  machine_.driver->start();
  EXPECT_EQ(cycles(100).faults, 0u);
  EXPECT_GT(machine_.drives[1]->joint.velocity, 0.5);
}

TEST_F(ExampleDriverTest, ASampleThatIsNotFiniteIsAFaultAndTheLastGoodOneStays) {
  const double before = cycles(1).joints[0].position;
  machine_.drives[0]->joint.position = std::numeric_limits<double>::quiet_NaN();
  const SensorFrame frame = cycles(1);
  EXPECT_EQ(frame.faults, kFaultNotFinite);
  EXPECT_EQ(frame.joints[0].position, before);
}

TEST_F(ExampleDriverTest, ASilentDriveIsNamedAtTheStart) {
  machine_.drives[1]->silent = true;
  try {
    machine_.driver->start();
    FAIL() << "started without the drive of joint 1";
  } catch (const DriverError& error) {
    EXPECT_NE(std::string(error.what()).find("joint 1"), std::string::npos);
  }
}

}  // namespace
}  // namespace robot_control
