#include "drivers/drive/can_driver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "drivers/line/can_load.h"

namespace robot_control {
namespace {

/// Returns why a drive sends no velocity; "" if it does.
const char* why_no_velocity(VelocitySource source) noexcept {
  switch (source) {
    case VelocitySource::kDrive:
      break;
    case VelocitySource::kNotRequested:
      return "velocity_pdo is off";
    case VelocitySource::kNoRoom:
      return "the bus load does not allow it: set a lower robot.rate";
    case VelocitySource::kNoUnit:
      return "its unit is not known: set velocity_unit";
    case VelocitySource::kNotMapped:
      return "the drive does not map 606C";
    case VelocitySource::kNotSent:
      return "the drive maps 606C, and does not send it";
  }
  return "";
}

bool is_checked(const DriveStatus& status) noexcept {
  return status.state == DrivePhase::kReady || status.state == DrivePhase::kRunning;
}

}  // namespace

CanDriver::CanDriver(CanBusParameters parameters, DriveSet drives, std::span<const Brake> brakes,
                     std::size_t joint_count, double period, CanSockets sockets, DriverClock clock)
    : joint_count_(joint_count),
      parameters_(std::move(parameters)),
      drives_(std::move(drives)),
      takes_speeds_(drives_.size() > 0 && drives_[0].drive_parameters().takes_speeds),
      clock_(std::move(clock)),
      period_(period),
      brakes_(brakes.begin(), brakes.end()),
      commands_(drives_.size()),
      send_(sockets.size()) {
  for (CanSocket& socket : sockets) {
    load_ =
        std::max(load_, bus_load(drives_.plan(lines_.size()), 1 / period, parameters_.bit_rate, parameters_.data_rate));
    lines_.emplace_back(std::move(socket));
  }
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    laws_.emplace_back(brakes[i], drives_[i].drive_parameters().torque_limit);
    closes_impedance_ = closes_impedance_ && drives_[i].drive_parameters().max_stiffness > 0;
  }
}

bool CanDriver::measures(MachineInput input) const noexcept {
  if (input != MachineInput::kJointEffort) return Driver::measures(input);
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (!drives_[i].drive_parameters().measures_torque) return false;
  }
  return true;
}

void CanDriver::stop() noexcept {
  stopped_ = true;
  if (!follows()) return;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const double damping = brakes_[i].damping;
    commands_[i] = {.enabled = true, .brake_damping = damping, .damping = damping};
  }
  send_commands(clock_().time_ns);
  if (!closes_impedance_) return;
  for (int repeated = 1; repeated < kLastCommands; ++repeated)
    for (std::size_t i = 0; i < lines_.size(); ++i) lines_[i].bus.send(send_[i].frames());
}

void CanDriver::send_commands(std::int64_t now_ns) noexcept {
  for (FrameBatch& batch : send_) batch.clear();
  drives_.step(commands_, now_ns, send_);
  for (std::size_t i = 0; i < lines_.size(); ++i) lines_[i].bus.send(send_[i].frames());
}

void CanDriver::start() {
  stopped_ = false;
  ran_ = false;
  begin();
}

void CanDriver::begin() noexcept {
  reset_ = true;
  state_ = DriverState::kStarting;
  faults_ = 0;
  for (JointLaw& law : laws_) law.reset();
}

bool CanDriver::all_are(DrivePhase state) const noexcept {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (drives_[i].status().state != state) return false;
  }
  return true;
}

bool CanDriver::all_checked() const noexcept {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (!is_checked(drives_[i].status())) return false;
  }
  return true;
}

/// A drive that waits is enabled with all others. One that has torque keeps it, also in a fault in which it can brake.
bool CanDriver::may_have_torque(std::size_t joint) const noexcept {
  return checked_ || drives_[joint].status().state >= DrivePhase::kRunning;
}

void CanDriver::judge_faults() noexcept {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const DriveStatus& status = drives_[i].status();
    if (status.state == DrivePhase::kFault && !reset_) faults_ |= fault_of(status.cause);
  }
  const bool fell_back = state_ == DriverState::kRunning && !all_are(DrivePhase::kRunning);
  if (fell_back && faults_ == 0) faults_ |= kFaultDrive;
  if (faults_ != 0) {
    state_ = DriverState::kFault;
  } else if (all_are(DrivePhase::kRunning)) {
    state_ = DriverState::kRunning;
    ran_ = true;
  }
}

bool CanDriver::follows() const noexcept {
  return state_ == DriverState::kRunning || (state_ == DriverState::kFault && ran_ && closes_impedance_);
}

void CanDriver::receive(std::size_t line, const CanTime& now) noexcept {
  CanBus& bus = lines_[line].bus;
  for (int i = 0; i < kMaxBatches; ++i) {
    const ReceivedFrames received = bus.receive(now);
    for (const ReceivedFrame& each : received.frames) drives_.receive(each.frame, each.stamp_ns, line);
    if (!received.more) break;
  }
  lines_[line].watch.step(bus, now.time_ns);
}

void CanDriver::read(SensorFrame& sensors) noexcept {
  const CanTime now = clock_();
  now_ns_ = now.time_ns;
  for (std::size_t i = 0; i < lines_.size(); ++i) receive(i, now);
  drives_.judge_silence(now_ns_);
  judge_faults();
  checked_ = all_checked();
  sensors.driver_state = state_;
  sensors.faults = faults_;
  sensors.valid = 0;
  sensors.joint_count = joint_count_;
  for (std::size_t i = drives_.size(); i < joint_count_; ++i) sensors.joints[i] = {};
  sensors.battery_voltage = 0;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const DriveSample& sample = drives_[i].sample();
    JointSample& joint = sensors.joints[i];
    joint = sample.valid ? at_time(sample, now_ns_) : sample.joint;
    if (!drives_[i].drive_parameters().measures_torque) joint.effort = std::numeric_limits<double>::quiet_NaN();
    joint.age_ns = now_ns_ - sample.stamp_ns;
    joint.valid = (sample.valid ? kValidPosition | kValidVelocity : 0U) | (sample.effort_valid ? kValidEffort : 0U);
    if (drives_[i].drive_parameters().takes_effort) joint.valid |= kTakesEffort;
    const DriveStatus& status = drives_[i].status();
    joint.fault = status.state == DrivePhase::kFault ? static_cast<std::uint32_t>(status.cause) : 0;
    if (sample.voltage > 0) sensors.battery_voltage = sample.voltage;
  }
  if (sensors.battery_voltage > 0) sensors.valid |= kValidBattery;
  sensors.link_count = lines_.size();
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const CanCounts& counts = lines_[i].bus.counts();
    sensors.links[i] = {.state = lines_[i].watch.status().state,
                        .sent = counts.sent,
                        .lost = counts.refused + counts.lost,
                        .late = 0,
                        .errors = counts.errors + counts.error_frames + counts.malformed};
  }
  publish_statuses();
}

void CanDriver::publish_statuses() noexcept {
  bool changed = false;
  const auto update = [&changed](auto& last, const auto& now) {
    if (last == now) return;
    last = now;
    changed = true;
  };
  for (std::size_t i = 0; i < drives_.size(); ++i) update(statuses_.drives[i], drives_[i].full_status());
  for (std::size_t i = 0; i < lines_.size(); ++i) update(statuses_.buses[i], lines_[i].watch.status());
  if (changed) published_statuses_.store(statuses_);
}

std::string CanDriver::description() const {
  std::ostringstream text;
  text << word_of(parameters_.dialect) << (takes_speeds_ ? " that takes speeds" : "") << " on ";
  for (const std::string& bus : drives_.buses()) text << (&bus == &drives_.buses().front() ? "" : ", ") << bus;
  text << " at " << parameters_.bit_rate / 1000 << " kbit/s, load at most " << std::lround(100 * load_) << " %";
  Statuses statuses;
  if (!published_statuses_.load(statuses)) return text.str();
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const KnownReaction& known = statuses.drives[i].on_silence;
    text << (i == 0 ? "; on silence " : ", ") << drives_[i].drive_parameters().joint << ' '
         << described(known.reaction);
    if (known.evidence == ReactionEvidence::kRead) text << " (read from the drive)";
    if (known.evidence == ReactionEvidence::kConfirmed) text << " (stated in the drive file)";
  }
  std::string without;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const char* reason = why_no_velocity(statuses.drives[i].velocity);
    if (*reason == '\0') continue;
    without += (without.empty() ? "" : ", ") + drives_[i].drive_parameters().joint + " (" + reason + ")";
  }
  if (!without.empty()) {
    text << "; the velocity is computed from the positions, so late frames make the robot sway (docs/drivers.md), of "
         << without;
  }
  return text.str();
}

std::string CanDriver::warning() const {
  Statuses statuses;
  if (!published_statuses_.load(statuses)) return "";
  std::string text;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const std::string words = robot_control::words(statuses.buses[i]);
    if (words.empty()) continue;
    text += (text.empty() ? "" : ". ") + (lines_.size() > 1 ? drives_.buses()[i] + ", " : "") + words;
  }
  const std::span drives = std::span(statuses.drives).first(drives_.size());
  const bool others_wait = !std::ranges::all_of(drives, is_checked);
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const DriveStatus& status = drives[i];
    if (status.state == DrivePhase::kRunning || (others_wait && status.cause == DriveCause::kEnable)) continue;
    if (!text.empty()) text += ". ";
    text += drives_[i].words(status);
  }
  return text;
}

DriveCommand CanDriver::wanted(std::size_t joint, const JointCommand& command) noexcept {
  DriveCommand wanted{.enabled = may_have_torque(joint), .reset = reset_, .brake_torque = brakes_[joint].effort};
  wanted.brake_damping = brakes_[joint].damping;
  const DriveSample& sample = drives_[joint].sample();
  if (!sample.valid) {
    laws_[joint].reset();
  } else if (takes_speeds_) {
    wanted.speed = wanted_speed(command, drives_[joint].drive_parameters().velocity_limit);
    if (command.mode == JointMode::kDriveVelocity && finite(command)) wanted.torque = command.effort;
  } else {
    const JointSample now = at_time(sample, now_ns_);
    wanted.torque = laws_[joint].step(command, now.position, now.velocity);
    add_impedance(joint, command, now, wanted);
  }
  return wanted;
}

void CanDriver::add_hold(const DriveParameters& drive, const JointSample& now, DriveCommand& wanted) const noexcept {
  const double stiffness = std::min(drive.torque_limit / (kHoldSpeed * period_), drive.max_stiffness);
  if (wanted.stiffness >= stiffness) return;
  const double moves = kHoldPeriods * period_ * now.velocity;
  wanted.stiffness = stiffness;
  wanted.position = now.position + moves;
  wanted.torque += stiffness * moves;
}

void CanDriver::add_impedance(std::size_t joint, const JointCommand& command, const JointSample& now,
                              DriveCommand& wanted) const noexcept {
  const DriveParameters& drive = drives_[joint].drive_parameters();
  if (drive.max_stiffness == 0 || std::abs(wanted.torque) >= drive.torque_limit) return;
  switch (finite(command) ? command.mode : JointMode::kBrake) {
    case JointMode::kEffort:
      return;
    case JointMode::kImpedance:
      wanted.stiffness = std::min(command.stiffness, drive.max_stiffness);
      wanted.position = command.position;
      if (drive.on_silence == SilenceReaction::kKeeps) add_hold(drive, now, wanted);
      [[fallthrough]];
    case JointMode::kVelocity:
      wanted.damping = std::min(command.damping, drive.max_damping);
      wanted.speed = command.velocity;
      break;
    default:
      wanted.damping = std::min(brakes_[joint].damping, drive.max_damping);
  }
  wanted.torque -= wanted.stiffness * (wanted.position - now.position) + wanted.damping * (wanted.speed - now.velocity);
}

void CanDriver::write(std::span<const JointCommand> commands) noexcept {
  const bool obeys = !stopped_ && follows() && commands.size() == joint_count_;
  for (std::size_t i = 0; i < drives_.size(); ++i) commands_[i] = wanted(i, obeys ? commands[i] : JointCommand{});
  reset_ = false;
  send_commands(now_ns_);
}

}  // namespace robot_control
