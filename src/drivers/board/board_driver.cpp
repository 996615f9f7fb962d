#include "drivers/board/board_driver.h"

#include <cmath>

#include "signals/formatted_text.h"

namespace robot_control {
namespace {

constexpr double kMicro = 1.0e-6;
constexpr double kSpeedSteps = 256;  // of a speed, per count
constexpr double kBitsPerByte = 10;  // with start and stop bit

/// Returns bytes of the longest frame with a body of this size.
constexpr double frame_bytes(std::size_t body) {
  return static_cast<double>(body + std::size_t{BOARD_MAX_FRAME} - std::size_t{BOARD_MAX_BODY});
}

/// Returns the larger load of the two directions, as a share of the bit rate; 0 for USB.
double line_load(std::size_t wheels, double period, std::uint64_t bit_rate) {
  if (bit_rate == 0) return 0;
  const double order = frame_bytes(6 + 5 * wheels);
  const double report = frame_bytes(28 + 9 * wheels + 30);
  return std::max(order, report) * kBitsPerByte / period / static_cast<double>(bit_rate);
}

std::size_t velocity_samples(double period) {
  const std::int64_t span = std::max<std::int64_t>(1, BoardDriver::kVelocitySpanNs / std::llround(1.0e9 * period));
  return std::min(PositionDifference::kSamples, static_cast<std::size_t>(span));
}

const char* words_of_reset(std::uint8_t reason) noexcept {
  switch (reason) {
    case BOARD_BROWN_OUT:
      return "after its supply was too low";
    case BOARD_RESET_BUTTON:
      return "by its reset button or the opening of its line";
    case BOARD_RESET_WATCHDOG:
      return "by its own watchdog, because its program hung";
    default:
      return "";
  }
}

}  // namespace

BoardDriver::BoardDriver(const BoardParameters& parameters, std::span<const Brake> brakes, std::size_t joint_count,
                         double period, std::unique_ptr<SerialLine> line, std::function<std::int64_t()> clock)
    : SerialDriver(parameters.wheels, velocity_samples(period), joint_count, period, std::move(line), std::move(clock)),
      parameters_(parameters),
      load_(line_load(parameters.wheels.size(), period, parameters.line.bit_rate)) {
  if (load_ > kMaxLineLoad) {
    throw DriverError("a line of " + std::to_string(parameters.line.bit_rate) +
                      formatted(" bit/s allows at most %g Hz for this board, but robot.rate is %g Hz: "
                                "set a higher board.bit_rate here and in the board, or a lower robot.rate",
                                std::floor(kMaxLineLoad / load_ / period), std::round(1 / period)));
  }
  for (std::size_t i = 0; i < wheels_.size(); ++i) laws_.emplace_back(brakes[i], parameters.wheels[i].torque_limit);
  max_age_ns_ = static_cast<std::int64_t>(parameters.line.max_silence) * period_ns_;
}

void BoardDriver::begin() noexcept {
  silent_for_ = 0;
  forget_samples();
  for (JointLaw& law : laws_) law.reset();
}

void BoardDriver::forget_samples() noexcept {
  has_report_ = false;
  board_clock_.restart();
  for (BoardWheel& wheel : wheels_) wheel.difference.clear();
}

bool BoardDriver::receive() noexcept {
  ++silent_for_;
  SerialChunk chunk;
  const std::uint16_t bad = decoder_.bad;
  for (int i = 0; i < kMaxChunks && line_->receive(chunk); ++i) {
    for (const std::uint8_t byte : chunk.received()) {
      const std::uint8_t size = board_decode(&decoder_, byte);
      if (size == 0) continue;
      board_report report{};
      if (board_read_report(decoder_.body, size, &report) != 0) {
        accept(report, std::min(chunk.time_ns, now_ns_));
      } else if (decoder_.body[0] != BOARD_PROTOCOL) {
        evaluate(DriveCause::kDiffers, "version of the protocol", 0, decoder_.body[0], BOARD_PROTOCOL);
      }
    }
  }
  link_.errors += static_cast<std::uint16_t>(decoder_.bad - bad);
  return silent_for_ > parameters_.line.max_silence;
}

void BoardDriver::accept(const board_report& report, std::int64_t arrived_ns) noexcept {
  firmware_ = report.firmware;
  if (report.wheels != wheels_.size())
    return evaluate(DriveCause::kDiffers, "number of wheels", 0, report.wheels, static_cast<double>(wheels_.size()));
  if ((report.flags & BOARD_REFUSED) != 0)
    return evaluate(DriveCause::kDiffers, "the board refuses the orders: version of the protocol or number of wheels");
  const auto behind = static_cast<std::uint16_t>(cycle_ - report.cycle);
  const auto after = static_cast<std::uint16_t>(report.cycle - answered_);
  const std::int64_t sent_ns = sent_ns_[report.cycle % kOrders];
  if (behind >= std::min<std::uint64_t>(kOrders, orders_) || arrived_ns - sent_ns > kMaxTripNs ||
      (has_report_ && (after == 0 || after >= kOrders))) {
    ++link_.late;
    return;
  }
  if (has_report_) link_.lost += after - 1U;
  const std::int64_t elapsed_us = has_report_ ? static_cast<std::uint32_t>(report.time_us - board_us_) : 0;
  if (has_report_ && std::abs(1000 * elapsed_us - (sent_ns - answered_ns_)) > kClockJumpNs) {
    evaluate(DriveCause::kRestarted, words_of_reset(report.sensors.reset));
    forget_samples();
    return;
  }
  // A board that restarted braked as well: that is not its cause.
  const bool braked = (report.flags & BOARD_WATCHDOG) != 0;
  if (braked) evaluate(DriveCause::kOwnBrake);
  total_us_ += elapsed_us;
  board_clock_.add(sent_ns, total_us_, total_us_ + report.delay_us, arrived_ns);
  sample_ns_ = board_clock_.host_ns(total_us_);
  accept_counts(report, elapsed_us);
  board_us_ = report.time_us;
  answered_ns_ = sent_ns;
  answered_ = report.cycle;
  has_report_ = true;
  silent_for_ = 0;
  sensors_ = report.sensors;
  accept_imu(report);
  if (status().state == DrivePhase::kStarting && !braked) run();
}

void BoardDriver::accept_counts(const board_report& report, std::int64_t elapsed_us) noexcept {
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const BoardWheelParameters& parameters = parameters_.wheels[i];
    BoardWheel& wheel = wheels_[i];
    const std::uint32_t counts = report.counts[parameters.wheel];
    const std::uint32_t step = counts - wheel.counts;
    const auto moved = parameters.counter_bits == 16 ? static_cast<std::int16_t>(static_cast<std::uint16_t>(step))
                                                     : static_cast<std::int32_t>(step);
    wheel.counts = counts;
    if (has_report_) {
      const double reach = kSpeedMargin * parameters.velocity_limit *
                               (kMicro * static_cast<double>(elapsed_us) + 1.0e-9 * static_cast<double>(period_ns_)) +
                           2 * std::abs(wheel.rad_per_count);
      const double turned = wheel.rad_per_count * moved;
      if (std::abs(turned) > reach) evaluate(DriveCause::kPositionJump, "counts of", i, turned, reach);
      wheel.total += moved;
    } else {
      wheel.total = counts;
    }
    wheel.measure(1000 * total_us_);  // the estimate of the offset moves; drift is 0.05 % at most
    const double direction = static_cast<double>(parameters.direction);
    wheel.effort = direction * kMicro * report.sensors.effort[parameters.wheel];
    wheel.fault = report.sensors.fault[parameters.wheel];
    if (wheel.fault != 0) evaluate(DriveCause::kDriveError, "fault word of", i);
  }
}

void BoardDriver::accept_imu(const board_report& report) noexcept {
  if ((report.sensors.valid & BOARD_HAS_IMU) == 0) return;
  const board_imu& imu = report.sensors.imu;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    imu_.angular_velocity[axis] = kMicro * imu.angular_velocity[axis];
    imu_.linear_acceleration[axis] = kMicro * imu.linear_acceleration[axis];
  }
  const auto age_us = static_cast<std::int32_t>(report.time_us - imu.time_us);
  imu_ns_ = board_clock_.host_ns(total_us_ - age_us);
}

void BoardDriver::add_measurements(SensorFrame& sensors) noexcept {
  const auto has = [this](unsigned bit) { return (sensors_.valid & bit) != 0; };
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    JointSample& joint = sensors.joints[i];
    if (has(BOARD_HAS_EFFORT)) joint.effort = wheels_[i].effort;
    joint.temperature = 0.1 * sensors_.temperature_dc;
    if (running() && has(BOARD_HAS_EFFORT)) joint.valid |= kValidEffort;
    if (running() && has(BOARD_HAS_TEMPERATURE)) joint.valid |= kValidTemperature;
    if (wheels_[i].fault != 0) joint.fault = wheels_[i].fault;
  }
  if (running() && has(BOARD_HAS_BATTERY)) {
    sensors.valid |= kValidBattery;
    sensors.battery_voltage = 1.0e-3 * sensors_.battery_mv;
    sensors.battery_current = 1.0e-2 * sensors_.battery_ca;
  }
  if (running() && has(BOARD_HAS_IMU) && now_ns_ - imu_ns_ <= max_age_ns_) {
    sensors.valid |= kValidGyro | kValidAccelerometer;
    sensors.imu = imu_;
  }
  const bool released = (sensors_.inputs & BOARD_E_STOP_RELEASED) != 0;
  if (parameters_.line.e_stop_input && has_report_ && !released) sensors.digital_inputs = kInputEmergencyStop;
}

void BoardDriver::send_order(board_order& order) noexcept {
  order.cycle = ++cycle_;
  order.wheels = static_cast<std::uint8_t>(wheels_.size());
  std::array<std::uint8_t, BOARD_MAX_BODY> body;
  std::array<std::uint8_t, BOARD_MAX_FRAME> frame;
  const std::uint8_t size = board_encode(body.data(), board_write_order(&order, body.data()), frame.data());
  sent_ns_[cycle_ % kOrders] = clock_();
  ++orders_;
  send(std::span(frame).first(size));
}

void BoardDriver::write(std::span<const JointCommand> commands) noexcept {
  board_order order{};
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    if (!running()) continue;  // BOARD_BRAKE
    order.wheel[parameters_.wheels[i].wheel] = order_of(i, obeys(commands) ? commands[i] : JointCommand{});
  }
  send_order(order);
}

board_wheel_order BoardDriver::order_of(std::size_t i, const JointCommand& command) noexcept {
  const BoardWheel& wheel = wheels_[i];
  const BoardWheelParameters& parameters = parameters_.wheels[i];
  if (parameters_.takes_speeds) {
    const double speed = wanted_speed(command, parameters.velocity_limit);
    return {BOARD_VELOCITY, rounded(kSpeedSteps * speed / wheel.rad_per_count)};
  }
  const double age = 1.0e-9 * static_cast<double>(now_ns_ - sample_ns_);
  const double torque = laws_[i].step(command, wheel.position + wheel.velocity * age, wheel.velocity);
  return {BOARD_EFFORT, rounded(static_cast<double>(parameters.direction) * torque / kMicro)};
}

void BoardDriver::stop() noexcept {
  stopped_ = true;
  if (!running()) return;
  board_order order{};
  send_order(order);
}

std::string BoardDriver::description() const {
  const std::uint64_t firmware = published().firmware;
  std::string text = "board on " + line_->name() + ", protocol " + std::to_string(BOARD_PROTOCOL);
  if (firmware != 0) text += ", firmware " + std::to_string(firmware);
  if (load_ > 0) text += ", load of the line " + std::to_string(std::lround(100 * load_)) + " %";
  return text + (parameters_.takes_speeds ? ", takes speeds" : ", takes torques") + "; on silence it " +
         described(parameters_.line.on_silence) + " (stated in the drive file)";
}

std::string BoardDriver::warning() const {
  const DriveStatus drive = published().drive;
  const bool names_wheel = drive.cause == DriveCause::kPositionJump || drive.cause == DriveCause::kDriveError;
  return words("board", names_wheel ? parameters_.wheels.at(drive.code).joint : "");
}

}  // namespace robot_control
