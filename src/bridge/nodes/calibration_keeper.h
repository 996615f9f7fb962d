#pragma once
/// Keeps what state_estimator learns in its file: every 30 s when more was learned, and at the end. Called from the
/// ordinary thread, which also publishes: a disk may take a second, so a thread of its own waits for it.

#include <cstdint>
#include <future>
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

  /// Any time; begins to write when it is due.
  void look(const StateFrame& state, std::int64_t now_ns);

  /// Waits until a write that has begun ends; a failure is reported once.
  void wait();

  /// At the end: writes and waits.
  void finish(const StateFrame& state);

 private:
  void save(const StateFrame& state);
  bool busy() const;

  std::string path_;
  RobotModel robot_;
  EstimatorParameters parameters_;
  LearnedCalibration saved_;  ///< or about to be
  std::int64_t next_ns_ = 0;
  bool failed_ = false;
  std::future<void> writing_;
};

/// `parameters` with what its calibration_file holds, if there is one. Throws ParameterError.
Parameters with_calibration(const Parameters& parameters, const RobotModel& robot);

}  // namespace robot_control
