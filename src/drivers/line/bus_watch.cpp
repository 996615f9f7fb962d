#include "drivers/line/bus_watch.h"

#include <linux/can/error.h>

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
    text += "; check the cable and the bit rate; with restart-ms 100 (ip link), the interface restarts by itself";
  } else if (status.silent) {
    text += "; check the cable, its terminators, the power of the drives and the bit rate";
  } else {
    text += "; check the cable, its terminators, the bit rate and the bus load";
  }
  return text;
}

namespace {

struct ErrorWords {
  canid_t error_class;
  unsigned byte;  // of the data; 0: the class alone counts
  std::uint8_t bits;
  const char* words;
};

constexpr ErrorWords kWords[] = {
    {CAN_ERR_BUSOFF, 0, 0, "bus-off: the CAN controller is off until it is restarted"},
    {CAN_ERR_RESTARTED, 0, 0, "controller restarted"},
    {CAN_ERR_ACK, 0, 0, "no acknowledgement: no other node is active at this bit rate"},
    {CAN_ERR_TX_TIMEOUT, 0, 0, "transmit timeout"},
    {CAN_ERR_LOSTARB, 0, 0, "lost arbitration"},
    {CAN_ERR_BUSERROR, 0, 0, "bus error"},
    {CAN_ERR_TRX, 0, 0, "transceiver: a wire is broken or shorted"},
    {CAN_ERR_CRTL, 1, CAN_ERR_CRTL_RX_OVERFLOW, "receive buffer overflow"},
    {CAN_ERR_CRTL, 1, CAN_ERR_CRTL_TX_OVERFLOW, "transmit buffer overflow"},
    {CAN_ERR_CRTL, 1, CAN_ERR_CRTL_RX_WARNING, "many receive errors"},
    {CAN_ERR_CRTL, 1, CAN_ERR_CRTL_TX_WARNING, "many transmit errors"},
    {CAN_ERR_CRTL, 1, CAN_ERR_CRTL_RX_PASSIVE, "error passive by receive errors"},
    {CAN_ERR_CRTL, 1, CAN_ERR_CRTL_TX_PASSIVE, "error passive by transmit errors"},
    {CAN_ERR_CRTL, 1, CAN_ERR_CRTL_ACTIVE, "error active again"},
    {CAN_ERR_PROT, 2, CAN_ERR_PROT_BIT, "single bit error"},
    {CAN_ERR_PROT, 2, CAN_ERR_PROT_FORM, "frame format error"},
    {CAN_ERR_PROT, 2, CAN_ERR_PROT_STUFF, "bit stuffing error: check that all nodes have the same bit rate"},
    {CAN_ERR_PROT, 2, CAN_ERR_PROT_BIT0, "no dominant bit could be sent"},
    {CAN_ERR_PROT, 2, CAN_ERR_PROT_BIT1, "no recessive bit could be sent"},
    {CAN_ERR_PROT, 2, CAN_ERR_PROT_OVERLOAD, "bus overload"},
};

}  // namespace

std::string can_error_words(const can_frame& error) {
  std::string text;
  for (const ErrorWords& each : kWords) {
    if ((error.can_id & each.error_class) == 0 || (each.byte != 0 && (error.data[each.byte] & each.bits) == 0))
      continue;
    text += (text.empty() ? "" : ", ") + std::string(each.words);
  }
  if (text.empty() && error.can_id != 0) text = "the controller reports errors without a reason";
  return text;
}

}  // namespace robot_control
