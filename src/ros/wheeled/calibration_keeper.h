#pragma once
/// Writes the calibration that the estimator learns to its file: every 30 s if it changed, and at the end. It is
/// called from the ordinary thread, which also publishes. A disk may take a second, so a thread of its own writes the
/// file.

#include <cstdint>
#include <future>
#include <string>

#include "configuration/parameters.h"
#include "configuration/wheeled/calibration_file.h"

namespace robot_control {

class CalibrationKeeper {
 public:
  static constexpr std::int64_t kPeriod = 30'000'000'000;  ///< ns; a crash loses at most what was learned in this time

  /// `parameters` are as the user gave them, without the calibration of the file.
  CalibrationKeeper(const Parameters& parameters, const DriveTrain& robot)
      : path_(parameters.estimator.self_calibration ? parameters.calibration_file : ""),
        robot_(robot),
        parameters_(parameters.estimator) {}

  /// Begins to write if a write is due; may be called at any time.
  void write_if_due(const StateFrame& state, std::int64_t now_ns);

  /// Waits until a write that has begun ends. A failure is reported once.
  void wait();

  /// Writes the last state and waits for the end of the write.
  void finish(const StateFrame& state);

 private:
  void save(const StateFrame& state);
  bool busy() const;

  std::string path_;
  DriveTrain robot_;
  EstimatorParameters parameters_;
  LearnedCalibration saved_;  ///< content of the file, or of the write that is running
  std::int64_t next_ns_ = 0;
  bool failed_ = false;
  std::future<void> writing_;
};

/// Returns `parameters` with the calibration of its calibration_file, if there is one. Throws ParameterError.
Parameters with_calibration(const Parameters& parameters, const DriveTrain& robot);

}  // namespace robot_control
