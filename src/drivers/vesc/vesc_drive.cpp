#include "drivers/vesc/vesc_drive.h"

#include <algorithm>
#include <cmath>

#include "drivers/wrapped_count.h"
#include "signals/formatted_text.h"

namespace robot_control::vesc {
namespace {

constexpr double kMaxTemperatures = 6.5;  // periods; five lost ones in a row happen once in 10⁶ at a loss of 5 %

/// Returns the angle of the motor in one count of the tachometer, rad.
double count_of(const VescParameters& parameters) {
  return 2 * std::numbers::pi / (kCountsPerTurn * static_cast<double>(parameters.pole_pairs));
}

DriveParameters with_statuses(const VescParameters& parameters, double period) {
  DriveParameters drive = parameters.drive;
  drive.sample_period = parameters.status_period;
  drive.measures_torque = parameters.torque_constant > 0;
  drive.effort_is_rare = !drive.takes_speeds && parameters.status_period > period;
  drive.position_step = count_of(parameters);
  return drive;
}

}  // namespace

VescDrive::VescDrive(const VescParameters& parameters, double period)
    : Drive(with_statuses(parameters, period), period), parameters_(parameters), count_(count_of(parameters)) {}

std::vector<PlannedFrames> VescDrive::plan() const {
  return {{.extended = true, .data_bytes = 4, .per_cycle = 1},
          {.extended = true,
           .data_bytes = 8,
           .per_second = 2 / parameters_.status_period + 1 / parameters_.temperature_period}};
}

void VescDrive::restart(bool /*reset*/, std::int64_t /*now_ns*/) noexcept {
  seen_ = running_ = false;
  status_ns_ = temperature_ns_ = 0;
  counts_.reset();
  compared_way_ = compared_travel_ = 0;
}

void VescDrive::receive(const can_frame& frame, std::int64_t now_ns) noexcept {
  if (!is_extended_data(frame) || (node_of(frame) != node() && node_of(frame) != kEveryNode)) return;
  if (commands_motion(command_of(frame))) return fail(DriveCause::kForeignCommander, "", frame.can_id & CAN_EFF_MASK);
  if (node_of(frame) != node()) return;
  seen_ = true;
  if (const auto status = decode<Status>(frame)) receive_status(*status, now_ns);
  if (const auto status = decode<Status5>(frame)) receive_position(*status, now_ns);
  if (const auto status = decode<Status4>(frame)) {
    temperature_ns_ = now_ns;
    accept_temperature(std::fmax(status->transistors, status->motor));
  }
}

void VescDrive::receive_status(const Status& status, std::int64_t now_ns) noexcept {
  status_ns_ = now_ns;
  velocity_ = status.speed / static_cast<double>(parameters_.pole_pairs);
  current_ = std::abs(status.current);
  accept_velocity(velocity_);
  if (drive_parameters().measures_torque) {
    accept_motor_torque(parameters_.torque_constant * (status.duty < 0 ? -status.current : status.current), now_ns);
  }
}

void VescDrive::receive_position(const Status5& status, std::int64_t now_ns) noexcept {
  accept_voltage(status.voltage);
  if (status_ns_ == 0) return;  // The velocity is not known yet.
  const std::int64_t before = counts_.value_or(status.tachometer);
  counts_ = continued_count(before, status.tachometer);
  const double measured = count_ * static_cast<double>(*counts_);
  if (!sample().valid) {
    position_ = measured;
    position_ns_ = now_ns;
  }
  const double travel = velocity_ * 1.0e-9 * static_cast<double>(now_ns - position_ns_);
  position_ += travel;
  const double beyond = position_ - std::clamp(position_, measured - count_ / 2, measured + count_ / 2);
  position_ -= (std::abs(beyond) > count_ ? 1 : kCorrected) * beyond;
  position_ns_ = now_ns;
  accept_position(position_, velocity_, now_ns);
  if (!running_) return;
  compared_travel_ += travel;
  compare_units(count_ * static_cast<double>(*counts_ - before));
}

void VescDrive::compare_units(double moved) noexcept {
  compared_way_ += moved;
  const double longer = std::fmax(std::abs(compared_way_), std::abs(compared_travel_));
  if (longer < kComparedCounts * count_) return;
  if (std::abs(compared_way_ - compared_travel_) > kUnitTolerance * longer) {
    fail(DriveCause::kDiffers, "counts of the tachometer per electrical turn", 0,
         kCountsPerTurn * compared_way_ / compared_travel_, kCountsPerTurn);
  }
  compared_way_ = compared_travel_ = 0;
}

const char* VescDrive::missing_message(std::int64_t now_ns) const noexcept {
  const double longest = 1.0e9 * kMaxTemperatures * parameters_.temperature_period;
  if (status_ns_ == 0 || now_ns - status_ns_ > max_silence_ns()) return "CAN status message 1";
  if (temperature_ns_ == 0 || static_cast<double>(now_ns - temperature_ns_) > longest) return "CAN status message 4";
  return sample().valid ? nullptr : "CAN status message 5";
}

void VescDrive::advance(const DriveCommand& command, std::int64_t now_ns, FrameBatch& send) noexcept {
  const bool drives = running_ && command.enabled && !disabled();
  send.add(drives ? order(command) : brakes_by_itself() ? brake(command) : encode(node(), SetCurrent{}));
  if (disabled()) return;
  if (const char* missing = missing_message(now_ns)) {
    if (running_) return fail(DriveCause::kSilent, missing);
    if (seen_) return set(DrivePhase::kStarting, DriveCause::kMessage, missing);
    return set(DrivePhase::kStarting, DriveCause::kFirstFrame);
  }
  if (status().state == DrivePhase::kStarting) settle_reaction();
  if (status().state == DrivePhase::kFault) return judge_release(command, now_ns);
  if (!command.enabled || !running_) {
    running_ = command.enabled;
    current_ns_ = now_ns;
    return set(DrivePhase::kReady, DriveCause::kEnable);
  }
  set(DrivePhase::kRunning, DriveCause::kNone);
  judge_release(command, now_ns);
}

bool VescDrive::needs_current(const DriveCommand& command) const noexcept {
  const double fastest = std::abs(motor_speed(drive_parameters().velocity_limit));
  if (drive_parameters().takes_speeds) return std::abs(motor_speed(command.speed) - velocity_) > kMaxLag * fastest;
  const double current = motor_torque(command.torque) / parameters_.torque_constant;
  return std::abs(current) > kMinCurrent && std::abs(velocity_) < fastest;
}

void VescDrive::judge_release(const DriveCommand& command, std::int64_t now_ns) noexcept {
  if (current_ > kNoCurrent || !needs_current(command)) current_ns_ = now_ns;
  if (now_ns - current_ns_ <= kReleasedNs) return;
  running_ = false;
  if (status().state != DrivePhase::kFault) fail(DriveCause::kReleased, "no current");
}

can_frame VescDrive::order(const DriveCommand& command) const noexcept {
  if (drive_parameters().takes_speeds) {
    return encode(node(), SetSpeed{.speed = motor_speed(command.speed) * static_cast<double>(parameters_.pole_pairs)});
  }
  return encode(node(), SetCurrent{.current = motor_torque(command.torque) / parameters_.torque_constant});
}

can_frame VescDrive::brake(const DriveCommand& command) const noexcept {
  if (drive_parameters().takes_speeds) return encode(node(), SetSpeed{});
  return encode(node(),
                SetBrakeCurrent{.current = std::abs(motor_torque(command.brake_torque)) / parameters_.torque_constant});
}

std::string VescDrive::code_words(const DriveStatus& status) const {
  if (status.cause != DriveCause::kForeignCommander) return "";
  return formatted("0x%llX", static_cast<unsigned long long>(status.code));
}

}  // namespace robot_control::vesc
