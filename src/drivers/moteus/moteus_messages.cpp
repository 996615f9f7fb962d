#include "drivers/moteus/moteus_messages.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace robot_control::moteus {
namespace {

constexpr std::uint8_t kWriteError = 0x30, kReadError = 0x31, kNothing = 0x50;
constexpr double kNoLimit = -1;

constexpr ReplyField kFields[] = {
    {Register::kMode, Type::kInt8, &Reply::mode, 1},
    {Register::kPosition, Type::kFloat, &Reply::position, kTurn},
    {Register::kVelocity, Type::kFloat, &Reply::velocity, kTurn},
    {Register::kTorque, Type::kFloat, &Reply::torque, 1},
    {Register::kVoltage, Type::kInt8, &Reply::voltage, 0.5},
    {Register::kTemperature, Type::kInt8, &Reply::temperature, 1},
    {Register::kFault, Type::kInt8, &Reply::fault, 1},
    {Register::kHome, Type::kInt8, &Reply::home, 1},
    {Register::kMapVersion, Type::kInt32, &Reply::map_version, 1},
    {Register::kProportional, Type::kFloat, &Reply::proportional, 1},
    {Register::kIntegral, Type::kFloat, &Reply::integral, 1},
    {Register::kDerivative, Type::kFloat, &Reply::derivative, 1},
};
constexpr unsigned kState = 0x7F, kIdentity = 0x180, kGains = 0xE00;  // bits of fields, in their order

constexpr unsigned bytes_of(Type type) noexcept {
  return type == Type::kFloat ? 4 : 1U << static_cast<unsigned>(type);
}

SubframeWriter begin_order(std::uint64_t node, Mode mode) noexcept {
  SubframeWriter writer(kRequestsReply | kHost << 8U | static_cast<canid_t>(node));
  writer.begin(Access::kWrite, Type::kInt8, Register::kMode, 1).value(Type::kInt8, static_cast<double>(mode));
  return writer;
}

can_frame with_query(SubframeWriter writer, Query query) noexcept {
  writer.begin(Access::kRead, Type::kInt8, Register::kMode, 1);
  writer.begin(Access::kRead, Type::kFloat, Register::kPosition, 3);
  writer.begin(Access::kRead, Type::kInt8, Register::kVoltage, 3);
  if (query == Query::kIdentity) {
    writer.begin(Access::kRead, Type::kInt8, Register::kHome, 1);
    writer.begin(Access::kRead, Type::kInt32, Register::kMapVersion, 1);
  }
  if (query == Query::kGains) writer.begin(Access::kRead, Type::kFloat, Register::kProportional, 3);
  return writer.frame();
}

}  // namespace

SubframeReader::SubframeReader(const can_frame& frame) noexcept
    : rest_(frame.data, std::min<std::size_t>(frame.len, max_length(frame))) {}

std::uint32_t SubframeReader::varuint() noexcept {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 35 && !rest_.empty(); shift += 7) {
    const std::uint8_t byte = rest_.front();
    rest_ = rest_.subspan(1);
    value |= std::uint64_t{byte & 0x7FU} << shift;
    if (byte < 0x80) return static_cast<std::uint32_t>(value);
  }
  whole_ = false;
  return 0;
}

std::optional<Subframe> SubframeReader::next() noexcept {
  while (whole_ && !rest_.empty()) {
    const std::uint8_t head = rest_.front();
    rest_ = rest_.subspan(1);
    if (head == kNothing) {
      whole_ = std::ranges::all_of(std::exchange(rest_, {}), [](std::uint8_t byte) { return byte == kNothing; });
      break;
    }
    if (head == kWriteError || head == kReadError) {
      varuint();
      varuint();
      continue;
    }
    whole_ = head < kWriteError;
    Subframe subframe{
        .access = static_cast<Access>(head & 0xF0U), .type = static_cast<Type>(head >> 2U & 3U), .count = head & 3U};
    if (subframe.count == 0 && whole_) subframe.count = varuint();
    if (subframe.count == 0 && whole_) continue;
    subframe.first = varuint();
    const std::size_t bytes = subframe.access == Access::kRead ? 0 : subframe.count * bytes_of(subframe.type);
    whole_ = whole_ && subframe.count <= kMaxCount && bytes <= rest_.size();
    if (!whole_) break;
    subframe.values = rest_.first(bytes);
    rest_ = rest_.subspan(bytes);
    return subframe;
  }
  return std::nullopt;
}

SubframeWriter::SubframeWriter(canid_t id) noexcept {
  frame_.can_id = id > CAN_SFF_MASK ? id | CAN_EFF_FLAG : id;
  frame_.flags = CANFD_FDF | CANFD_BRS;
}

SubframeWriter& SubframeWriter::begin(Access access, Type type, Register first, unsigned count) noexcept {
  const unsigned head = static_cast<unsigned>(access) | static_cast<unsigned>(type) << 2U;
  add(count <= 3 ? head | count : head);
  if (count > 3) add(count);
  auto number = static_cast<std::uint32_t>(first);
  for (; number >= 0x80; number >>= 7U) add(0x80 | (number & 0x7FU));
  add(number);
  return *this;
}

SubframeWriter& SubframeWriter::value(Type type, double value) noexcept {
  const unsigned bytes = bytes_of(type);
  const std::uint64_t raw =
      type == Type::kFloat ? float_bits(value) : static_cast<std::uint64_t>(saturated(value, 8 * bytes));
  for (unsigned i = 0; i < bytes; ++i) add(raw >> 8U * i & 0xFFU);
  return *this;
}

can_frame SubframeWriter::frame() const noexcept {
  SubframeWriter padded = *this;
  while (padded.frame_.len < fd_length(frame_.len)) padded.add(kNothing);
  return padded.frame_;
}

double value_of(const Subframe& subframe, unsigned i) noexcept {
  const unsigned bytes = bytes_of(subframe.type);
  std::uint32_t raw = 0;
  for (unsigned byte = bytes; byte-- > 0;) raw = raw << 8U | subframe.values[i * bytes + byte];
  if (subframe.type == Type::kFloat) return double{std::bit_cast<float>(raw)};
  const std::int64_t value = sign_extended(raw, 8 * bytes);
  return raw == 1U << (8 * bytes - 1) ? std::nan("") : static_cast<double>(value);
}

const ReplyField* field_of(std::uint32_t number, Type type) noexcept {
  const ReplyField* field = std::ranges::find(kFields, static_cast<Register>(number), &ReplyField::number);
  return field != std::end(kFields) && field->type == type ? field : nullptr;
}

can_frame encode_stop(std::uint64_t node, Query query) noexcept {
  return with_query(begin_order(node, Mode::kStopped), query);
}

can_frame encode_order(std::uint64_t node, const MitRanges& ranges, const MitCommand& command, double timeout,
                       Query query) noexcept {
  SubframeWriter writer = begin_order(node, Mode::kPosition);
  writer.begin(Access::kWrite, Type::kFloat, Register::kOrderPosition, 6);
  for (const double value : {command.position / kTurn, command.velocity / kTurn, command.torque,
                             command.stiffness / ranges.stiffness, command.damping / ranges.damping, ranges.torque})
    writer.value(Type::kFloat, value);
  writer.begin(Access::kWrite, Type::kFloat, Register::kTimeout, 1).value(Type::kFloat, timeout);
  writer.begin(Access::kWrite, Type::kInt8, Register::kVelocityLimit, 2);
  writer.value(Type::kInt8, kNoLimit).value(Type::kInt8, kNoLimit);
  return with_query(writer, query);
}

std::optional<Reply> decode_reply(const can_frame& frame, std::uint64_t node) noexcept {
  if ((frame.can_id & ~CAN_EFF_FLAG) != (node << 8U | kHost) || !is_fd(frame)) return std::nullopt;
  Reply reply;
  unsigned found = 0;
  SubframeReader reader(frame);
  while (const auto subframe = reader.next()) {
    if (subframe->access != Access::kReply) return std::nullopt;
    for (unsigned i = 0; i < subframe->count; ++i) {
      const ReplyField* field = field_of(subframe->first + i, subframe->type);
      if (field == nullptr) continue;
      reply.*field->member = field->scale * value_of(*subframe, i);
      found |= 1U << (field - kFields);
    }
  }
  if (!reader.whole() || (found & kState) != kState || std::isnan(reply.mode) || std::isnan(reply.fault))
    return std::nullopt;
  reply.has_identity = (found & kIdentity) == kIdentity;
  reply.has_gains = (found & kGains) == kGains;
  return reply;
}

bool commands(const can_frame& frame, std::uint64_t node) noexcept {
  const canid_t id = frame.can_id & ~CAN_EFF_FLAG;
  const canid_t target = id & 0x7FU;
  if (id > 0xFFFF || (target != node && target != kBroadcast)) return false;
  SubframeReader reader(frame);
  while (const auto subframe = reader.next()) {
    if (subframe->access == Access::kWrite) return true;
  }
  return !reader.whole();
}

}  // namespace robot_control::moteus
