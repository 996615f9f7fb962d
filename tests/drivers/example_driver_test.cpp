#include "drivers/example/example_driver.h"

#include <gtest/gtest.h>

#include <limits>

#include "drivers/example_machine.h"

namespace robot_control {
namespace {

/// The healthy machine, turning at 0.1 N·m.
class ExampleDriverTest : public testing::Test {
 protected:
  void SetUp() override {
    machine_.start();
    cycles(100);
  }

  SensorFrame cycles(int count) {
    SensorFrame frame;
    for (int i = 0; i < count; ++i) {
      machine_.read(frame);
      machine_.write(commands_);
    }
    return frame;
  }

  ExampleMachine machine_;
  const std::array<JointCommand, 2> commands_{JointCommand{.mode = JointMode::kEffort, .effort = 0.1},
                                              JointCommand{.mode = JointMode::kEffort, .effort = 0.1}};
};

TEST_F(ExampleDriverTest, ThreeLateReportsAreBorneTheFourthIsAFault) {
  machine_.board().inject("board", "off");
  const SensorFrame late = cycles(4);  // the report of the last cycle still comes
  EXPECT_EQ(late.faults, 0u);
  EXPECT_EQ(late.joints[1].age_ns, 3'000'000);
  const SensorFrame frame = cycles(1);
  EXPECT_EQ(frame.faults, kFaultLink);
  EXPECT_EQ(frame.driver_state, DriverState::kFault);
  EXPECT_EQ(frame.joints[0].valid, 0u);
}

TEST_F(ExampleDriverTest, AFaultStaysUntilTheReset) {
  machine_.board().inject("board", "fault");
  EXPECT_EQ(cycles(2).faults, kFaultDrive);
  machine_.board().inject("board", "ok");
  EXPECT_EQ(cycles(100).driver_state, DriverState::kFault);
  machine_.reset();
  EXPECT_EQ(cycles(100).driver_state, DriverState::kRunning);
}

TEST_F(ExampleDriverTest, ANumberThatIsNotFiniteIsAFault) {
  machine_.joints[0].position = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(cycles(2).faults, kFaultNotFinite);
}

TEST_F(ExampleDriverTest, ABoardThatIsOffIsAwaited) {
  ExampleMachine machine;
  machine.board().inject("board", "off");
  machine.start();
  SensorFrame frame;
  machine.read(frame);
  EXPECT_EQ(frame.driver_state, DriverState::kStarting);
  EXPECT_NE(machine.warning().find("no report"), std::string::npos);
}

TEST_F(ExampleDriverTest, TheBoardBrakesWhenItsDriverIsSilent) {
  cycles(400);
  ASSERT_GT(machine_.joints[0].velocity, 3);
  for (int i = 0; i < 500; ++i) machine_.run_board();
  EXPECT_NEAR(machine_.joints[0].velocity, 0, 0.05);  // rad/s: it stands
}

}  // namespace
}  // namespace robot_control
