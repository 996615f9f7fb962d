#include "estimation/wheels/slip_watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimation/filter/algebra.h"
#include "signals/state_frame.h"

namespace robot_control {
namespace {

using algebra::square;
using Filter = ErrorStateFilter;
constexpr std::size_t kLeft = 0;
constexpr std::size_t kRight = 1;
constexpr std::size_t kLateral = 2;
constexpr std::size_t kVertical = 3;
constexpr std::array<int, kContacts> kAxis{0, 0, 1, 2};
constexpr double kVerticalSlack = 0.004;  // m: a bump that a wheel takes in its stride
constexpr int kTurning[4] = {Filter::kGyroBias + 2, Filter::kRadiusRatio, Filter::kWheelBase, Filter::kGyroScale};
constexpr double kSigmas = 4;
constexpr double kInflation = 3;      // deviations of the window's end speed: it was a slide that made the window
constexpr double kYoungest = 0.04;    // s
constexpr double kShaken = 0.4;       // share of its limit from which a residual shakes the belief in a contact
constexpr double kEase = 0.3;         // share of its limit up to which the slip proximity is 0
constexpr std::size_t kLearning = 2;  // index of the window that bias and tilt learn from
constexpr double kSame = 0.3;         // part of the acceleration by which two of them differ at most

}  // namespace

void SlipWatch::reset() noexcept {
  states_ = {};
  windows_ = {};
  since_judged_ = 0;
  no_slip_time_ = kNoSlipTime;
  shaken_ = 0;
  reasons_ = 0;
  turn_nis_ = travel_nis_ = slip_proximity_ = 0;
  turn_slips_ = false;
}

void SlipWatch::begin(const Filter& filter) noexcept {
  reset();
  renew(filter);
}

void SlipWatch::renew(const Filter& filter) noexcept {
  for (Window& window : windows_) open(window, filter);
}

void SlipWatch::open(Window& window, const Filter& filter) const noexcept {
  window = {};
  const auto& p = filter.covariance;
  window.velocity_variance = p.diagonal().segment<3>(Filter::kVelocity);
  window.acceleration_variance = filter.acceleration_deviation().cwiseAbs2().array() + square(kLeastAcceleration);
  window.tilt_variance = square(Filter::kGravity) * std::max(p(Filter::kOrientation, Filter::kOrientation),
                                                             p(Filter::kOrientation + 1, Filter::kOrientation + 1));
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) window.turning_covariance(i, j) = p(kTurning[i], kTurning[j]);
  }
}

void SlipWatch::step(const Sample& sample, Filter& filter) noexcept {
  const auto& g = filter.geometry();
  const Eigen::Vector3d& u = filter.velocity;
  const Eigen::Vector3d& w = filter.rate;
  const double scale[2] = {1 / (1 - filter.radius_ratio / 2), 1 / (1 + filter.radius_ratio / 2)};
  const Vector4 measured{sample.left, sample.right, 0, 0};
  Vector4 predicted;
  for (const int side : {0, 1}) {
    predicted[static_cast<std::size_t>(side)] = sample.dt * scale[side] * filter.tread_speed(side, u, w);
  }
  predicted[kLateral] = sample.dt * (u.y() + w.z() * g.middle_x - w.x() * g.height - filter.creep_across());
  predicted[kVertical] = sample.dt * (u.z() + w.x() * g.middle_y - w.y() * g.middle_x);
  const double forward = sample.dt * std::abs(u.x());
  const Eigen::Vector3d pulled = filter.acceleration_by(filter.corrections());

  for (std::size_t i = 0; i < kWindows; ++i) {
    Window& window = windows_[i];
    window.inertial = window.inertial && sample.inertial;
    auto d = window.corrections.segment<3>(Filter::kVelocity);
    window.acceleration += pulled;
    d += filter.corrections().segment<3>(Filter::kVelocity) + sample.dt * (window.acceleration - w.cross(d));
    window.corrections.head<6>() += filter.corrections().head<6>();
    window.corrections.tail<9>() += filter.corrections().tail<9>();
    window.corrections.segment<3>(Filter::kPosition) += sample.dt * (filter.rotation * d);
    window.way += sample.dt * d;
    for (const std::size_t c : {kLeft, kRight}) {
      window.measured[c] += measured[c];
      window.predicted[c] += predicted[c];
      window.path[c] += std::max(std::abs(measured[c]), std::abs(predicted[c]));
    }
    for (const std::size_t c : {kLateral, kVertical}) {
      window.predicted[c] += predicted[c];
      window.path[c] += forward;
    }
    window.age += sample.dt;
    window.turn += sample.dt * w.z();
  }
  for (State& state : states_) {
    (state.trusted ? state.trusted_time : state.distrusted_time) += sample.dt;
    if (state.trusted_time >= kNoSlipTime) state.unsure = 0;
  }
  const auto trusted = [](const State& state) { return state.trusted; };
  no_slip_time_ = std::ranges::all_of(states_, trusted) ? no_slip_time_ + sample.dt : 0;
  if (no_slip_time_ == 0) shaken_ = 0;

  since_judged_ += sample.dt;
  if (since_judged_ >= kJudgeEvery) {
    since_judged_ = 0;
    judge(filter);
  }
}

double SlipWatch::residual(const Window& window, std::size_t contact) noexcept {
  return window.measured[contact] - window.predicted[contact] + window.way[kAxis[contact]];
}

/// m per error: what a wheel's travel in the window gets from the errors of kTurning.
Eigen::Vector4d SlipWatch::by_turning(const Window& window, int side, const Filter& filter) noexcept {
  const double sign = side == 0 ? 0.5 : -0.5;
  const double lever = filter.lever(side);
  return {lever * window.age, sign * window.predicted[static_cast<std::size_t>(side)],
          -sign * filter.geometry().wheel_base * window.turn, -lever * window.turn};
}

double SlipWatch::turning_variance(const Window& window, const Eigen::Vector4d& by) noexcept {
  return by.dot(window.turning_covariance * by);
}

double SlipWatch::variance(const Window& window, std::size_t contact, const Filter& filter) noexcept {
  const int axis = kAxis[contact];
  const double t = window.age;
  const auto& noise = filter.noise();
  // A bias that tilt made good is made good no more after a turn: an acceleration that grows from nothing.
  const double turned = window.tilt_variance * square(window.turn / 3);
  double sum = window.velocity_variance[axis] * t * t +
               (window.acceleration_variance[axis] + turned) * square(t * t) / 4 +
               square(noise.accelerometer) * t * t * t / 3;
  if (contact <= kRight) {
    sum += 2 * square(noise.encoder) + (square(noise.wheel_slip) + square(noise.common_slip)) * window.path[contact] +
           turning_variance(window, by_turning(window, static_cast<int>(contact), filter));
  }
  return sum;
}

double SlipWatch::excess(const Window& window, std::size_t contact, const Filter& filter) noexcept {
  const double limit = kSigmas * std::sqrt(variance(window, contact, filter)) + kCreep * window.path[contact] +
                       (contact == kVertical ? kVerticalSlack : kSlack);
  return std::abs(residual(window, contact)) / limit;
}

/// The oldest of the windows that sees any of `contacts` beyond a share of its limit: it began before the sliding did.
const SlipWatch::Window& SlipWatch::oldest_that_sees(const std::array<bool, kContacts>& contacts, const Window& sure,
                                                     const Filter& filter) const noexcept {
  const Window* oldest = &sure;
  for (const Window& window : windows_) {
    if (!window.inertial || window.age <= oldest->age) continue;
    for (std::size_t c = 0; c < kContacts; ++c) {
      if (contacts[c] && excess(window, c, filter) > kShaken) oldest = &window;
    }
  }
  return *oldest;
}

bool SlipWatch::judge(const Window& window, Filter& filter) noexcept {
  std::array<bool, kContacts> slides{};
  bool found = false;
  for (std::size_t c = 0; c < kContacts; ++c) {
    slides[c] = states_[c].trusted && excess(window, c, filter) > 1;
    found = found || slides[c];
  }
  if (!found) return false;
  const Window& whole = oldest_that_sees(slides, window, filter);
  const double age = whole.age;
  std::array<double, 3> inflation{};
  std::array<double, 3> way{};
  for (std::size_t c = 0; c < kContacts; ++c) {
    // A contact near its limit is distrusted together with another that exceeds it: two wheels on ice rarely begin
    // together.
    if (!states_[c].trusted || !(slides[c] || excess(window, c, filter) > kShaken)) continue;
    const double unsure = states_[c].unsure;
    states_[c] = {.trusted = false, .excess = residual(window, c) / window.age};
    const auto axis = static_cast<std::size_t>(kAxis[c]);
    if (std::abs(residual(whole, c)) > std::abs(way[axis])) way[axis] = residual(whole, c);
    inflation[axis] = std::max({inflation[axis], kInflation * std::sqrt(variance(whole, c, filter)) / age, unsure});
  }
  undo(whole, {inflation[0] > 0, inflation[1] > 0, inflation[2] > 0}, filter);
  for (int axis = 0; axis < 3; ++axis) {
    const double deviation = inflation[static_cast<std::size_t>(axis)];
    if (deviation > 0) filter.inflate_velocity(axis, deviation, age);
    if (deviation > 0) filter.inflate_position(axis, way[static_cast<std::size_t>(axis)] / 2);
  }
  return true;
}

/// What was used of a sliding contact since the window began: the whole way, the velocity along its axis, and what
/// that made of the acceleration. Bias and tilt keep what they have learned apart from each other. Of wheels also yaw,
/// the gyro's bias about it, and calibration. Older windows keep the rest of their corrections; younger ones began with
/// what was wrong, and restart.
void SlipWatch::undo(const Window& window, const std::array<bool, 3>& axes, Filter& filter) noexcept {
  const double age = window.age;
  const Filter::Column& made = window.corrections;
  Filter::Column back = Filter::Column::Zero();
  Eigen::Vector3d pulled = Eigen::Vector3d::Zero();
  back.segment<3>(Filter::kPosition) = -made.segment<3>(Filter::kPosition);
  for (int axis = 0; axis < 3; ++axis) {
    if (!axes[static_cast<std::size_t>(axis)]) continue;
    back[Filter::kVelocity + axis] = -made[Filter::kVelocity + axis];
    back[Filter::kAccelerometerBias + axis] = window.acceleration[axis];
    pulled[axis] = window.acceleration[axis];
  }
  if (axes[0]) {
    back[Filter::kOrientation + 2] = -made[Filter::kOrientation + 2];
    for (const int index : kTurning) back[index] = -made[index];
  }
  filter.inject(back);
  for (Window& other : windows_) {
    if (other.age > age) {
      other.corrections += back;
      other.acceleration -= pulled;
    } else {
      open(other, filter);
    }
  }
}

/// A window in which everything rolled shows what the accelerometer's bias and the tilt are together.
void SlipWatch::learn_acceleration(const Window& window, Filter& filter) noexcept {
  if (!window.inertial || no_slip_time_ < kNoSlipTime) return;
  const double per_way = 2 / square(window.age);
  const Eigen::Vector3d excess_by = per_way * Eigen::Vector3d{(residual(window, kLeft) + residual(window, kRight)) / 2,
                                                              residual(window, kLateral), residual(window, kVertical)};
  double worst = 0;
  for (std::size_t c = 0; c < kContacts; ++c) worst = std::max(worst, excess(window, c, filter));
  const bool same = (excess_by - shaken_by_).norm() <= kSame * excess_by.norm();
  shaken_by_ = excess_by;
  shaken_ = worst > kShaken && same ? shaken_ + 1 : 0;
  if (worst > kShaken && shaken_ < kSteady) return;
  for (const int axis : {0, 1, 2}) {
    const double start = 4 * window.velocity_variance[axis] / square(window.age);
    // A way weighs what came first twice: the mean acceleration is that of a third of the window.
    filter.correct_acceleration(axis, excess_by[axis], start + square(kRoughness), window.turn * 2 / 3);
  }
}

void SlipWatch::re_accept(const Window& window, const Filter& filter) noexcept {
  for (std::size_t c = 0; c < kContacts; ++c) {
    State& state = states_[c];
    if (state.trusted) continue;
    const int axis = kAxis[c];
    const double excess = residual(window, c) / window.age;
    const double deviation = std::sqrt(filter.covariance(Filter::kVelocity + axis, Filter::kVelocity + axis));
    const double known = 3 * deviation;
    const double speed = window.path[c] / window.age;
    const double cap = std::max(0.05, 0.3 * speed);
    const double read = c <= kRight ? kSigmas * std::numbers::sqrt2 * filter.noise().encoder / window.age : 0;
    const double same = std::max(kAgreeSpeed, read);
    const bool agrees = std::abs(excess) <= same + kCreep * speed + std::min(known, cap);
    const bool steady = std::abs(excess - state.excess) <= same;
    state.excess = excess;
    state.agreed = agrees && steady ? state.agreed + 1 : 0;
    const double enough = c == kVertical ? kLanded : kAgree * std::clamp(deviation / kSure, 1.0, kLonger);
    if (static_cast<double>(state.agreed) >= enough || state.distrusted_time > kDeadlock) {
      state = {.unsure = deviation};
      if (c == kVertical) continue;
      for (Window& other : windows_) {
        other.measured[c] -= residual(other, c);
        other.path[c] = 0;
      }
    }
  }
}

void SlipWatch::judge(Filter& filter) noexcept {
  bool found = false;
  slip_proximity_ = 0;
  for (const Window& window : windows_) {
    if (!window.inertial || window.age < kYoungest) continue;
    slip_proximity_ = std::max({slip_proximity_, excess(window, kLeft, filter), excess(window, kRight, filter)});
  }
  slip_proximity_ = std::clamp((slip_proximity_ - kEase) / (1 - kEase), 0.0, 1.0);
  for (std::size_t i = 0; i < kWindows && !found; ++i) {
    if (windows_[i].inertial && windows_[i].age >= 0.4 * kLengths[i]) found = judge(windows_[i], filter);
  }
  if (windows_[0].inertial) {
    const Window& one = windows_[0];
    const Window& other = windows_[1];
    const bool first = one.age >= kYoungest && (one.age < other.age || other.age < kYoungest);
    const Window& young = first ? one : other;
    if (young.age >= kYoungest) re_accept(young, filter);
  }
  if (!windows_[0].inertial) {
    for (State& state : states_) state = {};
  }
  // The newer window of the two looks over the shorter time; the turn needs no accelerometer.
  const Window& longest = windows_[4].age > windows_[5].age ? windows_[4] : windows_[5];
  const bool received = std::isfinite(longest.measured[kLeft]) && std::isfinite(longest.measured[kRight]);
  if (longest.age > 0 && received) {
    const double left = residual(longest, kLeft);
    const double right = residual(longest, kRight);
    const auto& noise = filter.noise();
    const double path = longest.path[kLeft] + longest.path[kRight];
    const Eigen::Vector4d by = by_turning(longest, 1, filter) - by_turning(longest, 0, filter);
    const double var = 4 * square(noise.encoder) + square(noise.wheel_slip) * path + turning_variance(longest, by) +
                       square(noise.gyro) * longest.age * square(filter.geometry().wheel_base);
    turn_nis_ = square(right - left) / var;
    turn_slips_ = std::abs(right - left) > kSigmas * std::sqrt(var) + kCreep * path + kSlack;
    travel_nis_ = square((left + right) / 2) / variance(longest, kLeft, filter);
  } else {
    turn_slips_ = false;
  }
  for (std::size_t i = 0; i < kWindows; ++i) {  // the two of a length stay half a length apart
    Window& window = windows_[i];
    if (i == kLearning && window.age >= kLengths[i] - 1e-9) learn_acceleration(window, filter);
    const bool twin = i % 2 == 1 && window.age == windows_[i - 1].age && window.age >= kLengths[i] / 2 - 1e-9;
    if (twin || window.age >= kLengths[i] - 1e-9) open(window, filter);
  }
  report(filter);
}

void SlipWatch::report(const Filter& filter) noexcept {
  reasons_ = 0;
  for (const std::size_t c : {kLeft, kRight}) {
    if (states_[c].trusted || states_[c].agreed >= kReported) continue;
    reasons_ |= c == kLeft ? kSlipLeft : kSlipRight;
    const double forward = filter.velocity.x();
    const bool faster = std::abs(forward + states_[c].excess) > std::abs(forward);
    reasons_ |= faster ? kSlipSpinning : kSlipStalled;
  }
  if (turn_slips_) reasons_ |= kSlipTurn;
  if (!states_[kLateral].trusted && states_[kLateral].agreed < kReported) reasons_ |= kSlipSideways;
  if (!states_[kVertical].trusted) reasons_ |= kSlipLifted;
}

}  // namespace robot_control
