/// Parts that end at the height of the wheels, or almost.

#include <cmath>

#include "machine/bodies/rigid_bodies.h"
#include "machine/random_text.h"
#include "machine/urdf_text.h"
#include "support/matchers.h"

namespace robot_control::tests {

constexpr double kFloor = -0.1;  // m, of two_wheels()

/// A ball on the body that ends `gap` m above where the wheels do.
std::string ball(const std::string& name, double x, double y, double radius, double gap) {
  const std::string shape = collision("<sphere radius=\"" + metres(radius) + "\"/>");
  return link(name, inertial("0.1") + shape) + joint({.name = name + "_joint",
                                                      .child = name,
                                                      .xyz = xyz(x, y, kFloor + radius + gap),
                                                      .type = "fixed",
                                                      .axis = ""});
}

/// m: lowest point of the shapes of `link`.
double end_of(const DriveTrain& robot, const std::string& link) {
  double end = std::numeric_limits<double>::infinity();
  for (const RigidBody& body : robot.bodies->bodies) {
    for (const Shape& shape : body.shapes) {
      if (shape.link == link) end = std::min(end, (body.in_root * shape.in_body).translation().z() - shape.radius);
    }
  }
  return end;
}

TEST(Feet, AreLevelledWithANoteWithinAMillimetre) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const double gap = (toss(random) ? 1 : -1) * between(random, 2e-6, 0.00098);
    const double radius = between(random, 0.01, 0.05), x = between(random, 0.1, 0.3);
    const DriveTrain robot = read_drive_train(
        robot_of(two_wheels() + ball("front", x, 0, radius, gap) + ball("back", -x, 0.05, radius, -gap / 2)), {});
    EXPECT_NEAR(end_of(robot, "front"), kFloor, 1e-9);
    EXPECT_NEAR(end_of(robot, "back"), kFloor, 1e-9);
    EXPECT_THAT(notes_of(robot, RobotNote::Kind::kAssumed),
                AllOf(HasSubstr("<link name=\"front\">"), HasSubstr("level")));
  }
}

TEST(Feet, FartherOffStandAsDrawn) {
  for (const double gap : {-0.002, -0.0011, 0.0011, 0.002}) {
    const DriveTrain robot = read_drive_train(robot_of(two_wheels() + ball("front", 0.2, 0, 0.03, gap)), {});
    EXPECT_NEAR(end_of(robot, "front"), kFloor + gap, 1e-9) << gap;
    EXPECT_THAT(notes_of(robot, RobotNote::Kind::kAssumed), Not(HasSubstr("level with"))) << gap;
  }
}

TEST(Feet, CastersThatRollAreLevelledToo) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const double gap = (toss(random) ? 1 : -1) * between(random, 2e-6, 0.00098);
    const std::string swivel =
        link("fork", inertial("0.2")) +
        joint({.name = "swivel", .child = "fork", .xyz = "-0.3 0 0", .axis = "<axis xyz=\"0 0 1\"/>"}) +
        link("roller", inertial("0.2") + tyre("0.04")) +
        joint({.name = "caster", .child = "roller", .xyz = xyz(-0.02, 0, kFloor + 0.04 + gap), .parent = "fork"});
    const DriveTrain robot = read_drive_train(robot_of(two_wheels() + swivel), {});
    ASSERT_EQ(robot.casters.size(), 1u);
    EXPECT_NEAR(robot.casters[0].centre_base[2] - robot.casters[0].radius, kFloor, 1e-9);
    EXPECT_NEAR(robot.bodies->moved_by("caster")->in_root.translation().z() - 0.04, kFloor, 1e-9);
  }
}

/// A footprint link below the base whose box lies on the floor, in it, or through it.
std::string on_footprint(Random& random, const std::string& link_name) {
  const double thickness = between(random, 0.001, 0.018);
  const double along = std::max(3 * thickness, between(random, 0.02, 0.5)),
               across = std::max(3 * thickness, between(random, 0.02, 0.4));
  const double centre = (static_cast<double>(below(random, 3)) - 1) * thickness / 2;
  return link(link_name, collision("<box size=\"" + xyz(along, across, thickness) + "\"/>",
                                   "xyz=\"" + xyz(between(random, -0.3, 0.3) * along, 0, centre) + "\""));
}

TEST(Feet, AThinBoxOnTheFootprintAtFloorHeightIsNoPart) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const std::string name = seed % 2 == 0 ? "base_footprint" : "robot_footprint_link";
    const bool is_root = toss(random);
    std::string text = two_wheels() + on_footprint(random, name);
    text +=
        is_root
            ? joint({.name = "up", .child = "base_link", .xyz = "0 0 0.1", .type = "fixed", .axis = "", .parent = name})
            : joint({.name = "down", .child = name, .xyz = "0 0 -0.1", .type = "fixed", .axis = ""});
    const DriveTrain robot = read_drive_train(robot_of(text), {});
    EXPECT_TRUE(std::isinf(end_of(robot, name)));
    EXPECT_THAT(notes_of(robot, RobotNote::Kind::kIgnored), AllOf(HasSubstr(name), HasSubstr("footprint")));
  }
}

// The kobuki's is an example: it has nothing but the chassis there.
TEST(Feet, StayIfTheyAreAFootprintThatCarriesTheRobot) {
  const std::string skid = collision("<sphere radius=\"0.01\"/>", "xyz=\"0.2 0 0.01\"");
  const std::string text = two_wheels() + link("base_footprint", skid) +
                           joint({.name = "up",
                                  .child = "base_link",
                                  .xyz = "0 0 0.1",
                                  .type = "fixed",
                                  .axis = "",
                                  .parent = "base_footprint"});
  EXPECT_NEAR(end_of(read_drive_train(robot_of(text), {}), "base_footprint"), 0, 1e-9);
}

}  // namespace robot_control::tests
