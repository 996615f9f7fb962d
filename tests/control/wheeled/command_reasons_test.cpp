#include <gtest/gtest.h>

#include <cmath>

#include "control/wheeled/control_bench.h"
#include "signals/names.h"

namespace robot_control::tests {

/// Spoils one thing of a bench that drives at 0.5 m/s and 0.2 rad/s. It steps the bench no farther than to the command
/// with the reason.
using Break = std::function<void(ControlBench&)>;

const std::map<std::uint64_t, Break> kBreaks{
    {kReasonNoCommand, [](ControlBench& bench) { bench.controller.enter_run(bench.request); }},
    {kReasonTimedOut, [](ControlBench& bench) { bench.run(1.25); }},
    {kReasonRefused, [](ControlBench& bench) { bench.send(0.5, std::nan("")); }},
    {kReasonSpeedLimited, [](ControlBench& bench) { bench.send(1.5, 0); }},
    {kReasonAccelerationLimited,
     [](ControlBench& bench) {
       bench.send(1, 0.2);
       bench.run(0.15);  // s; 1 m/s² is reached after 0.1
     }},
    {kReasonJerkLimited, [](ControlBench& bench) { bench.send(1, 0.2); }},
    {kReasonCurvatureKept, [](ControlBench& bench) { bench.send(1, 0.4); }},
    {kReasonSaturated,
     [](ControlBench& bench) {
       bench.spoil = [](SensorFrame& sensors) { sensors.gate.reasons = kGateEffortClamped; };
     }},
    {kReasonNoPermit, [](ControlBench& bench) { bench.with_permit = false; }},
    {kReasonPermitBrake, [](ControlBench& bench) { bench.permit.action = PermitAction::kBrake; }},
    {kReasonPermitRamp,
     [](ControlBench& bench) {
       bench.permit.action = PermitAction::kRamp;
       bench.permit.ramp_until = bench.cycle + 100;
     }},
    {kReasonNoState, [](ControlBench& bench) { bench.with_state = false; }},
    {kReasonBadSensors,
     [](ControlBench& bench) {
       bench.spoil = [](SensorFrame& sensors) { sensors.joints[0].position = std::nan(""); };
     }},
    {kReasonHolding,
     [](ControlBench& bench) {
       bench.send(0, 0);
       bench.run(2);
     }},
    {kReasonPermitSlow, [](ControlBench& bench) { bench.permit.speed_limit = 0.1; }},
    {kReasonJerkYielded,
     [](ControlBench& bench) {  // a stop is requested while it passes zero on its way into reverse
       bench.send(-1, 0);
       while (bench.command.twist_limited.linear[0] > 0.02) bench.step();
       bench.send(0, 0);
       for (int k = 0; k < 1000 && (bench.command.reasons & kReasonJerkYielded) == 0; ++k) bench.step();
     }},
    {kReasonStale, [](ControlBench& bench) { ++bench.request.stale; }},
    {kReasonManySenders, [](ControlBench& bench) { bench.request.many_senders = 1; }},
    {kReasonRevoked, [](ControlBench& bench) { ++bench.request.revoked; }},
    {kReasonPartIgnored,
     [](ControlBench& bench) {
       bench.request.content.twist.linear[1] = 0.2;
       ++bench.request.count;
     }},
};

ControlBench driving() {
  ControlBench bench;
  bench.run(0.3);
  bench.send(0.5, 0.2);
  bench.run(1.0);
  bench.send(0.5, 0.2);
  bench.step();
  return bench;
}

TEST(CommandReasons, AreNoneOnAHealthyRobot) {
  EXPECT_EQ(driving().command.reasons, 0u);
}

TEST(CommandReasons, AreEachRaisedByWhatTheySay) {
  for (const BitName& row : kCommandReasonNames) {
    if (row.bit >= kReasonOutOfReach) continue;  // tests/robots/quadruped_test.cpp raises those of legs
    SCOPED_TRACE(row.name);
    const auto found = kBreaks.find(row.bit);
    ASSERT_NE(found, kBreaks.end()) << "no test raises it";
    ControlBench bench = driving();
    found->second(bench);
    if ((bench.command.reasons & row.bit) == 0) bench.step();
    EXPECT_NE(bench.command.reasons & row.bit, 0u);
  }
}

TEST(CommandReasons, NameAnIgnoredPartAndTheOthersAreExecuted) {
  ControlBench bench = driving();
  const double before = bench.plant.twist.linear;
  bench.request.content.twist.linear[1] = 0.2;
  ++bench.request.count;
  bench.run(1);
  EXPECT_NEAR(bench.plant.twist.linear, before, 1e-6);
  EXPECT_EQ(bench.command.ignored, kPartLinearY);
  EXPECT_EQ(bench.command.requests_partial, 1u);
  EXPECT_EQ(bench.command.requests_refused, 0u);
}

TEST(CommandReasons, RampWithTheEmergencyDecelerationForOneSenderTooMany) {
  DriveControllerParameters parameters = straight_ramps();
  parameters.max_linear_emergency_deceleration = 2;
  ControlBench bench(make_test_robot(), parameters);
  bench.run(0.3);
  bench.send(0.5, 0);
  bench.run(1.0);
  bench.request.many_senders = 1;
  bench.step();
  EXPECT_NEAR(bench.command.twist_limited.linear[0], 0.5 - 2e-3, 1e-12);
  bench.run(1);
  EXPECT_NE(bench.command.reasons & kReasonHolding, 0u);
  bench.request.many_senders = 0;
  bench.send(0.5, 0);
  bench.run(1);
  EXPECT_NEAR(bench.plant.twist.linear, 0.5, 1e-6) << "one is left";
}

}  // namespace robot_control::tests
