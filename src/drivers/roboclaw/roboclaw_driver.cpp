#include "drivers/roboclaw/roboclaw_driver.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace robot_control {
namespace {

constexpr std::size_t kSamples = 4;
constexpr std::int32_t kTimeoutSteps = 1;  // of 100 ms

struct ErrorWords {
  std::uint32_t bit;
  const char* words;
};

constexpr ErrorWords kErrors[] = {
    {0x0001, "emergency stop"},   {0x0002, "temperature 1"},         {0x0004, "temperature 2"},
    {0x0008, "battery too high"}, {0x0010, "logic supply too high"}, {0x0020, "logic supply too low"},
    {0x0040, "driver of M1"},     {0x0080, "driver of M2"},          {0x0100, "speed of M1"},
    {0x0200, "speed of M2"},      {0x0400, "position of M1"},        {0x0800, "position of M2"},
    {0x1000, "current of M1"},    {0x2000, "current of M2"},         {0x4000, "battery too low"},
    {0x8000, "battery too high"}};

std::string words_of_errors(std::uint64_t bits) {
  std::string text;
  for (const ErrorWords& error : kErrors) {
    if ((bits & error.bit) != 0) text += (text.empty() ? "" : ", ") + std::string(error.words);
  }
  return text;
}

}  // namespace

RoboclawDriver::RoboclawDriver(const RoboclawParameters& parameters, std::size_t joint_count, double period,
                               std::unique_ptr<SerialLine> line, std::function<std::int64_t()> clock)
    : SerialDriver(parameters.wheels, kSamples, joint_count, period, std::move(line), std::move(clock)),
      parameters_(parameters) {
  max_age_ns_ = kTimeoutNs;
}

void RoboclawDriver::begin() noexcept {
  setup_ = 0;
  turn_ = 0;
  ordered_ = false;
  has_counts_ = false;
  for (RoboclawWheel& wheel : wheels_) {
    wheel.blind = wheel.ordered = 0;
    wheel.difference.clear();
  }
}

bool RoboclawDriver::receive() noexcept {
  take_bytes();
  return 1.0e-9 * static_cast<double>(now_ns_ - sample_ns_) > kRoboclawSilence;
}

void RoboclawDriver::take_bytes() noexcept {
  SerialChunk chunk;
  for (int i = 0; i < kMaxChunks && line_->receive(chunk); ++i) {
    for (const std::uint8_t byte : chunk.received()) {
      arrived_ns_ = std::min(chunk.time_ns, now_ns_);
      if (!pending_) stray_ns_ = arrived_ns_;
      if (!pending_) continue;
      received_.add(byte, 1);
      if (answered()) accept();
    }
  }
  const bool pauses = unanswered_ == kRepeats;
  if (!pending_ || now_ns_ - sent_ns_ < (pauses ? kPauseNs : kAnswerNs)) return;
  // Older firmware answers with 16 bits.
  if (command_ == Command::kStatus && roboclaw::is_answer(asked_, received_, 2)) return accept();
  pending_ = false;
  unanswered_ = pauses ? 0 : unanswered_ + 1;
  if (unanswered_ == kRepeats) ordered_ = false;
  if (std::ranges::find(kSlowReadings, command_) != kSlowReadings.end()) ++turn_;  // a board may lack it
  ++link_.lost;
  if (received_.size() == 0) return;
  ++link_.errors;
  stray_ns_ = arrived_ns_;
}

bool RoboclawDriver::answered() noexcept {
  if (roboclaw::is_write(command_)) return received_.size() == 1 && received_.number(0, 1) == roboclaw::kAcknowledged;
  if (command_ != Command::kVersion) return roboclaw::is_answer(asked_, received_, roboclaw::answer_size(command_));
  const std::size_t size = received_.size();
  return size > 3 && received_.number(size - 3, 1) == 0 && roboclaw::is_answer(asked_, received_, size - 2);
}

void RoboclawDriver::accept() noexcept {
  pending_ = false;
  unanswered_ = 0;
  switch (command_) {
    case Command::kVelocityPid1:
      accept_gains(1);
      break;
    case Command::kVelocityPid2:
      accept_gains(2);
      break;
    case Command::kGetTimeout:
      if (received_.number(0, 1) != kTimeoutSteps)
        fail(DriveCause::kDiffers, "its serial timeout in ms", 0, 100 * received_.number(0, 1), 100 * kTimeoutSteps);
      break;
    case Command::kEncoders:
      accept_counts();
      break;
    case Command::kBattery:
      battery_ = 0.1 * received_.number(0, 2);
      valid_ = kValidBattery;
      break;
    case Command::kTemperature:
      temperature_ = 0.1 * received_.number(0, 2);
      has_temperature_ = true;
      break;
    case Command::kStatus: {
      const std::uint32_t errors = received_.number(0, received_.size() - 2) & 0xFFFFU;
      if (errors != 0) fail(DriveCause::kDriveError, "", errors);
      break;
    }
    default:
      break;
  }
  const bool is_order = command_ == Command::kSpeeds || command_ == Command::kDuties;
  ordered_ = is_order;
  if (is_order) return;
  if (status().state != DrivePhase::kStarting) {
    ++turn_;
    return;
  }
  if (setup_ < kSetup.size() && command_ == kSetup[setup_]) ++setup_;
  if (setup_ == kSetup.size()) run();
}

void RoboclawDriver::accept_gains(unsigned motor) noexcept {
  const auto found = std::ranges::find(parameters_.wheels, motor, &RoboclawWheelParameters::motor);
  if (found == parameters_.wheels.end()) return;
  if (received_.number(0, 4) == 0 && received_.number(4, 4) == 0)
    fail(DriveCause::kDiffers, "velocity gains of zero, tune them with the maker's tool, of", motor);
  const double fastest = found->velocity_limit * found->counts_per_turn / (2 * std::numbers::pi);
  if (received_.number(12, 4) < fastest)
    fail(DriveCause::kDiffers, "QPPS, below velocity_limit, of", motor, received_.number(12, 4), fastest);
}

void RoboclawDriver::accept_counts() noexcept {
  const std::int64_t stamp_ns = sent_ns_ + (arrived_ns_ - sent_ns_) / 2;
  const double elapsed = 1.0e-9 * static_cast<double>(stamp_ns - sample_ns_ + kAnswerNs);
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    RoboclawWheel& wheel = wheels_[i];
    const RoboclawWheelParameters& parameters = parameters_.wheels[i];
    const std::uint32_t counts = received_.number(4 * (parameters.motor - 1), 4);
    const auto moved = static_cast<std::int32_t>(counts - wheel.counts);
    wheel.counts = counts;
    if (!has_counts_) {
      wheel.total = static_cast<std::int32_t>(counts);
    } else {
      wheel.total += moved;
      const double reach = kSpeedMargin * parameters.velocity_limit * elapsed;
      const double turned = wheel.rad_per_count * moved;
      if (std::abs(turned) > reach) fail(DriveCause::kPositionJump, "counts of", i, turned, reach);
      if (moved != 0) wheel.blind = 0;
      if (wheel.blind > kBlindWay) fail(DriveCause::kNoCounts, "", i);
    }
    wheel.measure(stamp_ns);
  }
  has_counts_ = true;
  sample_ns_ = stamp_ns;
}

void RoboclawDriver::add_measurements(SensorFrame& sensors) noexcept {
  if (running()) sensors.valid = valid_;
  sensors.battery_voltage = battery_;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    sensors.joints[i].temperature = temperature_;
    if (running() && has_temperature_) sensors.joints[i].valid |= kValidTemperature;
  }
}

bool RoboclawDriver::counts_are_trusted() const noexcept {
  if (running()) return true;
  const DriveStatus& drive = status();
  return drive.state == DrivePhase::kFault &&
         (drive.cause == DriveCause::kSilent || drive.cause == DriveCause::kDriveError);
}

RoboclawDriver::Command RoboclawDriver::next() const noexcept {
  if (!ordered_) return counts_are_trusted() ? Command::kSpeeds : Command::kDuties;
  if (status().state == DrivePhase::kStarting) return setup_ < kSetup.size() ? kSetup[setup_] : Command::kEncoders;
  return turn_ % kSlowEvery == kSlowEvery - 1 ? kSlowReadings[turn_ / kSlowEvery % kSlowReadings.size()]
                                              : Command::kEncoders;
}

void RoboclawDriver::request(Command command) noexcept {
  const bool speeds = command == Command::kSpeeds;
  const std::int32_t first = speeds ? speeds_[0] : command == Command::kSetTimeout ? kTimeoutSteps : 0;
  asked_ = roboclaw::request(static_cast<std::uint8_t>(parameters_.line.board_address), command, first,
                             speeds ? speeds_[1] : 0);
  received_.clear();
  command_ = command;
  sent_ns_ = now_ns_;
  pending_ = true;
  send(asked_.bytes());
}

void RoboclawDriver::write(std::span<const JointCommand> commands) noexcept {
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    RoboclawWheel& wheel = wheels_[i];
    const RoboclawWheelParameters& parameters = parameters_.wheels[i];
    wheel.ordered = obeys(commands) ? wanted_speed(commands[i], parameters.velocity_limit) : 0;
    wheel.blind += std::abs(wheel.ordered) * 1.0e-9 * static_cast<double>(period_ns_);
    speeds_[parameters.motor - 1] = rounded(wheel.ordered / wheel.rad_per_count);
  }
  if (!pending_ && now_ns_ - stray_ns_ >= kPauseNs) request(next());
}

std::string RoboclawDriver::description() const {
  return "RoboClaw on " + line_->name() + ", takes speeds, its serial timeout is " +
         std::to_string(kTimeoutNs / 1'000'000) + " ms; on silence it " + described(parameters_.line.on_silence) +
         " (stated in the drive file)";
}

std::string RoboclawDriver::warning() const {
  const DriveStatus drive = published().drive;
  const bool names_wheel = drive.cause == DriveCause::kPositionJump || drive.cause == DriveCause::kNoCounts;
  if (drive.cause == DriveCause::kDriveError) return words("RoboClaw", words_of_errors(drive.code));
  if (names_wheel) return words("RoboClaw", parameters_.wheels.at(drive.code).joint);
  return words("RoboClaw", drive.code == 0 ? "" : "M" + std::to_string(drive.code));
}

}  // namespace robot_control
