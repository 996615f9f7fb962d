#include "loop/cycles/estimator_cycle.h"

#include <utility>

namespace robot_control {

EstimatorCycle::EstimatorCycle(std::unique_ptr<EstimatorLaw> estimator, std::uint64_t robot_hash,
                               const FrameReader<SensorFrame>& sensors, FrameWriter<StateFrame> state, Now now)
    : estimator_(std::move(estimator)),
      clock_(now),
      sensors_channel_(&sensors),
      state_channel_(state),
      robot_hash_(robot_hash),
      snapshots_(LawName::kEstimator),
      rows_(state.kept()) {}

EstimatorCycle::EstimatorCycle(const EstimatorCycle& other, const FrameReader<SensorFrame>& sensors,
                               FrameWriter<StateFrame> state)
    : EstimatorCycle(other) {
  sensors_channel_ = &sensors;
  state_channel_ = state;
}

void EstimatorCycle::enter_run(const FrameHead& head) noexcept {
  StateFrame last;
  first_cycle_ = head.cycle;
  calls_.law.new_run = 1;
  estimator_->enter_run();
  if (state_channel_.reader().newest(last) == Lookup::kFrame && last.head.run == head.run) estimator_->resume(last);
}

bool EstimatorCycle::step() noexcept {
  const std::int64_t woke_ns = clock_.now();
  const Found<SensorFrame> found = sensors_channel_->find_newest(buffer_);
  const SensorFrame& sensors = *found.frame;
  if (found.lookup != Lookup::kFrame) return false;
  if (!current(*sensors_channel_, sensors.head, robot_hash_)) return false;
  const Arrival arrival = clock_.compare(sensors.head);
  if (arrival == Arrival::kOld) return false;
  if (arrival == Arrival::kNewRun) enter_run(sensors.head);
  clock_.accept(sensors.head);

  snapshots_.copy_if_due(*estimator_, calls_.law, sensors.head, state_channel_.seals());
  PoseRequest request;
  if (inbox_.load(request) && request.count != received_) {
    received_ = request.count;
    calls_.pose_set = 1;
    calls_.pose = request.pose;
    estimator_->set_pose(request.pose);
  }
  EstimatorTrace& row = rows_.begin(sensors.head.cycle);
  estimator_->step(sensors, row.state);
  row.state.first_cycle = first_cycle_;
  row.state.head = {.run = sensors.head.run, .cycle = sensors.head.cycle, .stamp_ns = sensors.head.stamp_ns};
  state_channel_.publish_in_place(row.state);
  row.timing = clock_.timing(woke_ns, sensors);
  calls_.first_cycle = first_cycle_;
  close_row(state_channel_.seals(), calls_, sensors.head.checksum, row.state.head.checksum, row.calls);
  return true;
}

}  // namespace robot_control
