#pragma once
/// The mass of one link, and what is done with inertias that no body has.

#include <urdf_model/link.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "robot/robot_model.h"

namespace robot_control {

struct PointInertia {
  double mass = 0;                                    ///< kg
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< m
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< kg·m², about `centre`
};

/// The inertia nearest to `given` that a body of this mass can have. With the principal moments A ≤ B ≤ C:
///
///   each ≥ m ρ², ρ = kLeastGyration;  A + B ≥ (1 + ε) C, ε = kThickness: where not, A and B both grow by half of
///   what lacks
///
/// C stays, because it is what the maker is likelier to have meant; so do the principal axes. `given` itself where it
/// needs no repair. Where all of it is zero: that of a solid ball of kBallRadius. ε keeps a flat part valid when its
/// tensor is rotated or summed in doubles: rounding is 10⁻¹⁵ of C, a part with A + B = C a plate without thickness.
Eigen::Matrix3d possible_inertia(const Eigen::Matrix3d& given, double mass);

/// Whether it needs no repair that is worth a note: a plate without thickness, A + B = C up to 10⁻⁹ of C, is possible.
bool is_possible(const Eigen::Matrix3d& given, double mass);

inline constexpr double kThickness = 1e-6;
inline constexpr double kLeastGyration = 1e-4;  ///< m: that of a ball of 0.3 mm
inline constexpr double kBallRadius = 0.02;     ///< m

/// In the body's frame, of which `in_body` is the link's. A link without <inertial> has no mass. Repairs are noted.
/// Throws RobotError: a negative mass.
PointInertia inertia_of(const urdf::Link& link, const Eigen::Isometry3d& in_body, const std::string& source,
                        std::vector<RobotNote>& notes);

/// Steiner: both together about their common centre of gravity.
PointInertia sum(const PointInertia& a, const PointInertia& b);

Eigen::Isometry3d eigen_pose(const urdf::Pose& pose);
Eigen::Matrix3d eigen_inertia(const urdf::Inertial& given);

}  // namespace robot_control
