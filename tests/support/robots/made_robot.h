#pragma once
/// Robots with given dimensions: a box on wheels, one pair per axle, and on request a frictionless ball behind it.

#include <sstream>
#include <string>
#include <vector>

#include "machine/wheeled/drive_train.h"

namespace robot_control {

struct MadeRobot {
  std::vector<double> axles{0};  ///< m, x of each
  double wheel_base = 0.5;       ///< m
  double radius = 0.1;           ///< m
  double width = 0.04;           ///< m
  double wheel_mass = 1;         ///< kg
  double body_mass = 10;         ///< kg, at (body_x, 0, body_z)
  double body_x = 0;             ///< m
  double body_z = 0;             ///< m above the axles
  double effort = 90;            ///< N·m; a number that the reader takes for no placeholder
  double ball_x = 0;             ///< m; 0: no ball
  std::string more;              ///< links and joints

  double mass() const { return body_mass + 2 * wheel_mass * static_cast<double>(axles.size()); }

  RobotDescription description() const {
    std::ostringstream urdf;
    const double spread = wheel_base * wheel_base / 12 * body_mass;
    urdf << "<robot name=\"made\"><link name=\"base_link\"><inertial><origin xyz=\"" << body_x << " 0 " << body_z
         << "\"/><mass value=\"" << body_mass << "\"/><inertia ixx=\"" << spread << "\" iyy=\"" << spread << "\" izz=\""
         << 2 * spread * 0.9 << "\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>";
    if (ball_x != 0) {
      urdf << "<collision><origin xyz=\"" << ball_x << " 0 " << -radius / 2 << "\"/><geometry><sphere radius=\""
           << radius / 2 << "\"/></geometry></collision>";
    }
    urdf << "</link>";
    for (std::size_t axle = 0; axle < axles.size(); ++axle) {
      add_wheel(urdf, "left_" + std::to_string(axle), axles[axle], wheel_base / 2);
      add_wheel(urdf, "right_" + std::to_string(axle), axles[axle], -wheel_base / 2);
    }
    urdf << more << "</robot>";
    return {urdf.str(), "made"};
  }

  DriveTrainParameters names() const {
    DriveTrainParameters parameters;
    for (std::size_t axle = 0; axle < axles.size(); ++axle) {
      parameters.left_wheel_joints.push_back("left_" + std::to_string(axle));
      parameters.right_wheel_joints.push_back("right_" + std::to_string(axle));
    }
    return parameters;
  }

  DriveTrain model() const { return read_drive_train(description(), names()); }

  /// kg·m², of a wheel about its axle: a homogeneous disc.
  double wheel_inertia() const { return wheel_mass * radius * radius / 2; }

 private:
  void add_wheel(std::ostream& urdf, const std::string& name, double x, double y) const {
    const double across = wheel_mass * (3 * radius * radius + width * width) / 12;
    urdf << "<link name=\"" << name << "_wheel\"><inertial><mass value=\"" << wheel_mass << "\"/><inertia ixx=\""
         << across << "\" iyy=\"" << wheel_inertia() << "\" izz=\"" << across
         << "\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision><origin rpy=\"1.5707963267948966 0 0\"/>"
         << "<geometry><cylinder radius=\"" << radius << "\" length=\"" << width << "\"/></geometry></collision></link>"
         << "<joint name=\"" << name << "\" type=\"continuous\"><parent link=\"base_link\"/><child link=\"" << name
         << "_wheel\"/><origin xyz=\"" << x << ' ' << y << " 0\"/><axis xyz=\"0 1 0\"/><limit effort=\"" << effort
         << "\" velocity=\"100\"/></joint>";
  }
};

}  // namespace robot_control
