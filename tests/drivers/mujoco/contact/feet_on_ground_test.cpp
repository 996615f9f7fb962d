/// Robots on feet whose lowest points differ from those of the wheels.

#include <random>

#include "drivers/mujoco/plant_fixture.h"
#include "support/matchers.h"
#include "support/message_of.h"
#include "support/robots/made_robot.h"

namespace robot_control::tests {

struct FeetOnGround : PlantTest {
  /// Balls of 3 cm before and behind the wheels that end `gap` m above them.
  static MadeRobot on_balls(double front, double back, double x = 0.3) {
    MadeRobot robot;
    for (const bool first : {true, false}) {
      const double gap = first ? front : back;
      std::ostringstream text;
      text.precision(12);
      const std::string name = first ? "front_caster" : "back_caster";
      text << "<link name=\"" << name
           << "\"><collision><geometry><sphere radius=\"0.03\"/></geometry></collision></link>"
           << "<joint name=\"" << name << "_joint\" type=\"fixed\"><parent link=\"base_link\"/><child link=\"" << name
           << "\"/><origin xyz=\"" << (first ? x : -x) << " 0 " << -0.07 + gap << "\"/></joint>";
      robot.more += text.str();
    }
    return robot;
  }
  std::unique_ptr<MujocoPlant> stood(const MadeRobot& robot) {
    return started(robot.description(), kFlat, 0.001, robot.names());
  }
};

TEST_F(FeetOnGround, CastersWithinAMillimetreOfTheWheelsLetThemDrive) {
  std::uniform_real_distribution<double> uniform(-0.001, 0.001);
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const double front = seed == 0 ? -0.00005 : uniform(random), back = seed == 0 ? -0.00005 : uniform(random);
    auto plant = stood(on_balls(front, back));
    const TruthFrame rest = truth(*plant);
    EXPECT_GT(rest.normal_force[0], 10);
    EXPECT_GT(rest.normal_force[1], 10);
    speed_up(*plant, 3, 3);
    EXPECT_NEAR(truth(*plant).twist_base.linear[0], 0.3, 0.006);
  }
}

TEST_F(FeetOnGround, CastersFartherBelowAreNamedInTheRefusal) {
  const std::string message = message_of<DriverError>([&] { stood(on_balls(-0.003, -0.003)); });
  EXPECT_THAT(message, AllOf(HasSubstr("wheels carry no load"), HasSubstr("front_caster"), HasSubstr("back_caster")));
}

/// Two casters of 4 cm on swivels, before and behind, `gap` m above the wheels' lowest points.
std::string swivelling(const std::string& name, double x, double gap) {
  std::ostringstream text;
  text.precision(12);
  const std::string inertia =
      "<inertial><mass value=\"0.2\"/><inertia ixx=\"2e-4\" iyy=\"2e-4\" izz=\"2e-4\" ixy=\"0\" ixz=\"0\" "
      "iyz=\"0\"/></inertial>";
  text << "<link name=\"" << name << "_fork\">" << inertia << "</link><joint name=\"" << name
       << "_swivel\" type=\"continuous\"><parent link=\"base_link\"/><child link=\"" << name
       << "_fork\"/><origin xyz=\"" << x << " 0 0\"/><axis xyz=\"0 0 1\"/></joint><link name=\"" << name << "_wheel\">"
       << inertia
       << "<collision><origin rpy=\"1.5707963267948966 0 0\"/><geometry><cylinder radius=\"0.04\" "
          "length=\"0.02\"/></geometry></collision></link>"
       << "<joint name=\"" << name << "_roll\" type=\"continuous\"><parent link=\"" << name << "_fork\"/><child link=\""
       << name << "_wheel\"/><origin xyz=\"-0.02 0 " << -0.06 + gap << "\"/><axis xyz=\"0 1 0\"/></joint>";
  return text.str();
}

TEST_F(FeetOnGround, RollingCastersThatLiftTheWheelsAreNamedInTheRefusal) {
  MadeRobot robot;
  robot.more = swivelling("front", 0.3, -0.003) + swivelling("back", -0.3, -0.003);
  const std::string message = message_of<DriverError>([&] { stood(robot); });
  EXPECT_THAT(message, AllOf(HasSubstr("wheels carry no load"), HasSubstr("front_wheel"), HasSubstr("back_wheel")));
}

TEST_F(FeetOnGround, AFootprintBoxDoesNotLiftTheWheels) {
  MadeRobot robot = on_balls(0, 0);
  robot.more +=
      "<link name=\"base_footprint\"><collision><geometry><box size=\"0.3 0.3 0.01\"/></geometry></collision></link>"
      "<joint name=\"down\" type=\"fixed\"><parent link=\"base_link\"/><child link=\"base_footprint\"/><origin xyz=\"0 "
      "0 -0.1\"/></joint>";
  EXPECT_GT(truth(*stood(robot)).normal_force[0], 10);
}

}  // namespace robot_control::tests
