#pragma once
/// A UnitreeLeggedFront is a simulated Go1 at its low level, before the motors of a simulated robot. It answers each
/// LowCmd with a LowState kAnswerNs later. A motor gives torque = tau + kp (q − q_motor) + kd (dq − q̇_motor), within
/// the torque_limit of the drive file. After kSilenceNs without a command it damps: an assumption, because what the
/// robot does is not documented.
///
/// `inject` takes `robot`, `motor` or `line` as the component; the line has faults in virtual time alone.
///
///   robot  ok | off | reset (silent for kBootNs; the tick starts again) | frozen (its last state again and again)
///          | encrypted (wrong check sums) | other_robot (another serial number) | low_battery | e_stop (L2 and B)
///   motor  ok | hot | not_finite; of the first joint
///   line   kDatagramFaultWords, kAnswerFaultWords

#include <vector>

#include "drivers/drive/device_front.h"
#include "drivers/unitree_legged/unitree_legged_parameters.h"
#include "drivers/unitree_legged/virtual_datagrams.h"

namespace robot_control {

class UnitreeLeggedFront final : public DeviceFront {
 public:
  static constexpr std::int64_t kStepNs = 250'000;    ///< between two steps of the motors
  static constexpr std::int64_t kAnswerNs = 250'000;  ///< from a command to its answer
  static constexpr std::int64_t kSilenceNs = 20'000'000;
  static constexpr std::int64_t kBootNs = 300'000'000;
  static constexpr double kSilentDamping = 2;  ///< N·m·s/rad

  /// `true_line`: null for a line in virtual time, with this seed.
  UnitreeLeggedFront(UnitreeLeggedParameters parameters, double period, std::uint64_t seed,
                     std::unique_ptr<DatagramLine> true_line);

  std::size_t size() const override { return torques_.size(); }
  std::int64_t now_ns() const override { return now_ns_; }
  LineEnd driver_end() override { return virtual_line_->driver_end(); }
  bool is_absolute() const override { return true; }
  bool reports_imu() const override { return true; }
  void sense(const ImuSample& imu) override;
  void run(std::span<const JointSample> joints) override;
  double torque(std::size_t joint) const override { return torques_.at(joint); }
  std::string inject(std::string_view component, std::string_view kind) override;

  /// Returns the last command that came.
  const unitree::LowCmd& command() const { return command_; }
  /// Returns the next state; a test may set what `run` and `sense` do not.
  unitree::LowState& state() { return state_; }
  /// Returns the line in virtual time.
  VirtualDatagrams& line() { return *virtual_line_; }

 private:
  enum class Fault { kNone, kOff, kFrozen, kEncrypted };

  DatagramLine& robot_line() { return virtual_line_ ? virtual_line_->device_end() : *true_line_; }
  void take_commands();
  void answer();
  double motor_torque(std::size_t joint) const;
  bool inject_robot(std::string_view kind);
  bool inject_motor(std::string_view kind);

  UnitreeLeggedParameters parameters_;
  std::int64_t period_ns_;
  std::unique_ptr<DatagramLine> true_line_;
  std::unique_ptr<VirtualDatagrams> virtual_line_;  // null: the true one
  unitree::LowCmd command_;
  unitree::LowState state_;
  std::vector<double> torques_;  // N·m, of the joints, means of the period
  std::int64_t now_ns_ = 0;
  std::int64_t command_ns_ = -kSilenceNs;  // when the last command came
  std::int64_t answer_ns_ = -1;            // when the next answer is due; -1: none
  std::int64_t boots_ns_ = 0;
  Fault fault_ = Fault::kNone;
  bool not_finite_ = false;
};

}  // namespace robot_control
