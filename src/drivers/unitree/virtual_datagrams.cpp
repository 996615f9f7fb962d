#include "drivers/unitree/virtual_datagrams.h"

#include <algorithm>
#include <utility>

namespace robot_control {

std::optional<DatagramFaults> datagram_faults(std::string_view word) {
  constexpr double kLoss = 0.05;
  constexpr std::int64_t kJitterNs = 2'000'000;
  DatagramFaults faults;
  if (word == "lossy" || word == "disturbed") faults.loss = kLoss;
  if (word == "late" || word == "disturbed") faults.jitter_ns = kJitterNs;
  faults.cut = word == "cut";
  faults.answers = answer_fault(word);
  const bool known =
      word == "ok" || faults.loss > 0 || faults.jitter_ns > 0 || faults.cut || faults.answers != AnswerFault::kNone;
  return known ? std::optional(faults) : std::nullopt;
}

std::size_t VirtualDatagrams::receive(Way& way, std::span<std::uint8_t> bytes) const noexcept {
  Datagram* oldest = nullptr;
  for (Datagram& each : way) {
    if (each.size == 0 || each.arrives_ns > now_ns_) continue;
    if (oldest == nullptr || each.arrives_ns < oldest->arrives_ns) oldest = &each;
  }
  if (oldest == nullptr) return 0;
  const std::size_t size = std::exchange(oldest->size, 0);
  std::copy_n(oldest->bytes.begin(), std::min(size, bytes.size()), bytes.begin());
  return size;
}

bool VirtualDatagrams::send(Way& way, std::span<const std::uint8_t> bytes) {
  const AnswerFault fault = &way == &to_driver_ ? faults_.answers : AnswerFault::kNone;
  if (faults_.cut || fault == AnswerFault::kLost || chance() < faults_.loss) return true;
  const auto place = std::ranges::find(way, 0U, &Datagram::size);
  if (place == way.end() || bytes.size() >= kMaxDatagram) return true;
  const std::size_t shift = fault == AnswerFault::kShifted ? 1 : 0;
  place->bytes[0] = 0;
  std::ranges::copy(bytes.first(bytes.size() - shift), place->bytes.begin() + static_cast<std::ptrdiff_t>(shift));
  place->size = bytes.size();
  if (fault == AnswerFault::kDamaged) {
    const auto at = static_cast<std::size_t>(chance() * static_cast<double>(bytes.size()));
    place->bytes[at] ^= static_cast<std::uint8_t>(1U << (random_() % 8));
  }
  const auto jitter_ns = static_cast<std::int64_t>(chance() * static_cast<double>(faults_.jitter_ns));
  place->arrives_ns = now_ns_ + faults_.delay_ns + jitter_ns + (fault == AnswerFault::kLate ? kLateAnswerNs : 0);
  return true;
}

}  // namespace robot_control
