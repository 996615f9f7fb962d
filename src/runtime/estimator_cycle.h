#pragma once
/// The estimator's duty in one cycle: newest sensors k → state k. A token is passed on. Told to fail, it does
/// (faulty_writer.h).

#include <atomic>
#include <cstdint>

#include "estimation/estimator.h"
#include "rt/latest_frames.h"
#include "runtime/cycle_clock.h"
#include "runtime/faulty_writer.h"
#include "signals/trace.h"

namespace robot_control {

class EstimatorCycle {
 public:
  EstimatorCycle(const EstimatorParameters& parameters, const RobotModel& robot, double period,
                 const FrameReader<SensorFrame>& sensors, FrameWriter<StateFrame> state, Now now);

  /// True when there was a new sensor frame of the driver's current run, and a state was published.
  bool step() noexcept;

  /// Any thread: the pose is zero from the next cycle on.
  void request_pose_reset() noexcept { pose_resets_.fetch_add(1); }

  const EstimatorTrace& trace() const noexcept { return trace_; }

 private:
  void enter_run() noexcept;

  Estimator estimator_;
  CycleClock clock_;
  const FrameReader<SensorFrame>& sensors_channel_;
  FrameWriter<StateFrame> state_channel_;
  FaultyWriter<StateFrame> out_{FaultComponent::kEstimator};
  std::uint64_t robot_hash_;
  std::atomic<std::uint64_t> pose_resets_{0};
  std::uint64_t pose_resets_done_ = 0;
  SensorFrame sensors_;
  EstimatorTrace trace_;
};

}  // namespace robot_control
