#pragma once
/// Keeps what state_estimator learns in its file: every 30 s when there is more to say, and at the end. Ordinary
/// thread.

#include <cstdint>
#include <string>

#include "parameters/calibration_file.h"
#include "parameters/parameters.h"

namespace robot_control {

class CalibrationKeeper {
 public:
  static constexpr std::int64_t kPeriod = 30'000'000'000;  ///< ns; a crash loses that much of a slow learning

  /// `parameters`: as the user gave them, before anything was read from the file.
  CalibrationKeeper(const Parameters& parameters, const RobotModel& robot)
      : path_(parameters.estimator.self_calibration ? parameters.calibration_file : ""),
        robot_(robot),
        parameters_(parameters.estimator) {}

  /// Any time; writes when it is due.
  void look(const StateFrame& state, std::int64_t now_ns);

  /// At the end.
  void finish(const StateFrame& state) { save(state); }

 private:
  void save(const StateFrame& state);

  std::string path_;
  RobotModel robot_;
  EstimatorParameters parameters_;
  LearnedCalibration saved_;
  std::int64_t next_ns_ = 0;
  bool failed_ = false;
};

/// `parameters` with what its calibration_file holds, if there is one. Throws ParameterError.
Parameters with_calibration(const Parameters& parameters, const RobotModel& robot);

}  // namespace robot_control
