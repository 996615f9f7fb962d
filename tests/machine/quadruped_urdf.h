#pragma once
/// A small quadruped: a trunk of 6 kg and four legs of three joints with limits, each leg of 1.5 kg with a ball as its
/// foot. Its base link has no mass, its IMU is fixed to the trunk.

#include <string>

#include "machine/urdf_text.h"

namespace robot_control {

inline constexpr const char* kSmall = "ixx=\"0.001\" iyy=\"0.001\" izz=\"0.001\" ixy=\"0\" ixz=\"0\" iyz=\"0\"";

inline std::string leg(const std::string& place, double x, double y) {
  const auto text = [](double value) { return std::to_string(value); };
  const std::string names[3] = {place + "_hip", place + "_thigh", place + "_calf"};
  const std::string shapes[3] = {"<sphere radius=\"0.04\"/>", "<box size=\"0.03 0.03 0.2\"/>",
                                 "<sphere radius=\"0.02\"/>"};
  const std::string limits[3] = {"lower=\"-0.8\" upper=\"0.8\" effort=\"20\" velocity=\"30\"",
                                 "lower=\"-9.42\" upper=\"9.42\" effort=\"20\" velocity=\"30\"",
                                 "lower=\"-2.7\" upper=\"-0.9\" effort=\"35\" velocity=\"20\""};
  const std::string places[3] = {text(x) + " " + text(y) + " 0", "0 " + text(y > 0 ? 0.08 : -0.08) + " 0", "0 0 -0.21"};
  std::string content, parent = "trunk";
  for (std::size_t i = 0; i < 3; ++i) {
    content += link(names[i], inertial("0.5", kSmall) + (i < 2 ? collision(shapes[i]) : std::string()));
    content += joint({.name = names[i] + "_joint",
                      .child = names[i],
                      .xyz = places[i],
                      .type = "revolute",
                      .axis = i == 0 ? "<axis xyz=\"1 0 0\"/>" : "<axis xyz=\"0 1 0\"/>",
                      .rest = "<limit " + limits[i] + "/>",
                      .parent = parent});
    parent = names[i];
  }
  return content + link(place + "_foot", collision(shapes[2])) +
         joint({.name = place + "_foot_joint",
                .child = place + "_foot",
                .xyz = "0 0 -0.21",
                .type = "fixed",
                .axis = "",
                .parent = parent});
}

inline std::string small_quadruped() {
  return link("base", "") + link("trunk", inertial("6") + collision("<box size=\"0.4 0.2 0.1\"/>")) +
         joint({.name = "floating_base", .child = "trunk", .type = "fixed", .axis = "", .parent = "base"}) +
         link("imu_link", "") +
         joint({.name = "imu_joint",
                .child = "imu_link",
                .xyz = "0.1 0 0.02",
                .type = "fixed",
                .axis = "",
                .parent = "trunk"}) +
         leg("front_right", 0.19, -0.05) + leg("front_left", 0.19, 0.05) + leg("rear_right", -0.19, -0.05) +
         leg("rear_left", -0.19, 0.05);
}

}  // namespace robot_control
