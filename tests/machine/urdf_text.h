#pragma once
/// Small robots in short texts. The healthy one is a box of 10 kg on two wheels of 1 kg, radius 0.1 m, 0.5 m apart.

#include <string>

#include "machine/wheeled/drive_train.h"
#include "support/message_of.h"

namespace robot_control {

inline constexpr double kRounding = 1e-12;  ///< of masses and lengths of order one

inline const std::string kBall = "ixx=\"0.01\" iyy=\"0.01\" izz=\"0.01\" ixy=\"0\" ixz=\"0\" iyz=\"0\"";

inline std::string inertial(const std::string& mass, const std::string& inertia = kBall) {
  return "<inertial><mass value=\"" + mass + "\"/><inertia " + inertia + "/></inertial>";
}

inline std::string collision(const std::string& geometry, const std::string& origin = "") {
  return "<collision><origin " + origin + "/><geometry>" + geometry + "</geometry></collision>";
}

/// About y.
inline std::string tyre(const std::string& radius, const std::string& offset = "0") {
  return collision("<cylinder radius=\"" + radius + "\" length=\"0.04\"/>",
                   "xyz=\"0 " + offset + " 0\" rpy=\"1.5707963267948966 0 0\"");
}

inline std::string link(const std::string& name, const std::string& content) {
  return "<link name=\"" + name + "\">" + content + "</link>";
}

struct JointText {
  std::string name;
  std::string child;
  std::string xyz = "0 0 0";
  std::string type = "continuous";
  std::string axis = "<axis xyz=\"0 1 0\"/>";
  std::string rest = "";
  std::string parent = "base_link";
  std::string rpy = "0 0 0";
};

inline std::string joint(const JointText& j) {
  return "<joint name=\"" + j.name + "\" type=\"" + j.type + "\"><parent link=\"" + j.parent + "\"/><child link=\"" +
         j.child + "\"/><origin xyz=\"" + j.xyz + "\" rpy=\"" + j.rpy + "\"/>" + j.axis + j.rest + "</joint>";
}

/// Joint `name` at `xyz` and its link, `name`_link.
inline std::string wheel(const std::string& name, const std::string& xyz, const std::string& radius = "0.1",
                         const std::string& rest = "") {
  return link(name + "_link", inertial("1") + tyre(radius)) +
         joint({.name = name, .child = name + "_link", .xyz = xyz, .rest = rest});
}

inline std::string base() {
  return link("base_link", inertial("10") + collision("<box size=\"0.6 0.4 0.1\"/>"));
}

inline std::string transmission(const std::string& name) {
  return "<transmission name=\"t\"><joint name=\"" + name + "\"/></transmission>";
}

inline RobotDescription robot_of(const std::string& content) {
  return {"<robot name=\"r\">" + content + "</robot>", "r.urdf"};
}

inline std::string two_wheels() {
  return base() + wheel("left", "0 0.25 0") + wheel("right", "0 -0.25 0");
}

/// The same robot in the form that says that it is free: its root hangs by a joint of this type on an empty `world`.
inline RobotDescription on_world(RobotDescription description, const std::string& root, const std::string& type) {
  const std::string parts = link("world", "") + joint({.name = "world_joint",
                                                       .child = root,
                                                       .xyz = "3 -2 1.5",
                                                       .type = type,
                                                       .parent = "world",
                                                       .rpy = "0.1 0.2 99"});
  description.text.insert(description.text.rfind("</robot>"), parts);
  return description;
}

/// The message of the refusal, or "accepted".
inline std::string refusal_of(const RobotDescription& description, const DriveTrainParameters& parameters = {}) {
  return message_of<RobotError>([&] { read_drive_train(description, parameters); }, "accepted");
}

/// All notes of one kind, one per line: "element: text".
inline std::string notes_of(const DriveTrain& robot, RobotNote::Kind kind) {
  std::string text;
  for (const RobotNote& note : robot.notes) {
    if (note.kind == kind) text += note.element + ": " + note.text + "\n";
  }
  return text;
}

}  // namespace robot_control
