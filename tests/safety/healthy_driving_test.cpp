// A healthy robot raises nothing, whatever its encoders and its rate, and its states follow its drives.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "safety/monitor_fixture.h"

namespace robot_control::tests {

struct Machine {
  double rate;    ///< Hz
  double counts;  ///< of an encoder; 0: exact
};

std::ostream& operator<<(std::ostream& out, const Machine& machine) {
  return out << machine.rate << " Hz, " << machine.counts << " counts";
}

/// Drives of 6 s: up at 1 m/s² to 0.9 m/s, a curve, through zero to −0.5 m/s, and to rest. The wheels follow their
/// targets 20 ms later, as a wheel loop of 8 Hz does.
struct HealthyDriving : testing::TestWithParam<Machine> {
  static constexpr double kDrive = 6;  // s
  static constexpr double kLag = 0.02;

  HealthyDriving() {
    const double period = 1 / GetParam().rate;
    SafetyParameters parameters;
    monitor_.emplace(derived_limits(parameters, robot_, 15), robot_, period);
  }

  /// m/s requested at t.
  static double request(double t) {
    t = std::fmod(t, kDrive);
    return t < 0.5 ? 0 : t < 2.5 ? 0.9 : t < 4 ? -0.5 : 0;
  }
  static double turn(double t) {
    t = std::fmod(t, kDrive);
    return t > 1 && t < 2.5 ? 0.8 : 0;
  }

  void step() {
    const double period = 1 / GetParam().rate;
    const double t = static_cast<double>(cycle_) * period;
    const auto ramp = [&](double& value, double target, double rate) {
      value += std::clamp(target - value, -rate * period, rate * period);
    };
    ramp(linear_, request(t), 1);
    ramp(angular_, turn(t), 4);
    const std::array<double, 2> target{(linear_ - 0.25 * angular_) / 0.1, (linear_ + 0.25 * angular_) / 0.1};
    const double gain = 1 - std::exp(-period / kLag);
    for (std::size_t i = 0; i < 2; ++i) {
      speed_[i] += gain * (target[i] - speed_[i]);
      if (target[i] == 0 && std::abs(speed_[i]) < 1e-3) speed_[i] = 0;
      angle_[i] += speed_[i] * period;
    }
    fill(target);
    if (looked_at_) {
      monitor_->step(input_, permit_);
      older_ = newest_;
      newest_ = cycle_;
    }
    ++cycle_;
  }

  void fill(const std::array<double, 2>& target) {
    sensors_.head.cycle = cycle_;
    sensors_.driver_state = DriverState::kRunning;
    set_joints_valid(sensors_, kValidMotion);
    sensors_.valid = kValidGyro | kValidAccelerometer;
    sensors_.joint_count = command_.joint_count = 2;
    const double quantum = GetParam().counts > 0 ? 2 * std::numbers::pi / GetParam().counts : 0;
    const bool rests = target[0] == 0 && target[1] == 0 && speed_[0] == 0 && speed_[1] == 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const double angle = angle_[i] + 0.1;  // at rest away from the edge of a count, and of another one each
      sensors_.joints[i].position = quantum > 0 ? quantum * std::floor(angle / quantum) : angle;
      sensors_.joints[i].velocity = speed_[i];
      command_.joints[i] = {.mode = rests ? JointMode::kBrake : JointMode::kEffort, .velocity = target[i]};
    }
    const double flicker = cycle_ % 2 == 0 ? 1e-4 : -1e-4;
    sensors_.imu.angular_velocity = {flicker, 0, (speed_[1] - speed_[0]) * 0.1 / 0.5};
    sensors_.imu.linear_acceleration = {0, flicker, 9.81};
    sensors_.gate = {.cycle = cycle_ == 0 ? 0 : cycle_ - 1,
                     .verdict = rests ? GateVerdict::kBrake : GateVerdict::kPassed,
                     .reasons = rests ? std::uint64_t{kGateControllerBrake} : 0,
                     .permit_cycle = newest_ + 1 < cycle_ ? newest_ : older_};
    if (cycle_ < 3) sensors_.gate = {};
    command_.head.cycle = command_.state_cycle = cycle_ == 0 ? 0 : cycle_ - 1;
    command_.requested.twist.linear[0] = request(static_cast<double>(cycle_) / GetParam().rate);
    command_.zero_requests = 1;  // the run begins with a zero request
    input_ = {.sensors = &sensors_, .command = &command_, .state = &state_, .operator_input = {}};
  }

  const DriveTrain robot_ = two_wheels();
  std::optional<SafetyMonitor> monitor_;
  SensorFrame sensors_;
  CommandFrame command_;
  StateFrame state_;
  MonitorInput input_;
  Permit permit_;
  std::uint64_t cycle_ = 0;
  bool looked_at_ = true;     ///< by the monitor
  std::uint64_t newest_ = 0;  ///< permit given
  std::uint64_t older_ = 0;   ///< the one before
  double linear_ = 0;
  double angular_ = 0;
  std::array<double, 2> speed_{};
  std::array<double, 2> angle_{};
};

TEST_P(HealthyDriving, RaisesNothingAndIsReadyOncePerDrive) {
  constexpr int kDrives = 5;
  int ready = 0;
  SupervisorState last = SupervisorState::kInit;
  while (static_cast<double>(cycle_) < kDrives * kDrive * GetParam().rate) {
    step();
    ASSERT_EQ(permit_.causes | permit_.warnings, 0u)
        << "cycle " << cycle_ << ": cause " << permit_.evidence[0].cause << ", " << permit_.evidence[0].value
        << " beyond " << permit_.evidence[0].limit;
    if (permit_.state == SupervisorState::kReady && last != SupervisorState::kReady) ++ready;
    last = permit_.state;
  }
  EXPECT_EQ(ready, 1 + kDrives) << "once at the start, then after each drive";
  EXPECT_EQ(permit_.state, SupervisorState::kReady);
}

TEST_P(HealthyDriving, RaisesNothingWhenTheMonitorSkipsTwoOfSevenCycles) {
  while (static_cast<double>(cycle_) < 2 * kDrive * GetParam().rate) {
    looked_at_ = cycle_ % 7 < 5;
    step();
    ASSERT_EQ(permit_.causes | permit_.warnings, 0u)
        << "cycle " << cycle_ << ": cause " << permit_.evidence[0].cause << ", " << permit_.evidence[0].value
        << " beyond " << permit_.evidence[0].limit;
  }
}

INSTANTIATE_TEST_SUITE_P(Machines, HealthyDriving,
                         testing::Values(Machine{100, 4096}, Machine{100, 64}, Machine{1000, 4096}, Machine{1000, 64},
                                         Machine{2000, 4096}, Machine{2000, 64}, Machine{1000, 0}));

}  // namespace robot_control::tests
