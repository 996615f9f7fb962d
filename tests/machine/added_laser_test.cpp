#include "machine/bodies/added_laser.h"

#include "machine/bodies/rigid_bodies.h"
#include "support/matchers.h"

namespace robot_control::tests {

RobotDescription described(const std::string& name, const std::string& without = "") {
  RobotDescription description = load_description(PROJECT_DIRECTORY "/urdf/" + name + ".urdf");
  if (without.empty()) return description;
  for (std::size_t at = 0; (at = description.text.find(without, at)) != std::string::npos;)
    description.text.replace(at, without.size(), "mast");
  return description;
}

TEST(AddedLaser, ARobotWithTheLinkStaysAsItIs) {
  EXPECT_EQ(with_laser(described("diffbot"), true).text, described("diffbot").text);
}

TEST(AddedLaser, ARobotStaysAsItIsUnlessALaserIsWanted) {
  EXPECT_EQ(with_laser(described("diffbot", "laser_link"), false).text, described("diffbot", "laser_link").text);
}

TEST(AddedLaser, TheLinkIsLevelAboveTheBodyAndAddingItAgainChangesNothing) {
  for (const std::string name : {"diffbot", "quadbot"}) {
    const RobotDescription added = with_laser(described(name, "laser_link"), true);
    const RigidBodies robot = read_rigid_bodies(added);
    const LinkPlace place = robot.links.at(kLaserLink);
    EXPECT_EQ(place.body, 0U) << name;
    EXPECT_TRUE(place.in_body.linear().isIdentity()) << name;
    EXPECT_NEAR(place.in_body.translation().head<2>().norm(), 0, 1e-9) << name;
    EXPECT_GT(place.in_body.translation().z(), 0.05) << name;
    EXPECT_LT(place.in_body.translation().z(), 0.3) << name;
    EXPECT_EQ(with_laser(added, true).text, added.text) << name;
  }
}

TEST(AddedLaser, OnATallRobotItIsAtTheHeightOfFurniture) {
  RobotDescription tall = described("diffbot", "laser_link");
  tall.text.replace(
      tall.text.rfind("</robot>"), 8,
      "<link name=\"pole\"><collision><origin xyz=\"0 0 1\"/><geometry><box size=\"0.1 0.1 2\"/></geometry>"
      "</collision></link><joint name=\"pole\" type=\"fixed\"><parent link=\"base_link\"/><child "
      "link=\"pole\"/></joint></robot>");
  const RigidBodies robot = read_rigid_bodies(with_laser(tall, true));
  EXPECT_NEAR(robot.links.at(kLaserLink).in_body.translation().z(), kHighest - 0.1, 1e-6);  // wheels of 0.1 m
}

}  // namespace robot_control::tests
