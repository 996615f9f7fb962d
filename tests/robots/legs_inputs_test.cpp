/// Bad inputs to a robot on legs: it refuses them with the reason, or walks on as before.

#include "control/legged/walk/gait_table.h"
#include "robots/quadruped_fixture.h"

namespace robot_control::tests {

TEST(LegsInputs, AnUnknownGaitMovesNothing) {
  for (const Mode& mode : {Mode{ModeKind::kGait, kStandGait}, Mode{ModeKind::kGait, kGaits.size()},
                           Mode{ModeKind::kLift, kLegs}, Mode{static_cast<ModeKind>(6)}}) {
    QuadrupedLoop robot = loop_of("quadbot");
    robot.run(1.0, walk(0.5, 0, 0, mode));
    EXPECT_EQ(robot.command().legged.phase, LegPhase::kLying) << mode.index;
    EXPECT_NE(robot.command().reasons & kReasonPartIgnored, 0u) << mode.index;
  }
}

TEST(LegsInputs, ATwistThatIsNotFiniteEndsTheWalk) {
  QuadrupedLoop robot = walking();
  robot.run(1.5, walk(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_NE(robot.command().reasons & kReasonRefused, 0u);
  EXPECT_EQ(robot.command().legged.phase, LegPhase::kStanding);
  EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
}

TEST(LegsInputs, ATwistBeyondEveryLimitIsLimited) {
  QuadrupedLoop robot = walking();
  Request request = walk(1e9);
  request.twist.linear[1] = -1e9;
  request.twist.angular[2] = 1e9;
  robot.run(2.0, request);
  EXPECT_NE(robot.command().reasons & (std::uint64_t{kReasonSpeedLimited} | kReasonLegSpeed), 0u);
  EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
}

TEST(LegsInputs, GaitsThatSwitchInEveryCycleDoNotStopTheWalk) {
  QuadrupedLoop robot = walking();
  for (std::uint64_t k = 0; k < 2000; ++k) {
    robot.loop.request(walk(0.3, 0, 0, {ModeKind::kGait, 1 + k % 3}));
    robot.step();
  }
  EXPECT_EQ(robot.command().legged.phase, LegPhase::kWalking);
  EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
  EXPECT_LT(robot.tilt, 0.2);
}

TEST(LegsInputs, NothingThatNeverTimesOutMovesAnythingAfterAStopAndItsReset) {
  Request joints = stance({ModeKind::kJoints});
  joints.joints.fill(0.1);
  for (const Request& request : {stance({ModeKind::kStand}), walk(0.3), joints}) {
    Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kIdeal);
    parameters.leg_control.request_timeout = 0;
    QuadrupedLoop robot = loop_of(parameters);
    robot.run(1.0, request);
    robot.fold();
    for (int seconds = 0; seconds < 3; ++seconds) {
      robot.loop.e_stop_reset();
      robot.wait(1.0);
      EXPECT_EQ(robot.gate().verdict, GateVerdict::kBrake) << static_cast<int>(request.mode.kind);
      EXPECT_EQ(robot.command().legged.phase, LegPhase::kLying) << static_cast<int>(request.mode.kind);
    }
    robot.loop.command({});
    robot.wait(0.1);
    robot.loop.e_stop_reset();
    robot.wait(1.0);
    EXPECT_EQ(robot.permit().causes, 0u) << robot.causes();
    EXPECT_EQ(robot.command().legged.phase, LegPhase::kLying) << static_cast<int>(request.mode.kind);
  }
}

}  // namespace robot_control::tests
