#include "loop/cycles/estimator_cycle.h"

#include <utility>

namespace robot_control {

EstimatorCycle::EstimatorCycle(std::unique_ptr<EstimatorLaw> estimator, std::uint64_t robot_hash,
                               const FrameReader<SensorFrame>& sensors, FrameWriter<StateFrame> state, Now now)
    : estimator_(std::move(estimator)),
      clock_(now),
      sensors_channel_(sensors),
      state_channel_(state),
      robot_hash_(robot_hash),
      snapshots_(LawName::kEstimator) {}

void EstimatorCycle::enter_run() noexcept {
  StateFrame last;
  const FrameReader<StateFrame> own(state_channel_.memory());
  first_cycle_ = sensors_.head.cycle;
  calls_.law.new_run = 1;
  estimator_->enter_run();
  if (own.newest(last) == Lookup::kFrame && last.head.run == sensors_.head.run) estimator_->resume(last);
}

bool EstimatorCycle::step() noexcept {
  const std::int64_t woke_ns = clock_.now();
  const Lookup found = sensors_channel_.newest(sensors_);
  if (found != Lookup::kFrame) return false;
  if (!current(sensors_channel_, sensors_.head, robot_hash_)) return false;
  const Arrival arrival = clock_.compare(sensors_.head);
  if (arrival == Arrival::kOld) return false;
  if (arrival == Arrival::kNewRun) enter_run();
  clock_.accept(sensors_.head);

  snapshots_.copy_if_due(*estimator_, calls_.law, sensors_.head);
  PoseRequest request;
  if (inbox_.load(request) && request.count != received_) {
    received_ = request.count;
    calls_.pose_set = 1;
    calls_.pose = request.pose;
    estimator_->set_pose(request.pose);
  }
  estimator_->step(sensors_, trace_.state);
  trace_.state.first_cycle = first_cycle_;
  trace_.state.head = {.run = sensors_.head.run, .cycle = sensors_.head.cycle, .stamp_ns = sensors_.head.stamp_ns};
  state_channel_.publish(trace_.state);
  trace_.timing = clock_.timing(woke_ns, sensors_);
  calls_.first_cycle = first_cycle_;
  close_row(calls_, sensors_.head.checksum, trace_.state.head.checksum, trace_.calls);
  return true;
}

}  // namespace robot_control
