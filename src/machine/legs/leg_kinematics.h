#pragma once
/// The kinematics of one leg of three turning joints, in closed form.
///
/// The first joint turns about the lengthwise axis x, the second and third about the lateral axis y. With the vectors
/// of LegGeometry in the base's axes while every joint is at zero, and θᵢ = signᵢ · qᵢ,
///
///   p(q) = hip + Rx(θ₁) [ upper + Ry(θ₂) ( lower + Ry(θ₃) foot ) ]
///
/// is the centre of the foot. A leg of three links in one plane is the special case upper.x = upper.z = foot.x = 0.
/// All y components turn with θ₁ alone: d = upper.y + lower.y + foot.y is the distance of the leg's plane.
///
/// The bend β of the knee is the angle from `lower` to the turned `foot` about y, 0 for a straight leg. A positive bend
/// points the knee forward. `inverse` keeps the sign that LegGeometry::bend gives.
///
/// All functions are real-time safe.

#include <Eigen/Core>
#include <array>
#include <optional>

#include "machine/machine_model.h"

namespace robot_control {

inline constexpr std::size_t kLegJoints = 3;
using LegAngles = Eigen::Vector3d;  ///< rad, joint angles from the body outwards

/// Lengths are in m, in the base's axes, with all joints at zero.
struct LegGeometry {
  Eigen::Vector3d hip = Eigen::Vector3d::Zero();    ///< from the base to the first joint
  Eigen::Vector3d upper = Eigen::Vector3d::Zero();  ///< from the first joint to the second
  Eigen::Vector3d lower = Eigen::Vector3d::Zero();  ///< from the second joint to the third
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();   ///< from the third joint to the foot's centre
  std::array<double, kLegJoints> sign{1, 1, 1};     ///< +1: a positive angle turns about +x, +y, +y
  std::array<JointRange, kLegJoints> range{};       ///< rad; ±∞ where a joint turns without end
  double bend = 1;                                  ///< +1: the knee points forward, −1: backward
};

/// How a requested foot position relates to what the leg can reach.
enum class FootReach {
  kReached,
  kBeyondReach,  ///< The lengths of the leg do not allow it.
  kBeyondRange,  ///< The lengths allow it, but no angles within the joints' ranges do.
};

struct LegSolution {
  LegAngles angles = LegAngles::Zero();
  FootReach reach = FootReach::kReached;
};

class LegKinematics {
 public:
  LegKinematics() = default;
  /// `lower` and `foot` must have a length in the x-z plane.
  explicit LegKinematics(const LegGeometry& geometry);

  const LegGeometry& geometry() const noexcept { return geometry_; }

  /// Returns the range of a joint in rad for `inverse`: that of the geometry, and of the knee its bending side alone.
  const JointRange& range(std::size_t joint) const noexcept { return range_[joint]; }

  /// Returns the foot's centre in m, base axes.
  Eigen::Vector3d position(const LegAngles& angles) const noexcept;

  /// Returns the third joint in m, base axes.
  Eigen::Vector3d knee(const LegAngles& angles) const noexcept;

  /// Returns ∂p/∂q in m/rad, and sets `foot` to p.
  Eigen::Matrix3d jacobian(const LegAngles& angles, Eigen::Vector3d& foot) const noexcept;

  /// Returns angles within the ranges that bring the foot's centre to `foot` (m, base axes). The leg below its
  /// hip is the preferred one of two solutions. If none exists, the angles are those of the nearest point that the
  /// search of leg_nearest.cpp finds within the ranges. Joints that turn farther than a whole turn stay within ±π of
  /// the middle of their range.
  LegSolution inverse(const Eigen::Vector3d& foot) const noexcept;

  /// Returns the angles of `inverse`, but none if the leg does not reach `foot`.
  std::optional<LegAngles> reached(const Eigen::Vector3d& foot) const noexcept;

  /// Returns the length from the second joint to the foot in m, while the leg is straight.
  double length() const noexcept { return upper_length_ + lower_length_; }

  /// Returns the distance from the second joint to the foot in m: length() while the leg is straight.
  double stretch(const LegAngles& angles) const noexcept;

  /// Returns the lever in m, about the knee, of a force from the foot towards the second joint, `stretch` m away.
  double knee_lever(double stretch) const noexcept;

  /// Returns the knee's bend β in rad, within ±π.
  double bend(const LegAngles& angles) const noexcept;

 private:
  struct Branch {
    LegAngles angles = LegAngles::Zero();
    bool reached = false;
    bool in_range = false;
  };
  Branch branch(const Eigen::Vector3d& from_hip, double side) const noexcept;
  LegAngles nearest(const Eigen::Vector3d& foot, const LegAngles& start, double& distance) const noexcept;

  LegGeometry geometry_;
  std::array<JointRange, kLegJoints> range_{};
  double offset_ = 0;        ///< d
  double upper_length_ = 1;  ///< of `lower` and of `foot` in the x-z plane
  double lower_length_ = 1;
  double upper_angle_ = 0;  ///< atan2(x, z) of `lower`; turning about y adds to it
  double lower_angle_ = 0;  ///< atan2(x, z) of `foot`
};

/// Returns the angle within ±π.
double wrapped(double angle) noexcept;

}  // namespace robot_control
