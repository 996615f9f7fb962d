#include "estimation/legged/legged_estimator.h"

#include <algorithm>
#include <cmath>

#include "estimation/legged/small_turn.h"
#include "machine/gravity.h"
#include "signals/rotation.h"

namespace robot_control {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Map = Eigen::Map<Vector3d>;
using ConstMap = Eigen::Map<const Vector3d>;

constexpr double kFirstTilt = 0.3;          // rad, of the first sample of an accelerometer
constexpr double kPlainTilt = 0.05;         // rad
constexpr double kPlainSpeed = 0.05;        // m/s
constexpr double kHeightDeviation = 0.005;  // m, of a robot that lies or stands on level ground
constexpr double kRestRate = 0.01;          // rad/s, of one sample of the gyro
constexpr double kRestSpeed = 0.02;         // m/s
constexpr double kFallSpeed = 1;            // m/s, of a body on the ground: its velocity vanishes within 0.3 s
// The densities of the filter exceed white noise, so that errors which repeat with every step do not look like
// knowledge of the tilt. The velocity is better than they say, by this part of the variance
// (docs/evidence/derivations.md).
constexpr double kSpeedPart = 0.07;

/// Returns which feet bear: as the command asked, or, where none is asked to, all that do. A foot that stood still does
/// while it may bear. Without the angles of all joints no foot is known to bear.
std::array<bool, kLegs> feet_that_bear(const SensorFrame& sensors, const LeggedEstimator::State& state) noexcept {
  std::array<bool, kLegs> bear{};
  if (!joints_have(sensors, kLegsJoints, kValidMotion)) return bear;
  const bool asked = feet_asked(sensors);
  for (std::size_t leg = 0; leg < kLegs; ++leg)
    bear[leg] = (FootContacts::bears(state.contacts.probability[leg]) ||
                 (state.stands[leg] != 0 && state.contacts.probability[leg] > 0)) &&
                (sensors.gate.contact_schedule[leg] > 0 || !asked);
  return bear;
}

}  // namespace

LeggedEstimator::LeggedEstimator(const LegModel& robot, double period)
    : period_(period),
      footfall_(kFootfall * robot.leg_length()),
      creep_(footfall_ / std::sqrt(std::sqrt(robot.leg_length() / kGravity))),
      foot_speed_(kFootSpeed * std::sqrt(robot.leg_length() * kGravity)),
      legs_(robot.legs),
      contacts_(robot),
      ground_(robot.leg_length()),
      base_from_imu_(rotation_of(robot.imu_in_base.orientation)),
      imu_(robot.imu_in_base.position.data()),
      belly_ground_(robot.belly) {
  for (const Leg& leg : legs_) belly_ground_ += leg.foot_radius / kLegs;
  enter_run();
}

void LeggedEstimator::enter_run() noexcept {
  state_ = {};
  for (int axis = 0; axis < 3; ++axis) {
    leg_filter().set_variance(LegFilter::kRateBias + axis, LegFilter::kGyroBias * LegFilter::kGyroBias);
    leg_filter().set_variance(LegFilter::kForceBias + axis,
                              LegFilter::kAccelerometerBias * LegFilter::kAccelerometerBias);
  }
  set_height(0);
}

void LeggedEstimator::resume(const StateFrame& last) noexcept {
  const BaseState& base = last.base;
  enter_run();
  Map(state_.filter.rate_bias.data()) = base_from_imu_ * ConstMap(base.gyro_bias.data());
  Map(state_.filter.force_bias.data()) = base_from_imu_ * ConstMap(base.accelerometer_bias.data());
  state_.plain = {.attitude = base.pose_odom.orientation,
                  .bias = state_.filter.rate_bias,
                  .velocity = base.twist_base.linear,
                  .position = base.pose_odom.position};
  const Quaterniond attitude = quaternion_of(base.pose_odom.orientation);
  Map(state_.filter.position.data()) = ConstMap(base.pose_odom.position.data()) + attitude * imu_;
  leg_filter().begin(attitude, attitude * ConstMap(base.twist_base.linear.data()), kPlainTilt, kPlainSpeed);
  for (std::size_t i = 0; i < 3; ++i)
    leg_filter().set_variance(LegFilter::kPlace + static_cast<int>(i), base.pose_covariance[7 * i]);
  leg_filter().set_variance(LegFilter::kTurn + 2, base.pose_covariance[35]);
  state_.distance = base.distance;
  state_.begun = 1;
}

void LeggedEstimator::set_pose(const Vector3& pose) noexcept {
  const double turn = pose[2] - yaw_of(state_.filter.attitude);
  leg_filter().turn(turn);
  store(Quaterniond(Eigen::AngleAxisd(turn, Vector3d::UnitZ())) * quaternion_of(state_.plain.attitude),
        state_.plain.attitude);
  const Vector3d at = position();
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    state_.filter.position[axis] += pose[axis] - at[i];
    leg_filter().set_variance(LegFilter::kPlace + static_cast<int>(axis), 0);
  }
  leg_filter().set_variance(LegFilter::kTurn + 2, 0);
}

Vector3d LeggedEstimator::rate() const noexcept {
  return ConstMap(state_.rate.data()) - ConstMap(state_.filter.rate_bias.data());
}

Vector3d LeggedEstimator::velocity() const noexcept {
  return quaternion_of(state_.filter.attitude).conjugate() * ConstMap(state_.filter.velocity.data()) -
         rate().cross(imu_);
}

Vector3d LeggedEstimator::position() const noexcept {
  return ConstMap(state_.filter.position.data()) - quaternion_of(state_.filter.attitude) * imu_;
}

void LeggedEstimator::set_height(double height) noexcept {
  state_.filter.position[2] += height - position()[2];
  leg_filter().set_variance(LegFilter::kPlace + 2, kHeightDeviation * kHeightDeviation);
}

void LeggedEstimator::step(const SensorFrame& sensors, StateFrame& out) noexcept {
  const std::uint64_t cycle = sensors.head.cycle;
  const std::uint64_t elapsed = state_.stepped != 0 && cycle > state_.last_cycle ? cycle - state_.last_cycle : 1;
  state_.stepped = 1;
  state_.last_cycle = cycle;
  const double dt = static_cast<double>(elapsed) * period_;
  const bool measured = joints_have(sensors, kLegsJoints, kValidMotion);
  const bool felt = read(sensors, dt);
  const Vector3d up = quaternion_of(state_.filter.attitude).conjugate() * Vector3d::UnitZ();
  const Vector3d normal = quaternion_of(state_.filter.attitude).conjugate() * ConstMap(state_.ground.normal.data());
  const FeetMotion feet = feet_motion(legs_, sensors, rate(), normal);
  if (state_.begun != 0) {
    if (measured) {
      const Vector3d force = ConstMap(state_.force.data()) - ConstMap(state_.filter.force_bias.data());
      contacts_.step(sensors, feet, rate(), force, up, dt, state_.contacts);
    }
    const PlainLegs::Input input{.rate = ConstMap(state_.rate.data()),
                                 .force = ConstMap(state_.force.data()),
                                 .at_rest = state_.still > kRestTime,
                                 .asked = feet_asked(sensors),
                                 .dt = dt};
    PlainLegs::turn(input, state_.plain);
    if (measured) PlainLegs::move(input, feet, feet_that_bear(sensors, state_), state_.plain);
    compare(filter(sensors, feet, dt), dt);
    state_.distance += dt * velocity().norm();
  }
  write(sensors, feet, felt && measured, out);
}

/// Returns whether gyro and accelerometer were valid.
bool LeggedEstimator::read(const SensorFrame& sensors, double dt) noexcept {
  const Vector3d rate = base_from_imu_ * ConstMap(sensors.imu.angular_velocity.data());
  const Vector3d force = base_from_imu_ * ConstMap(sensors.imu.linear_acceleration.data());
  const bool gyro = (sensors.valid & kValidGyro) != 0 && rate.allFinite();
  const bool accelerometer = (sensors.valid & kValidAccelerometer) != 0 && force.allFinite();
  Map mean(state_.mean_rate.data());
  if (gyro) Map(state_.rate.data()) = rate;
  if (gyro) mean += std::min(1.0, dt / kMeanTime) * (rate - mean);
  const bool measured = joints_have(sensors, kLegsJoints, kValidMotion);
  bool moves = !gyro || !measured || (rate - mean).cwiseAbs().maxCoeff() > kRestRate ||
               (mean - ConstMap(state_.filter.rate_bias.data())).cwiseAbs().maxCoeff() > kMaxBias;
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    double& joint = state_.mean_rates[i];
    joint += std::min(1.0, dt / kMeanTime) * (valid_velocity(sensors.joints[i]) - joint);
    moves = moves || std::abs(joint) > kRestRate;
  }
  if (moves && state_.still > kRestTime) {
    for (int axis = 0; axis < 3; ++axis) leg_filter().set_variance(LegFilter::kSpeed + axis, kPlainSpeed * kPlainSpeed);
  }
  state_.still = moves ? 0 : state_.still + dt;
  if (accelerometer) Map(state_.force.data()) = force;
  if (accelerometer && state_.begun == 0 && force.norm() > PlainLegs::kBand) {
    state_.begun = 1;
    const Quaterniond attitude = Quaterniond::FromTwoVectors(force, Vector3d::UnitZ());
    store(attitude, state_.plain.attitude);
    leg_filter().begin(attitude, Vector3d::Zero(), kFirstTilt, kRestSpeed);
    Map(state_.filter.position.data()) = attitude * imu_;
    set_height(0);
  }
  return gyro && accelerometer;
}

/// Returns whether feet bear, and none shows the filter's velocity.
bool LeggedEstimator::filter(const SensorFrame& sensors, const FeetMotion& feet, double dt) noexcept {
  LegFilter filter(state_.filter);
  filter.predict(ConstMap(state_.rate.data()), ConstMap(state_.force.data()), feet.rolling, creep_, dt);
  const std::array<bool, kLegs> bear = feet_that_bear(sensors, state_);
  const bool lost = stand(bear, feet, filter);
  const bool borne = bear != std::array<bool, kLegs>{} || feet_asked(sensors);
  state_.lies = borne ? 0 : state_.lies + dt;
  const double once = std::sqrt(0.001 / dt);
  if (state_.still > kRestTime) {
    filter.rest(ConstMap(state_.rate.data()), kRestRate * once);
    filter.stop(kRestSpeed * once);
  } else if (!borne && joints_have(sensors, kLegsJoints, kValidMotion)) {
    filter.stop(kFallSpeed * once);
  }
  filter.finish();
  if (std::min(state_.lies, state_.still) > kRestTime) {
    set_height(state_.ground.known != 0 ? state_.filter.ground - belly_ground_ : position()[2]);
    state_.lay = state_.ground.known;
  }
  return lost;
}

bool LeggedEstimator::stand(const std::array<bool, kLegs>& bear, const FeetMotion& feet, LegFilter& filter) noexcept {
  const double deviation = std::sqrt(filter.speed_variance() + foot_speed_ * foot_speed_);
  // At rest the body keeps its place, not the feet: the model lets them creep.
  for (std::size_t leg = 0; leg < kLegs && state_.still <= kRestTime; ++leg)
    if (state_.stands[leg] != 0 && bear[leg]) filter.hold(leg);
  bool any = false, all_move = true;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    const Vector3d place = feet.place[leg] - imu_;
    const bool moves = (velocity() - feet.base_velocity[leg]).norm() > kStandGate * deviation;
    any = any || bear[leg];
    all_move = all_move && (moves || !bear[leg]);
    const bool stood = state_.stands[leg] != 0;
    state_.stands[leg] = bear[leg] && (stood || !moves) ? 1 : 0;
    if (state_.stands[leg] == 0) continue;
    if (stood) {
      filter.stand(leg, place);
    } else {
      filter.land(leg, place);
      if (state_.lay != 0) set_height(position()[2] + state_.filter.ground - filter.height(leg));
      state_.lay = 0;
      ground_.footfall(leg, footfall_, filter, state_.ground);
    }
  }
  return any && all_move;
}

void LeggedEstimator::compare(bool lost, double dt) noexcept {
  const Vector3d plain = ConstMap(state_.plain.velocity.data());
  state_.degraded = std::max(0.0, state_.degraded - dt);
  state_.apart = lost ? state_.apart + dt : 0;
  if (state_.apart < kDivergenceTime) return;
  state_.apart = 0;
  state_.degraded = kDegraded;
  const Quaterniond turn(
      Eigen::AngleAxisd(yaw_of(state_.filter.attitude) - yaw_of(state_.plain.attitude), Vector3d::UnitZ()));
  const Quaterniond attitude = turn * quaternion_of(state_.plain.attitude);
  const Vector3d at = position();
  leg_filter().begin(attitude, attitude * (plain + rate().cross(imu_)), kPlainTilt, kPlainSpeed);
  Map(state_.filter.position.data()) += at - position();
  state_.stands = {};
  state_.ground.fallen = {};
}

void LeggedEstimator::write(const SensorFrame& sensors, const FeetMotion& feet, bool good,
                            StateFrame& out) const noexcept {
  out = {};
  BaseState& base = out.base;
  Map(base.pose_odom.position.data()) = position();
  base.pose_odom.orientation = base.attitude = state_.filter.attitude;
  Map(base.twist_base.linear.data()) = velocity();
  Map(base.twist_base.angular.data()) = rate();
  write_covariances(base);
  Map(base.gyro_bias.data()) = base_from_imu_.transpose() * ConstMap(state_.filter.rate_bias.data());
  Map(base.accelerometer_bias.data()) = base_from_imu_.transpose() * ConstMap(state_.filter.force_bias.data());
  base.distance = state_.distance;
  if (state_.degraded > 0) base.degraded = kDegradedPosition;
  base.flags = (state_.begun != 0 ? std::uint64_t{kStateValid} : 0) | (good ? 0 : std::uint64_t{kStateBadSample}) |
               (state_.still > kRestTime ? std::uint64_t{kStateStandstill} : 0) |
               (state_.degraded > 0 ? std::uint64_t{kStateDegraded} : 0);
  out.contact_count = kLegs;
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    out.contacts[leg].probability = state_.contacts.probability[leg];
    out.contacts[leg].load = state_.contacts.loads[leg];
    out.contacts[leg].slip = state_.stands[leg] != 0 ? (feet.base_velocity[leg] - velocity()).norm() : 0;
  }
  for (std::size_t i = 0; i < kLegsJoints; ++i) out.joint_velocity[i] = valid_velocity(sensors.joints[i]);
}

void LeggedEstimator::write_covariances(BaseState& base) const noexcept {
  using Matrix6d = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  Eigen::Map<Matrix6d> pose(base.pose_covariance.data()), twist(base.twist_covariance.data());
  const auto P = Eigen::Map<const LegFilter::Covariance, Eigen::Aligned16>(state_.filter.covariance.data());
  const Matrix3d into_base = quaternion_of(state_.filter.attitude).conjugate().toRotationMatrix();
  constexpr int kTurn = LegFilter::kTurn, kPlace = LegFilter::kPlace;
  pose.topLeftCorner<3, 3>() = P.block<3, 3>(kPlace, kPlace);
  pose.topRightCorner<3, 3>() = P.block<3, 3>(kPlace, kTurn);
  pose.bottomLeftCorner<3, 3>() = P.block<3, 3>(kTurn, kPlace);
  pose.bottomRightCorner<3, 3>() = P.block<3, 3>(kTurn, kTurn);
  twist.topLeftCorner<3, 3>() =
      kSpeedPart * into_base * P.block<3, 3>(LegFilter::kSpeed, LegFilter::kSpeed) * into_base.transpose();
  twist.bottomRightCorner<3, 3>() = P.block<3, 3>(LegFilter::kRateBias, LegFilter::kRateBias);
  twist.diagonal().tail<3>().array() += kRestRate * kRestRate;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(base.attitude_covariance.data()) =
      P.block<3, 3>(kTurn, kTurn);
  const Matrix3d biases =
      base_from_imu_.transpose() * P.block<3, 3>(LegFilter::kRateBias, LegFilter::kRateBias) * base_from_imu_;
  Map(base.gyro_bias_deviation.data()) = biases.diagonal().cwiseMax(0).cwiseSqrt();
}

}  // namespace robot_control
