#pragma once
/// Reads the mass of one link and repairs inertias that no body has.

#include <urdf_model/link.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "machine/machine_model.h"

namespace robot_control {

struct PointInertia {
  double mass = 0;                                    ///< kg
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< m
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< kg·m², about `centre`
};

/// Returns the inertia nearest to `given` that a body of this mass can have. With the principal moments A ≤ B ≤ C:
///
///   each moment ≥ m ρ² with ρ = kMinGyration
///   A + B ≥ (1 + ε) C with ε = kThickness; otherwise A and B both grow by half of the difference
///
/// C stays, because it is likelier to be what the maker meant; so do the principal axes. An inertia of zero becomes
/// that of a solid ball of kBallRadius. The margin ε keeps a flat part valid when its tensor is rotated or summed:
/// rounding is 10⁻¹⁵ of C, and a part with A + B = C is a plate without thickness.
Eigen::Matrix3d possible_inertia(const Eigen::Matrix3d& given, double mass);

/// Returns true if no repair is worth a note: a plate without thickness, A + B = C up to 10⁻⁹ of C, is possible.
bool is_possible(const Eigen::Matrix3d& given, double mass);

inline constexpr double kThickness = 1e-6;
inline constexpr double kMinGyration = 1e-4;  ///< m, that of a ball of 0.3 mm
inline constexpr double kBallRadius = 0.02;   ///< m

/// Returns the inertia in the body's frame; `in_body` is the link's frame in it. A link without <inertial> has no mass.
/// Repairs are noted. Throws RobotError if the mass is negative.
PointInertia inertia_of(const urdf::Link& link, const Eigen::Isometry3d& in_body, const std::string& source,
                        std::vector<RobotNote>& notes);

/// Returns both parts together about their common centre of gravity (Steiner).
PointInertia sum(const PointInertia& a, const PointInertia& b);

Eigen::Isometry3d eigen_pose(const urdf::Pose& pose);
Eigen::Matrix3d eigen_inertia(const urdf::Inertial& given);

}  // namespace robot_control
