#include "machine/overrides.h"

#include <algorithm>
#include <cmath>

#include "machine/description/urdf_document.h"
#include "machine/description/wording.h"

namespace robot_control {

double overridden(const std::string& name, const std::string& unit, const std::optional<double>& given,
                  double from_urdf, const RigidBodies& robot, std::vector<RobotNote>& notes) {
  if (!given) return from_urdf;
  const std::string element = "robot." + name;
  const std::string space = unit.empty() ? "" : " ";
  if (!std::isfinite(*given) || *given <= 0) {
    refuse(robot.source, element, number(*given) + space + unit, "Set a finite value above zero, or none");
  }
  if (std::abs(*given - from_urdf) <= kNotedShare * std::abs(from_urdf)) return *given;
  const RobotNote note{RobotNote::Kind::kOverridden, element,
                       number(*given) + space + unit + " is used, the URDF has " +
                           (from_urdf == 0 ? "nothing" : number(from_urdf) + space + unit)};
  const bool known = std::any_of(notes.begin(), notes.end(), [&](const RobotNote& other) {
    return other.element == note.element && other.text == note.text;
  });
  if (!known) notes.push_back(note);
  return *given;
}

}  // namespace robot_control
