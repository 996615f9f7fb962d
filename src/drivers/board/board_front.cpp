#include "drivers/board/board_front.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace robot_control {
namespace {

constexpr double kMicro = 1.0e-6;
constexpr double kFullPwm = 10'000;
constexpr double kSpeedSteps = 256;          // of a speed, per count
constexpr double kGainSteps = 65536;         // of a gain
constexpr std::int64_t kLoopNs = 2'000'000;  // of the speed loop, in which a wheel moves by some counts
constexpr std::uint16_t kFirmware = 1;
constexpr std::uint8_t kWheelFault = 1;

}  // namespace

BoardFront::BoardFront(const BoardParameters& parameters, std::span<const Brake> brakes, double period, FrontLine line)
    : SerialFront(brakes.size(), period, parameters.line.bit_rate, std::move(line)), parameters_(parameters) {
  for (const Brake& brake : brakes) wheels_.push_back({.brake = BrakeLaw(brake), .damping = brake.damping});
  sensors_.valid = BOARD_HAS_EFFORT;
  sensors_.inputs = BOARD_E_STOP_RELEASED;
  boot(BOARD_POWER_ON);
}

void BoardFront::boot(board_reset reason) {
  board_config config{};
  config.context = this;
  config.wheels = static_cast<std::uint8_t>(wheels_.size());
  config.firmware = kFirmware;
  config.functions = {
      .time_us = [](void* front) { return static_cast<BoardFront*>(front)->time_us(); },
      .counts = [](void* front, std::uint32_t* counts) { static_cast<BoardFront*>(front)->counts(counts); },
      .drive = [](void* front, std::uint8_t wheel, board_mode mode,
                  std::int32_t value) { static_cast<BoardFront*>(front)->drive(wheel, mode, value); },
      .sensors = [](void* front, std::uint8_t /*outputs*/,
                    board_sensors* sensors) { static_cast<BoardFront*>(front)->read_sensors(*sensors); },
      .write =
          [](void* front, const std::uint8_t* bytes, std::uint8_t size) {
            static_cast<BoardFront*>(front)->write({bytes, size});
          }};
  if (parameters_.takes_speeds) tune(config);
  booted_ns_ = now_ns();
  for (std::size_t i = 0; i < wheels_.size(); ++i) wheels_[i].start = counted(i);
  sensors_.reset = reason;
  board_begin(&board_, &config);
}

/// One set of gains serves all wheels: that of wheel 0. The proportional gain is the
/// damping of the brake, which is stable also for a lifted wheel.
void BoardFront::tune(board_config& config) const {
  const std::size_t joint = joint_of(0);
  const BoardWheelParameters& wheel = parameters_.wheels[joint];
  const double counts_per_rad = kSpeedSteps * wheel.counts_per_turn / (2 * std::numbers::pi);
  const double full_torque = kStall * wheel.torque_limit;
  const auto gain = [&](double pwm_s_per_rad) {
    return static_cast<std::int32_t>(std::lround(kGainSteps * kFullPwm * pwm_s_per_rad / counts_per_rad));
  };
  const double proportional = wheels_[joint].damping / full_torque;
  config.velocity_loop = 1;
  config.loop_period_us = static_cast<std::uint32_t>(std::max<std::int64_t>(kLoopNs, period_ns()) / 1000);
  config.kf = gain(1 / (kFree * wheel.velocity_limit));
  config.kp = gain(proportional);
  config.ki = gain(proportional * kMicro * config.loop_period_us / kIntegralTime);
  config.max_pwm = static_cast<std::int16_t>(kFullPwm);
}

std::size_t BoardFront::joint_of(std::size_t wheel) const {
  const auto found = std::ranges::find(parameters_.wheels, wheel, &BoardWheelParameters::wheel);
  return static_cast<std::size_t>(found - parameters_.wheels.begin());
}

std::uint32_t BoardFront::time_us() const {
  const double elapsed_us = 1.0e-3 * static_cast<double>(now_ns() - booted_ns_) * (1 + kMicro * kClockPpm);
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(elapsed_us));
}

std::int64_t BoardFront::counted(std::size_t joint) const {
  const BoardWheelParameters& wheel = parameters_.wheels[joint];
  const double turns = motion(joint).position / (2 * std::numbers::pi) * static_cast<double>(wheel.direction);
  return static_cast<std::int64_t>(std::floor(turns * wheel.counts_per_turn));
}

void BoardFront::counts(std::uint32_t* counts) const {
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const BoardWheelParameters& wheel = parameters_.wheels[i];
    const auto wrapped = static_cast<std::uint32_t>(static_cast<std::uint64_t>(counted(i) - wheels_[i].start) + zero_);
    counts[wheel.wheel] = wheel.counter_bits == 16 ? wrapped & 0xFFFFU : wrapped;
  }
}

void BoardFront::drive(std::size_t wheel, board_mode mode, std::int32_t value) {
  const std::size_t joint = joint_of(wheel);
  wheels_[joint].mode = mode;
  const double unit = mode == BOARD_PWM ? 1 / kFullPwm : kMicro;
  wheels_[joint].ordered = unit * value * static_cast<double>(parameters_.wheels[joint].direction);
}

double BoardFront::ordered_torque(std::size_t joint) const {
  const Wheel& wheel = wheels_[joint];
  if (wheel.mode != BOARD_PWM) return wheel.ordered;
  const BoardWheelParameters& parameters = parameters_.wheels[joint];
  return kStall * parameters.torque_limit *
         (wheel.ordered - motion(joint).velocity / (kFree * parameters.velocity_limit));
}

void BoardFront::read_sensors(board_sensors& sensors) const {
  sensors = sensors_;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const BoardWheelParameters& wheel = parameters_.wheels[i];
    sensors.effort[wheel.wheel] =
        static_cast<std::int32_t>(std::lround(wheels_[i].torque * static_cast<double>(wheel.direction) / kMicro));
  }
  if (fault_) sensors.fault[0] = kWheelFault;
  sensors.imu.time_us = time_us();
}

void BoardFront::write(std::span<const std::uint8_t> bytes) {
  if (!other_protocol_) {
    board_line().send(bytes);
    return;
  }
  board_decoder decoder{};
  std::array<std::uint8_t, BOARD_MAX_FRAME> frame;
  std::uint8_t size = 0;
  for (const std::uint8_t byte : bytes) size = board_decode(&decoder, byte);
  decoder.body[0] = BOARD_PROTOCOL + 1;
  board_line().send(std::span(frame).first(board_encode(decoder.body, size, frame.data())));
}

void BoardFront::step_board() {
  SerialChunk chunk;
  if (off_ || booting()) {
    while (board_line().receive(chunk)) {
    }
    for (Wheel& wheel : wheels_) {
      wheel.torque = wheel.ordered = 0;
      wheel.mode = BOARD_EFFORT;  // no supply, no torque
    }
    return;
  }
  if (boots_ns_ != 0) {
    boots_ns_ = 0;
    boot(next_reset_);
  }
  bool stepped = false;
  while (board_line().receive(chunk)) {
    board_step(&board_, chunk.bytes.data(), static_cast<std::uint8_t>(chunk.size));
    stepped = true;
  }
  if (!stepped) board_step(&board_, nullptr, 0);
}

double BoardFront::step_wheel(std::size_t joint, double /*seconds*/) {
  Wheel& wheel = wheels_[joint];
  if (wheel.mode != BOARD_BRAKE) wheel.brake.release();
  const double wanted = wheel.mode == BOARD_BRAKE
                            ? wheel.brake.step(wheel.torque, motion(joint).position, motion(joint).velocity)
                            : ordered_torque(joint);
  const double limit = parameters_.wheels[joint].torque_limit;
  wheel.torque = std::clamp(wanted, -limit, limit);
  return wheel.torque;
}

bool BoardFront::inject_board(std::string_view component, std::string_view kind) {
  const auto is = [kind](auto... words) { return ((kind == words) || ...); };
  if (component != "board" || !is("ok", "off", "reset", "brown_out", "fault", "e_stop", "other_protocol")) return false;
  const bool back = off_ && kind != "off";
  off_ = kind == "off";
  fault_ = kind == "fault";
  other_protocol_ = kind == "other_protocol";
  sensors_.inputs = kind == "e_stop" ? 0 : BOARD_E_STOP_RELEASED;
  if (back || is("reset", "brown_out")) boots_ns_ = now_ns() + kBootNs;
  next_reset_ = kind == "reset" ? BOARD_RESET_BUTTON : kind == "brown_out" ? BOARD_BROWN_OUT : BOARD_POWER_ON;
  return true;
}

std::unique_ptr<DeviceFront> make_board_front(const DriveFile& file, FrontSetup setup) {
  return std::make_unique<BoardFront>(parameters_of(dynamic_cast<const BoardBlocks&>(file)), setup.motors.brakes,
                                      file.request().period(), std::move(setup));
}

}  // namespace robot_control
