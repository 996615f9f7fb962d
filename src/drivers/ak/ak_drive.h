#pragma once
/// One AK motor (drivers/drive/mit/mit_drive.h).
///
/// It has no timeout: when this program is silent it keeps its last order for ever. `stop` of the driver therefore ends
/// with a damping. It also keeps an order while it is released, and carries it out when it is enabled. So the request
/// to release it takes turns with an order of zeros.
///
/// It does not report whether it is released. It counts as enabled after kAnswers answers since the first request: one
/// of them may answer an earlier frame. It counts as released where its order needs more than kNeeded of the torque's
/// range, and it reports less than kNoTorque of it for kReleasedNs. An order that needs no torque shows nothing.
///
/// Its ranges depend on type and firmware, public lists contradict each other, and the motor has no registers. So its
/// velocities are compared with its positions (drivers/drive/mit/motion_scale.h). The range of the torque is not
/// checked.

#include <cstdint>

#include "drivers/ak/ak_messages.h"
#include "drivers/ak/ak_parameters.h"
#include "drivers/drive/mit/mit_drive.h"

namespace robot_control::ak {

class AkDrive final : public MitDrive {
 public:
  static constexpr unsigned kAnswers = 3;
  static constexpr double kNeeded = 0.1;
  static constexpr double kNoTorque = 0.01;
  static constexpr std::int64_t kReleasedNs = 100'000'000;

  AkDrive(const AkParameters& parameters, double period);

  void receive(const can_frame& frame, std::int64_t now_ns) noexcept override;
  std::vector<PlannedFrames> plan() const override;

 private:
  void forget_motor() noexcept override;
  bool is_set_up() const noexcept override { return true; }
  can_frame set_up() noexcept override { return release(); }
  void end_unanswered() noexcept override {}
  bool is_on() const noexcept override { return answers_ >= kAnswers && !released_ && !in_error(); }
  bool in_error() const noexcept override { return error_ != Error::kNone; }
  std::uint64_t state_code() const noexcept override { return static_cast<std::uint64_t>(error_); }
  can_frame clear() noexcept override { return encode_request(node(), MitRequest::kRelease); }
  can_frame enable() noexcept override;
  can_frame release() noexcept override;
  can_frame order(const MitCommand& command) noexcept override;
  std::string code_words(const DriveStatus& status) const override;

  void judge_release(const Reply& reply, std::int64_t now_ns) noexcept;

  double temperature_offset_;
  Error error_ = Error::kNone;
  MitCommand ordered_;
  bool enables_ = false;
  bool zeros_ = false;  // The last release was an order of zeros.
  bool released_ = false;
  unsigned answers_ = 0;        // since the first request to enable it
  std::int64_t obeyed_ns_ = 0;  // when its torque last agreed with its order
};

}  // namespace robot_control::ak
