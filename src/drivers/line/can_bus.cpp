#include "drivers/line/can_bus.h"

#include <linux/can/error.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <optional>
#include <utility>

namespace robot_control {
namespace {

constexpr std::size_t kControlBytes = CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t));

int send_batch(int descriptor, mmsghdr* messages, std::size_t count) noexcept {
  return sendmmsg(descriptor, messages, static_cast<unsigned>(count), MSG_DONTWAIT | MSG_NOSIGNAL);
}

bool queue_is_full(int error) noexcept {
  return error == ENOBUFS || error == EAGAIN;
}

/// Writes the places of the frames' bytes to `parts`, which has room for them.
template <class Parts>
msghdr message_of(std::span<const can_frame> frames, Parts& parts) noexcept {
  for (std::size_t i = 0; i < frames.size(); ++i)
    parts[i] = {.iov_base = const_cast<can_frame*>(&frames[i]), .iov_len = transfer_size(frames[i])};
  msghdr message{};
  message.msg_iov = parts.data();
  message.msg_iovlen = frames.size();
  return message;
}

/// Returns the frame at the beginning of a datagram; nothing if it is not whole. Kernels before Linux 5.14 do not mark
/// the frames of CAN FD.
std::optional<can_frame> first_frame(std::span<const std::byte> datagram) noexcept {
  if (datagram.size() < kFrameBytes) return std::nullopt;
  can_frame frame{};
  std::memcpy(&frame, datagram.data(), kFrameBytes);
  if (datagram.size() == kFdFrameBytes) frame.flags |= CANFD_FDF;
  if (datagram.size() < transfer_size(frame)) return std::nullopt;
  if (is_fd(frame)) std::memcpy(frame.data, datagram.data() + offsetof(can_frame, data), CANFD_MAX_DLEN);
  return frame;
}

template <class Value>
const Value* control_value(msghdr& head, int type) noexcept {
  for (cmsghdr* entry = CMSG_FIRSTHDR(&head); entry != nullptr; entry = CMSG_NXTHDR(&head, entry)) {
    if (entry->cmsg_level == SOL_SOCKET && entry->cmsg_type == type) {
      return reinterpret_cast<const Value*>(CMSG_DATA(entry));
    }
  }
  return nullptr;
}

}  // namespace

CanBus::CanBus(CanSocket socket) noexcept : socket_(std::move(socket)) {
  present_.set();
}

std::size_t CanBus::send(std::span<const can_frame> frames) noexcept {
  std::size_t sent = 0;
  int error = 0;
  while (sent < frames.size() && error == 0) {
    const auto batch = frames.subspan(sent, std::min<std::size_t>(frames.size() - sent, kMaxFramesPerDatagram));
    const Sent part = send_part(batch);
    sent += part.frames;
    error = part.error;
  }
  if (error != 0 && !queue_is_full(error)) ++counts_.errors;
  counts_.sent += sent;
  counts_.refused += frames.size() - sent;
  return sent;
}

CanBus::Sent CanBus::send_part(std::span<const can_frame> frames) noexcept {
  if (socket_.is_line()) return send_together(frames);
  return socket_.parties().empty() ? send_singly(frames) : send_to_parties(frames);
}

CanBus::Sent CanBus::send_together(std::span<const can_frame> frames) noexcept {
  Parts parts{};
  const msghdr message = message_of(frames, parts);
  while (sendmsg(socket_.descriptor(), &message, MSG_DONTWAIT | MSG_NOSIGNAL) < 0) {
    if (errno != EINTR) return {.frames = 0, .error = errno};
  }
  return {.frames = frames.size(), .error = 0};
}

CanBus::Sent CanBus::send_singly(std::span<const can_frame> frames) noexcept {
  Parts parts{};
  message_of(frames, parts);
  std::array<mmsghdr, kMaxFramesPerDatagram> messages{};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    messages[i].msg_hdr.msg_iov = &parts[i];
    messages[i].msg_hdr.msg_iovlen = 1;
  }
  Sent sent;
  while (sent.frames < frames.size() && sent.error == 0) {
    const int accepted = send_batch(socket_.descriptor(), &messages[sent.frames], frames.size() - sent.frames);
    if (accepted > 0) {
      sent.frames += static_cast<std::size_t>(accepted);
    } else if (errno != EINTR) {
      sent.error = errno;
    }
  }
  return sent;
}

CanBus::Sent CanBus::send_to_parties(std::span<const can_frame> frames) noexcept {
  Parts parts{};
  const msghdr message = message_of(frames, parts);
  std::array<mmsghdr, kMaxParties> messages{};
  std::array<unsigned, kMaxParties> receivers{};
  std::size_t count = 0;
  for (unsigned party = 0; party < kMaxParties; ++party) {
    if (party == socket_.own_party() || !present_[party]) continue;
    messages[count].msg_hdr = message;
    messages[count].msg_hdr.msg_name = &socket_.parties()[party];
    messages[count].msg_hdr.msg_namelen = sizeof(sockaddr_un);
    receivers[count++] = party;
  }
  std::size_t next = 0, reached = 0;
  while (next < count) {
    const int accepted = send_batch(socket_.descriptor(), &messages[next], count - next);
    if (accepted > 0) {
      next += static_cast<std::size_t>(accepted);
      reached += static_cast<std::size_t>(accepted);
    } else if (queue_is_full(errno)) {
      counts_.lost += frames.size();
      ++reached;
      ++next;
    } else if (errno != EINTR) {
      present_.reset(receivers[next++]);  // there is no such name, or its process has ended
    }
  }
  if (reached == 0) return {.frames = 0, .error = ENOBUFS};
  return {.frames = frames.size(), .error = 0};
}

ReceivedFrames CanBus::receive(const CanTime& now) noexcept {
  if (now.time_ns - searched_ns_ >= kPartySearchNs) {
    present_.set();
    searched_ns_ = now.time_ns;
  }
  alignas(cmsghdr) std::array<std::array<char, kControlBytes>, kMaxDatagrams> controls;
  std::array<iovec, kMaxDatagrams> parts;
  std::array<mmsghdr, kMaxDatagrams> messages{};
  for (std::size_t i = 0; i < kMaxDatagrams; ++i) {
    parts[i] = {.iov_base = datagrams_[i].data(), .iov_len = sizeof(Frames)};
    messages[i].msg_hdr.msg_iov = &parts[i];
    messages[i].msg_hdr.msg_iovlen = 1;
    messages[i].msg_hdr.msg_control = controls[i].data();
    messages[i].msg_hdr.msg_controllen = kControlBytes;
  }
  const int received = recvmmsg(socket_.descriptor(), messages.data(), kMaxDatagrams, MSG_DONTWAIT, nullptr);
  if (received < 0 && errno != EAGAIN && errno != EINTR) ++counts_.errors;

  received_count_ = 0;
  for (int i = 0; i < received; ++i) {
    mmsghdr& message = messages[static_cast<std::size_t>(i)];
    const bool whole = (message.msg_hdr.msg_flags & MSG_TRUNC) == 0;
    count_dropped(message.msg_hdr);
    accept(std::span(datagrams_[static_cast<std::size_t>(i)]).first(whole ? message.msg_len : 0),
           stamp_of(message.msg_hdr, now));
  }
  const bool more = received == static_cast<int>(kMaxDatagrams);
  if (!more) emptied_ns_ = now.time_ns;
  return {.frames = {received_.data(), received_count_}, .more = more};
}

void CanBus::accept(std::span<const std::byte> datagram, std::int64_t stamp_ns) noexcept {
  std::array<can_frame, kMaxFramesPerDatagram> frames;
  std::size_t count = 0;
  while (!datagram.empty()) {
    const auto frame = count < frames.size() ? first_frame(datagram) : std::nullopt;
    if (!frame) {
      count = 0;
      break;
    }
    frames[count++] = *frame;
    datagram = datagram.subspan(transfer_size(*frame));
  }
  if (count == 0) ++counts_.malformed;
  for (const can_frame& frame : std::span(frames).first(count)) {
    if (frame.len > max_length(frame)) {
      ++counts_.malformed;
    } else if (is_error(frame)) {
      evaluate_error_frame(frame);
    } else if (socket_.passes(frame.can_id)) {
      ++counts_.received;
      if (state_ == CanState::kBusOff) state_ = CanState::kActive;  // in bus-off a controller receives nothing
      received_[received_count_++] = {.frame = frame, .stamp_ns = stamp_ns};
    }
  }
}

void CanBus::evaluate_error_frame(const can_frame& frame) noexcept {
  ++counts_.error_frames;
  last_error_frame_ = frame;
  const std::uint8_t controller = (frame.can_id & CAN_ERR_CRTL) != 0 ? frame.data[1] : 0;
  if ((controller & CAN_ERR_CRTL_RX_OVERFLOW) != 0) ++counts_.lost;
  if ((frame.can_id & CAN_ERR_BUSOFF) != 0) {
    if (state_ != CanState::kBusOff) ++counts_.bus_off;
    state_ = CanState::kBusOff;
  } else if ((frame.can_id & CAN_ERR_RESTARTED) != 0 || (controller & CAN_ERR_CRTL_ACTIVE) != 0) {
    state_ = CanState::kActive;
  } else if ((controller & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
    state_ = CanState::kPassive;
  } else if ((controller & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) {
    state_ = CanState::kWarning;
  }
}

std::int64_t CanBus::stamp_of(msghdr& head, const CanTime& now) noexcept {
  const auto* stamp = control_value<timespec>(head, SCM_TIMESTAMPNS);
  if (stamp == nullptr) return now.time_ns;
  const std::int64_t age_ns = now.utc_ns - (stamp->tv_sec * 1'000'000'000 + stamp->tv_nsec);
  return now.time_ns - std::clamp<std::int64_t>(age_ns, 0, now.time_ns - emptied_ns_);
}

void CanBus::count_dropped(msghdr& head) noexcept {
  const auto* dropped = control_value<std::uint32_t>(head, SO_RXQ_OVFL);
  if (dropped == nullptr) return;
  counts_.lost += *dropped - dropped_;
  dropped_ = *dropped;
}

}  // namespace robot_control
