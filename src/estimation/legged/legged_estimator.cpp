#include "estimation/legged/legged_estimator.h"

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

bool stands_asked(const SensorFrame& sensors) noexcept {
  return std::any_of(sensors.gate.stance.begin(), sensors.gate.stance.end(), [](double part) { return part > 0; });
}

}  // namespace

LeggedEstimator::LeggedEstimator(const LegModel& robot, double period)
    : period_(period),
      legs_(robot.legs),
      contacts_(robot),
      base_from_imu_(rotation_of(robot.imu_in_base.orientation)),
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
  const Vector3d up = quaternion(state_.attitude).conjugate() * Vector3d::UnitZ();
  const FeetMotion feet = feet_motion(legs_, sensors, ConstMap(state_.rate.data()), up);
  if (measured) {
    contacts_.step(sensors, feet, ConstMap(state_.rate.data()), ConstMap(state_.force.data()), up, dt, state_.contacts);
    weigh(sensors, feet);
    move(sensors, feet, dt);
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
  if (accelerometer) Map(state_.force.data()) = force;
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

void LeggedEstimator::weigh(const SensorFrame& sensors, const FeetMotion& feet) noexcept {
  const std::array<std::uint64_t, kLegs> before = state_.bears;
  for (std::size_t leg = 0; leg < kLegs; ++leg)
    state_.bears[leg] = FootContacts::bears(state_.contacts.probability[leg]) ? 1 : 0;
  constexpr std::array<std::uint64_t, kLegs> kNone{};
  if (state_.bears == kNone && !stands_asked(sensors)) state_.lay = 1;
  if (before != state_.bears) anchor(feet);
}

void LeggedEstimator::anchor(const FeetMotion& feet) noexcept {
  const Quaterniond attitude = quaternion(state_.attitude);
  double height = 0, count = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    Map(state_.anchors[leg].data()) = ConstMap(state_.position.data()) + attitude * feet.place[leg];
    if (state_.bears[leg] == 0) continue;
    height += state_.anchors[leg][2];
    count += 1;
  }
  if (state_.lay == 0 || count == 0) return;
  state_.lay = 0;
  if (state_.grounded == 0) state_.ground = height / count;
  state_.grounded = 1;
  const double rise = state_.ground - height / count;
  state_.position[2] += rise;
  for (Vector3& anchor : state_.anchors) anchor[2] += rise;
}

void LeggedEstimator::move(const SensorFrame& sensors, const FeetMotion& feet, double dt) noexcept {
  const Quaterniond attitude = quaternion(state_.attitude);
  Vector3d position = Vector3d::Zero(), velocity = Vector3d::Zero();
  double count = 0;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    if (state_.bears[leg] == 0) continue;
    Map(state_.anchors[leg].data()) += dt * (attitude * feet.rolling[leg]);
    position += ConstMap(state_.anchors[leg].data()) - attitude * feet.place[leg];
    velocity += feet.base_velocity[leg];
    count += 1;
  }
  Map smoothed(state_.velocity.data());
  if (count == 0 && stands_asked(sensors)) {
    position = ConstMap(state_.position.data()) + dt * (attitude * smoothed);
    velocity = smoothed;
    count = 1;
  }
  if (count == 0) {
    smoothed.setZero();
    if (state_.still > kRest) state_.position[2] = 0;
    return;
  }
  state_.distance += (position / count - ConstMap(state_.position.data())).norm();
  Map(state_.position.data()) = position / count;
  smoothed += std::min(1.0, dt / kSmooth) * (velocity / count - smoothed);
}

void LeggedEstimator::write(const SensorFrame& sensors, const FeetMotion& feet, bool good, StateFrame& out) const noexcept {
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
    out.contacts[leg].probability = state_.contacts.probability[leg];
    out.contacts[leg].load = state_.contacts.loads[leg];
    out.contacts[leg].slip = state_.bears[leg] != 0 ? (feet.base_velocity[leg] - ConstMap(state_.velocity.data())).norm() : 0;
  }
  for (std::size_t i = 0; i < kLegsJoints; ++i) out.joint_velocity[i] = valid_velocity(sensors.joints[i]);
}

}  // namespace robot_control
