#include "estimation/legged/legged_estimator.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "machine/gravity.h"
#include "signals/rotation.h"

namespace robot_control {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Map = Eigen::Map<Vector3d>;
using ConstMap = Eigen::Map<const Vector3d>;

constexpr double kPositionVariance = 1e-6;  // m², of the pose of a robot that never walked
constexpr double kAngleVariance = 1e-4;     // rad²
constexpr double kSpeedVariance = 1e-4;     // m²/s²

Quaterniond quaternion(const std::array<double, 4>& q) noexcept {
  return {q[3], q[0], q[1], q[2]};
}

void store(const Quaterniond& q, std::array<double, 4>& to) noexcept {
  const Quaterniond unit = q.normalized();
  to = {unit.x(), unit.y(), unit.z(), unit.w()};
}

Quaterniond turned_by(const Vector3d& angle) noexcept {
  return Quaterniond(1, angle.x() / 2, angle.y() / 2, angle.z() / 2).normalized();
}

}  // namespace

/// The feet in one step, in base axes.
struct LeggedEstimator::Feet {
  std::array<Vector3d, kLegs> place;            ///< m
  std::array<Eigen::Matrix3d, kLegs> jacobian;  ///< m/rad
  std::array<Vector3d, kLegs> body_velocity;    ///< m/s, of the base if this foot stands
  std::array<Vector3d, kLegs> rolling;          ///< m/s, of the foot's centre over the ground
  std::array<double, kLegsJoints> angles{};     ///< rad
};

LeggedEstimator::LeggedEstimator(const LegModel& robot, double period)
    : period_(period),
      legs_(robot.legs),
      dynamics_(robot),
      base_from_imu_(rotation_of(robot.imu_in_base.orientation)),
      share_(dynamics_.mass() * kGravity / kLegs),
      belly_ground_(robot.belly) {
  for (const Leg& leg : legs_) belly_ground_ += leg.foot_radius / kLegs;
}

void LeggedEstimator::resume(const StateFrame& last) noexcept {
  state_ = {};
  state_.attitude = last.base.pose_odom.orientation;
  state_.position = last.base.pose_odom.position;
  state_.distance = last.base.distance;
  Map(state_.bias.data()) = base_from_imu_ * ConstMap(last.base.gyro_bias.data());
  state_.ground = belly_ground_;
  state_.grounded = state_.begun = 1;
}

void LeggedEstimator::set_pose(const Vector3& pose) noexcept {
  const Quaterniond now = quaternion(state_.attitude);
  const double yaw = yaw_of({now.x(), now.y(), now.z(), now.w()});
  store(Quaterniond(Eigen::AngleAxisd(pose[2] - yaw, Vector3d::UnitZ())) * now, state_.attitude);
  state_.position[0] = pose[0];
  state_.position[1] = pose[1];
  state_.bears = {};  // each foot gets a new anchor
}

void LeggedEstimator::step(const SensorFrame& sensors, StateFrame& out) noexcept {
  const std::uint64_t cycle = sensors.head.cycle;
  const std::uint64_t elapsed = state_.stepped != 0 && cycle > state_.last_cycle ? cycle - state_.last_cycle : 1;
  state_.stepped = 1;
  state_.last_cycle = cycle;
  const double dt = static_cast<double>(elapsed) * period_;
  const bool measured = joints_have(sensors, kLegsJoints, kValidMotion);
  const bool felt = turn(sensors, dt);
  const Feet feet = observe(sensors);
  if (measured) {
    weigh(sensors, feet);
    move(feet, dt);
  }
  write(sensors, feet, felt && measured, out);
}

/// Returns whether gyro and accelerometer were valid.
bool LeggedEstimator::turn(const SensorFrame& sensors, double dt) noexcept {
  const Vector3d rate = base_from_imu_ * ConstMap(sensors.imu.angular_velocity.data());
  const Vector3d force = base_from_imu_ * ConstMap(sensors.imu.linear_acceleration.data());
  const bool gyro = (sensors.valid & kValidGyro) != 0 && rate.allFinite();
  const bool accelerometer = (sensors.valid & kValidAccelerometer) != 0 && force.allFinite();
  bool moves = !gyro || (rate - ConstMap(state_.bias.data())).cwiseAbs().maxCoeff() > kStill;
  for (std::size_t i = 0; i < kLegsJoints; ++i) moves = moves || std::abs(valid_velocity(sensors.joints[i])) > kStill;
  state_.still = moves ? 0 : state_.still + dt;
  if (accelerometer && state_.begun == 0 && force.norm() > kBand) {
    state_.begun = 1;
    store(Quaterniond::FromTwoVectors(force, Vector3d::UnitZ()), state_.attitude);
  }
  if (gyro) {
    if (state_.still > kRest) Map(state_.bias.data()) += dt / kBiasTime * (rate - ConstMap(state_.bias.data()));
    Map(state_.rate.data()) = rate - ConstMap(state_.bias.data());
  }
  if (accelerometer) correct(force, dt);
  store(quaternion(state_.attitude) * turned_by(dt * ConstMap(state_.rate.data())), state_.attitude);
  return gyro && accelerometer;
}

void LeggedEstimator::correct(const Vector3d& force, double dt) noexcept {
  if (std::abs(force.norm() - kGravity) > kBand) return;
  const Quaterniond now = quaternion(state_.attitude);
  const Vector3d up = now.conjugate() * Vector3d::UnitZ();
  const double time = state_.still > kRest ? kTiltAtRest : kTilt;
  store(now * turned_by(dt / time * force.normalized().cross(up)), state_.attitude);
}

LeggedEstimator::Feet LeggedEstimator::observe(const SensorFrame& sensors) const noexcept {
  Feet feet;
  const Vector3d up = quaternion(state_.attitude).conjugate() * Vector3d::UnitZ();
  const Vector3d rate = ConstMap(state_.rate.data());
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const JointSample* const joints = &sensors.joints[kLegJoints * leg];
    for (std::size_t i = 0; i < kLegJoints; ++i)
      feet.angles[kLegJoints * leg + i] = has_position(joints[i]) ? joints[i].position : 0;
    const Vector3d speeds(valid_velocity(joints[0]), valid_velocity(joints[1]), valid_velocity(joints[2]));
    const LegGeometry& geometry = legs_[leg].kinematics.geometry();
    feet.jacobian[leg] = legs_[leg].kinematics.jacobian(LegModel::angles_of(feet.angles, leg), feet.place[leg]);
    const double first = geometry.sign[0] * feet.angles[kLegJoints * leg];
    const double pitching = geometry.sign[1] * speeds[1] + geometry.sign[2] * speeds[2];
    const Vector3d shank =
        rate + Vector3d(geometry.sign[0] * speeds[0], pitching * std::cos(first), pitching * std::sin(first));
    feet.rolling[leg] = legs_[leg].foot_radius * shank.cross(up);
    feet.body_velocity[leg] = feet.rolling[leg] - feet.jacobian[leg] * speeds - rate.cross(feet.place[leg]);
  }
  return feet;
}

void LeggedEstimator::measure_loads(const SensorFrame& sensors, const Vector3d& up) noexcept {
  for (std::size_t leg = 0; leg < kLegs; ++leg)
    state_.loads[leg] = up.dot(ConstMap(sensors.contacts[leg].force.data()));
}

void LeggedEstimator::compute_loads(const SensorFrame& sensors, const Feet& feet, const Vector3d& up) noexcept {
  LeggedEquations equations;
  dynamics_.step({.angles = feet.angles, .gravity = -kGravity * up}, equations);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const JointSample* const joints = &sensors.joints[kLegJoints * leg];
    const Vector3d effort = Vector3d(joints[0].effort, joints[1].effort, joints[2].effort) -
                            equations.bias.segment<3>(static_cast<Eigen::Index>(6 + kLegJoints * leg));
    const double load = -up.dot(feet.jacobian[leg].transpose().inverse() * effort);
    state_.loads[leg] = load;
  }
}

void LeggedEstimator::weigh(const SensorFrame& sensors, const Feet& feet) noexcept {
  const Quaterniond attitude = quaternion(state_.attitude);
  const Vector3d up = attitude.conjugate() * Vector3d::UnitZ();
  const bool sensed =
      sensors.contact_count >= kLegs && std::all_of(sensors.contacts.begin(), sensors.contacts.begin() + kLegs,
                                                    [](const ContactSample& contact) { return contact.valid != 0; });
  if (sensed) {
    measure_loads(sensors, up);
  } else {
    compute_loads(sensors, feet, up);
  }
  const std::array<std::uint64_t, kLegs> before = state_.bears;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    if (!std::isfinite(state_.loads[leg])) state_.loads[leg] = 0;
    const double bound = (state_.bears[leg] != 0 ? kFloats : kBears) * share_;
    state_.bears[leg] = state_.loads[leg] > bound ? 1 : 0;
  }
  if (before == state_.bears) return;
  double height = 0, count = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    Map(state_.anchors[leg].data()) = ConstMap(state_.position.data()) + attitude * feet.place[leg];
    if (state_.bears[leg] == 0) continue;
    height += state_.anchors[leg][2];
    count += 1;
  }
  if (before != std::array<std::uint64_t, kLegs>{}) return;
  if (state_.grounded == 0) state_.ground = height / count;
  state_.grounded = 1;
  const double rise = state_.ground - height / count;
  state_.position[2] += rise;
  for (Vector3& anchor : state_.anchors) anchor[2] += rise;
}

void LeggedEstimator::move(const Feet& feet, double dt) noexcept {
  const Quaterniond attitude = quaternion(state_.attitude);
  Vector3d position = Vector3d::Zero(), velocity = Vector3d::Zero();
  double count = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    if (state_.bears[leg] == 0) continue;
    Map(state_.anchors[leg].data()) += dt * (attitude * feet.rolling[leg]);
    position += ConstMap(state_.anchors[leg].data()) - attitude * feet.place[leg];
    velocity += feet.body_velocity[leg];
    count += 1;
  }
  Map smoothed(state_.velocity.data());
  if (count == 0) {
    smoothed.setZero();
    if (state_.still > kRest) state_.position[2] = 0;
    return;
  }
  state_.distance += (position / count - ConstMap(state_.position.data())).norm();
  Map(state_.position.data()) = position / count;
  smoothed += std::min(1.0, dt / kSmooth) * (velocity / count - smoothed);
}

void LeggedEstimator::write(const SensorFrame& sensors, const Feet& feet, bool good, StateFrame& out) const noexcept {
  out = {};
  BaseState& base = out.base;
  base.pose_odom = {.position = state_.position, .orientation = state_.attitude};
  base.twist_base = {.linear = state_.velocity, .angular = state_.rate};
  base.attitude = state_.attitude;
  for (std::size_t i = 0; i < 6; ++i) {
    base.pose_covariance[7 * i] = i < 3 ? kPositionVariance : kAngleVariance;
    base.twist_covariance[7 * i] = i < 3 ? kSpeedVariance : kAngleVariance;
  }
  for (std::size_t i = 0; i < 3; ++i) base.attitude_covariance[4 * i] = kAngleVariance;
  Map(base.gyro_bias.data()) = base_from_imu_.transpose() * ConstMap(state_.bias.data());
  base.distance = state_.distance;
  base.flags = (state_.begun != 0 ? std::uint64_t{kStateValid} : 0) | (good ? 0 : std::uint64_t{kStateBadSample}) |
               (state_.still > kRest ? std::uint64_t{kStateStandstill} : 0);
  out.contact_count = kLegs;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const bool bears = state_.bears[leg] != 0;
    out.contacts[leg].probability = bears ? 1 : 0;
    out.contacts[leg].load = state_.loads[leg];
    out.contacts[leg].slip = bears ? (feet.body_velocity[leg] - ConstMap(state_.velocity.data())).norm() : 0;
  }
  for (std::size_t i = 0; i < kLegsJoints; ++i) out.joint_velocity[i] = valid_velocity(sensors.joints[i]);
}

}  // namespace robot_control
