#include "drivers/drive/mit/mit_drive.h"

#include <cmath>
#include <numbers>

namespace robot_control {
namespace {

DriveParameters with_impedance(const MitJoint& joint) {
  DriveParameters drive = joint.drive;
  drive.takes_speeds = false;
  drive.is_absolute = true;
  drive.max_stiffness = joint.ranges.stiffness * drive.gear * drive.gear;
  drive.max_damping = joint.ranges.damping * drive.gear * drive.gear;
  return drive;
}

}  // namespace

MitDrive::MitDrive(const MitJoint& joint, double period)
    : Drive(with_impedance(joint), period),
      ranges_(joint.ranges),
      scale_(joint.ranges),
      start_angle_(joint.start_angle),
      motor_gear_(joint.motor_gear) {}

void MitDrive::restart(bool reset, std::int64_t /*now_ns*/) noexcept {
  phase_ = Phase::kSetup;
  reset_ = reset;
  accept_answer();
  scale_.clear();
  forget_motor();
}

void MitDrive::compare(const char* name, double found, double expected) noexcept {
  if (!(std::abs(found - expected) <= kTolerance * expected)) fail(DriveCause::kDiffers, name, 0, found, expected);
}

void MitDrive::check_scale(double position, double velocity, std::int64_t now_ns) noexcept {
  if (!scale_.step(position, velocity, now_ns)) return;
  if (scale_.ratio() <= 0) return fail(DriveCause::kDiffers, "change of its position, which its velocity contradicts");
  fail(DriveCause::kDiffers, "velocity_range by its positions, or position_range", 0, ranges_.velocity / scale_.ratio(),
       ranges_.velocity);
}

can_frame MitDrive::request_set_up(std::int64_t now_ns) noexcept {
  set(DrivePhase::kStarting, sample().valid ? DriveCause::kIdentity : DriveCause::kFirstFrame);
  if (now_ns < next_request_ns_) return release();
  next_request_ns_ = now_ns + kRetryNs;
  if (!sample().valid) {
    tries_ = 0;
  } else if (tries_++ == kTries) {
    end_unanswered();
  }
  return set_up();
}

can_frame MitDrive::clear_error(std::int64_t now_ns) noexcept {
  if (now_ns < next_request_ns_) return release();
  next_request_ns_ = now_ns + kRetryNs;
  if ((reset_ || starts_from_error()) && may_clear()) return clear();
  fail(DriveCause::kDriveError, "", state_code());
  return release();
}

void MitDrive::check_start_angle() noexcept {
  if (!start_angle_) return;
  const double half_turn = std::numbers::pi / (motor_gear_ * drive_parameters().gear);
  const double angle = sample().joint.position;
  if (std::abs(angle - *start_angle_) <= half_turn) return;
  fail(DriveCause::kDiffers, "start_angle", 0, angle, *start_angle_);
}

void MitDrive::advance(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept {
  const can_frame frame = disabled() ? release() : next_frame(command, now_ns);
  if (!disabled()) return send.add(frame);
  send.add(brakes_by_itself() ? order({.damping = motor_gain(command.brake_damping)}) : release());
}

can_frame MitDrive::next_frame(const DriveCommand& command, std::int64_t now_ns) noexcept {
  if (phase_ == Phase::kRunning && !is_on()) {
    fail(in_error() ? DriveCause::kDriveError : DriveCause::kReleased, "", state_code());
    return release();
  }
  if (phase_ == Phase::kSetup && is_set_up()) {
    settle_reaction();
    phase_ = Phase::kPosition;
  }
  if (phase_ == Phase::kSetup) return request_set_up(now_ns);
  if (in_error()) return clear_error(now_ns);
  if (phase_ == Phase::kPosition) {
    set(DrivePhase::kStarting, DriveCause::kFirstFrame);
    if (!sample().valid) return release();
    check_start_angle();
    phase_ = Phase::kReady;
  }
  if (!command.enabled) {
    phase_ = Phase::kReady;
    set(DrivePhase::kReady, DriveCause::kEnable);
    return release();
  }
  if (phase_ == Phase::kReady) {
    phase_ = Phase::kEnable;
    deadline_ns_ = now_ns + kEnterNs;
  }
  if (phase_ == Phase::kEnable && !is_on()) {
    set(DrivePhase::kReady, DriveCause::kPower);
    if (now_ns > deadline_ns_) fail(DriveCause::kStaysOff);
    return enable();
  }
  phase_ = Phase::kRunning;
  reset_ = false;
  set(DrivePhase::kRunning, DriveCause::kNone);
  return order({.position = motor_position(command.position),
                .velocity = motor_speed(command.speed),
                .stiffness = motor_gain(command.stiffness),
                .damping = motor_gain(command.damping),
                .torque = motor_torque(command.torque)});
}

}  // namespace robot_control
