/// Wheels whose collision meshes are not quite round.

#include <cmath>

#include "machine/random_text.h"
#include "machine/urdf_text.h"
#include "support/matchers.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

/// OBJ: a prism about z, 0.03 long, with the corner of the angle φ at the radius reach(φ).
template <typename Reach>
std::string prism_of(int sides, Reach reach) {
  std::string vertices, faces;
  for (int i = 0; i < sides; ++i) {
    const double phi = 2 * M_PI * i / sides;
    const std::string xy = metres(reach(phi) * std::cos(phi)) + " " + metres(reach(phi) * std::sin(phi));
    vertices += "v " + xy + " -0.015\nv " + xy + " 0.015\n";
    const int a = 2 * i + 1, b = 2 * ((i + 1) % sides) + 1;
    faces += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(b + 1) + "\n";
    faces += "f " + std::to_string(a) + " " + std::to_string(b + 1) + " " + std::to_string(a + 1) + "\n";
  }
  return vertices + faces;
}

/// A wheel that is out of round by `off`: beside its axle, oval, or with a bump.
std::string out_of_round(Random& random, double radius, double off) {
  const int sides = 24 + static_cast<int>(below(random, 40));
  const double towards = between(random, 0, 2 * M_PI);
  switch (below(random, 3)) {
    case 0:
      return prism_of(sides, [&](double phi) {  // of a circle about a centre `off` from the axle
        const double c = off * std::cos(phi - towards), s = off * std::sin(phi - towards);
        return c + std::sqrt(radius * radius - s * s);
      });
    case 1:
      return prism_of(sides, [&](double phi) { return radius + off * std::cos(2 * (phi - towards)); });
    default: {
      const double bump = 2 * M_PI * static_cast<double>(below(random, static_cast<std::size_t>(sides))) / sides;
      return prism_of(sides, [&](double phi) { return radius + (std::abs(phi - bump) < 1e-6 ? off : 0); });
    }
  }
}

RobotDescription with_meshes(const TemporaryFolder& folder, double radius) {
  std::string text = base();
  for (const std::string name : {"left", "right"}) {
    text += link(name + "_link",
                 inertial("1") + collision("<mesh filename=\"" + name + ".obj\"/>", "rpy=\"1.5707963267948966 0 0\"")) +
            joint({.name = name, .child = name + "_link", .xyz = name == "left" ? "0 0.25 0" : "0 -0.25 0"});
  }
  return {robot_of(text).text, (folder.path() / ("r" + metres(radius) + ".urdf")).string()};
}

TEST(OutOfRound, IsAWheelFoundOrNamedByAMillimetre) {
  DriveTrainParameters named;
  named.left_wheel_joints = {"left"};
  named.right_wheel_joints = {"right"};
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TemporaryFolder folder;
    const double radius = between(random, 0.02, 0.12), off = between(random, 0.0008, 0.0011);
    folder.write("left.obj",
                 toss(random) ? out_of_round(random, radius, off) : prism_of(40, [&](double) { return radius; }));
    folder.write("right.obj", out_of_round(random, radius, off));
    folder.write("r" + metres(radius) + ".urdf", with_meshes(folder, radius).text);
    for (const DriveTrainParameters& parameters : {DriveTrainParameters{}, named}) {
      ASSERT_EQ(refusal_of(with_meshes(folder, radius), parameters), "accepted");
      const DriveTrain robot = read_drive_train(with_meshes(folder, radius), parameters);
      // The bounds are the polygon's own sagitta for a corner, and that of the mean for an oval.
      EXPECT_NEAR(robot.wheels[0].radius, radius, 0.01 * radius);
      EXPECT_NEAR(robot.wheels[1].radius, radius, std::max(0.01 * radius, 0.0005));
    }
  }
}

TEST(OutOfRound, IsNotedWhereTheRadiusIsAMean) {
  TemporaryFolder folder;
  folder.write("left.obj", prism_of(40, [&](double) { return 0.04; }));
  folder.write("right.obj", prism_of(40, [&](double phi) { return 0.04 + 0.001 * std::cos(phi); }));
  folder.write("r0.040000000.urdf", "");
  const DriveTrain robot = read_drive_train(with_meshes(folder, 0.04), {});
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kSuspicious), HasSubstr("right_link\">: out of round"));
  EXPECT_THAT(notes_of(robot, RobotNote::Kind::kSuspicious), Not(HasSubstr("left_link\">: out of round")));
}

TEST(OutOfRound, ABoxAndASlabAreNoWheels) {
  TemporaryFolder folder;
  for (const int sides : {3, 4, 6}) {
    for (const double radius : {0.02, 0.05, 0.2}) {
      folder.write("left.obj", prism_of(sides, [&](double) { return radius; }));
      folder.write("right.obj", prism_of(sides, [&](double) { return radius; }));
      folder.write("r" + metres(radius) + ".urdf", "");
      EXPECT_THAT(refusal_of(with_meshes(folder, radius)), HasSubstr("round about the axle")) << sides << " " << radius;
    }
  }
}

}  // namespace robot_control::tests
