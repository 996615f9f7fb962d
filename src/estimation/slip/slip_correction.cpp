#include "estimation/slip/slip_correction.h"

#include <cmath>

namespace robot_control {
namespace {

double squared_norm(const Planar& v) noexcept {
  return square(v.x) + square(v.y);
}

}  // namespace

PathCorrection SlipCorrection::begin(const MotionDifference& difference, double span, const Input& input) noexcept {
  const Point onset = difference.before(difference.last().time - 0.9 * span);
  const Point older = difference.before(onset.time - span);
  if (!(onset.time > older.time)) return {};
  active_ = true;
  given_up_ = false;
  since_end_ = rolling_time_ = sideways_time_ = standing_time_ = turn_slope_ = 0;
  total_ = {};
  path_deviation_ = 0;
  carried_on_ = {};
  contacts_.slip_all();
  line_.begin(older, onset, input.noise, input.path_slope_deviation);
  path_slope_ = line_.slope();
  onset_speed_ = rotated(onset.velocity + line_.slope(), -onset.yaw).x;
  path_begin_ = difference.path_begin();
  corrected_ = onset.time < path_begin_ ? difference.before(path_begin_) : onset;
  decided_ = onset;
  decide(difference.last(), input);
  PathCorrection correction = correct(difference.last(), input);
  correction.variance += square(Tuning::kCorrectionDeviation) * squared_norm(total_);
  return correction;
}

PathCorrection SlipCorrection::step(const MotionDifference& difference, const Input& input) noexcept {
  const Point now = difference.last();
  const Planar earlier = total_;
  PathCorrection correction = correct(now, input);
  correction.variance +=
      square(Tuning::kCorrectionDeviation) * std::max(0.0, squared_norm(total_) - squared_norm(earlier));
  if (now.time - decided_.time < 2 * Tuning::kPointInterval * (1 - 1e-9)) return correction;
  const double time = now.time - std::max(line_.begin_time(), path_begin_);
  const bool both_slipped = contacts_.both_slip();
  const Planar slope = line_.slope();
  decide(now, input);
  if (both_slipped && !contacts_.both_slip()) {  // the error of the line has moved the path since it was carried on
    const Planar shift = undo(line_.slope() - slope, time, now.yaw);
    correction.shift = correction.shift + shift;
    total_ = total_ + shift;
  }
  if (line_.begin_time() == now.time) carried_on_ = {};
  const double longest = input.sensors_as_specified ? Tuning::kLongestSlide : Tuning::kLongestShakenSlide;
  const bool drifts = sideways_time_ > Tuning::kLongestDrift;
  given_up_ = drifts || now.time - line_.begin_time() > longest;
  if (drifts || (given_up_ && !input.sensors_as_specified)) {
    correction = {-earlier, squared_norm(total_)};
    undone_for_ = Tuning::kUndoneTime;
  }
  if (rolling_time_ >= Tuning::kRollingTime || standing_time_ >= Tuning::kRollingTime || given_up_) end();
  return correction;
}

/// Slopes since the last decision → contacts, line, speeds and reasons.
void SlipCorrection::decide(const Point& to, const Input& input) noexcept {
  const double dt = to.time - decided_.time;
  if (!(dt > 0)) return;
  const double yaw = (to.yaw + decided_.yaw) / 2;
  const Planar path_slope = (to.path_difference - decided_.path_difference) / dt;
  const double turn_slope = (to.turn_difference - decided_.turn_difference) / dt;
  const Planar off_line = rotated(path_slope - line_.slope(), -yaw);
  const Planar bend = rotated(path_slope - std::exchange(path_slope_, path_slope), -yaw);
  const DifferenceSlope excess{.along = off_line.x, .across = off_line.y, .turn = turn_slope};
  const double turn_bend = turn_slope - std::exchange(turn_slope_, turn_slope);
  contacts_.judge(excess, {.along = bend.x, .across = bend.y, .turn = turn_bend}, tolerance(input));
  standing_time_ = stands(to, input) ? standing_time_ + dt : 0;
  if (standing_time_ >= Tuning::kRollingTime) {
    contacts_.roll_all();
    line_.set_slope(-to.velocity);
  } else if (!contacts_.both_slip()) {
    renew_line(to, input, excess);
  }
  rolling_time_ = contacts_.all_roll() ? rolling_time_ + dt : 0;
  sideways_time_ = contacts_.only_sideways() ? sideways_time_ + dt : 0;
  const auto [low, high] = speed_bounds(input.wheel_speed);
  const double speed = input.wheel_speed - contacts_.slipped(excess.along, excess.turn);
  excess_speed_ = input.wheel_speed - std::clamp(speed, low, high);
  const double fastest = std::max(-low, high);
  lateral_speed_ = contacts_.sideways ? std::clamp(-excess.across, -fastest, fastest) : 0;
  reasons_ = contacts_.reasons(excess, input.wheel_speed);
  decided_ = to;
}

SlideContacts::Tolerance SlipCorrection::tolerance(const Input& input) const noexcept {
  const double line = line_.speed_deviation(corrected_.time, input.noise);
  const auto significant = [](double deviation) {
    return std::max(Tuning::kLeastSlip, Tuning::kSignificant * deviation);
  };
  return {.path = significant(std::hypot(line, input.path_slope_deviation)),
          .turn = significant(input.turn_slope_deviation),
          .bend = significant(input.path_slope_deviation)};
}

/// Wheels and gyro stand still, and the body does not brake.
bool SlipCorrection::stands(const Point& to, const Input& input) const noexcept {
  const double dt = to.time - decided_.time;
  const Planar velocity = to.velocity + line_.slope();
  const Planar acceleration = (to.velocity - decided_.velocity) / dt;
  const double speed = velocity.norm();
  const double braking = speed > Tuning::kLeastSlip ? -dot(acceleration, velocity) / speed : acceleration.norm();
  return std::abs(input.wheel_speed) < Tuning::kLeastSlip &&
         std::abs(to.yaw - decided_.yaw) < Tuning::kLeastSlip * dt && braking < Tuning::kSignificant * input.noise.slow;
}

/// Towards the slope that a rolling side shows.
void SlipCorrection::renew_line(const Point& to, const Input& input, const DifferenceSlope& excess) noexcept {
  const double along = contacts_.both_roll() ? excess.along : excess.side(contacts_.slips[0] ? 1 : 0);
  line_.renew(rotated({Tuning::kLineGain * along, contacts_.sideways ? 0 : Tuning::kLineGain * excess.across},
                      (to.yaw + decided_.yaw) / 2),
              input.path_slope_deviation + input.noise.slow * (to.time - decided_.time));
  if (!contacts_.sideways) line_.begin_at(to.time);
}

/// Of the path since the last correction.
PathCorrection SlipCorrection::correct(const Point& to, const Input& input) noexcept {
  const double dt = to.time - std::max(corrected_.time, path_begin_);
  if (to.time <= path_begin_) corrected_ = to;
  if (!(dt > 0)) return {};
  const double share = dt / (to.time - corrected_.time);  // the pose may have been set since then
  const double yaw = (to.yaw + corrected_.yaw) / 2;
  const Planar off_line = rotated((to.path_difference - corrected_.path_difference) * share - line_.slope() * dt, -yaw);
  const double slipped = contacts_.slipped(off_line.x, (to.turn_difference - corrected_.turn_difference) * share);
  const double rolled = input.wheel_speed * dt;
  const auto [low, high] = speed_bounds(input.wheel_speed);
  const double farthest = std::max(-low, high) * dt;
  const Planar off{rolled - std::clamp(rolled - slipped, low * dt, high * dt),
                   std::clamp(contacts_.sideways ? off_line.y : 0, -farthest, farthest)};
  carried_on_.rolled += rolled;
  carried_on_.slipped = carried_on_.slipped + off;
  carried_on_.lowest += low * dt;
  carried_on_.highest += high * dt;
  carried_on_.farthest += farthest;
  const Planar shift = -rotated(off, yaw);
  const double deviation = std::hypot(line_.speed_deviation(to.time, input.noise), input.path_slope_deviation);
  const double before = path_deviation_;
  path_deviation_ += std::min(deviation, high - low) * dt;
  corrected_ = to;
  total_ = total_ + shift;
  return {shift, square(path_deviation_) - square(before)};
}

/// m, odom axes: of a path that followed a line whose slope was wrong by that, m/s, odom axes, for `time` s.
Planar SlipCorrection::undo(const Planar& slope_error, double time, double yaw) noexcept {
  const Planar before = carried_on_.slipped;
  const Planar slipped = before - rotated(slope_error, -yaw) * time;
  const CarriedOn& c = carried_on_;
  carried_on_.slipped = {c.rolled - std::clamp(c.rolled - slipped.x, c.lowest, c.highest),
                         std::clamp(slipped.y, -c.farthest, c.farthest)};
  return rotated(before - carried_on_.slipped, yaw);
}

std::pair<double, double> SlipCorrection::speed_bounds(double wheel_speed) const noexcept {
  const auto [low, high] = std::minmax({0.0, onset_speed_, wheel_speed});
  return {low - Tuning::kLeastSlip, high + Tuning::kLeastSlip};
}

void SlipCorrection::begin_path(const MotionDifference& difference) noexcept {
  if (!active_) return;
  path_begin_ = difference.time();
  corrected_ = difference.last();
  total_ = {};
  carried_on_ = {};
}

void SlipCorrection::end() noexcept {
  if (!active_) return;
  active_ = false;
  since_end_ = 0;
  excess_speed_ = lateral_speed_ = 0;
  contacts_.roll_all();
}

}  // namespace robot_control
