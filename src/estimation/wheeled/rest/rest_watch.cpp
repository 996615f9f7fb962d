#include "estimation/wheeled/rest/rest_watch.h"

#include <cmath>
#include <utility>

#include "estimation/common/tuning.h"

namespace robot_control {

void RestWatch::begin() noexcept {
  time_ = left_ = right_ = 0;
  gyro_.reset();
  force_.reset();
}

void RestWatch::reset() noexcept {
  begin();
  pending_ = done_ = {};
  steady_time_ = repeated_time_ = 0;
  bias_changed_ = false;
}

RestWindow RestWatch::step(const Sample& sample, const Bias& bias) noexcept {
  bias_changed_ = confirmed_ = false;
  left_ += sample.left;
  right_ += sample.right;
  if (std::abs(left_) > params_.tolerance || std::abs(right_) > params_.tolerance) {
    confirmed_ = time_ >= 2 * Tuning::kOffset && pending_.time > 0;
    if (confirmed_) done_ = pending_;
    begin();
    pending_ = {};
    steady_time_ = 0;
    return RestWindow::kBroken;
  }
  time_ += sample.dt;
  if (sample.gyro) gyro_.add(*sample.gyro, sample.dt);
  if (sample.accelerometer) force_.add(*sample.accelerometer, sample.dt);
  return time_ < params_.window * (1 - 1e-9) ? RestWindow::kOpen : close(bias);
}

RestWindow RestWatch::close(const Bias& bias) noexcept {
  Means now{.time = time_};
  if (force_.over(time_)) now.accelerometer = force_.mean();
  RestWindow verdict = RestWindow::kQuiet;
  if (gyro_.over(time_)) {
    Vector3 mean = gyro_.mean();
    mean[2] -= (right_ - left_) * params_.turn_per_metre / time_;
    bool same = bias.known;
    bool goes_on = steady_time_ > 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double apart = std::abs(mean[i] - bias.value[i]);
      same = same && apart <= params_.steady + Tuning::kSignificant * bias.deviation[i];
      goes_on = goes_on && std::abs(mean[i] - steady_gyro_[i]) <= params_.steady;
    }
    const double noise = Tuning::kSignificant * bias.deviation[2];
    const bool repeats = goes_on && pending_.gyro && std::abs(mean[2] - (*pending_.gyro)[2]) <= noise;
    repeated_time_ = (repeats ? repeated_time_ : 0) + time_;
    if (!goes_on) {
      steady_time_ = 0;
      steady_gyro_ = mean;
    }
    steady_time_ += time_;
    const bool shown = !bias.known && repeated_time_ >= Tuning::kBlock * (1 - 1e-9);
    bias_changed_ = !same && (shown || steady_time_ >= Tuning::kConstantRate);
    if (!same && !bias_changed_) verdict = RestWindow::kTurned;
    if (same) steady_time_ = 0;
    now.gyro = mean;
  }
  done_ = std::exchange(pending_, now);
  begin();
  return verdict;
}

}  // namespace robot_control
