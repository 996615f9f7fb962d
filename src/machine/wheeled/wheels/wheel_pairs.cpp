#include "machine/wheeled/wheels/wheel_pairs.h"

#include <algorithm>
#include <cmath>

#include "machine/description/wording.h"

namespace robot_control {
namespace {

constexpr double kMinTolerance = 0.002;  // m, difference between drawings of one robot

PairObjection pair_objection(const RigidBodies& robot, const RollingBody& left, const RollingBody& right,
                             double middle) {
  const auto& a = left.wheel;
  const auto& b = right.wheel;
  const std::string names = robot.bodies[left.body].joint.name + " and " + robot.bodies[right.body].joint.name;
  const double base = a.centre_base[1] - b.centre_base[1];
  const double tolerance = std::max(kMinTolerance, kPairTolerance * base);
  if (std::abs(a.centre_base[0] - b.centre_base[0]) > tolerance) {
    return {
        names + " are not on one axle: x is " + length(a.centre_base[0]) + " and " + length(b.centre_base[0]) + " m",
        "Move both joints to the same x in the URDF"};
  }
  if (std::abs(a.centre_base[1] + b.centre_base[1] - 2 * middle) > 2 * tolerance) {
    return {names + " are not at equal distances from the middle line: y is " + length(a.centre_base[1]) + " and " +
                length(b.centre_base[1]) + " m",
            "Move both joints to equal distances from the middle line (y) in the URDF"};
  }
  return {};
}

PairObjection radius_objection(const RigidBodies& robot, const std::vector<RollingBody>& wheels) {
  const auto by_radius = [](const RollingBody& a, const RollingBody& b) { return a.wheel.radius < b.wheel.radius; };
  const auto [least, largest] = std::minmax_element(wheels.begin(), wheels.end(), by_radius);
  const double unsure = std::max(least->out_of_round, largest->out_of_round);
  const double tolerance = std::max(kPairTolerance * largest->wheel.radius, unsure);
  if (largest->wheel.radius - least->wheel.radius <= tolerance) return {};
  return {"their radii differ by more than 1 %: " + described(robot, *least) + " and " + described(robot, *largest),
          kOneRadius};
}

}  // namespace

std::string described(const RigidBodies& robot, const RollingBody& wheel) {
  return robot.bodies[wheel.body].joint.name + " (x " + length(wheel.wheel.centre_base[0]) + " m, y " +
         length(wheel.wheel.centre_base[1]) + " m, radius " + number(wheel.wheel.radius) + " m)";
}

PairObjection sort_into_pairs(const RigidBodies& robot, std::vector<RollingBody>& wheels) {
  if (wheels.size() == 1) return {"there is only one", kSetWheels};
  const auto y_of = [](const RollingBody& wheel) { return wheel.wheel.centre_base[1]; };
  const auto by_y = [&](const RollingBody& a, const RollingBody& b) { return y_of(a) < y_of(b); };
  const auto [right_most, left_most] = std::minmax_element(wheels.begin(), wheels.end(), by_y);
  const double middle = (y_of(*right_most) + y_of(*left_most)) / 2;
  std::size_t left = 0;
  for (RollingBody& wheel : wheels) {
    wheel.wheel.side = y_of(wheel) > middle ? Side::kLeft : Side::kRight;
    left += wheel.wheel.side == Side::kLeft;
  }
  std::stable_sort(wheels.begin(), wheels.end(), [](const RollingBody& a, const RollingBody& b) {
    if (a.wheel.side != b.wheel.side) return a.wheel.side == Side::kLeft;
    return a.wheel.centre_base[0] > b.wheel.centre_base[0];
  });
  if (2 * left != wheels.size()) {
    return {std::to_string(left) + " wheels are on the left, " + std::to_string(wheels.size() - left) + " on the right",
            kSetWheels};
  }
  for (std::size_t i = 0; i < left; ++i) {
    PairObjection objection = pair_objection(robot, wheels[i], wheels[left + i], middle);
    if (!objection.found.empty()) return objection;
  }
  return radius_objection(robot, wheels);
}

}  // namespace robot_control
