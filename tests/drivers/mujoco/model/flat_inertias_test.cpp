/// Inertias of flat and thin parts, as drawn or as repaired, are valid in every orientation.

#include <Eigen/Geometry>
#include <random>

#include "drivers/mujoco/plant_fixture.h"
#include "support/robots/made_robot.h"

namespace robot_control::tests {

std::string exact(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

// A plate has A + B = C to the last bit, a rod A = 0; others are broken by a copyist. Rotated, rounding decides.
TEST(FlatInertias, AreValidInEveryOrientation) {
  for (unsigned seed = 0; seed < 120; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0, 1);
    MadeRobot robot;
    for (int part = 0; part < 3; ++part) {
      const double a = std::pow(10, -5 + 4 * uniform(random)), b = a * (0.2 + uniform(random));
      Eigen::Vector3d principal(a, b, a + b);
      if (seed % 4 == 1) principal = {0, a, a};
      if (seed % 4 == 2) principal = {a, b, 3 * (a + b)};
      if (seed % 4 == 3) principal = {0, 0, a};
      Eigen::Quaterniond turn(normal(random), normal(random), normal(random), normal(random));
      const Eigen::Matrix3d r = turn.normalized().toRotationMatrix();
      const bool rotate_tensor = part == 1;
      const Eigen::Matrix3d i = rotate_tensor ? Eigen::Matrix3d(r * principal.asDiagonal() * r.transpose())
                                              : Eigen::Matrix3d(principal.asDiagonal());
      const Eigen::Vector3d rpy = r.eulerAngles(2, 1, 0);
      std::ostringstream origin;
      if (!rotate_tensor)
        origin << "<origin rpy=\"" << exact(rpy[2]) << ' ' << exact(rpy[1]) << ' ' << exact(rpy[0]) << "\"/>";
      const std::string name = "part_" + std::to_string(part);
      // One part moves by itself, so that nothing round is added to it.
      const std::string joint = part == 2 ? "base_link" : "fixed";
      robot.more += "<link name=\"" + name + "\"><inertial>" + origin.str() + "<mass value=\"" +
                    exact(0.05 + uniform(random)) + "\"/><inertia ixx=\"" + exact(i(0, 0)) + "\" iyy=\"" +
                    exact(i(1, 1)) + "\" izz=\"" + exact(i(2, 2)) + "\" ixy=\"" + exact(i(0, 1)) + "\" ixz=\"" +
                    exact(i(0, 2)) + "\" iyz=\"" + exact(i(1, 2)) + "\"/></inertial></link><joint name=\"" + name +
                    "_joint\" type=\"" + (joint == "fixed" ? "fixed" : "continuous") +
                    "\"><parent link=\"base_link\"/><child link=\"" + name + "\"/><origin rpy=\"" +
                    exact(uniform(random)) + " " + exact(uniform(random)) + " 0\"/><axis xyz=\"0 0 1\"/></joint>";
    }
    MujocoPlantParameters parameters;
    parameters.scene = kFlat;
    EXPECT_NO_THROW(compile_model(read_drive_train(robot.description(), robot.names()), parameters, 0.001))
        << "seed " << seed;
  }
}

}  // namespace robot_control::tests
