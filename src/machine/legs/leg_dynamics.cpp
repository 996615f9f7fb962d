#include "machine/legs/leg_dynamics.h"

#include <Eigen/Geometry>
#include <cmath>

#include "machine/bodies/rigid_bodies.h"

namespace robot_control {
namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

/// A motion or a force about the base's origin: angular and linear velocity, or moment and force.
struct Spatial {
  Vector angular = Vector::Zero();
  Vector linear = Vector::Zero();
  double dot(const Spatial& other) const noexcept { return angular.dot(other.angular) + linear.dot(other.linear); }
  Spatial operator*(double factor) const noexcept { return {factor * angular, factor * linear}; }
  Spatial operator+(const Spatial& other) const noexcept { return {angular + other.angular, linear + other.linear}; }
};

/// The inertia of bodies about the base's origin.
struct Inertia {
  double mass = 0;
  Vector first = Vector::Zero();  ///< m c
  Matrix second = Matrix::Zero();

  void add(const Inertia& other) noexcept {
    mass += other.mass;
    first += other.first;
    second += other.second;
  }
  Spatial operator*(const Spatial& motion) const noexcept {
    return {second * motion.angular + first.cross(motion.linear), mass * motion.linear - first.cross(motion.angular)};
  }
};

Inertia about_origin(double mass, const Vector& centre, const Matrix& about_centre) noexcept {
  Inertia result{mass, mass * centre, about_centre};
  result.second.noalias() -= result.first * centre.transpose();
  result.second.diagonal().array() += result.first.dot(centre);
  return result;
}

/// Returns v × m of two motions.
Spatial cross(const Spatial& v, const Spatial& m) noexcept {
  return {v.angular.cross(m.angular), v.angular.cross(m.linear) + v.linear.cross(m.angular)};
}

/// Returns v × f of a motion and a force.
Spatial cross_force(const Spatial& v, const Spatial& f) noexcept {
  return {v.angular.cross(f.angular) + v.linear.cross(f.linear), v.angular.cross(f.linear)};
}

/// Turns a vector about y, then about x.
struct Turn {
  double s1 = 0, c1 = 1, s = 0, c = 1;
  Vector operator*(const Vector& v) const noexcept {
    const double x = v.x() * c + v.z() * s, z = v.z() * c - v.x() * s;
    return {x, c1 * v.y() - s1 * z, s1 * v.y() + c1 * z};
  }
  Matrix matrix() const noexcept {
    Matrix r;
    r << c, 0, s, s1 * s, c1, -s1 * c, -c1 * s, s1, c1 * c;
    return r;
  }
};

/// Joints and bodies of one leg at a moment; `force` is what their motion with a = 0 needs.
struct MovedLeg {
  std::array<Spatial, kLegJoints> screw, force;
  std::array<Inertia, kLegJoints> inertia;
};

/// The force that moves a body with this speed and acceleration.
Spatial needed(const Inertia& inertia, const Spatial& speed, const Spatial& change) noexcept {
  return inertia * change + cross_force(speed, inertia * speed);
}

std::array<Turn, kLegJoints> turns(const LegGeometry& geometry, const double* angles) noexcept {
  const double s1 = std::sin(geometry.sign[0] * angles[0]), c1 = std::cos(geometry.sign[0] * angles[0]);
  const double second = geometry.sign[1] * angles[1], third = second + geometry.sign[2] * angles[2];
  return {Turn{s1, c1, 0, 1}, Turn{s1, c1, std::sin(second), std::cos(second)},
          Turn{s1, c1, std::sin(third), std::cos(third)}};
}

}  // namespace

LegDynamics::LegDynamics(const LegModel& model) : rotor_inertia_(model.rotor_inertia) {
  const RigidBody& root = model.bodies->bodies[0];
  base_ = {root.mass, root.centre_of_gravity, root.inertia};
  mass_ = root.mass;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    geometry_[leg] = model.legs[leg].kinematics.geometry();
    for (std::size_t i = 0; i < kLegJoints; ++i) {
      const RigidBody& body = *model.bodies->moved_by(model.joints[3 * leg + i].name);
      const Matrix turn = body.in_root.linear();
      bodies_[leg][i] = {body.mass, turn * body.centre_of_gravity, turn * body.inertia * turn.transpose()};
      mass_ += body.mass;
    }
  }
}

namespace {

template <class Body>
MovedLeg moved(const LegGeometry& geometry, const std::array<Body, kLegJoints>& bodies, const double* angles,
               const double* rates, const double* accelerations, Spatial speed, Spatial change) noexcept {
  const std::array<Turn, kLegJoints> turn = turns(geometry, angles);
  const std::array<Vector, kLegJoints> arm{geometry.hip, turn[0] * geometry.upper, turn[1] * geometry.lower};
  const Vector lateral(0, turn[0].c1, turn[0].s1);
  const std::array<Vector, kLegJoints> axis{Vector(geometry.sign[0], 0, 0), geometry.sign[1] * lateral,
                                            geometry.sign[2] * lateral};
  MovedLeg leg;
  Vector origin = Vector::Zero();
  for (std::size_t i = 0; i < kLegJoints; ++i) {
    origin += arm[i];
    leg.screw[i] = {axis[i], origin.cross(axis[i])};
    const Spatial joint_speed = leg.screw[i] * rates[i];
    change = change + cross(speed, joint_speed) + leg.screw[i] * accelerations[i];
    speed = speed + joint_speed;
    const Matrix rotation = turn[i].matrix();
    leg.inertia[i] = about_origin(bodies[i].mass, origin + turn[i] * bodies[i].centre,
                                  rotation * bodies[i].inertia * rotation.transpose());
    leg.force[i] = needed(leg.inertia[i], speed, change);
  }
  return leg;
}

constexpr std::array<double, kLegJoints> kNoAcceleration{};

/// Sums the leg from its foot to the base; `first` is the row of its first joint.
void gather(MovedLeg& leg, Eigen::Index first, double rotor_inertia, Inertia& whole, Spatial& total,
            LeggedEquations& out) noexcept {
  for (std::size_t i = kLegJoints; i-- > 0;) {
    const Eigen::Index row = first + i;
    out.bias[row] = leg.screw[i].dot(leg.force[i]);
    const Spatial column = leg.inertia[i] * leg.screw[i];
    for (std::size_t j = 0; j <= i; ++j) {
      const Eigen::Index other = first + j;
      out.mass(other, row) = out.mass(row, other) = leg.screw[j].dot(column);
    }
    out.mass(row, row) += rotor_inertia;
    out.mass.block<3, 1>(0, row) = column.linear;
    out.mass.block<3, 1>(3, row) = column.angular;
    out.mass.block<1, 3>(row, 0) = column.linear.transpose();
    out.mass.block<1, 3>(row, 3) = column.angular.transpose();
    Spatial& towards = i > 0 ? leg.force[i - 1] : total;
    towards = towards + leg.force[i];
    (i > 0 ? leg.inertia[i - 1] : whole).add(leg.inertia[i]);
  }
}

}  // namespace

void LegDynamics::step(const LeggedMotion& motion, LeggedEquations& out) const noexcept {
  out.mass.setZero();
  const Spatial speed{motion.angular, motion.linear};
  // The spatial acceleration of the base's origin is p̈ − ω × v; gravity acts as an acceleration upwards.
  const Spatial change{Vector::Zero(), -motion.angular.cross(motion.linear) - motion.gravity};
  Inertia whole = about_origin(base_.mass, base_.centre, base_.inertia);
  Spatial total = needed(whole, speed, change);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const std::size_t first = kLegJoints * leg;
    MovedLeg of_base = moved(geometry_[leg], bodies_[leg], &motion.angles[first], &motion.rates[first],
                             kNoAcceleration.data(), speed, change);
    gather(of_base, 6 + first, rotor_inertia_, whole, total, out);
  }
  out.bias.head<3>() = total.linear;
  out.bias.segment<3>(3) = total.angular;
  const Vector& first = whole.first;
  Matrix skew;
  skew << 0, -first.z(), first.y(), first.z(), 0, -first.x(), -first.y(), first.x(), 0;
  out.mass.block<3, 3>(0, 0) = whole.mass * Matrix::Identity();
  out.mass.block<3, 3>(0, 3) = -skew;
  out.mass.block<3, 3>(3, 0) = skew;
  out.mass.block<3, 3>(3, 3) = whole.second;
  out.centre_of_gravity = first / whole.mass;
}

Vector LegDynamics::efforts(std::size_t leg, const LeggedMotion& motion,
                            const LeggedAcceleration& change) const noexcept {
  const std::size_t first = kLegJoints * leg;
  const MovedLeg moving =
      moved(geometry_[leg], bodies_[leg], &motion.angles[first], &motion.rates[first], &change.joints[first],
            {motion.angular, motion.linear}, {change.angular, -motion.angular.cross(motion.linear) - motion.gravity});
  Vector result;
  Spatial sum;
  for (std::size_t i = kLegJoints; i-- > 0;) {
    sum = sum + moving.force[i];
    result[i] = moving.screw[i].dot(sum) + rotor_inertia_ * change.joints[first + i];
  }
  return result;
}

}  // namespace robot_control
