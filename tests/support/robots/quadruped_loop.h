#pragma once
/// A robot on legs in the closed loop, on the simulated machine, with the largest values that tests judge.

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "control/legged/leg_controller.h"
#include "log/replay/recorded.h"
#include "machine/legs/leg_model.h"
#include "robots/quadruped.h"
#include "signals/names.h"
#include "signals/rotation.h"
#include "simulation/closed_loop.h"

namespace robot_control {

struct QuadrupedLoop {
  explicit QuadrupedLoop(const LegModel& robot, std::uint64_t seed = 0, ErrorLevel errors = ErrorLevel::kIdeal)
      : QuadrupedLoop(robot, parameters(seed, errors)) {}
  QuadrupedLoop(const LegModel& robot, const Parameters& parameters)
      : QuadrupedLoop(std::make_shared<Quadruped>(parameters, robot), parameters) {}
  QuadrupedLoop(std::shared_ptr<const Robot> robot, const Parameters& parameters)
      : parameters_(parameters), loop_(std::make_unique<ClosedLoop>(parameters_, std::move(robot))) {
    loop_->record();
  }

  /// bench_legs_loop sets these two: Hz of the loop, and cycles that a command is late.
  static inline double given_rate = 1000;
  static inline std::uint64_t given_lateness = 0;

  static Parameters parameters(std::uint64_t seed, ErrorLevel errors) {
    Parameters result = default_parameters();
    result.robot = {};
    result.loop.rate = given_rate;
    result.plant.actuator_delay = given_lateness;
    result.leg_control.request_timeout = 0.5;
    result.plant.seed = seed;
    result.plant.sensor_errors = errors;
    result.plant.contact_sensors = true;
    return result;
  }

  /// Requests this every 20 ms.
  void run(double seconds, const Request& request) {
    for (std::uint64_t k = 0; k < cycles(seconds); ++k) {
      if (k % cycles(0.02) == 0) loop.request(request);
      step();
    }
  }
  void wait(double seconds) {
    for (std::uint64_t k = 0; k < cycles(seconds); ++k) step();
  }
  void step() {
    loop.step();
    if (record) recording.add(loop);
    if (after_step) after_step();
    const TruthFrame& now = truth();
    for (std::size_t i = 0; i < kLegsJoints; ++i) {
      effort = std::max(effort, std::abs(now.joints[i].effort) / robot().joints[i].effort_limit);
    }
    tilt = std::max(tilt, tilt_now());
    const Vector3& force = loop.row().driver->sensors.imu.linear_acceleration;
    shock = std::max(shock, std::hypot(force[0], force[1], force[2]) - 9.81);
    for (std::size_t i = 0; i < kLegs; ++i) slipped[i] += now.slip[i] * period();
  }
  struct Fold {
    int cycles = 0;      ///< until the gate brakes
    double rest_at = 0;  ///< s, when the body comes to rest
  };
  /// Stops the robot as the operator does, and runs for 3 s.
  Fold fold() {
    clear();
    loop.e_stop();
    Fold fold;
    for (int k = 1; k <= static_cast<int>(cycles(3)); ++k) {
      if (fold.cycles == 0 || gate().verdict != GateVerdict::kBrake) fold.cycles = k;
      step();
      if (speed() >= 0.01) fold.rest_at = k * period();
    }
    return fold;
  }
  void clear() { effort = tilt = shock = 0, slipped = {}; }
  double period() const { return parameters_.loop.period(); }
  std::uint64_t cycles(double seconds) const { return static_cast<std::uint64_t>(std::llround(seconds / period())); }

  const LegModel& robot() const { return leg_model_of(loop.robot().machine()); }
  const TruthFrame& truth() const { return loop.row().driver->truth; }
  const StateFrame& state() const { return loop.row().estimator->state; }
  const CommandFrame& command() const { return loop.row().controller->command; }
  const GateReport& gate() const { return loop.row().driver->gate; }
  const Permit& permit() const { return loop.row().monitor->permit; }
  std::string causes() const { return names_of(kStopCauseNames, permit().causes); }
  double tilt_now() const {
    const Quaternion& q = truth().pose_world.orientation;
    return 2 * std::asin(std::min(1.0, std::hypot(q[0], q[1])));
  }
  double speed() const {
    const Vector3& v = truth().twist_base.linear;
    return std::hypot(v[0], v[1], v[2]);
  }

  Parameters parameters_;
  std::unique_ptr<ClosedLoop> loop_;
  ClosedLoop& loop = *loop_;  // stays where it is when this moves
  Recording recording;
  bool record = false;
  std::function<void()> after_step;  // is called after each cycle
  // Largest values since `clear`.
  double effort = 0;                    // of the limits
  double tilt = 0;                      // rad
  double shock = 0;                     // m/s²
  std::array<double, kLegs> slipped{};  // m
};

inline Request stance(const Mode& mode) {
  return {.twist = {}, .posture = {}, .mode = mode};
}

}  // namespace robot_control
