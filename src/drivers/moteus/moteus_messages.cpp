#include "drivers/moteus/moteus_messages.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <span>

namespace robot_control::moteus {
namespace {

constexpr canid_t kHost = 0;  // number of this program
constexpr canid_t kRequestsReply = 0x8000;
constexpr std::uint8_t kNothing = 0x50;

using Bytes = std::initializer_list<std::uint8_t>;

/// A Writer and a Reader follow the same layout of a frame.
class Writer {
 public:
  explicit Writer(canid_t id) noexcept {
    frame_.can_id = id > CAN_SFF_MASK ? id | CAN_EFF_FLAG : id;
    frame_.flags = CANFD_FDF | CANFD_BRS;
  }
  void bytes(Bytes bytes) noexcept {
    for (const std::uint8_t byte : bytes) frame_.data[frame_.len++] = byte;
  }
  bool branch(bool taken, Bytes first) noexcept {
    if (taken) bytes(first);
    return taken;
  }
  void integer(unsigned bits, double& value, double scale = 1) noexcept {
    raw(bits, static_cast<std::uint32_t>(saturated(value / scale, bits)));
  }
  void real(double& value, double scale = 1) noexcept { raw(32, float_bits(value / scale)); }
  can_frame padded() noexcept {
    for (const unsigned length = fd_length(frame_.len); frame_.len < length;) bytes({kNothing});
    return frame_;
  }

 private:
  void raw(unsigned bits, std::uint32_t value) noexcept {
    for (unsigned bit = 0; bit < bits; bit += 8) bytes({static_cast<std::uint8_t>(value >> bit)});
  }

  can_frame frame_{};
};

class Reader {
 public:
  explicit Reader(const can_frame& frame) noexcept
      : rest_(frame.data, std::min<std::size_t>(frame.len, max_length(frame))) {}
  void bytes(Bytes bytes) noexcept { good_ = branch(true, bytes) && good_; }
  bool branch(bool /*taken*/, Bytes first) noexcept {
    if (rest_.size() < first.size() || !std::ranges::equal(rest_.first(first.size()), first)) return false;
    rest_ = rest_.subspan(first.size());
    return true;
  }
  void integer(unsigned bits, double& value, double scale = 1) noexcept {
    const std::int64_t number = sign_extended(raw(bits), bits);
    value = number == sign_extended(1ULL << (bits - 1), bits) ? std::nan("") : scale * static_cast<double>(number);
  }
  void real(double& value, double scale = 1) noexcept { value = scale * double{std::bit_cast<float>(raw(32))}; }
  /// Returns whether the frame has the layout that was read.
  bool ends() const noexcept {
    return good_ && std::ranges::all_of(rest_, [](std::uint8_t byte) { return byte == kNothing; });
  }

 private:
  std::uint32_t raw(unsigned bits) noexcept {
    std::uint32_t value = 0;
    good_ = good_ && rest_.size() >= bits / 8;
    for (unsigned i = 0; good_ && i < bits / 8; ++i) value |= std::uint32_t{rest_[i]} << 8U * i;
    if (good_) rest_ = rest_.subspan(bits / 8);
    return value;
  }

  std::span<const std::uint8_t> rest_;
  bool good_ = true;
};

template <class Coder>
void follow(Coder& coder, const MitRanges& gains, Request& request) noexcept {
  if (coder.branch(request.mode == Mode::kPosition, {0x01, 0x00, static_cast<std::uint8_t>(Mode::kPosition)})) {
    request.mode = Mode::kPosition;
    coder.bytes({0x0C, 6, 0x20});
    coder.real(request.command.position, kTurn);
    coder.real(request.command.velocity, kTurn);
    coder.real(request.command.torque);
    coder.real(request.command.stiffness, gains.stiffness);
    coder.real(request.command.damping, gains.damping);
    coder.real(request.max_torque);
    coder.bytes({0x0D, 0x27});
    coder.real(request.timeout);
    coder.bytes({0x02, 0x28, 0xFF, 0xFF});  // limits of velocity and acceleration below 0: none
  } else {
    coder.bytes({0x01, 0x00, static_cast<std::uint8_t>(Mode::kStopped)});
  }
  coder.bytes({0x11, 0x00, 0x1F, 0x01, 0x13, 0x0D});
  request.details = coder.branch(request.details, {0x11, 0x0C, 0x19, 0x82, 0x02, 0x1F, 0x30});
}

template <class Coder>
void follow(Coder& coder, Reply& reply) noexcept {
  coder.bytes({0x21, 0x00});
  coder.integer(8, reply.mode);
  coder.bytes({0x2F, 0x01});
  coder.real(reply.position, kTurn);
  coder.real(reply.velocity, kTurn);
  coder.real(reply.torque);
  coder.bytes({0x23, 0x0D});
  coder.integer(8, reply.voltage, 0.5);
  coder.integer(8, reply.temperature);
  coder.integer(8, reply.fault);
  reply.details = coder.branch(reply.details, {0x21, 0x0C});
  if (!reply.details) return;
  coder.integer(8, reply.home);
  coder.bytes({0x29, 0x82, 0x02});
  coder.integer(32, reply.map_version);
  coder.bytes({0x2F, 0x30});
  coder.real(reply.proportional);
  coder.real(reply.integral);
  coder.real(reply.derivative);
}

bool has_id(const can_frame& frame, std::uint64_t id) noexcept {
  return (frame.can_id & ~CAN_EFF_FLAG) == id && is_fd(frame);
}

}  // namespace

can_frame encode(std::uint64_t node, const MitRanges& gains, Request request) noexcept {
  Writer writer(kRequestsReply | kHost << 8U | static_cast<canid_t>(node));
  follow(writer, gains, request);
  return writer.padded();
}

can_frame encode(std::uint64_t node, Reply reply) noexcept {
  Writer writer(static_cast<canid_t>(node) << 8U | kHost);
  follow(writer, reply);
  return writer.padded();
}

std::optional<Request> decode_request(const can_frame& frame, std::uint64_t node, const MitRanges& gains) noexcept {
  Request request;
  Reader reader(frame);
  follow(reader, gains, request);
  return has_id(frame, kRequestsReply | kHost << 8U | node) && reader.ends() ? std::optional(request) : std::nullopt;
}

std::optional<Reply> decode_reply(const can_frame& frame, std::uint64_t node) noexcept {
  Reply reply;
  Reader reader(frame);
  follow(reader, reply);
  const bool known = !std::isnan(reply.mode) && !std::isnan(reply.fault);
  return has_id(frame, node << 8U | kHost) && reader.ends() && known ? std::optional(reply) : std::nullopt;
}

bool commands(const can_frame& frame, std::uint64_t node) noexcept {
  const canid_t id = frame.can_id & ~CAN_EFF_FLAG;
  const canid_t target = id & 0x7FU;
  return id <= 0xFFFF && (target == node || target == kBroadcast) && frame.len > 0 && frame.data[0] >> 4U != 1;
}

}  // namespace robot_control::moteus
