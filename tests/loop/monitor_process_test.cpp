/// A latched stop belongs to the robot that it stopped.

#include "loop/processes/monitor_process.h"

#include <gtest/gtest.h>

#include "cycle_fixture.h"
#include "robots/differential_drive.h"
#include "support/bus/scoped_bus.h"

namespace robot_control::tests {

struct MonitorProcessTest : testing::Test {
  MonitorProcessTest() {
    parameters_.loop.realtime = RealtimePolicy::kOff;
    robot_.name = "the one";
  }

  /// A monitor of this robot leaves a latched stop.
  void stop(const DriveTrain& robot) {
    MonitorProcess(parameters_, DifferentialDrive(parameters_, robot), bus_.name());
    Permit permit;
    permit.head.run = 5;
    permit.causes = permit.first_cause = kCauseStall;
    Output<Permit>(bus_.name(), ChannelNames::kPermit).writer.publish(permit);
  }

  bool stopped_at_start(const DriveTrain& robot) {
    return !MonitorProcess(parameters_, DifferentialDrive(parameters_, robot), bus_.name()).restored().empty();
  }

  Parameters parameters_;
  DriveTrain robot_ = two_wheels();
  ScopedBus bus_;
};

TEST_F(MonitorProcessTest, RestoresTheStopOfItsRobotWhateverItsSizes) {
  stop(robot_);
  robot_.hash += 1;
  robot_.mass += 1;
  EXPECT_TRUE(stopped_at_start(robot_));
}

TEST_F(MonitorProcessTest, DoesNotRestoreTheStopOfARobotOfAnotherName) {
  stop(robot_);
  robot_.name = "the next one";
  EXPECT_FALSE(stopped_at_start(robot_));
  EXPECT_FALSE(stopped_at_start(robot_)) << "and not at its next start";
}

TEST_F(MonitorProcessTest, DoesNotRestoreTheStopOfARobotWithOtherJoints) {
  stop(robot_);
  robot_.joints[0].name = "port_joint";
  EXPECT_FALSE(stopped_at_start(robot_));
}

}  // namespace robot_control::tests
