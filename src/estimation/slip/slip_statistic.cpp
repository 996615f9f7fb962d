#include "estimation/slip/slip_statistic.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/values.h"

namespace robot_control {
namespace {

constexpr double kSlow = 0.02;      // m/s², what no inertial sensor on a moving robot knows better
constexpr double kSlip = 2e-3;      // m/√m
constexpr double kWindUp = 1.6e-3;  // rad/√(rad/s)
constexpr double kStep = 0.5;
constexpr double kUsual = 0.1;     // share of the speed of one comparison in the usual one
constexpr double kSlowest = 0.01;  // m/s: slower than that nothing is learned
constexpr double kCalmLevel = 3;   // level
constexpr std::uint64_t kFirst = 8;
constexpr double kProof = 5;
constexpr double kSeconded = 3;
constexpr double kNormal90 = 1.645;    // deviations, the 90 % quantile of |normal|
constexpr std::size_t kLevelSpan = 1;  // index of T = 0.2 s
constexpr std::size_t kTiltSpan = 2;   // index of T = 0.4 s

}  // namespace

SlipStatistic::SlipStatistic(const SlipStatisticParams& params) noexcept : params_(params) {}

void SlipStatistic::restart() noexcept {
  count_ = 0;
  const double yaw = now_.yaw;
  now_ = {};
  now_.yaw = yaw;
  inertial_ = before_ = {};
  learned_at_ = {};
  proven_ = {};
  pulled_at_ = path_began_ = 0;
  pull_ = {};
  onset_ = {};
  nis_.fill(-1);
}

void SlipStatistic::restart_on(const Planar& slope) noexcept {
  const Planar speed = now_.speed;
  const double rate = now_.rate;
  restart();
  now_.rate = rate;
  now_.speed = speed;
  constexpr std::size_t kPast = 34;  // points: twice the longest span
  for (std::size_t i = kPast; i-- > 0;) {
    Point point = now_;
    point.time = -static_cast<double>(i) * kGrid;
    point.e = {slope.x * point.time, slope.y * point.time};
    points_[count_++] = point;
  }
  before_ = {-lever_.x, -lever_.y};
}

/// Nose up, an IMU above the contacts moves backwards.
Planar SlipStatistic::lever(double yaw, const Vector3& up) const noexcept {
  const double ahead = params_.ahead - params_.height * up[0];
  const double aside = params_.aside - params_.height * up[1];
  const double c = std::cos(yaw);
  const double n = std::sin(yaw);
  return {c * ahead - n * aside, n * ahead + c * aside};
}

bool SlipStatistic::step(const Sample& s) noexcept {
  now_.time += s.dt;
  const double middle = s.yaw - s.turned / 2;
  const double c = std::cos(middle);
  const double n = std::sin(middle);
  const double ax = c * s.acceleration[0] - n * s.acceleration[1];
  const double ay = n * s.acceleration[0] + c * s.acceleration[1];
  inertial_.x += (now_.speed.x + ax * s.dt / 2) * s.dt;
  inertial_.y += (now_.speed.y + ay * s.dt / 2) * s.dt;
  now_.speed.x += ax * s.dt;
  now_.speed.y += ay * s.dt;
  now_.yaw = s.yaw;
  now_.rate = s.rate;
  now_.path += s.path;
  now_.w += s.across - params_.wheel_base * s.turned;
  lever_ = lever(s.yaw, s.up);
  before_.x += s.way.x;
  before_.y += s.way.y;
  now_.e = {before_.x + lever_.x - inertial_.x, before_.y + lever_.y - inertial_.y};
  if (!s.read || (count_ > 0 && now_.time - last().time < kGrid * (1 - 1e-9))) return false;
  points_[count_++ % kPoints] = now_;
  return true;
}

const SlipStatistic::Point& SlipStatistic::before(double time) const noexcept {
  const std::size_t oldest = count_ > kPoints ? count_ - kPoints : 0;
  std::size_t i = count_ - 1;
  while (i > oldest && points_[i % kPoints].time > time + 1e-9) --i;
  return points_[i % kPoints];
}

SlipStatistic::Second SlipStatistic::second_difference(double span) const noexcept {
  const Point& end = last();
  const Point& middle = before(end.time - 0.9 * span);
  const double late = end.time - middle.time;
  const Point& first = before(middle.time - 0.9 * late);
  const double early = middle.time - first.time;
  Second second;
  second.known = late > 0.8 * span && late < 1.6 * span && early > 0.8 * late && early < 1.6 * late;
  if (!second.known) return second;
  second.span = late;
  second.path = end.path - first.path;
  second.turned = end.yaw - first.yaw;
  second.changed = end.rate - middle.rate;
  const double x = end.e.x - middle.e.x - (middle.e.x - first.e.x) * late / early;
  const double y = end.e.y - middle.e.y - (middle.e.y - first.e.y) * late / early;
  const Planar gained{end.speed.x - first.speed.x, end.speed.y - first.speed.y};
  second.gained = std::min({second.path / late, std::hypot(gained.x, gained.y),
                            std::hypot(gained.x + 2 * x / late, gained.y + 2 * y / late)});
  const double c = std::cos(middle.yaw);
  const double n = std::sin(middle.yaw);
  second.d = {c * x + n * y, c * y - n * x, end.w - middle.w};
  return second;
}

SlipStatistic::Noise SlipStatistic::best() const noexcept {
  return {.white = params_.accelerometer, .slow = kSlow, .jitter = 0, .slip = params_.slip};
}

double SlipStatistic::deviation(std::size_t channel, const Second& s, const Noise& noise,
                                const Doubts& doubts) const noexcept {
  if (channel == kTurn) {
    const double b = params_.wheel_base;
    return std::sqrt(4 * square(params_.encoder) + 2 * square(noise.slip) * s.path +
                     square(b * doubts.base * s.turned) + square(b * kWindUp) * std::abs(s.changed) +
                     square(b * doubts.bias * s.span) + square(noise.jitter * b * s.changed));
  }
  const double slow = square(noise.slow) + doubts.acceleration[channel];
  return std::sqrt(6 * square(params_.encoder) + square(noise.white) * s.span * s.span * s.span * 2 / 3 +
                   slow * square(s.span * s.span) + 2 * square(kSlip) * s.path + 6 * square(noise.jitter * s.speed()));
}

double SlipStatistic::at_speed(double level, double speed) const noexcept {
  const double faster = std::max(1.0, speed / std::max(kSlowest, usual_speed_));
  return std::sqrt(1 + (square(level) - 1) * square(faster));
}

double SlipStatistic::expected(std::size_t span, std::size_t channel, const Second& s,
                               const Doubts& doubts) const noexcept {
  const double least = deviation(channel, s, best(), doubts);
  const double level = level_[span][channel];
  const double usual =
      level == 0 ? std::max(least, deviation(channel, s, kFloor, doubts)) : at_speed(level, s.speed()) * least;
  return std::hypot(usual, doubts.offset * (channel == kTurn ? params_.wheel_base * s.changed : s.gained));
}

void SlipStatistic::judge(const Doubts& doubts, bool learns) noexcept {
  std::array<Second, kCount> seconds;
  for (std::size_t i = 0; i < kCount; ++i) seconds[i] = second_difference(kSpans[i]);
  if (seconds[kTiltSpan].known) speed_ = seconds[kTiltSpan].speed();
  proven_ = {};
  for (std::size_t c = 0; c < kChannels; ++c) {
    const auto exceeds = [&](std::size_t i, double deviations) {
      return seconds[i].known && std::abs(seconds[i].d[c]) > deviations * expected(i, c, seconds[i], doubts);
    };
    for (std::size_t i = kCount - 1; i-- > 0;) {
      if (exceeds(i, kProof) && exceeds(i + 1, kSeconded)) proven_[c] = seconds[i].span;
    }
    if (seconds[0].known) slope_[c] = expected(0, c, seconds[0], doubts) / seconds[0].span;
    if (proven_[c] > 0) {
      for (std::size_t i = 0; i < kCount; ++i) {
        const double least = seconds[i].known ? deviation(c, seconds[i], best(), doubts) : 1;
        onset_[i][c] = seconds[i].known ? std::abs(seconds[i].d[c]) / least / kProof : 0;
      }
    }
    nis_[c] = seconds[1].known ? square(seconds[1].d[c] / expected(1, c, seconds[1], doubts)) : -1;
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    const Second& second = seconds[i];
    const bool unknown = level_[i][kAlong] == 0;
    if ((learns || unknown) && second.known && second.path > kSlowest * second.span &&
        now_.time - learned_at_[i] >= second.span) {
      learn(i, second, doubts);
    }
  }
  pull_.known = false;
  const Second& tilt = seconds[kTiltSpan];
  if (!tilt.known || !learns || now_.time - pulled_at_ < tilt.span) return;
  const double squared = square(tilt.span);
  const double usual = expected(kTiltSpan, kAlong, tilt, {});
  pull_ = {.known = true,
           .along = -tilt.d[kAlong] / squared,
           .across = -tilt.d[kAcross] / squared,
           .variance = square(usual / squared),
           .interval = now_.time - pulled_at_};
  pulled_at_ = now_.time;
}

void SlipStatistic::learn(std::size_t span, const Second& second, const Doubts& doubts) noexcept {
  learned_at_[span] = now_.time;
  if (span == kTiltSpan)
    usual_speed_ +=
        std::max(kUsual, 1.0 / static_cast<double>(seen_[span][kAlong] + 1)) * (second.speed() - usual_speed_);
  for (std::size_t c = 0; c < kChannels; ++c) {
    const double ratio = std::abs(second.d[c]) / deviation(c, second, best(), doubts) / kNormal90;
    double& level = level_[span][c];
    const std::uint64_t seen = ++seen_[span][c];
    if (seen <= kFirst) largest_[span][c] = std::max(largest_[span][c], ratio);
    if (seen == kFirst) level = std::max(1.0, largest_[span][c]);
    if (seen > kFirst) level = std::max(1.0, level * std::exp(ratio > level ? 0.9 * kStep : -0.1 * kStep));
  }
}

void SlipStatistic::learn_false() noexcept {
  for (std::size_t i = 0; i < kCount; ++i) {
    for (std::size_t c = 0; c < kChannels; ++c) level_[i][c] = std::max(level_[i][c], std::exchange(onset_[i][c], 0));
  }
}

bool SlipStatistic::calm() const noexcept {
  return level() > 0 && level() < kCalmLevel;
}

double SlipStatistic::level() const noexcept {
  return level_[kLevelSpan][kAlong];
}

double SlipStatistic::white() const noexcept {
  const double level = level_[kTiltSpan][kAlong];
  return level == 0 ? kFloor.white : at_speed(level, speed_) * params_.accelerometer;
}

double SlipStatistic::slow(double acceleration_variance) const noexcept {
  const double level = level_[kTiltSpan][kAlong];
  return std::sqrt(square(level == 0 ? kFloor.slow : at_speed(level, speed_) * kSlow) + acceleration_variance);
}

}  // namespace robot_control
