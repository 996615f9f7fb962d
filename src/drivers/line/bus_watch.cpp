#include "drivers/line/bus_watch.h"

#include "drivers/line/can_errors.h"

namespace robot_control {

void BusWatch::step(const CanBus& bus, std::int64_t now_ns) noexcept {
  if (began_ns_ < 0) began_ns_ = now_ns;
  const CanCounts& counts = bus.counts();
  const bool received = received_.recent(counts.received, now_ns);
  const bool errors = errors_.recent(counts.error_frames, now_ns) || bus.state() != CanState::kActive;
  status_.bus_off = bus.state() == CanState::kBusOff;
  status_.silent = !received && now_ns - began_ns_ >= kRecentNs;
  status_.queue_full = refused_.recent(counts.refused, now_ns);
  status_.error = errors ? bus.last_error_frame() : can_frame{};
  if (status_.bus_off || status_.silent) {
    status_.state = LinkState::kDown;
  } else if (!received) {
    status_.state = LinkState::kStarting;
  } else {
    status_.state = errors || status_.queue_full ? LinkState::kDegraded : LinkState::kUp;
  }
}

std::string words(const BusStatus& status) {
  std::string text;
  const auto add = [&text](const std::string& problem) {
    if (!problem.empty()) text += (text.empty() ? "the bus: " : ", ") + problem;
  };
  add(can_error_words(status.error));
  if (status.queue_full) add("the send queue is full");
  if (status.silent) add("no frame was received in the last 1.5 s");
  if (text.empty()) return text;
  if (status.bus_off) {
    text += "; look at the cable and the bit rate; the interface restarts by itself with restart-ms 100 (ip link)";
  } else if (status.silent) {
    text += "; look at the cable, its terminators, the power of the drives and the bit rate";
  } else {
    text += "; look at the cable and its terminators, the bit rate, and how much is sent";
  }
  return text;
}

}  // namespace robot_control
