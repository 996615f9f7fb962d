#include "estimation/slip/slip_correction.h"

#include <algorithm>
#include <cmath>

#include "estimation/values.h"
#include "signals/state_frame.h"

namespace robot_control {
namespace {

constexpr double kAgreed = 0.15;     // s
constexpr double kStands = 0.25;     // s
constexpr double kLine = 0.4;        // s, over which the line's slope is taken
constexpr double kDoubts = 3;        // deviations
constexpr double kLeastSlip = 0.02;  // m/s
constexpr double kQuiet = 0.15;      // m/s²: a robot that slides brakes by more
constexpr double kSlack = 0.02;      // m/s, of the bounds; rad/s

/// In axes that are turned by that angle.
Planar turned(const Planar& v, double angle) noexcept {
  const double c = std::cos(angle);
  const double n = std::sin(angle);
  return {c * v.x + n * v.y, c * v.y - n * v.x};
}

}  // namespace

SlipCorrection::Step SlipCorrection::begin(const SlipStatistic& statistic, double span, const Known& known) noexcept {
  const SlipStatistic::Point& onset = statistic.before(statistic.last().time - 0.9 * span);
  const SlipStatistic::Point& older = statistic.before(onset.time - std::max(kLine, span));
  const double time = onset.time - older.time;
  if (!(time > 0)) return {};
  active_ = true;
  gave_up_ = false;
  reasons_ = 0;
  since_end_ = 0;
  line_ = {(onset.e.x - older.e.x) / time, (onset.e.y - older.e.y) / time};
  const double heading_x = std::cos(onset.yaw);
  const double heading_y = std::sin(onset.yaw);
  const double before = heading_x * (onset.speed.x + line_.x) + heading_y * (onset.speed.y + line_.y);
  least_ = std::min(0.0, before);
  most_ = std::max(0.0, before);
  onset_speed_ = before;
  onset_deviation_ = std::sqrt(square(known.along) + square(known.slow * time / 2) + square(known.white) * time / 3);
  anchored_ = onset.time;
  counted_ = agreed_ = stood_ = 0;
  total_ = {};
  slips_ = {true, true};
  sideways_ = true;
  path_began_ = statistic.path_began();
  from_ = looked_ = onset;
  slope_ = line_;
  turn_ = 0;
  if (onset.time < path_began_) from_ = statistic.before(path_began_);
  decide(statistic.last(), known);
  Step correction = travel(statistic.last(), known);
  correction.variance += square(kUncertain) * size();
  return correction;
}

std::pair<double, double> SlipCorrection::bounds(const Known& known) const noexcept {
  return {std::min(least_, known.speed) - kSlack, std::max(most_, known.speed) + kSlack};
}

double SlipCorrection::slipped(double along, double turn) const noexcept {
  if (slips_[0] && slips_[1]) return along;
  return slips_[0] ? -turn / 2 : slips_[1] ? turn / 2 : 0;
}

double SlipCorrection::size() const noexcept {
  return square(total_.x) + square(total_.y);
}

double SlipCorrection::speed_deviation(const Known& known) const noexcept {
  const double t = std::max(0.0, from_.time - anchored_);
  return std::sqrt(square(onset_deviation_) + square(known.slow * t) + square(known.white) * t);
}

/// Which sides slip and whether the robot slides across; `off`, m/s: from the line, along, across, and of W.
void SlipCorrection::judge_contacts(const Known& known, const Slope& off, const Slope& bend) noexcept {
  const double doubt = std::max(kLeastSlip, kDoubts * std::hypot(speed_deviation(known), known.along));
  const bool one_sided = std::abs(off.turn) > std::max(kLeastSlip, kDoubts * known.turn);
  for (const std::size_t i : {0U, 1U}) slips_[i] = std::abs(off.side(i)) > doubt;
  if (one_sided && !slips_[0] && !slips_[1]) slips_[std::abs(off.side(0)) > std::abs(off.side(1)) ? 0 : 1] = true;
  if (one_sided && slips_[0] && slips_[1]) {  // one side at least keeps to the line if the other explains all of it
    const std::size_t better = std::abs(off.side(0)) < std::abs(off.side(1)) ? 0 : 1;
    if (std::abs(off.side(better)) < 1.5 * doubt) slips_[better] = false;
  }
  sideways_ = std::abs(off.across) > doubt;
  const double steady = std::max(kLeastSlip, kDoubts * known.along);  // friction bends E, beside the line, too
  for (const std::size_t i : {0U, 1U}) slips_[i] = slips_[i] || std::abs(bend.side(i)) > steady;
  sideways_ = sideways_ || std::abs(bend.across) > steady;
}

/// Wheels and gyro stand still, and the body does not brake, as friction would brake it.
bool SlipCorrection::stands(const SlipStatistic::Point& to, const Known& known, double dt) const noexcept {
  const Planar velocity{to.speed.x + line_.x, to.speed.y + line_.y};
  const Planar acceleration{(to.speed.x - looked_.speed.x) / dt, (to.speed.y - looked_.speed.y) / dt};
  const double speed = std::hypot(velocity.x, velocity.y);
  const double brakes = speed > kSlack ? -(acceleration.x * velocity.x + acceleration.y * velocity.y) / speed
                                       : std::hypot(acceleration.x, acceleration.y);
  return std::abs(known.speed) < kSlack && std::abs(to.yaw - looked_.yaw) < kSlack * dt &&
         brakes < kQuiet + kDoubts * known.slow;
}

/// The line is half that of before, half what a side that rolls says.
void SlipCorrection::renew_line(const SlipStatistic::Point& to, const Known& known, const Slope& off) noexcept {
  const bool both = !slips_[0] && !slips_[1];
  const double along = both ? off.along : off.side(slips_[0] ? 1 : 0);
  const Planar half = turned({0.5 * along, sideways_ ? 0 : 0.5 * off.across}, -(to.yaw + looked_.yaw) / 2);
  line_ = {line_.x + half.x, line_.y + half.y};
  if (!sideways_) anchored_ = to.time;
  counted_ = 0;
  onset_deviation_ = known.along + known.slow * (to.time - looked_.time);
}

void SlipCorrection::decide(const SlipStatistic::Point& to, const Known& known) noexcept {
  const double dt = to.time - looked_.time;
  if (!(dt > 0)) return;
  const double yaw = (to.yaw + looked_.yaw) / 2;
  const Planar slope{(to.e.x - looked_.e.x) / dt, (to.e.y - looked_.e.y) / dt};
  const Planar beside = turned({slope.x - line_.x, slope.y - line_.y}, yaw);
  const Planar bent = turned({slope.x - slope_.x, slope.y - slope_.y}, yaw);
  const double turn = (to.w - looked_.w) / dt;
  const Slope off{.along = beside.x, .across = beside.y, .turn = turn};
  judge_contacts(known, off, {.along = bent.x, .across = bent.y, .turn = turn - turn_});
  slope_ = slope;
  turn_ = turn;
  stood_ = stands(to, known, dt) ? stood_ + dt : 0;
  if (stood_ >= kStands) {
    slips_ = {};
    sideways_ = false;
    line_ = {-to.speed.x, -to.speed.y};
  } else if (!slips_[0] || !slips_[1]) {
    renew_line(to, known, off);
  }
  agreed_ = !slips_[0] && !slips_[1] && !sideways_ ? agreed_ + dt : 0;
  const auto [low, high] = bounds(known);
  excess_ = known.speed - std::clamp(known.speed - slipped(off.along, turn), low, high);
  aside_ = sideways_ ? std::clamp(-off.across, -std::max(-low, high), std::max(-low, high)) : 0;
  name_reasons(known, off.side(0), off.side(1));
  looked_ = to;
}

void SlipCorrection::name_reasons(const Known& known, double left, double right) noexcept {
  reasons_ = 0;
  if (slips_[0]) reasons_ |= kSlipLeft;
  if (slips_[1]) reasons_ |= kSlipRight;
  if (slips_[0] != slips_[1]) reasons_ |= kSlipTurn;
  if (sideways_) reasons_ |= kSlipSideways;
  const double excess[2] = {left, right};  // m/s, of the wheels over the ground
  for (const std::size_t i : {0U, 1U}) {
    if (!slips_[i]) continue;
    const bool faster = std::abs(known.speed) > std::abs(known.speed - excess[i]);
    reasons_ |= faster ? kSlipSpinning : kSlipStalled;
  }
}

SlipCorrection::Step SlipCorrection::travel(const SlipStatistic::Point& to, const Known& known) noexcept {
  const double dt = to.time - from_.time;
  if (!(dt > 0)) return {};
  const double c = std::cos((to.yaw + from_.yaw) / 2);
  const double n = std::sin((to.yaw + from_.yaw) / 2);
  const double x = to.e.x - from_.e.x - line_.x * dt;
  const double y = to.e.y - from_.e.y - line_.y * dt;
  const double turn = to.w - from_.w;
  double along = slipped(c * x + n * y, turn);
  double across = sideways_ ? c * y - n * x : 0;
  const double rolled = known.speed * dt;
  const auto [low, high] = bounds(known);
  along = rolled - std::clamp(rolled - along, low * dt, high * dt);
  const double widest = std::max(-low, high) * dt;
  across = std::clamp(across, -widest, widest);
  const double t = to.time - anchored_;
  const double total =
      square(onset_deviation_ * t) + square(known.slow * t * t / 2) + square(known.white) * t * t * t / 3;
  const double variance = slips_[0] && slips_[1] ? std::max(0.0, total - counted_) : 0;
  counted_ = std::max(counted_, total);
  from_ = to;
  total_.x -= c * along - n * across;
  total_.y -= n * along + c * across;
  return {-c * along + n * across, -n * along - c * across, variance};
}

SlipCorrection::Step SlipCorrection::step(const SlipStatistic& statistic, const Known& known) noexcept {
  const SlipStatistic::Point& now = statistic.now();
  const Planar earlier = total_;
  const double before = size();
  Step correction = travel(now, known);
  correction.variance += square(kUncertain) * std::max(0.0, size() - before);
  if (now.time - looked_.time < 2 * SlipStatistic::kGrid * (1 - 1e-9)) return correction;
  const double carried = now.time - std::max(anchored_, path_began_);
  const bool blind = slips_[0] && slips_[1];
  const Planar line = line_;
  decide(now, known);
  if (blind && (!slips_[0] || !slips_[1])) {  // the line's error grew on the way
    const double x = (line_.x - line.x) * carried;
    const double y = (line_.y - line.y) * carried;
    correction.x += x;
    correction.y += y;
    total_.x += x;
    total_.y += y;
  }
  gave_up_ = now.time - anchored_ > (known.calm ? kLongest : kLongestShaken);
  if (gave_up_ && !known.calm) {  // the plain odometry wins
    correction = {-earlier.x, -earlier.y, size()};
    taken_back_ = kTakenBack;
  }
  if (agreed_ >= kAgreed || stood_ >= kStands || gave_up_) end();
  return correction;
}

void SlipCorrection::begin_path(const SlipStatistic& statistic) noexcept {
  if (!active_) return;
  path_began_ = statistic.now().time;
  from_ = statistic.now();
  total_ = {};
}

void SlipCorrection::end() noexcept {
  if (!active_) return;
  active_ = false;
  since_end_ = 0;
  excess_ = aside_ = 0;
  slips_ = {};
  sideways_ = false;
}

}  // namespace robot_control
