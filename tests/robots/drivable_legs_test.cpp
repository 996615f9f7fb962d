/// A robot on legs that cannot stand is refused.

#include "robots/quadruped_fixture.h"
#include "support/matchers.h"
#include "support/message_of.h"

namespace robot_control::tests {

/// Returns why it is refused; empty: it is not.
std::string refusal_of(const LegModel& robot) {
  try {
    Quadruped(QuadrupedLoop::parameters(0, ErrorLevel::kIdeal), robot).require_drivable();
    return {};
  } catch (const ParameterError& error) {
    return error.what();
  }
}

TEST(Quadruped, IsRefusedAtARateAtWhichItFalls) {
  Parameters parameters = QuadrupedLoop::parameters(0, ErrorLevel::kIdeal);
  const auto refusal_at = [&](double rate) {
    parameters.loop.rate = rate;
    return message_of<ParameterError>([&] { Quadruped(parameters, legged_robot("quadbot")).require_drivable(); }, "");
  };
  EXPECT_EQ(refusal_at(100), "");
  EXPECT_THAT(refusal_at(99), HasSubstr("robot.rate = 99 Hz: a robot on legs falls below 100 Hz"));
}

TEST(Quadruped, IsRefusedIfItsLegsDoNotReachTheGround) {
  LegModel robot = legged_robot("quadbot");
  robot.legs[0].foot_radius = -10;
  EXPECT_THAT(refusal_of(robot), HasSubstr("does not reach the ground while the robot stands 0.3 m above"));
}

TEST(Quadruped, IsRefusedIfItsKneeDoesNotBearATrot) {
  LegModel robot = legged_robot("quadbot");
  const double needs = 12.7 * 9.81 / 2 * 0.213 * std::sin(std::acos(2 * 0.85 * 0.85 - 1)) / (2 * 0.85);  // N·m
  robot.joints[8].effort_limit = needs / 0.64;
  EXPECT_EQ(refusal_of(robot), "");
  robot.joints[8].effort_limit = needs / 0.66;
  EXPECT_THAT(refusal_of(robot),
              HasSubstr("the knee rear_left_knee_joint needs 6.99 N·m for half of the weight, as in a trot: "
                        "0.66 of its effort limit, at most 0.65. Give"));
}

}  // namespace robot_control::tests
