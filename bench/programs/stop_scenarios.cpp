#include "bench/programs/stop_scenarios.h"

namespace robot_control::bench {
namespace {

constexpr double kFullSpeed = 1.0;  // m/s, max_linear_speed
constexpr double kSpin = 2.0;       // rad/s, max_angular_speed

Overlay set(const std::string& key, const std::string& value) {
  return {.path = key, .text = value, .origin = "bench_stops"};
}

std::function<void(ClosedLoop&)> inject(const std::string& component, const std::string& kind) {
  return [component, kind](ClosedLoop& loop) { loop.inject_fault(component, kind); };
}

/// At full speed ahead.
StopScenario ahead(StopCause cause, const std::string& component, const std::string& kind) {
  return {cause, component + " " + kind, kFullSpeed, 0, {}, inject(component, kind)};
}

StopScenario in_reverse(StopScenario scenario) {
  scenario.fact += ", in reverse";
  scenario.linear = -scenario.linear;
  return scenario;
}

StopScenario turning(StopScenario scenario) {
  scenario.fact += ", turning";
  scenario.linear = 0;
  scenario.angular = kSpin;
  return scenario;
}

/// `force` N along an axis of the robot, from kFactTime on.
StopScenario pushed(StopCause cause, const std::string& fact, const std::string& axis, double force, double seconds) {
  return {cause,
          fact,
          kFullSpeed,
          0,
          {set("mujoco_plant.push_" + axis, std::to_string(force)),
           set("mujoco_plant.push_start", std::to_string(kFactTime)),
           set("mujoco_plant.push_duration", std::to_string(seconds))},
          [](ClosedLoop&) {}};
}

StopScenario with(StopScenario scenario, std::vector<Overlay> parameters) {
  scenario.parameters.insert(scenario.parameters.end(), parameters.begin(), parameters.end());
  return scenario;
}

}  // namespace

std::vector<StopScenario> stop_scenarios() {
  const auto e_stop = [](ClosedLoop& loop) { loop.e_stop(); };
  const StopScenario service{kCauseEmergencyStopService, "e_stop_trigger", kFullSpeed, 0, {}, e_stop};
  const StopScenario heartbeat{kCauseHeartbeatLost,
                               "no heartbeat since the start",
                               kFullSpeed,
                               0,
                               {set("safety_monitor.heartbeat_timeout", std::to_string(kFactTime))},
                               [](ClosedLoop&) {}};
  const std::vector<Overlay> battery{set("mujoco_plant.battery_voltage", "24"),
                                     set("safety_monitor.battery_low.limit", "22"),
                                     set("safety_monitor.battery_empty.limit", "20")};
  const StopScenario wall{kCauseImpact, "a wall", kFullSpeed, 0, {set("mujoco_plant.scene", "walls.xml")}, {}};
  return {
      service,
      in_reverse(service),
      turning(service),
      ahead(kCauseEmergencyStopInput, "e_stop_button", "stuck"),
      ahead(kCauseControllerLost, "controller", "off"),
      in_reverse(ahead(kCauseControllerLost, "controller", "off")),
      ahead(kCauseEstimatorLost, "estimator", "off"),
      ahead(kCauseGateRefuses, "monitor", "off"),
      heartbeat,
      ahead(kCauseNotFinite, "right_encoder", "off"),
      ahead(kCauseEncodersLost, "left_encoder", "off"),
      ahead(kCauseImuLost, "gyro", "off"),
      ahead(kCauseImuStuck, "gyro", "stuck"),
      ahead(kCauseImuJump, "gyro", "garbage"),
      ahead(kCauseCommandStale, "controller", "delayed"),
      ahead(kCauseCommandStale, "controller", "stuck"),
      with(ahead(kCauseWheelSpeed, "controller", "wrong"),
           {set("safety_monitor.runaway.reaction", "off"), set("safety_monitor.wrong_direction.reaction", "off")}),
      ahead(kCauseWheelAcceleration, "left_encoder", "garbage"),
      ahead(kCauseStall, "left_encoder", "stuck"),
      ahead(kCauseStall, "right_motor", "stuck"),
      in_reverse(ahead(kCauseStall, "right_motor", "stuck")),
      ahead(kCauseRunaway, "controller", "wrong"),
      ahead(kCauseWrongDirection, "right_motor", "wrong"),
      ahead(kCauseWrongDirection, "left_encoder", "wrong"),
      turning(ahead(kCauseYawRate, "gyro", "wrong")),
      pushed(kCauseTilt, "lifted at one side", "z", 110, 1.0),
      pushed(kCauseTipOver, "pushed over sideways", "y", 300, 0.3),
      pushed(kCauseFreeFall, "thrown up", "z", 500, 0.1),
      with(pushed(kCauseLift, "lifted by nine tenths", "z", 106, 1.0), {set("mujoco_plant.contact_sensors", "true")}),
      wall,
      pushed(kCauseImpact, "a blow from ahead", "x", -3000, 0.005),
      ahead(kCauseGateRefuses, "controller", "garbage"),
      with(ahead(kCauseBatteryEmpty, "battery", "wrong"), battery),
  };
}

}  // namespace robot_control::bench
