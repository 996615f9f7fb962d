/// Runs one node of the loop without ROS, for benches and tests:
///
///   rc_participant NODE --bus NAME --params YAML [--set path=value]… [--seconds S]
///
/// NODE: mujoco_plant, free_wheels (free_wheels.h), state_estimator, safety_monitor, telemetry, or the controller of
/// the robot's kind. It ends on SIGTERM or SIGINT, after S seconds, or, as the plant, after mujoco_plant.cycles. At
/// each SIGUSR1 the controller takes another speed limit over, on wheels. Exit code 1: refused, reason on stderr.

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/mujoco/mujoco_plant.h"
#include "loop/processes/controller_process.h"
#include "loop/processes/driver_process.h"
#include "loop/processes/estimator_process.h"
#include "loop/processes/monitor_process.h"
#include "loop/processes/telemetry_process.h"
#include "machine/wheeled/drive_train.h"
#include "robots/robot_kind.h"
#include "rt/clock.h"
#include "rt/crash_report.h"
#include "rt/futex.h"
#include "rt/realtime_thread.h"
#include "signals/robot_kinds.h"
#include "support/robots/free_wheels.h"

namespace robot_control {
namespace {

constexpr std::int64_t kLookNs = 10'000'000;
constexpr std::int64_t kDrainNs = 2'000'000;  // as telemetry_node.cpp

std::atomic<bool> interrupted{false};
std::atomic<int> tunings{0};  // that are due

struct Arguments {
  std::string node;
  std::string bus;
  std::string params;
  std::vector<Overlay> overlays;
  double seconds = 1.0e9;
};

Arguments parse(const std::vector<std::string>& words) {
  Arguments arguments;
  const auto bad = [](const std::string& what) { throw std::invalid_argument(what + "; see the head of the source"); };
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (!word.starts_with("--")) {
      arguments.node = word;
      continue;
    }
    if (i + 1 == words.size()) bad(word + " wants a value");
    const std::string& value = words[++i];
    if (word == "--bus") {
      arguments.bus = value;
    } else if (word == "--params") {
      arguments.params = value;
    } else if (word == "--seconds") {
      arguments.seconds = std::stod(value);
    } else if (const std::size_t equals = value.find('='); word == "--set" && equals != std::string::npos) {
      arguments.overlays.push_back({value.substr(0, equals), value.substr(equals + 1), "--set"});
    } else {
      bad("cannot read " + word + " " + value);
    }
  }
  if (arguments.node.empty() || arguments.bus.empty() || arguments.params.empty()) bad("NODE, --bus, --params wanted");
  return arguments;
}

/// Calls `look` until it returns that the end has come.
void run(double seconds, const std::function<bool()>& look, std::int64_t pause_ns = kLookNs) {
  const std::int64_t end_ns = monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
  while (!interrupted.load() && monotonic_ns() < end_ns && look()) sleep_ns(pause_ns);
}

void run_process(
    Process& process, double seconds, const std::function<void()>& receive = [] {}) {
  run(seconds, [&] {
    receive();
    process.poll();
    return !process.finished();
  });
  for (const std::string& text : process.realtime_messages()) std::fprintf(stderr, "%s\n", text.c_str());
  process.stop();
}

void run_telemetry(TelemetryProcess& telemetry, double seconds) {
  std::int64_t next_poll_ns = 0;
  const auto look = [&] {
    if (const std::int64_t now_ns = monotonic_ns(); now_ns >= next_poll_ns) {
      telemetry.poll();
      next_poll_ns = now_ns + kLookNs;
    }
    telemetry.drain();
    return true;
  };
  run(seconds, look, kDrainNs);
  telemetry.finish();
}

void participate(const Arguments& arguments) {
  const Parameters parameters = read_parameters(arguments.params, arguments.overlays);
  const std::unique_ptr<const Robot> composed = make_robot(parameters);
  const Robot& robot = *composed;
  const LoopParameters& loop = parameters.loop;
  install_crash_report(arguments.node, "the motors brake without it");
  prepare_process(loop.clock == ClockMode::kWall ? loop.realtime : RealtimePolicy::kOff);
  if (arguments.node == "mujoco_plant") {
    DriverProcess driver(parameters, robot, arguments.bus);
    driver.open_driver(std::make_unique<MujocoPlant>(robot.machine(), parameters.plant, loop.period()));
    run_process(driver, arguments.seconds);
  } else if (arguments.node == "free_wheels") {
    DriverProcess driver(parameters, robot, arguments.bus);
    driver.open_driver(std::make_unique<FreeWheels>(drive_train_of(robot.machine()), robot.brakes(), loop.period()));
    run_process(driver, arguments.seconds);
  } else if (arguments.node == "state_estimator") {
    EstimatorProcess estimator(parameters, robot, arguments.bus);
    run_process(estimator, arguments.seconds);
  } else if (arguments.node == names_of_kind(robot.kind()).controller) {
    ControllerProcess controller(parameters, robot, arguments.bus);
    run_process(controller, arguments.seconds, [&controller, taken = 0]() mutable {
      constexpr std::array kLimits = {"0.5", "0.7", "1.0"};  // m/s
      for (; controller.retuner() != nullptr && taken < tunings.load(); ++taken) {
        controller.retuner()->set(std::string("{max_linear_speed: ") + kLimits[taken % kLimits.size()] + "}");
      }
    });
  } else if (arguments.node == "safety_monitor") {
    MonitorProcess monitor(parameters, robot, arguments.bus);
    run_process(monitor, arguments.seconds);
  } else if (arguments.node == "telemetry") {
    TelemetryProcess telemetry(parameters, robot, arguments.bus);
    if (loop.clock == ClockMode::kWall && loop.realtime != RealtimePolicy::kOff) precede_ordinary_threads();
    run_telemetry(telemetry, arguments.seconds);
  } else {
    throw std::invalid_argument("no node is called " + arguments.node);
  }
}

}  // namespace
}  // namespace robot_control

int main(int argc, char** argv) {
  std::signal(SIGINT, [](int) { robot_control::interrupted.store(true); });
  std::signal(SIGTERM, [](int) { robot_control::interrupted.store(true); });
  std::signal(SIGUSR1, [](int) { robot_control::tunings.fetch_add(1); });
  try {
    robot_control::participate(robot_control::parse({argv, argv + argc}));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rc_participant: refused:\n%s\n", error.what());
    return 1;
  }
}
