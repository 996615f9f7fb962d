#include "drivers/drive/serial_front.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

SerialFront::SerialFront(std::size_t wheels, double period, std::uint64_t bit_rate, FrontLine line)
    : motions_(wheels), period_ns_(std::llround(1.0e9 * period)), true_line_(std::move(line.true_end)) {
  if (!true_line_) virtual_line_ = std::make_unique<VirtualSerial>(static_cast<double>(bit_rate), line.seed);
}

void SerialFront::run(std::span<const JointSample> joints) {
  for (Motion& motion : motions_) motion.mean_torque = 0;
  const std::int64_t begin_ns = now_ns_;
  const std::int64_t end_ns = begin_ns + period_ns_;
  while (now_ns_ < end_ns) {
    const auto elapsed = 1.0e-9 * static_cast<double>(now_ns_ - begin_ns);
    for (std::size_t i = 0; i < motions_.size(); ++i) {
      motions_[i].position = joints[i].position + joints[i].velocity * elapsed;
      motions_[i].velocity = joints[i].velocity;
    }
    if (virtual_line_) virtual_line_->advance(now_ns_);
    step_board();
    const std::int64_t next_ns = std::min(now_ns_ + kStepNs, end_ns);
    const double share = static_cast<double>(next_ns - now_ns_) / static_cast<double>(period_ns_);
    const double seconds = 1.0e-9 * static_cast<double>(next_ns - now_ns_);
    for (std::size_t i = 0; i < motions_.size(); ++i) motions_[i].mean_torque += share * step_wheel(i, seconds);
    now_ns_ = next_ns;
  }
  if (virtual_line_) virtual_line_->advance(now_ns_);
}

std::string SerialFront::inject(std::string_view component, std::string_view kind) {
  if (inject_board(component, kind)) return "";
  if (component == "line" && virtual_line_) {
    if (const std::optional<SerialFaults> faults = serial_faults(kind)) {
      virtual_line_->faults() = *faults;
      return "";
    }
  }
  return "component must be " + fault_words() + " or line (with " + kSerialFaultWords + ", " + kAnswerFaultWords + ")";
}

}  // namespace robot_control
