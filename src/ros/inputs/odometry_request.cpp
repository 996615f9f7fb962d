#include "ros/inputs/odometry_request.h"

#include <array>
#include <cmath>
#include <numbers>

#include "parameters/block.h"

namespace robot_control {

std::string odometry_problem(const Vector3& pose) {
  struct Part {
    const char* name;
    const char* unit;
    double max;
  };
  constexpr std::array<Part, 3> kParts{{{"x", "m", kMaxPosition}, {"y", "m", kMaxPosition}, {"yaw", "rad", kMaxYaw}}};
  std::string problems;
  for (std::size_t i = 0; i < kParts.size(); ++i) {
    if (std::abs(pose[i]) <= kParts[i].max) continue;
    const std::string max = shortest(kParts[i].max);
    problems.append(problems.empty() ? "" : "; ").append(kParts[i].name).append(" = ").append(shortest(pose[i]));
    problems.append(" ").append(kParts[i].unit).append(": must be a number of -").append(max).append(" … ");
    problems.append(max).append(" ").append(kParts[i].unit);
  }
  return problems;
}

std::string taken_sentence(const Vector3& pose) {
  return "the pose is " + shortest(pose[0]) + " m, " + shortest(pose[1]) + " m, " + shortest(pose[2]) +
         " rad from the next cycle on";
}

Vector3 normalised(const Vector3& pose) {
  const double yaw = std::remainder(pose[2], 2 * std::numbers::pi);
  return {pose[0], pose[1], yaw == -std::numbers::pi ? std::numbers::pi : yaw};
}

}  // namespace robot_control
