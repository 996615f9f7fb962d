#include "drivers/mujoco/model/terrain.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <random>

#include "drivers/driver.h"
#include "drivers/mujoco/model/mjcf_shapes.h"

namespace robot_control {

Terrain::Terrain(const TerrainParameters& course, std::uint64_t seed)
    : heading_(course.heading), friction_(course.friction * (course.kind == TerrainKind::kIce ? kIceFriction : 1)) {
  lay(course, seed);
  if (course.kind == TerrainKind::kNone || (!boxes_.empty() && boxes_.size() <= kMaxBoxes)) return;
  throw DriverError("mujoco_plant.terrain: height, length and count give " + std::to_string(boxes_.size()) +
                    " boxes; there must be 1 to " + std::to_string(kMaxBoxes) +
                    ". Set a height above 0, a length of at most 4 m, a larger length or a smaller count.");
}

void Terrain::lay(const TerrainParameters& course, std::uint64_t seed) {
  const double begin = course.distance, length = course.length, height = course.height;
  const auto count = static_cast<double>(course.count);
  switch (course.kind) {
    case TerrainKind::kNone:
      return;
    case TerrainKind::kStairs:
      for (double step = 0; step < count; ++step)
        add(begin + step * length, begin + kLanding + (2 * count - 1 - step) * length, (step + 1) * height);
      return;
    case TerrainKind::kRough: {
      std::mt19937_64 random(seed);
      const auto columns = static_cast<std::uint64_t>(kTiles / length);
      for (double row = 0; row < count; ++row) {
        for (std::uint64_t column = 0; column < columns; ++column) {
          const double right = length * (static_cast<double>(column) - static_cast<double>(columns) / 2);
          const double part = static_cast<double>(random() >> 11U) * 0x1p-53;
          add(begin + row * length, begin + (row + 1) * length, part * height, right + length, right);
        }
      }
      return;
    }
    case TerrainKind::kBars:
      for (double bar = 0; bar < count; ++bar) add(begin + bar * length, begin + bar * length + height, height);
      return;
    case TerrainKind::kGap:
      add(begin - kPlatform, begin, kDepth);
      add(begin + length, begin + length + kPlatform, kDepth);
      return;
    case TerrainKind::kIce:
      add(begin, begin + length, kPatch);
      return;
  }
}

void Terrain::add(double from, double to, double height, double left, double right) {
  if (height > 0) boxes_.push_back({.from = {from, right}, .to = {to, left}, .height = height});
}

double Terrain::height(double x, double y) const noexcept {
  const Eigen::Vector2d place = Eigen::Rotation2Dd(-heading_) * Eigen::Vector2d(x, y);
  double highest = 0;
  for (const Box& box : boxes_) {
    const bool above = (place.array() >= box.from.array()).all() && (place.array() < box.to.array()).all();
    if (above) highest = std::max(highest, box.height);
  }
  return highest;
}

std::string Terrain::mjcf(const std::array<double, 7>& start) const {
  Eigen::Isometry3d course = Eigen::Translation3d(start[0], start[1], start[2]) *
                             Eigen::Quaterniond(start[3], start[4], start[5], start[6]) *
                             Eigen::AngleAxisd(heading_, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(kLean, Eigen::Vector3d(1, 1, 0).normalized());
  std::string text;
  for (const Box& box : boxes_) {
    const Eigen::Vector2d middle = (box.from + box.to) / 2, half = (box.to - box.from) / 2;
    const Eigen::Isometry3d at = course * Eigen::Translation3d(middle.x(), middle.y(), box.height / 2);
    text += R"(<geom type="box" size=")" + mjcf_numbers({half.x(), half.y(), box.height / 2}) + '"' + mjcf_pose(at) +
            R"( friction=")" + mjcf_number(friction_) + R"( 0.005 0.0001" condim="3" contype="1" conaffinity="1" )" +
            R"(rgba="0.62 0.64 0.66 1"/>)" + "\n";
  }
  return text;
}

}  // namespace robot_control
