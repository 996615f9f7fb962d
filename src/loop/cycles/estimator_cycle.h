#pragma once
/// The estimator's duty in one cycle: newest sensors k → state k.

#include <cstdint>
#include <memory>

#include "bus/latest_frames.h"
#include "bus/latest_value.h"
#include "loop/cycles/close_row.h"
#include "loop/cycles/cycle_clock.h"
#include "loop/cycles/rows.h"
#include "loop/cycles/snapshots.h"
#include "robots/laws.h"
#include "signals/trace.h"

namespace robot_control {

class EstimatorCycle {
  struct PoseRequest {
    std::uint64_t count = 0;
    Vector3 pose{};
  };

 public:
  /// `robot_hash` is that of the machine (process.h).
  EstimatorCycle(std::unique_ptr<EstimatorLaw> estimator, std::uint64_t robot_hash,
                 const FrameReader<SensorFrame>& sensors, FrameWriter<StateFrame> state, Now now);

  /// Continues as `other` would, on channels with the same frames.
  EstimatorCycle(const EstimatorCycle& other, const FrameReader<SensorFrame>& sensors, FrameWriter<StateFrame> state);

  /// True when there was a new sensor frame of the driver's current run, and a state was computed from it and
  /// published.
  bool step() noexcept;

  /// One thread: the pose is (x [m], y [m], yaw [rad]) from the next cycle on.
  void request_pose(const Vector3& pose) noexcept {
    ++requested_.count;
    requested_.pose = pose;
    inbox_.store(requested_);
  }

  /// Random number of this process, in every row.
  void set_process(std::uint64_t process) noexcept { calls_.law.process = process; }

  /// The row of the last step that returned true.
  const EstimatorTrace& trace() const noexcept { return rows_.last(); }

  /// The law's state before the step of the last row, where it was copied; else null.
  const LawSnapshot* snapshot() const noexcept { return snapshots_.taken(); }

 private:
  EstimatorCycle(const EstimatorCycle& other) = default;
  void enter_run(const FrameHead& head) noexcept;

  OwnedLaw<EstimatorLaw> estimator_;
  CycleClock clock_;
  const FrameReader<SensorFrame>* sensors_channel_;
  FrameWriter<StateFrame> state_channel_;
  std::uint64_t robot_hash_;
  PoseRequest requested_;  ///< the requesting thread's
  LatestValue<PoseRequest> inbox_;
  std::uint64_t received_ = 0;     ///< requests that were carried out
  std::uint64_t first_cycle_ = 0;  ///< StateFrame::first_cycle
  SensorFrame buffer_;
  EstimatorCalls calls_ = first_row<EstimatorCalls>();  ///< since the last row
  Snapshots snapshots_;
  Rows<EstimatorTrace> rows_;
};

}  // namespace robot_control
