#include "log/black_box/black_box.h"

#include <lz4.h>

#include <algorithm>

#include "signals/checksum.h"

namespace robot_control {

namespace {

constexpr std::size_t kMaxRecord = std::max(
    {sizeof(DriverTrace), sizeof(EstimatorTrace), sizeof(ControllerTrace), sizeof(MonitorTrace), sizeof(LawSnapshot)});

}  // namespace

BlackBox::BlackBox(const std::string& path, std::size_t bytes, std::uint64_t build, const LogHeader& header)
    : packed_(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(kMaxRecord)))),
      file_(path, bytes, hex(build) + encode(header)) {}

void BlackBox::add(const DriverTrace& row) noexcept {
  add_bytes(BlackBoxKind::kDriver, row.sensors.head.stamp_ns, &row, sizeof row);
}
void BlackBox::add(const EstimatorTrace& row) noexcept {
  add_bytes(BlackBoxKind::kEstimator, row.state.head.stamp_ns, &row, sizeof row);
}
void BlackBox::add(const ControllerTrace& row) noexcept {
  add_bytes(BlackBoxKind::kController, row.command.head.stamp_ns, &row, sizeof row);
}
void BlackBox::add(const MonitorTrace& row) noexcept {
  add_bytes(BlackBoxKind::kMonitor, row.permit.head.stamp_ns, &row, sizeof row);
}
void BlackBox::add(const LawSnapshot& snapshot) noexcept {
  add_bytes(BlackBoxKind::kSnapshot, snapshot.head.stamp_ns, &snapshot, sizeof snapshot);
}
void BlackBox::add_state(std::int64_t time_offset_ns, std::uint64_t lost) noexcept {
  const BlackBoxState state{.time_offset_ns = time_offset_ns, .lost = lost};
  add_bytes(BlackBoxKind::kState, 0, &state, sizeof state);
}

double BlackBox::seconds_added() const noexcept {
  return static_cast<double>(newest_ns_ - first_ns_) * 1e-9;
}

double BlackBox::seconds_held() const noexcept {
  if (file_.appended_bytes() == 0) return 0;
  return seconds_added() * static_cast<double>(file_.kept_bytes()) / static_cast<double>(file_.appended_bytes());
}

void BlackBox::add_bytes(BlackBoxKind kind, std::int64_t stamp_ns, const void* data, std::size_t size) noexcept {
  const int packed = LZ4_compress_default(static_cast<const char*>(data), packed_.data(), static_cast<int>(size),
                                          static_cast<int>(packed_.size()));
  if (stamp_ns > newest_ns_) newest_ns_ = stamp_ns;
  if (first_ns_ == 0) first_ns_ = stamp_ns;
  file_.append(static_cast<std::uint32_t>(kind), stamp_ns, {packed_.data(), static_cast<std::size_t>(packed)});
}

}  // namespace robot_control
