#include "simulation/devices/can_front.h"

#include <algorithm>
#include <cmath>

namespace robot_control {

CanFront::CanFront(const CanParameters& parameters, std::span<const Brake> brakes, double period, std::uint64_t seed,
                   CanSocket socket)
    : drives_(parameters, brakes, period, seed),
      line_(std::move(socket)),
      period_ns_(std::llround(1.0e9 * period)),
      host_(drives_.bus().join([this](const can_frame& frame, std::int64_t) { to_host_.push_back(frame); })) {
  std::visit(
      [this](const auto& joints) {
        for (const auto& joint : joints) joints_.push_back(joint.drive.joint);
      },
      parameters.joints);
}

void CanFront::run(std::span<const JointSample> joints) {
  const std::int64_t now_ns = drives_.bus().now_ns();
  for (bool more = true; more;) {
    const ReceivedFrames received = line_.receive({.time_ns = now_ns, .utc_ns = now_ns});
    for (const ReceivedFrame& each : received.frames) drives_.bus().send(host_, each.frame);
    more = received.more;
  }
  drives_.run(joints, now_ns + period_ns_);
  line_.send(to_host_);
  to_host_.clear();
}

std::string CanFront::inject(std::string_view component, std::string_view kind) {
  const std::vector<Word> words = words_of(DeviceFault());
  const auto word = std::ranges::find(words, kind, &Word::text);
  const auto joint = std::ranges::find(joints_, component);
  if (component == "bus" && (kind == "ok" || kind == "off" || kind == "lossy" || kind == "disturbed")) {
    drives_.bus().connect(host_, kind != "off");
    drives_.disturb(kind == "lossy" || kind == "disturbed", kind == "disturbed");
    return "";
  }
  if (joint != joints_.end() && word != words.end()) {
    drives_.inject(static_cast<std::size_t>(joint - joints_.begin()), static_cast<DeviceFault>(word->value));
    return "";
  }
  std::string problem = "component must be bus (with ok, off, lossy or disturbed)";
  for (const std::string& name : joints_) problem += ", " + name;
  problem += "; kind";
  for (const Word& each : words) problem += " " + std::string(each.text);
  return problem;
}

}  // namespace robot_control
