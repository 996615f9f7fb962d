#include "loop/cycles/controller_cycle.h"

#include <algorithm>
#include <utility>

namespace robot_control {

ControllerCycle::ControllerCycle(std::unique_ptr<ControllerLaw> controller, std::uint64_t robot_hash,
                                 const Channels& channels, CommandScript script, Now now)
    : controller_(std::move(controller)),
      clock_(now),
      channels_(channels),
      script_(std::move(script)),
      robot_hash_(robot_hash),
      tunings_(controller_->tuning()),
      snapshots_(LawName::kController),
      rows_(channels.command.kept()) {
  use(controller_->tuning());
}

ControllerCycle::ControllerCycle(const ControllerCycle& other, const Channels& channels) : ControllerCycle(other) {
  channels_ = channels;
}

/// Every row names the tuning in force.
void ControllerCycle::use(const LiveTuning& tuning) noexcept {
  rows_.for_each([&](ControllerTrace& row) { row.tuning = tuning; });
}

/// Takes over every member but the command itself, which script and inbox share.
void ControllerCycle::take_over(const VelocityCommand& arrived) noexcept {
  VelocityCommand merged = received_ = arrived;
  merged.content = request_.content;
  merged.count = request_.count;
  merged.age_ns = request_.age_ns;
  request_ = merged;
}

void ControllerCycle::enter_run(std::uint64_t run) noexcept {
  inbox_.load(received_);
  take_over(received_);
  script_.rewind();
  const auto last = published_before(channels_.command, run);
  if (last) script_.advance(*last);
  calls_.law.new_run = 1;
  calls_.inbox = request_;
  calls_.with_zero = script_.begins_with_zero() && !last ? 1 : 0;
  controller_->enter_run(request_, calls_.with_zero != 0);
}

void ControllerCycle::receive(std::uint64_t cycle) noexcept {
  const std::uint64_t version = inbox_.version();
  VelocityCommand arrived;
  if (version != inbox_seen_ && inbox_.load(arrived)) {
    inbox_seen_ = version;
    if (arrived.count != received_.count) {
      request_.content = arrived.content;
      request_.age_ns = arrived.age_ns;
      request_.count += arrived.count - received_.count;
    }
    take_over(arrived);
  }
  request_.contested = received_.contested;  // the script may have changed it
  const ScriptEvents events = script_.advance(cycle);
  if (events.has_twist) {
    request_.content = {.twist = events.twist};
    request_.age_ns = 0;
    request_.count += events.twists;
    if (request_.contested >= kNotFiniteMessage) request_.contested = 0;
  }
}

void ControllerCycle::tune() noexcept {
  const std::uint64_t version = tunings_.version();
  if (version == tunings_seen_) return;
  LiveTuning tuning;
  if (!tunings_.load(tuning)) return;
  tunings_seen_ = version;
  if (tuning == rows_.last().tuning) return;
  controller_->tune(tuning);
  use(tuning);
  calls_.tuned = 1;
}

bool ControllerCycle::step() noexcept {
  const std::int64_t woke_ns = clock_.now();
  const auto [found, newest] = channels_.state->find_newest(state_);
  const StateFrame& state = *newest;
  if (found == Lookup::kMissing) return false;
  if (!current(*channels_.sensors, state.head, robot_hash_)) return false;
  const Arrival arrival = clock_.compare(state.head);
  if (arrival == Arrival::kOld) return false;
  const std::uint64_t run = state.head.run;
  const std::uint64_t cycle = state.head.cycle;
  const auto [sensors_found, sample] = channels_.sensors->find_at(run, cycle, sensors_);
  const SensorFrame& sensors = *sample;
  // The head of a corrupt frame is used only if sensors of that cycle exist.
  if (found == Lookup::kCorrupt && sensors_found != Lookup::kFrame) return false;
  if (arrival == Arrival::kNewRun) enter_run(run);
  clock_.accept(state.head);
  if (found != Lookup::kFrame) {
    channels_.command.publish_token(found == Lookup::kCorrupt ? sensors.head : state.head);
    return false;
  }
  if (sensors_found != Lookup::kFrame) return false;

  snapshots_.copy_if_due(*controller_, calls_.law, state.head, channels_.command.seals());
  receive(cycle);
  tune();
  ControlInput input{.sensors = &sensors, .state = &state, .request = request_};
  if (cycle > 0) {
    const auto [permit_found, permit] =
        channels_.permit->find_within(run, cycle - std::min(cycle, kPermitLife), cycle - 1, permit_);
    if (permit_found == Lookup::kFrame && permit->expiry >= cycle) {
      input.permit = permit;
      calls_.permit = used(Lookup::kFrame, *permit);
    }
  }
  ControllerTrace& row = rows_.begin(cycle);
  controller_->step(input, row.command);
  row.command.head = {.run = run, .cycle = cycle, .stamp_ns = state.head.stamp_ns};
  channels_.command.publish_in_place(row.command);
  row.timing = clock_.timing(woke_ns, sensors);
  const bool seals = channels_.command.seals();
  if (seals) calls_.request = request_;
  calls_.state = state.head.checksum;
  close_row(seals, calls_, sensors.head.checksum, row.command.head.checksum, row.calls);
  return true;
}

}  // namespace robot_control
