#include "drivers/line/virtual_can.h"

#include <algorithm>
#include <cmath>

#include "drivers/line/can_load.h"

namespace robot_control {
namespace {

/// The lower value wins. The first 11 bits decide; of equal ones the identifier of 11 bits wins, because the bit after
/// them is recessive in a longer one.
std::uint64_t arbitration(const can_frame& frame) {
  const bool extended = is_extended(frame);
  const std::uint64_t id = extended ? frame.can_id & CAN_EFF_MASK : (frame.can_id & CAN_SFF_MASK) << 18U;
  return (id >> 18U) << 20U | (extended ? 1U << 19U : 0U) | (id & 0x3FFFFU) << 1U |
         (is_remote_request(frame) ? 1U : 0U);
}

}  // namespace

VirtualCan::VirtualCan(double bit_rate, std::uint64_t seed, double data_rate)
    : bit_rate_(bit_rate), data_rate_(data_rate), generator_(seed) {}

std::size_t VirtualCan::join(Receiver receiver) {
  parties_.push_back({.receiver = std::move(receiver), .queue = {}});
  parties_.back().queue.reserve(kMaxQueue);
  return parties_.size() - 1;
}

bool VirtualCan::send(std::size_t party, const can_frame& frame) {
  Party& sender = parties_.at(party);
  if (!sender.connected || sender.queue.size() == kMaxQueue) return false;
  sender.queue.push_back({frame, ready_ns(sender)});
  return true;
}

std::int64_t VirtualCan::ready_ns(const Party& sender) {
  if (longest_delay_ns_ == 0) return now_ns_;
  const std::int64_t delay_ns = std::uniform_int_distribution<std::int64_t>(0, longest_delay_ns_)(generator_);
  return std::max(now_ns_ + delay_ns, sender.queue.empty() ? 0 : sender.queue.back().ready_ns);
}

void VirtualCan::connect(std::size_t party, bool connected) {
  parties_.at(party).connected = connected;
  parties_.at(party).queue.clear();
}

VirtualCan::Party* VirtualCan::next_sender(std::int64_t start_ns) {
  Party* winner = nullptr;
  for (Party& party : parties_) {
    if (party.queue.empty() || party.queue.front().ready_ns > start_ns) continue;
    if (winner == nullptr || arbitration(party.queue.front().frame) < arbitration(winner->queue.front().frame)) {
      winner = &party;
    }
  }
  return winner;
}

void VirtualCan::advance(std::int64_t until_ns) {
  const bool acknowledged = std::ranges::count_if(parties_, [](const Party& party) { return party.connected; }) > 1;
  if (!acknowledged) free_ns_ = std::max(free_ns_, until_ns);
  while (acknowledged) {
    std::int64_t ready_ns = until_ns;
    for (const Party& party : parties_) {
      if (!party.queue.empty()) ready_ns = std::min(ready_ns, party.queue.front().ready_ns);
    }
    const std::int64_t start_ns = std::max(free_ns_, ready_ns);
    Party* const sender = next_sender(start_ns);
    if (sender == nullptr) break;
    const can_frame frame = sender->queue.front().frame;
    const double bits = is_fd(frame) ? fd_frame_bits(frame).weighted(bit_rate_, data_rate_) : frame_bits(frame);
    const std::int64_t end_ns = start_ns + std::llround(1.0e9 / bit_rate_ * bits);
    if (end_ns > until_ns) break;
    sender->queue.erase(sender->queue.begin());
    busy_ns_ += end_ns - start_ns;
    now_ns_ = free_ns_ = end_ns;
    ++frames_;
    deliver(*sender, frame);
  }
  now_ns_ = until_ns;
}

void VirtualCan::deliver(const Party& sender, const can_frame& frame) {
  if (loss_ > 0 && std::uniform_real_distribution<>(0, 1)(generator_) < loss_) return;
  for (const Party& party : parties_) {
    if (&party != &sender && party.connected) party.receiver(frame, now_ns_);
  }
}

}  // namespace robot_control
