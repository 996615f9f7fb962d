#include "ros/wheeled/calibration_keeper.h"

#include <ros/console.h>

#include <chrono>
#include <exception>

namespace robot_control {

bool CalibrationKeeper::busy() const {
  return writing_.valid() && writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

void CalibrationKeeper::write_if_due(const StateFrame& state, std::int64_t now_ns) {
  if (next_ns_ == 0) next_ns_ = now_ns + kPeriod;
  if (now_ns < next_ns_ || busy()) return;
  next_ns_ = now_ns + kPeriod;
  wait();
  save(state);
}

void CalibrationKeeper::finish(const StateFrame& state) {
  wait();
  save(state);
  wait();
}

void CalibrationKeeper::save(const StateFrame& state) {
  const LearnedCalibration now = learned(state);
  if (path_.empty() || (state.base.flags & kStateValid) == 0 || !may_be_kept(now) || !improve(saved_, now)) return;
  writing_ =
      std::async(std::launch::async, [this, next = saved_] { write_calibration(path_, next, robot_, parameters_); });
}

void CalibrationKeeper::wait() {
  if (!writing_.valid()) return;
  try {
    writing_.get();
    failed_ = false;
  } catch (const std::exception& error) {
    if (!failed_)
      ROS_WARN("the calibration is not saved: %s; the next attempts are every 30 s and at the end", error.what());
    failed_ = true;
    saved_ = {};
  }
}

Parameters with_calibration(const Parameters& parameters, const DriveTrain& robot) {
  if (parameters.calibration_file.empty()) return parameters;
  Parameters result = parameters;
  const auto kept = read_calibration(parameters.calibration_file, robot, parameters.estimator);
  if (kept) {
    result.estimator = continued(parameters.estimator, *kept);
    ROS_INFO("calibration of %s: radius_ratio %.5f ± %.5f, wheel_base_factor %.4f ± %.4f",
             parameters.calibration_file.c_str(), result.estimator.calibration.radius_ratio,
             result.estimator.calibration.radius_ratio_deviation, result.estimator.calibration.wheel_base_factor,
             result.estimator.calibration.wheel_base_deviation);
  }
  return result;
}

}  // namespace robot_control
