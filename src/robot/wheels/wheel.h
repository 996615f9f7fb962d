#pragma once
/// What rolls: a body that turns about a level axle and is round about it.
///
/// h(φ), the support function of all its shapes in the plane across the axle, from the axle: how far it reaches in
/// direction φ. Round: min h ≥ kRoundness · max h (a polygon with 10 sides has 0.951, a hexagon 0.87), or max h − min h
/// is below kOutOfRound (an eccentricity of 1 mm and the sides of a polygon) and kMostOutOfRound · max h. Only the
/// shapes that reach as far as the farthest (within 2 %) count: a rim, a motor or an axle beside the tyre says nothing
/// of the radius. Where these are not round, the farthest shape that is round by itself counts, if nothing reaches
/// beyond it by more than 10 %: a hub's box may have corners.
///   radius  that of a cylinder or sphere around the axle, as it stands; else the distance of the farthest corner, or
///           where that exceeds the median over all directions by more than kTrueRunning, that median: a bump, an oval
///           or an axle beside the centre does not change how far the wheel rolls in a turn
///   centre, width  from the ends of those shapes along the axle; of a mesh, of what lies within 3 % of its rim
/// A sphere is as wide as it is high.

#include <string>

#include "robot/bodies/rigid_bodies.h"

namespace robot_control {

/// An axle deviates from the lateral axis by less than this, and so does a shape from its axle: 0.2°.
inline constexpr double kAxleTolerance = 0.2 * 3.14159265358979323846 / 180;
inline constexpr double kRoundness = 0.95;
inline constexpr double kOutOfRound = 0.0026;     ///< m
inline constexpr double kMostOutOfRound = 0.128;  ///< a hexagon, which is no wheel at any size, has 0.134
inline constexpr double kTrueRunning = 0.005;

struct RollingMeasure {
  std::string objection;    ///< why it does not roll, with numbers; empty: it does
  double out_of_round = 0;  ///< m, of the farthest corner beyond the radius; 0: runs true
  WheelModel wheel;         ///< `sign` +1 where the axle points left; `joint` and `side` are left to the caller
  Eigen::Vector3d centre_in_body = Eigen::Vector3d::Zero();
  Eigen::Vector3d axle_in_root = Eigen::Vector3d::UnitY();
};

/// inertia: aᵀ I a + m |d⊥|², a the axle, d⊥ the centre of gravity's distance from it.
RollingMeasure measure_wheel(const RigidBody& body);

/// It turns about an axle that is level within 5°.
bool turns_upright(const RigidBody& body);

/// Between the axle and the lateral axis, whichever way both point; rad.
double axle_tilt(const RollingMeasure& measure);

/// The shape of `body` that reaches farthest from its axle; null when it has none.
const Shape* rolling_shape(const RigidBody& body);

}  // namespace robot_control
