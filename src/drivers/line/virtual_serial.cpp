#include "drivers/line/virtual_serial.h"

#include <algorithm>

namespace robot_control {
namespace {

constexpr double kBitsPerByte = 10;
constexpr double kPartialWrites = 0.1;
constexpr std::int64_t kFirstBytesNs = 100'000;  // bytes that arrive within this time are one chunk

}  // namespace

std::optional<SerialFaults> serial_faults(std::string_view word) {
  const auto is = [word](auto... words) { return ((word == words) || ...); };
  SerialFaults faults;
  faults.answers = answer_fault(word);
  if (faults.answers == AnswerFault::kNone && !is("ok", "lossy", "late", "disturbed", "partial", "stalled", "cut"))
    return std::nullopt;
  faults.message_loss = is("lossy", "disturbed") ? 0.05 : 0;
  faults.bit_errors = is("lossy", "disturbed") ? 0.01 : 0;
  faults.jitter_ns = is("late", "disturbed") ? 3'000'000 : 0;
  faults.partial = is("partial");
  faults.stalled = is("stalled");
  faults.cut = is("cut");
  return faults;
}

VirtualSerial::VirtualSerial(double bit_rate, std::uint64_t seed)
    : byte_ns_(bit_rate > 0 ? static_cast<std::int64_t>(1.0e9 * kBitsPerByte / bit_rate) : 0), random_(seed) {}

bool VirtualSerial::receive(Way& way, SerialChunk& chunk) const noexcept {
  chunk.size = 0;
  if (faults_.stalled) return false;
  while (way.taken < way.written && chunk.size < chunk.bytes.size()) {
    const Byte& byte = way.bytes[way.taken % kBufferBytes];
    if (byte.arrives_ns > now_ns_) break;
    if (chunk.size > 0 && byte.arrives_ns > chunk.time_ns + kFirstBytesNs) break;
    chunk.bytes[chunk.size++] = byte.value;
    chunk.time_ns = byte.arrives_ns;
    ++way.taken;
  }
  return chunk.size > 0;
}

bool VirtualSerial::send(Way& way, std::span<const std::uint8_t> bytes) {
  if (faults_.cut) return false;
  const AnswerFault fault = &way == &to_driver_ ? faults_.answers : AnswerFault::kNone;
  if (fault == AnswerFault::kLost || chance() < faults_.message_loss) return true;
  const bool partial = faults_.partial && chance() < kPartialWrites;
  const std::size_t taken = partial ? bytes.size() / 2 : bytes.size();
  const bool damaged = chance() < faults_.bit_errors || fault == AnswerFault::kDamaged;
  const std::size_t damage = random_() % (8 * std::max<std::size_t>(1, taken));
  const auto late_ns = faults_.delay_ns + static_cast<std::int64_t>(chance() * static_cast<double>(faults_.jitter_ns));
  const std::int64_t due_ns = now_ns_ + late_ns + (fault == AnswerFault::kLate ? kLateAnswerNs : 0);
  std::int64_t time_ns = std::max(due_ns, way.free_ns);
  const auto carry = [&](unsigned byte) {
    time_ns += byte_ns_;
    if (faults_.byte_loss > 0 && chance() < faults_.byte_loss) return;
    if (way.written - way.taken == kBufferBytes) return;
    way.bytes[way.written++ % kBufferBytes] = {time_ns, static_cast<std::uint8_t>(byte)};
  };
  if (fault == AnswerFault::kShifted) carry(static_cast<unsigned>(random_() % 256));
  for (std::size_t i = 0; i < taken; ++i) carry(bytes[i] ^ (damaged && damage / 8 == i ? 1U << damage % 8 : 0U));
  way.free_ns = time_ns;
  return !partial;
}

}  // namespace robot_control
