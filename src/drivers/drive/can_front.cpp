#include "drivers/drive/can_front.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

CanFront::CanFront(const CanParameters& parameters, std::span<const Brake> brakes, double period, std::uint64_t seed,
                   CanSocket socket)
    : drives_(parameters, brakes, period, seed),
      line_(std::move(socket)),
      period_ns_(std::llround(1.0e9 * period)),
      host_(drives_.bus().join([this](const can_frame& frame, std::int64_t now_ns) { carry(frame, now_ns); })),
      random_(seed) {
  std::visit(
      [this](const auto& joints) {
        for (const auto& joint : joints) joints_.push_back(joint.drive.joint);
      },
      parameters.joints);
}

void CanFront::carry(can_frame frame, std::int64_t now_ns) {
  if (fault_ == AnswerFault::kLost) return;
  const auto bit = static_cast<unsigned>(fault_ == AnswerFault::kDamaged ? random_() % 64 : 64);
  if (bit / 8 < frame.len) frame.data[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  if (fault_ == AnswerFault::kShifted) std::rotate(frame.data, frame.data + 7, frame.data + 8);
  answers_.push_back({frame, now_ns + (fault_ == AnswerFault::kLate ? kLateAnswerNs : 0)});
}

void CanFront::run(std::span<const JointSample> joints) {
  const std::int64_t now_ns = drives_.bus().now_ns();
  for (bool more = true; more;) {
    const ReceivedFrames received = line_.receive({.time_ns = now_ns, .utc_ns = now_ns});
    for (const ReceivedFrame& each : received.frames) drives_.bus().send(host_, each.frame);
    more = received.more;
  }
  drives_.run(joints, now_ns + period_ns_);
  std::vector<can_frame> arrived;
  for (; !answers_.empty() && answers_.front().due_ns <= now_ns + period_ns_; answers_.pop_front())
    arrived.push_back(answers_.front().frame);
  line_.send(arrived);
}

std::string CanFront::inject(std::string_view component, std::string_view kind) {
  const std::vector<Word> words = words_of(DeviceFault());
  const auto word = std::ranges::find(words, kind, &Word::text);
  const auto joint = std::ranges::find(joints_, component);
  const AnswerFault answers = answer_fault(kind);
  const auto is = [kind](auto... of_bus) { return ((kind == of_bus) || ...); };
  if (component == "bus" && (is("ok", "off", "lossy", "disturbed") || answers != AnswerFault::kNone)) {
    fault_ = answers;
    drives_.bus().connect(host_, kind != "off");
    drives_.disturb(is("lossy", "disturbed"), is("disturbed"));
    return "";
  }
  if (joint != joints_.end() && word != words.end()) {
    drives_.inject(static_cast<std::size_t>(joint - joints_.begin()), static_cast<DeviceFault>(word->value));
    return "";
  }
  std::string problem =
      std::string("component must be bus (with ok, off, lossy, disturbed, ") + kAnswerFaultWords + ")";
  for (const std::string& name : joints_) problem += ", " + name;
  problem += "; kind";
  for (const Word& each : words) problem += " " + std::string(each.text);
  return problem;
}

}  // namespace robot_control
