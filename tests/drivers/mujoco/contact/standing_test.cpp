/// Robots that stand on more than their wheels.

#include <cmath>

#include "drivers/mujoco/plant_fixture.h"
#include "support/matchers.h"
#include "support/message_of.h"
#include "support/robots/made_robot.h"

namespace robot_control::tests {

std::string part(const std::string& name, const std::string& shape, const std::string& parent, const std::string& joint,
                 const std::string& mass = "0.5") {
  return "<link name=\"" + name + "\"><inertial><mass value=\"" + mass +
         "\"/><inertia ixx=\"0.001\" iyy=\"0.001\" izz=\"0.001\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>" + shape +
         "</link><joint name=\"" + name + "_joint\" " + joint + "<parent link=\"" + parent + "\"/><child link=\"" +
         name + "\"/></joint>";
}

std::string ball(double radius) {
  return "<collision><geometry><sphere radius=\"" + std::to_string(radius) + "\"/></geometry></collision>";
}

struct Standing : PlantTest {
  std::unique_ptr<MujocoPlant> stood(const MadeRobot& robot) {
    return started(robot.description(), kFlat, 0.001, robot.names());
  }
};

// The bumper hangs 2 cm below the wheels.
TEST_F(Standing, IsRefusedOnItsBodyWithTheWheelsInTheAir) {
  MadeRobot robot;
  robot.more = part("bumper", "<collision><geometry><box size=\"0.6 0.6 0.04\"/></geometry></collision>", "base_link",
                    "type=\"fixed\"><origin xyz=\"0 0 -0.1\"/>");
  const std::string message = message_of<DriverError>([&] { stood(robot); });
  EXPECT_THAT(message, HasSubstr("its left wheels carry no load"));
  EXPECT_THAT(message, HasSubstr("on the ground is bumper"));
}

// A suspicious entry of the description may be the reason, so the refusal quotes it.
TEST_F(Standing, ARefusalNamesWhatIsSuspiciousInTheDescription) {
  MadeRobot robot;
  robot.body_x = 0.05;
  const std::string message = message_of<DriverError>([&] { stood(robot); });
  EXPECT_THAT(message, HasSubstr(" Suspicious: <robot>: no wheel, caster or foot within 3° of the ground supports it"));
}

// A ball 0.3 m behind the axle ends 1 cm above the ground: the robot leans back on it by θ with
// 0.3 sin θ + 0.04 cos θ = 0.05. Truth says so, and that the ground is level: nothing sinks as it drives.
TEST_F(Standing, LeaningBackIsInTheTruthAndTheGroundStaysLevel) {
  MadeRobot robot;
  robot.body_x = -0.1;
  robot.more = part("skid", ball(0.05), "base_link", "type=\"fixed\"><origin xyz=\"-0.3 0 -0.04\"/>");
  auto plant = stood(robot);
  const double lean = std::asin(0.05 / std::hypot(0.3, 0.04)) - std::atan2(0.04, 0.3);
  const TruthFrame rest = truth(*plant);
  EXPECT_EQ(rest.pose_world.position, Vector3{});
  EXPECT_NEAR(rest.pose_world.orientation[1], -std::sin(lean / 2), 1e-4);  // the contact gives way by micrometres
  speed_up(*plant, 5, 5);
  const TruthFrame driven = truth(*plant);
  EXPECT_GT(driven.pose_world.position[0], 0.5);
  EXPECT_NEAR(driven.pose_world.position[2], 0, 1e-4);
}

// A pendulum without friction never comes to rest; the robot below it does.
TEST_F(Standing, IsAllowedWhileSomethingOnItSwings) {
  MadeRobot robot;
  robot.axles = {0.2, -0.2};
  robot.more = part("pendulum", "", "base_link",
                    "type=\"continuous\"><origin xyz=\"0 0 0.3\" rpy=\"1.2 0 0\"/><axis xyz=\"0 0 1\"/>", "0.001");
  EXPECT_NO_THROW(stood(robot));
}

// Half of the weight is on a rear ball 0.4 m behind the wheels, which turns about its own axle alone. If it gripped, μ
// · 60 N · 0.4 m would outweigh the wheels' 2 · μ · 30 N · 0.25 m. The robot must still turn at 2 r q̇/b, except for
// the creep of the tyres: less than 1 %.
TEST_F(Standing, TurnsOnABallWithoutASwivel) {
  MadeRobot robot;
  robot.body_x = -0.24;
  robot.more =
      part("ball", ball(0.05), "base_link", "type=\"continuous\"><origin xyz=\"-0.4 0 -0.05\"/><axis xyz=\"0 1 0\"/>");
  auto plant = stood(robot);
  const double speed = 2;  // rad/s of the wheels
  const std::array<JointCommand, 3> turn{velocity_command(-speed), velocity_command(speed), JointCommand{}};
  for (int i = 0; i < 2000; ++i) plant->write(turn);
  const double expected = 2 * robot.radius * speed / robot.wheel_base;
  EXPECT_NEAR(truth(*plant).twist_base.angular[2], expected, 0.01 * expected);
}

}  // namespace robot_control::tests
