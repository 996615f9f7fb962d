#include "estimation/legged/leg_filter.h"

#include "estimation/legged/small_turn.h"
#include "machine/gravity.h"

namespace robot_control {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Map = Eigen::Map<Vector3d>;
using ConstMap = Eigen::Map<const Vector3d>;

/// The change of the error within one step, I + A dt, as an operator on rows of the covariance.
struct Transition {
  Matrix3d turned;  ///< dt R̂
  Vector3d velocity;
  std::array<Vector3d, kLegs> feet;
  double dt;

  /// Sets x to (I + A dt) x.
  template <class Column>
  void operator()(Column&& x) const noexcept {
    const Vector3d turn = x.template segment<3>(LegFilter::kTurn), speed = x.template segment<3>(LegFilter::kSpeed);
    const Vector3d rate = turned * x.template segment<3>(LegFilter::kRateBias);
    const Vector3d force = turned * x.template segment<3>(LegFilter::kForceBias);
    x.template segment<3>(LegFilter::kTurn) -= rate;
    x.template segment<3>(LegFilter::kSpeed) +=
        dt * Vector3d(kGravity * turn.y(), -kGravity * turn.x(), 0) - velocity.cross(rate) - force;
    x.template segment<3>(LegFilter::kPlace) += dt * (speed - velocity.cross(turn));
    for (std::size_t foot = 0; foot < kLegs; ++foot)
      x.template segment<3>(LegFilter::kFeet + 3 * static_cast<int>(foot)) -= dt * speed + feet[foot].cross(rate);
  }
};

}  // namespace

Quaterniond LegFilter::attitude() const noexcept {
  return quaternion_of(state_.attitude);
}

void LegFilter::begin(const Quaterniond& attitude, const Vector3d& velocity, double tilt, double speed) noexcept {
  store(attitude, state_.attitude);
  state_.velocity = {velocity.x(), velocity.y(), velocity.z()};
  for (int axis = 0; axis < 3; ++axis) {
    if (axis < 2) set_variance(kTurn + axis, tilt * tilt);
    set_variance(kSpeed + axis, speed * speed);
  }
}

void LegFilter::turn(double angle) noexcept {
  const Quaterniond turned(Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
  const Matrix3d matrix = turned.toRotationMatrix();
  store(turned * attitude(), state_.attitude);
  const auto rotate = [&](Vector3& vector) { Map(vector.data()) = (matrix * ConstMap(vector.data())).eval(); };
  rotate(state_.velocity);
  for (Vector3& foot : state_.feet) rotate(foot);
  auto P = covariance();
  for (int entry = 0; entry < kGround; entry += 3) {
    if (entry == kRateBias || entry == kForceBias) continue;
    P.middleRows<3>(entry) = (matrix * P.middleRows<3>(entry)).eval();
    P.middleCols<3>(entry) = (P.middleCols<3>(entry) * matrix.transpose()).eval();
  }
}

void LegFilter::predict(const Vector3d& rate, const Vector3d& force, const std::array<Vector3d, kLegs>& rolling,
                        double creep, double dt) noexcept {
  const Quaterniond before = attitude();
  const Vector3d turn = dt * (rate - ConstMap(state_.rate_bias.data()));
  Transition transition;
  transition.turned = dt * before.toRotationMatrix();
  Map velocity(state_.velocity.data());
  transition.velocity = velocity;
  transition.dt = dt;
  const Vector3d change = (before * turned_by(turn / 2)) * (force - ConstMap(state_.force_bias.data())) * dt -
                          Vector3d(0, 0, kGravity * dt);
  store(before * turned_by(turn), state_.attitude);
  const Vector3d way = dt * (velocity + change / 2);
  Map(state_.position.data()) += way;
  velocity += change;
  for (std::size_t foot = 0; foot < kLegs; ++foot) {
    Map place(state_.feet[foot].data());
    transition.feet[foot] = place;
    place += dt * (before * rolling[foot]) - way;
  }
  auto P = covariance();
  for (int i = 0; i < kEntries; ++i) transition(P.col(i));
  for (int i = 0; i < kEntries; ++i) transition(P.row(i).transpose());
  const auto grow = [&](int entry, double density) {
    P.diagonal().segment<3>(entry).array() += dt * density * density;
  };
  grow(kTurn, kGyroNoise);
  grow(kSpeed, kAccelerometerNoise);
  grow(kRateBias, kGyroWalk);
  grow(kForceBias, kAccelerometerWalk);
  for (std::size_t foot = 0; foot < kLegs; ++foot) grow(kFeet + 3 * static_cast<int>(foot), creep);
}

void LegFilter::set_variance(int entry, double variance) noexcept {
  auto P = covariance();
  P.row(entry).setZero();
  P.col(entry).setZero();
  P(entry, entry) = variance;
}

void LegFilter::land(std::size_t foot, const Vector3d& place) noexcept {
  Map(state_.feet[foot].data()) = attitude() * place;
  const int entry = kFeet + 3 * static_cast<int>(foot);
  for (int axis = 0; axis < 3; ++axis) set_variance(entry + axis, kFoot * kFoot);
  error_.segment<3>(entry).setZero();  // the attitude's error is that of the place, too
}

void LegFilter::stand(std::size_t foot, const Vector3d& place) noexcept {
  const int entry = kFeet + 3 * static_cast<int>(foot);
  const Vector3d error = ConstMap(state_.feet[foot].data()) - attitude() * place;
  auto P = covariance();
  for (int axis = 0; axis < 3; ++axis) {
    const double innovation = error[axis] - error_[entry + axis];
    double& own = P(entry + axis, entry + axis);
    if (innovation * innovation > kGate * kGate * (own + kFoot * kFoot)) {
      own += innovation * innovation;
      held_[foot] = false;
    }
    measure(entry + axis, error[axis], kFoot * kFoot);
  }
}

void LegFilter::rest(const Vector3d& rate, double deviation) noexcept {
  for (int axis = 0; axis < 3; ++axis)
    measure(kRateBias + axis, state_.rate_bias[static_cast<std::size_t>(axis)] - rate[axis], deviation * deviation);
}

void LegFilter::stop(double deviation) noexcept {
  for (int axis = 0; axis < 3; ++axis)
    measure(kSpeed + axis, state_.velocity[static_cast<std::size_t>(axis)], deviation * deviation);
}

/// Returns the change of the foot's height with each entry of the error.
LegFilter::Column LegFilter::height_row(std::size_t foot) const noexcept {
  Column row = Column::Zero();
  row[kTurn] = state_.feet[foot][1];
  row[kTurn + 1] = -state_.feet[foot][0];
  row[kPlace + 2] = row[kFeet + 3 * static_cast<int>(foot) + 2] = 1;
  return row;
}

bool LegFilter::touch(std::size_t foot, double deviation, double gate) noexcept {
  Column row = height_row(foot);
  row[kGround] = -1;
  const Column column = covariance() * row;
  const double innovation = height(foot) - state_.ground - row.dot(error_);
  const double expected = row.dot(column) + deviation * deviation;
  if (innovation * innovation > gate * gate * expected) return false;
  correct(column, innovation, expected);
  return true;
}

void LegFilter::set_ground(std::size_t foot, double deviation) noexcept {
  const Column row = height_row(foot), column = covariance() * row;
  state_.ground = height(foot);
  error_[kGround] = row.dot(error_);
  auto P = covariance();
  P.row(kGround) = column.transpose();
  P.col(kGround) = column;
  P(kGround, kGround) = row.dot(column) + deviation * deviation;
}

bool LegFilter::as_high(std::size_t foot, std::size_t other, double deviation, double gate) const noexcept {
  const Column row = height_row(foot) - height_row(other);
  const double difference = height(foot) - height(other) - row.dot(error_);
  return difference * difference <= gate * gate * (row.dot(covariance() * row) + 2 * deviation * deviation);
}

/// `error` is a measurement of this entry of the error.
void LegFilter::measure(int entry, double error, double variance) noexcept {
  const Column column = covariance().col(entry);
  correct(column, error - error_[entry], column[entry] + variance);
}

/// `column` is the covariance of the error with a measurement, `expected` the variance of its innovation.
void LegFilter::correct(const Column& column, double innovation, double expected) noexcept {
  if (!(expected > 0)) return;
  Column gain = column / expected;
  covariance().noalias() -= gain * column.transpose();
  Vector3d feet = Vector3d::Zero();  // the sum of the gains for the places of those that are held
  int held = 0;
  for (std::size_t foot = 0; foot < kLegs; ++foot) {
    if (!held_[foot]) continue;
    feet += gain.segment<3>(kFeet + 3 * static_cast<int>(foot)) + gain.segment<3>(kTurn).cross(this->foot(foot));
    ++held;
  }
  const Eigen::Vector2d change = (held > 0 ? -1.0 / held : 0) * feet.head<2>() - gain.segment<2>(kPlace);
  covariance().block<2, 2>(kPlace, kPlace) += expected * change * change.transpose();
  gain.segment<2>(kPlace) += change;
  error_ += innovation * gain;
}

void LegFilter::finish() noexcept {
  const Vector3d turn = error_.segment<3>(kTurn);
  const auto corrected = [&](Vector3& value, int entry) {
    Map now(value.data());
    now -= error_.segment<3>(entry);
    now -= turn.cross(now).eval();
  };
  store(turned_by(-turn) * attitude(), state_.attitude);
  corrected(state_.velocity, kSpeed);
  for (std::size_t foot = 0; foot < kLegs; ++foot) corrected(state_.feet[foot], kFeet + 3 * static_cast<int>(foot));
  Map(state_.position.data()) -= error_.segment<3>(kPlace);
  Map(state_.rate_bias.data()) -= error_.segment<3>(kRateBias);
  Map(state_.force_bias.data()) -= error_.segment<3>(kForceBias);
  state_.ground -= error_[kGround];
  error_.setZero();
  held_ = {};
}

}  // namespace robot_control
