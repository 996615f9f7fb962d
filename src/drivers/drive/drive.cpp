#include "drivers/drive/drive.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_control {
namespace {

double within(double value, double limit) noexcept {
  return std::isfinite(value) ? std::clamp(value, -limit, limit) : 0;
}

}  // namespace

JointSample at_time(const DriveSample& sample, std::int64_t now_ns) noexcept {
  JointSample joint = sample.joint;
  joint.position += joint.velocity * 1.0e-9 * static_cast<double>(now_ns - sample.stamp_ns);
  return joint;
}

void FrameBatch::add(const can_frame& frame) noexcept {
  if (count_ == frames_.size()) {
    ++dropped_;
  } else {
    frames_[count_++] = frame;
  }
}

Drive::Drive(DriveParameters parameters, double period)
    : period_ns_(std::llround(1.0e9 * period)),
      drive_(std::move(parameters)),
      to_joint_(static_cast<double>(drive_.direction) / drive_.gear),
      zero_(drive_.offset),
      position_(sample_period_ns()) {}

void Drive::step(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept {
  if (command.reset && !reset_before_) {
    clears_ = 0;
    if (status().state == DrivePhase::kFault) begin(true, now_ns);
  }
  reset_before_ = command.reset;
  judge_silence(now_ns);
  DriveCommand limited = command;
  limited.torque = within(command.torque, drive_.torque_limit);
  limited.speed = within(command.speed, drive_.velocity_limit);
  limited.stiffness = std::fmax(0, within(command.stiffness, drive_.max_stiffness));
  limited.damping = std::fmax(0, within(command.damping, drive_.max_damping));
  limited.position = within(command.position, std::numeric_limits<double>::max());
  advance(limited, now_ns, send);
  note_order(status().state == DrivePhase::kRunning ? limited.torque : 0);
}

void Drive::begin(bool reset, std::int64_t now_ns) noexcept {
  forget();
  sample_ = {};
  zero_ = drive_.offset;
  position_.clear();
  difference_.clear();
  on_silence_ = {};
  restart(reset, now_ns);
}

void Drive::judge_silence(std::int64_t now_ns) noexcept {
  if (sample_.valid && now_ns - sample_.stamp_ns > max_silence_ns()) {
    if (status().state == DrivePhase::kReady) {
      forget();
      restart(false, now_ns);
    } else if (status().state == DrivePhase::kRunning) {
      fail(DriveCause::kSilent, "position");
    }
    sample_.valid = false;
    position_.clear();
    difference_.clear();
  }
  if (now_ns - effort_ns_ > 5 * max_silence_ns()) sample_.effort_valid = false;
}

std::int64_t Drive::sample_period_ns() const noexcept {
  return std::max<std::int64_t>(period_ns_, std::llround(1.0e9 * drive_.sample_period));
}

namespace {

constexpr double kImpossibleSpeed = 10;  // times the limit: a number that no joint has

}  // namespace

void Drive::accept_position(double position, double velocity, std::int64_t now_ns) noexcept {
  if (!accept_motion(position, velocity, now_ns) || drive_.max_stiffness > 0) return;
  sample_.joint.position = position_.step(sample_.joint.position, to_joint_ * velocity, now_ns);
}

void Drive::accept_position(double position, std::int64_t now_ns) noexcept {
  if (!accept_motion(position, difference_.velocity(), now_ns)) return;
  difference_.add(position, now_ns);
  sample_.joint.velocity = to_joint_ * difference_.velocity();
}

bool Drive::accept_motion(double position, double velocity, std::int64_t now_ns) noexcept {
  if (!std::isfinite(position) || !std::isfinite(velocity)) {
    fail(DriveCause::kNotFinite);
    return false;
  }
  JointSample& joint = sample_.joint;
  const double moved = to_joint_ * position + zero_ - joint.position;
  // A frame may be late by a period; a joint that is pushed may be twice as fast as its limit.
  const double elapsed = 1.0e-9 * static_cast<double>(now_ns - sample_.stamp_ns + 2 * period_ns_);
  const double maximum = 2 * drive_.velocity_limit * std::fmax(elapsed, 2 * drive_.sample_period) +
                         std::abs(to_joint_) * drive_.position_step;
  if (sample_.valid && std::abs(moved) > maximum) {
    if (status().state >= DrivePhase::kRunning || drive_.is_absolute) {
      fail(DriveCause::kPositionJump, "position", 0, moved, maximum);
    } else {
      zero_ -= moved;
      position_.clear();
      difference_.clear();
    }
  }
  if (!is_possible(velocity)) return false;
  joint.position = to_joint_ * position + zero_;
  joint.velocity = to_joint_ * velocity;
  sample_.stamp_ns = now_ns;
  sample_.valid = true;
  return true;
}

bool Drive::is_possible(double velocity) noexcept {
  const double fastest = kImpossibleSpeed * drive_.velocity_limit;
  if (std::abs(to_joint_ * velocity) <= fastest) return true;
  fail(DriveCause::kPositionJump, "velocity", 0, to_joint_ * velocity, fastest);
  return false;
}

void Drive::accept_velocity(double velocity) noexcept {
  if (std::isfinite(velocity) && is_possible(velocity)) sample_.joint.velocity = to_joint_ * velocity;
}

void Drive::note_order(double torque) noexcept {
  std::shift_right(ordered_.begin(), ordered_.end(), 1);
  ordered_.front() = torque;
  if (follows_) sample_.joint.effort = torque;
}

void Drive::accept_motor_torque(double torque, std::int64_t now_ns) noexcept {
  if (!std::isfinite(torque)) return fail(DriveCause::kNotFinite);
  const double measured = torque / to_joint_;
  const auto [lowest, highest] = std::ranges::minmax(ordered_);
  const double tolerance = kEffortTolerance * drive_.torque_limit;
  follows_ = drive_.effort_is_rare && lowest - tolerance <= measured && measured <= highest + tolerance;
  if (!follows_) sample_.joint.effort = measured;
  sample_.effort_valid = true;
  effort_ns_ = now_ns;
}

void Drive::accept_temperature(double celsius) noexcept {
  if (!std::isfinite(celsius)) return;
  sample_.joint.temperature = celsius;
  if (celsius > drive_.max_temperature) fail(DriveCause::kHot, "temperature", 0, celsius, drive_.max_temperature);
}

void Drive::accept_voltage(double voltage) noexcept {
  if (!std::isfinite(voltage)) return;
  sample_.voltage = voltage;
  if (voltage < drive_.min_voltage) fail(DriveCause::kUnderVoltage, "voltage", 0, voltage, drive_.min_voltage);
}

void Drive::settle_reaction() noexcept {
  if (on_silence_.evidence == ReactionEvidence::kNone && drive_.on_silence != SilenceReaction::kUnknown) {
    on_silence_ = {drive_.on_silence, ReactionEvidence::kConfirmed};
  }
  if (on_silence_.reaction == SilenceReaction::kUnknown && !drive_.accept_unknown_watchdog) {
    fail(DriveCause::kUnknownWatchdog);
  }
}

DriveStatus Drive::full_status() const noexcept {
  DriveStatus status = this->status();
  status.on_silence = on_silence_;
  status.velocity = velocity_source();
  add_details(status);
  return status;
}

std::string Drive::words(const DriveStatus& status) const {
  return status_words(drive_.joint + " (node " + std::to_string(drive_.node) + ")", status, code_words(status));
}

}  // namespace robot_control
