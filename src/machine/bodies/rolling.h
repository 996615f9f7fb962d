#pragma once
/// Measures bodies that roll: they turn about a level axle and are round about it.
///
/// h(φ) is the support function of all its shapes in the plane across the axle: the reach from the axle in direction φ.
/// A body is round if min h ≥ kRoundness · max h; a polygon with 10 sides has 0.951, a hexagon 0.87. It is also round
/// if max h − min h is below both kOutOfRound and kMaxOutOfRound · max h. This allows an eccentricity of 1 mm and the
/// sides of a polygon.
///
/// Only the shapes that reach as far as the farthest (within 2 %) count. A rim, a motor or an axle beside the tyre does
/// not show the radius. If these shapes are not round, the farthest shape that is round by itself counts. No other
/// shape may reach beyond it by more than 10 %, which allows the corners of a hub's box.
///   radius  that of a cylinder or sphere around the axle, as given; else the distance of the farthest corner. If that
///           exceeds the median over all directions by more than kTrueRunning, it is the median: a bump, an oval or an
///           axle beside the centre does not change how far the wheel rolls in a turn
///   centre, width  from the ends of those shapes along the axle; for a mesh, from the points within 3 % of its rim
/// A sphere is as wide as it is high.

#include <string>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {

/// An axle may deviate from the lateral axis, and a shape from its axle, by 0.2°.
inline constexpr double kAxleTolerance = 0.2 * 3.14159265358979323846 / 180;
inline constexpr double kRoundness = 0.95;
inline constexpr double kOutOfRound = 0.0026;    ///< m
inline constexpr double kMaxOutOfRound = 0.128;  ///< a hexagon, which is no wheel at any size, has 0.134
inline constexpr double kTrueRunning = 0.005;

/// A reason why a body is not a wheel, and the changes of the file that make it one.
inline constexpr const char* kFixedWheel = "it is type=\"fixed\", but a drive wheel needs type=\"continuous\"";
inline constexpr const char* kContinuous = "Set type=\"continuous\" on the joint of each drive wheel";
inline constexpr const char* kLateralAxis = "Set <axis xyz=\"0 1 0\"/>, or correct <origin rpy=\"…\"> of the joint";
inline constexpr const char* kRoundShape = "Add a <collision> with a <cylinder> or <sphere> about the axle";

struct RollingMeasure {
  std::string objection;    ///< why it does not roll, with numbers; empty: it rolls
  std::string fix;          ///< the change of the file that makes it roll
  bool nearly = false;      ///< one number of the file keeps it from rolling, and `objection` names it
  double out_of_round = 0;  ///< m by which the farthest corner exceeds the radius; 0: runs true
  Vector3 centre_base{};    ///< m, centre of the shape
  double radius = 0;        ///< m
  double width = 0;         ///< m
  double inertia = 0;       ///< kg·m² about the axle
  Eigen::Vector3d centre_in_body = Eigen::Vector3d::Zero();
  Eigen::Vector3d axle_in_root = Eigen::Vector3d::UnitY();
};

/// Measures a wheel. Its inertia is aᵀ I a + m |d⊥|² with the axle a and the distance d⊥ of the centre of gravity from
/// it.
RollingMeasure measure_wheel(const RigidBody& body);

/// Returns true if the body turns about an axle that is level within 5°.
bool turns_upright(const RigidBody& body);

/// Returns the angle between the lines of the axle and the lateral axis, in rad.
double axle_tilt(const RollingMeasure& measure);

/// Returns the shape of `body` that reaches farthest from its axle; null if it has none.
const Shape* rolling_shape(const RigidBody& body);

}  // namespace robot_control
