#include "estimation/simple/simple_part.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

SimplePart::SimplePart(const SimplePartParams& params, const WheelGeometry& geometry) noexcept
    : params_(params),
      geometry_(geometry),
      rest_(params.rest, params.gyro_bias),
      tracks_{PlanarTrack(params.track), PlanarTrack(params.track)},
      slip_(params.slip) {
  reset();
}

void SimplePart::reset() noexcept {
  rest_.reset(params_.gyro_bias);
  for (const Horizon horizon : {kShort, kLong}) place(horizon, {}, {});
  tilt_.reset();
  slip_.reset();
  turned_ = credited_ = {};
  rate_ = rested_force_ = 0;
  last_sample_ = silence_ = silent_turn_ = 0;
}

void SimplePart::step(const Input& input) noexcept {
  rest_.step({.dt = input.dt,
              .gyro = input.gyro,
              .accelerometer = input.accelerometer,
              .left = input.travel[0],
              .right = input.travel[1]});
  turn(input);
  roll(input);
  tilt(input);
  const bool inertial = input.gyro && input.accelerometer && !input.lost[0] && !input.lost[1];
  slip_.step({.dt = input.dt,
              .force = input.accelerometer.value_or(Vector3{}),
              .up = tilt_.up(),
              .rate = rate_,
              .left = input.travel[0],
              .right = input.travel[1],
              .read = input.received[1],
              .inertial = inertial,
              .speed = input.speed});
  if (slip_.corrected() && !rest_.resting()) tilt_.pull(slip_.along(), slip_.across(), slip_.interval());
}

void SimplePart::turn(const Input& input) noexcept {
  if (rest_.window_ended()) {
    for (PlanarTrack& track : tracks_) {
      track.take_back(rest_.turned());
      track.learn_bias(rest_.variance());
    }
  }
  const double bias = rest_.bias()[2];
  double angle = 0;
  if (input.gyro && silence_ == 0) {
    angle = ((*input.gyro)[2] - bias) * input.dt;
    rate_ = (*input.gyro)[2] - bias;
  } else if (input.sample) {  // what the wheels seemed to turn meanwhile is replaced, if it was not for long
    silence_ += input.dt;
    angle = geometry_.turn(input.travel[0], input.travel[1]);
    if (silence_ < kLongestGap) angle = ((last_sample_ + *input.sample) / 2 - bias) * silence_ - silent_turn_;
    silence_ = silent_turn_ = 0;
  } else {
    angle = geometry_.turn(input.travel[0], input.travel[1]);
    silence_ += input.dt;
    silent_turn_ += angle;
  }
  if (input.sample) last_sample_ = *input.sample;
  for (PlanarTrack& track : tracks_) track.turn(angle, input.dt, input.gyro.has_value());
  for (double& turned : turned_) turned += angle;
}

void SimplePart::roll(const Input& input) noexcept {
  for (const std::size_t side : {0U, 1U}) {
    if (!input.received[side]) continue;
    const std::size_t other = 1 - side;
    double way = (input.travel[side] - credited_[side]) / 2;
    credited_[side] = 0;
    if (input.lost[other]) {
      const double across = (side == 0 ? 1 : -1) * turned_[side] * geometry_.wheel_base;
      way = input.travel[side] + across / 2;
      credited_[other] += input.travel[side] + across;
    }
    const double level = std::sqrt(std::max(0.0, 1 - tilt_.up()[0] * tilt_.up()[0]));
    for (PlanarTrack& track : tracks_) track.roll(way * level, turned_[side] / 2);
    turned_[side] = 0;
  }
}

void SimplePart::tilt(const Input& input) noexcept {
  if (!rest_.resting()) rested_force_ = 0;
  if (rest_.window_ended() && rest_.force()) {
    rested_force_ += RestBias::kWindow;
    tilt_.rest(*rest_.force(), RestBias::kWindow, rested_force_);
  }
  if (!input.gyro) return;
  Vector3 rate = *input.gyro;
  for (std::size_t i = 0; i < 3; ++i) rate[i] = rest_.learned() || i == 2 ? rate[i] - rest_.bias()[i] : 0;
  tilt_.turn(rate, input.dt);
}

}  // namespace robot_control
