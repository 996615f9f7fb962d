#pragma once
/// A motor board on a serial line as a Driver, after docs/board_protocol.md. The board runs the code of `firmware/`.
///
/// The driver sends one order in each cycle and the board answers it with one report. The counts of a report are those
/// of the instant at which the order came. Offset and drift of the board's clock are estimated (BoardClock). A sample
/// therefore has its own time, however late it arrived, and its velocity brings it to the time of `read`.
///
/// The board is given torques: every mode, the brake included, is computed here (drivers/joint_law.h). A board that
/// takes speeds is given the speed of kDriveVelocity, without its effort, and brakes with the speed zero, which it
/// keeps at rest. `read` reports
/// kStarting until the board answers without BOARD_WATCHDOG and BOARD_REFUSED. Its faults stay until the operator's
/// reset; meanwhile the driver orders the brake of the board.
///
///   silence         no new report for max_silence cycles
///   own brake       the board reports BOARD_WATCHDOG: it received no order in time, and its clock did not jump
///   refusal         the board reports BOARD_REFUSED, or speaks another version of the protocol
///   restart         the clock of the board jumped by more than kClockJumpNs against the host's
///   position jump   counts that the joint cannot reach within its velocity limit
///   fault word      of a wheel; the user's code gives the numbers
///
/// A report counts once, and only if it answers an order of the last kOrders cycles within kMaxTripNs.

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drivers/board/board_parameters.h"
#include "drivers/drive/serial_driver.h"
#include "drivers/drive_speed.h"
#include "drivers/joint_law.h"
#include "firmware/board_frame.h"
#include "firmware/board_messages.h"

namespace robot_control {

/// The time of a board's samples on the clock of the host.
///
/// An order leaves the host at h₀ and reaches the board at b₁; its report leaves at b₂ and reaches the host at h₃. With
/// the present estimate host = b (1 + drift) + offset, each exchange gives two delays with an unknown common error:
///
///   down = host(b₁) − h₀        up = h₃ − host(b₂)
///
/// Delays of a line vary, but each way is now and then nearly free of them. The least `down` and the least `up` of a
/// window are therefore the constant delays, which count as equal. Half of their difference is the error of the
/// estimate. It corrects the offset, and its rate the drift. Until the first window ends, the exchange with the
/// shortest round trip gives the offset.
class BoardClock {
 public:
  static constexpr std::int64_t kWindowNs = 1'000'000'000;
  static constexpr int kMinExchanges = 20;     ///< of a window; a slow loop has longer windows
  static constexpr double kDriftGain = 0.3;    ///< share of the error's rate
  static constexpr double kMaxDrift = 500e-6;  ///< of a crystal or a ceramic resonator that is trimmed

  void restart() noexcept { *this = BoardClock(); }

  /// `h0_ns`, `h3_ns` on the host's clock, `b1_us`, `b2_us` on that of the board, without its wraps.
  void add(std::int64_t h0_ns, std::int64_t b1_us, std::int64_t b2_us, std::int64_t h3_ns) noexcept {
    if (exchanges_ == 0 && windows_ == 0) {
      zero_us_ = b1_us;
      zero_ns_ = begin_ns_ = h0_ns;
      least_trip_ns_ = std::numeric_limits<std::int64_t>::max();
    }
    const std::int64_t trip_ns = (h3_ns - h0_ns) - 1000 * (b2_us - b1_us);
    if (windows_ == 0 && trip_ns < least_trip_ns_) {
      // The delays of this window were computed with another offset.
      const std::int64_t change_ns = (h0_ns - host_ns(b1_us) + h3_ns - host_ns(b2_us)) / 2;
      zero_ns_ += change_ns;
      down_ns_ += exchanges_ == 0 ? 0 : change_ns;
      up_ns_ -= exchanges_ == 0 ? 0 : change_ns;
      least_trip_ns_ = trip_ns;
    }
    down_ns_ = std::min(down_ns_, host_ns(b1_us) - h0_ns);
    up_ns_ = std::min(up_ns_, h3_ns - host_ns(b2_us));
    ++exchanges_;
    if (h0_ns - begin_ns_ >= kWindowNs && exchanges_ >= kMinExchanges) end_window(h0_ns, b1_us);
  }

  /// Returns the time on the host's clock.
  std::int64_t host_ns(std::int64_t board_us) const noexcept {
    const auto elapsed = static_cast<double>(1000 * (board_us - zero_us_));
    return zero_ns_ + 1000 * (board_us - zero_us_) + static_cast<std::int64_t>(drift_ * elapsed);
  }

  /// Returns by how much the host's clock runs faster than that of the board.
  double drift() const noexcept { return drift_; }

 private:
  static constexpr std::int64_t kNone = 1'000'000'000'000;

  void end_window(std::int64_t now_ns, std::int64_t now_us) noexcept {
    const std::int64_t error_ns = (up_ns_ - down_ns_) / 2;
    const std::int64_t now_host_ns = host_ns(now_us);
    // The first window has no drift yet, so its least delays lie at its ends: only its rate over the next one counts.
    const double rate = static_cast<double>(error_ns) / static_cast<double>(now_ns - begin_ns_);
    if (windows_ > 0) drift_ = std::clamp(drift_ + kDriftGain * rate, -kMaxDrift, kMaxDrift);
    zero_us_ = now_us;  // the drift turns about the newest instant
    zero_ns_ = now_host_ns + error_ns;
    begin_ns_ = now_ns;
    down_ns_ = up_ns_ = kNone;
    exchanges_ = 0;
    ++windows_;
  }

  std::int64_t zero_us_ = 0;  // on the board's clock
  std::int64_t zero_ns_ = 0;  // the same instant on the host's
  double drift_ = 0;
  std::int64_t begin_ns_ = 0;  // of the window
  std::int64_t down_ns_ = kNone;
  std::int64_t up_ns_ = kNone;
  std::int64_t least_trip_ns_ = 0;
  int exchanges_ = 0;  // in the window
  std::uint64_t windows_ = 0;
};

struct BoardWheel : CountedWheel {
  double effort = 0;       ///< N·m
  std::uint8_t fault = 0;  ///< its fault word
};

class BoardDriver final : public SerialDriver<BoardWheel> {
 public:
  static constexpr std::size_t kOrders = 256;                 ///< the answer to an older order is refused
  static constexpr std::int64_t kMaxTripNs = 50'000'000;      ///< after which the watchdog of a board has braked
  static constexpr std::int64_t kClockJumpNs = 200'000'000;   ///< two boots lie further apart
  static constexpr std::int64_t kVelocitySpanNs = 8'000'000;  ///< over which a velocity is measured, at 125 Hz and more
  static constexpr double kSpeedMargin = 1.5;                 ///< of the velocity limit, above which a position jumped
  static constexpr double kMaxLineLoad = 0.9;

  /// `brakes`: one per wheel of the board. The wheels move the first joints of a robot that has `joint_count`. `clock`
  /// states the present time in ns. Throws DriverError if the line cannot carry the messages at this period.
  BoardDriver(const BoardParameters& parameters, std::span<const Brake> brakes, std::size_t joint_count, double period,
              std::unique_ptr<SerialLine> line, std::function<std::int64_t()> clock);

  void write(std::span<const JointCommand> commands) noexcept override;
  /// The next `write` brakes. Until then the board brakes by itself.
  void stop() noexcept override;

  bool accepts(JointMode mode) const noexcept override { return accepted(mode, parameters_.takes_speeds); }
  /// The board may measure efforts and have an IMU, which is known after its first report.
  bool measures(MachineInput input) const noexcept override { return input != MachineInput::kContacts; }
  std::string description() const override;
  std::string warning() const override;

  const BoardClock& board_clock() const noexcept { return board_clock_; }

 private:
  void begin() noexcept override;
  bool receive() noexcept override;
  void add_measurements(SensorFrame& sensors) noexcept override;
  bool is_fault_at_start(DriveCause cause) const noexcept override { return cause == DriveCause::kPositionJump; }
  void forget_samples() noexcept;
  void accept(const board_report& report, std::int64_t arrived_ns) noexcept;
  void accept_counts(const board_report& report, std::int64_t elapsed_us) noexcept;
  void accept_imu(const board_report& report) noexcept;
  board_wheel_order order_of(std::size_t i, const JointCommand& command) noexcept;
  void send_order(board_order& order) noexcept;

  BoardParameters parameters_;
  double load_;  // of the line; 0: USB
  std::vector<JointLaw> laws_;
  board_decoder decoder_{};
  BoardClock board_clock_;
  std::array<std::int64_t, kOrders> sent_ns_{};  // of each order, by its cycle
  std::uint16_t cycle_ = 0;                      // of the last order
  std::uint64_t orders_ = 0;
  bool has_report_ = false;
  std::uint16_t answered_ = 0;    // cycle of the newest report
  std::uint32_t board_us_ = 0;    // its time, as sent
  std::int64_t total_us_ = 0;     // the same without wraps
  std::int64_t answered_ns_ = 0;  // when its order was sent
  std::uint64_t silent_for_ = 0;  // cycles
  board_sensors sensors_{};
  ImuSample imu_;
  std::int64_t imu_ns_ = 0;
};

}  // namespace robot_control
