/// One driver on two CAN buses.

#include <filesystem>

#include "drivers/table/drive_machine.h"
#include "support/matchers.h"

namespace robot_control::tests {

constexpr const char* kFile = R"(
bus: {dialect: odrive, address: can7}
every_joint: {torque_constant: 0.1, torque_limit: 3, velocity_limit: 30, on_silence: coasts, node: 5}
left_joint: {bus: can8}
right_joint: {direction: -1}
)";

struct TwoBuses : testing::Test {
  TwoBuses() {
    std::ofstream(path_) << kFile;
    machine_.emplace(path_, "can", false);
    std::filesystem::remove(path_);
    machine_->start();
  }

  std::string path_ = testing::TempDir() + "two_buses.yaml";
  std::optional<DriveMachine> machine_;
  const JointCommand drive_{.mode = JointMode::kVelocity, .velocity = 5, .damping = 0.2};
};

TEST_F(TwoBuses, MoveTheJointsOfEqualNodes) {
  const SensorFrame& frame = machine_->cycles(1000, drive_);
  ASSERT_EQ(frame.driver_state, DriverState::kRunning) << machine_->warning();
  EXPECT_NEAR(frame.joints[0].velocity, 5, 0.2);
  EXPECT_NEAR(frame.joints[1].velocity, 5, 0.2);
  ASSERT_EQ(frame.link_count, 2u);
  EXPECT_EQ(frame.links[0].state, LinkState::kUp);
  EXPECT_EQ(frame.links[1].state, LinkState::kUp);
  EXPECT_THAT(machine_->description(), HasSubstr("on can8, can7 at 1000 kbit/s"));
}

TEST_F(TwoBuses, ABusThatGoesIsNamedAndTheJointOfTheOtherBusBrakes) {
  machine_->cycles(1000, drive_);
  ASSERT_EQ(machine_->board().inject("can8", "off"), "");
  const SensorFrame& frame = machine_->cycles(1000, drive_);
  EXPECT_EQ(frame.driver_state, DriverState::kFault);
  EXPECT_EQ(frame.faults, std::uint64_t{kFaultLink});
  EXPECT_EQ(frame.links[0].state, LinkState::kDown);
  EXPECT_EQ(frame.links[1].state, LinkState::kUp);
  EXPECT_NEAR(frame.joints[1].velocity, 0, 0.05);
  EXPECT_THAT(machine_->warning(), AllOf(HasSubstr("can8, the bus: no frame was received"),
                                         HasSubstr("left_joint (node 5): fault; the drive is silent")));
}

TEST_F(TwoBuses, AnUnknownComponentIsAnsweredWithTheList) {
  EXPECT_THAT(machine_->board().inject("can9", "off"), HasSubstr("component must be bus, can8, can7 (with ok, off,"));
}

}  // namespace robot_control::tests
