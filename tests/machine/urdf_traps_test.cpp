/// XML that ROS accepts is accepted here, too, and so are meshes as shapes.

#include <cmath>

#include "machine/bodies/rigid_bodies.h"
#include "machine/urdf_text.h"
#include "support/matchers.h"
#include "support/quiet_refusal.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

std::string refusal(const std::string& content) {
  return quiet_refusal<RobotError>([&] { read_drive_train(robot_of(content), {}); });
}

std::string decorated(const std::string& visual) {
  return link("extra", "<visual>" + visual + "</visual>") +
         joint({.name = "extra_joint", .child = "extra", .type = "fixed"});
}

TEST(UrdfTraps, ForeignElementsAndAttributesAreNoMatter) {
  EXPECT_EQ(refusal(two_wheels() + "<sim_create/><create><x/></create><ros2_control/><material name=\"m\"/>"),
            "accepted");
  EXPECT_EQ(refusal(base() + wheel("left", "0 0.25 0", "0.1", "<limit effort=\"1\" k_velocity=\"0\" velocity=\"1\"/>") +
                    wheel("right", "0 -0.25 0", "0.1", "<safety_controller/><calibration rising=\"x\"/>")),
            "accepted");
}

TEST(UrdfTraps, UndefinedAndTwiceDefinedMaterialsAreNoMatter) {
  EXPECT_EQ(refusal(two_wheels() + decorated("<geometry><box size=\"1 1 1\"/></geometry><material "
                                             "name=\"nowhere\"/>")),
            "accepted");
  EXPECT_EQ(refusal("<material name=\"m\"/><material name=\"m\"/>" + two_wheels()), "accepted");
}

TEST(UrdfTraps, VisualMeshesAreNeitherReadNorJudged) {
  EXPECT_EQ(refusal(two_wheels() + decorated("<geometry><mesh filename=\"package://nowhere/x.dae\" "
                                             "scale=\"\"/><mesh filename=\"y.stl\"/></geometry>")),
            "accepted");
  EXPECT_EQ(refusal(two_wheels() + decorated("<geometry/>")), "accepted");
}

TEST(UrdfTraps, AFreeJointOnAnEmptyRootLinkSaysNothingButThatTheRobotIsFree) {
  const RobotDescription plain = robot_of(two_wheels());
  const DriveTrain robot = read_drive_train(plain, {});
  for (const std::string type : {"floating", "planar"}) {
    const DriveTrain free = read_drive_train(on_world(plain, "base_link", type), {});
    EXPECT_EQ(free.base_link, "base_link");
    EXPECT_EQ(free.mass, robot.mass);
    EXPECT_EQ(free.bodies->links.count("world"), 0u);
    EXPECT_EQ(free.wheels.front().centre_base, robot.wheels.front().centre_base);
    EXPECT_EQ(notes_of(free, RobotNote::Kind::kSuspicious), notes_of(robot, RobotNote::Kind::kSuspicious));
    EXPECT_EQ(notes_of(free, RobotNote::Kind::kIgnored),
              notes_of(robot, RobotNote::Kind::kIgnored) + "<joint name=\"world_joint\">: type=\"" + type +
                  "\" on the empty root link world marks the robot as free: base_link is its base, and the joint's "
                  "origin is not used\n");
  }
}

TEST(UrdfTraps, CommentsSayNothing) {
  EXPECT_EQ(refusal("<!-- ${x} <mesh filename=\"package://nowhere/x.stl\" scale=\"\"/> -->" + two_wheels()),
            "accepted");
}

TEST(UrdfTraps, AContinuousJointHasNoLimits) {
  const DriveTrain robot = read_drive_train(
      robot_of(base() + wheel("left", "0 0.25 0", "0.1", "<limit lower=\"-1\" upper=\"1\" effort=\"1\"/>") +
               wheel("right", "0 -0.25 0")),
      {});
  const BodyJoint& left = robot.bodies->moved_by("left")->joint;
  EXPECT_EQ(left.lower, 0);
  EXPECT_EQ(left.upper, 0);
}

std::string revolute_wheels(const std::string& limit) {
  std::string text = base();
  for (const std::string name : {"left", "right"}) {
    text += link(name + "_link", inertial("1") + tyre("0.1")) + joint({.name = name,
                                                                       .child = name + "_link",
                                                                       .xyz = name == "left" ? "0 0.25 0" : "0 -0.25 0",
                                                                       .type = "revolute",
                                                                       .rest = limit});
  }
  return text;
}

TEST(UrdfTraps, ARevoluteWheelWithoutAnEndIsContinuous) {
  const DriveTrain robot = read_drive_train(robot_of(revolute_wheels("<limit lower=\"-1e16\" upper=\"1e16\"/>")), {});
  EXPECT_EQ(robot.bodies->moved_by("left")->joint.type, JointType::kContinuous);
}

TEST(UrdfTraps, DegreesInTheLimitsAreNoted) {
  const DriveTrain robot = read_drive_train(robot_of(revolute_wheels("<limit lower=\"-180\" upper=\"180\"/>")), {});
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kSuspicious), HasSubstr("degrees"));
}

TEST(UrdfTraps, AWheelThatTurnsOnlySoFarIsNone) {
  EXPECT_THAT(refusal(revolute_wheels("<limit lower=\"-1\" upper=\"1\"/>")),
              HasSubstr("left: it turns only from -1 to 1 rad"));
}

TEST(UrdfTraps, AMimicOfNoJointIsIgnored) {
  const std::string follower = link("f", inertial("1")) + joint({.name = "follower",
                                                                 .child = "f",
                                                                 .axis = "<axis xyz=\"0 0 1\"/>",
                                                                 .rest = "<mimic joint=\"absent_joint\"/>"});
  const DriveTrain robot = read_drive_train(robot_of(two_wheels() + follower), {});
  EXPECT_EQ(robot.bodies->moved_by("follower")->joint.mimicked, "");
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kIgnored), HasSubstr("absent_joint"));
}

/// A prism with 40 sides about z, 1 high from z = 0: 80 corners, in an OBJ file.
std::string prism(double radius) {
  std::string vertices, faces;
  for (int i = 0; i < 40; ++i) {
    const double phi = 2 * M_PI * i / 40;
    const std::string xy = std::to_string(radius * std::cos(phi)) + " " + std::to_string(radius * std::sin(phi));
    vertices += "v " + xy + " 0\nv " + xy + " 1\n";
    const int a = 2 * i + 1, b = 2 * ((i + 1) % 40) + 1;
    faces += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(b + 1) + "\n";
    faces += "f " + std::to_string(a) + " " + std::to_string(b + 1) + " " + std::to_string(a + 1) + "\n";
  }
  return vertices + faces;
}

struct MeshShapes : testing::Test {
  MeshShapes() { folder_.write("wheel.obj", prism(1)); }

  RobotDescription with_wheel_mesh(const std::string& mesh) const {
    const std::string shape = collision("<mesh filename=\"" + mesh + "/>", "rpy=\"1.5707963267948966 0 0\"");
    std::string text = base();
    for (const std::string name : {"left", "right"}) {
      text += link(name + "_link", inertial("1") + shape) +
              joint({.name = name, .child = name + "_link", .xyz = name == "left" ? "0 0.25 0" : "0 -0.25 0"});
    }
    return load_description(folder_.write("r.urdf", robot_of(text).text).string());
  }

  TemporaryFolder folder_;
};

// R_x(π/2)·z = −y: the prism, which begins at z = 0, lies from y = 0 to −0.04, its middle at −0.02.
TEST_F(MeshShapes, AScaledRoundMeshIsAWheel) {
  const DriveTrain robot = read_drive_train(with_wheel_mesh("wheel.obj\" scale=\"0.1 0.1 0.04\""), {});
  const double digits = 1e-6;  // those of std::to_string
  EXPECT_NEAR(robot.wheels[0].radius, 0.1, digits);
  EXPECT_NEAR(robot.wheels[0].width, 0.04, digits);
  EXPECT_NEAR(robot.wheels[0].centre_base[1], 0.25 - 0.02, digits);
}

TEST_F(MeshShapes, ANegativeScaleMirrors) {
  const DriveTrain robot = read_drive_train(with_wheel_mesh("wheel.obj\" scale=\"0.1 0.1 -0.04\""), {});
  EXPECT_NEAR(robot.wheels[0].centre_base[1], 0.25 + 0.02, 1e-6);
}

TEST_F(MeshShapes, AScaleThatIsEmptyOrZeroIsRefused) {
  for (const std::string scale : {"", "0", "0 0 0", "0.1 0.1 0", "a b c", "nan nan nan"}) {
    EXPECT_THAT(refusal_of(with_wheel_mesh("wheel.obj\" scale=\"" + scale + "\"")),
                AllOf(HasSubstr("r.urdf: <link name=\"left_link\">"), HasSubstr("wheel.obj"), HasSubstr("scale"),
                      HasSubstr("0.001")))
        << scale;
  }
}

TEST_F(MeshShapes, AMissingEmptyOrUnreadableFileIsRefusedByElement) {
  folder_.write("empty.stl", "");
  folder_.write("picture.blend", "BLENDER");
  for (const std::string file : {"nowhere.stl", "empty.stl", "picture.blend", "package://nowhere/wheel.stl"}) {
    EXPECT_THAT(refusal_of(with_wheel_mesh(file + "\"")), AllOf(HasSubstr("r.urdf: <link name=\"left_link\">"),
                                                                HasSubstr(file.substr(file.find_last_of('/') + 1))))
        << file;
  }
}

TEST_F(MeshShapes, TheFirstOfTwoMeshesCounts) {
  EXPECT_EQ(refusal_of(with_wheel_mesh("wheel.obj\" scale=\"0.1 0.1 0.04\"/><mesh filename=\"nowhere.stl\"")),
            "accepted");
}

}  // namespace robot_control::tests
