#include "drivers/unitree_go/bridge/command_relay.h"

namespace robot_control::unitree::go {

void CommandRelay::store(const LowCmd& command, std::int64_t now_ns) noexcept {
  command_ = command;
  command_ns_ = now_ns;
  has_command_ = true;
  is_new_ = true;
}

const LowCmd* CommandRelay::last_command() noexcept {
  if (!sends_) return nullptr;
  for (MotorCommand& motor : command_.motors) {
    if (motor.mode == kServo) motor = {.mode = kServo, .dq = 0, .kd = damping_};
  }
  return &command_;
}

const LowCmd* CommandRelay::due(std::int64_t now_ns, bool may_send) noexcept {
  if (!may_send || !has_driver(now_ns)) {
    sends_ = false;
    is_new_ = false;
    return nullptr;
  }
  if (is_new_) {
    is_new_ = false;
    sends_ = true;
    return &command_;
  }
  if (now_ns - command_ns_ <= kSilenceNs || now_ns - damped_ns_ < kRepeatNs) return nullptr;
  damped_ns_ = now_ns;
  return last_command();
}

}  // namespace robot_control::unitree::go
