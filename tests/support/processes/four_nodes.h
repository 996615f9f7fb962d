#pragma once
/// The four nodes as four processes, without ROS: estimator, controller and monitor forked, the driver here,
/// and a telemetry beside it on request.

#include <sys/prctl.h>

#include <atomic>
#include <csignal>
#include <functional>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

#include "drivers/mujoco/mujoco_plant.h"
#include "loop/processes/controller_process.h"
#include "loop/processes/driver_process.h"
#include "loop/processes/estimator_process.h"
#include "loop/processes/monitor_process.h"
#include "loop/processes/telemetry_process.h"
#include "robots/differential_drive.h"
#include "rt/clock.h"
#include "rt/futex.h"
#include "support/bus/scoped_bus.h"
#include "support/processes/child_process.h"

namespace robot_control {

class FourNodes {
 public:
  /// The run ends by itself after `parameters.plant.cycles`. `record`: telemetry writes into
  /// parameters.telemetry.directory.
  FourNodes(const Parameters& parameters, const DriveTrain& robot, bool record)
      : FourNodes(parameters, std::make_shared<DifferentialDrive>(parameters, robot), record) {}

  /// A robot of any kind, composed with these parameters.
  FourNodes(const Parameters& parameters, std::shared_ptr<const Robot> robot, bool record)
      : parameters_(parameters),
        robot_(std::move(robot)),
        record_(record),
        estimator_([this] { return consume<EstimatorProcess>(); }),
        controller_([this] { return consume<ControllerProcess>(); }),
        monitor_([this] { return consume<MonitorProcess>(); }) {}

  using Operator = std::function<void(DriverProcess&)>;

  /// Runs and returns the real-time factor. It ends after `parameters.plant.cycles`, or when `operate` returns, which
  /// has a thread of its own and may call the services. Throws std::runtime_error if it does not end within
  /// `timeout_s`.
  double run(double timeout_s, const Operator& operate = {}) {
    std::unique_ptr<TelemetryProcess> telemetry;
    if (record_) telemetry = std::make_unique<TelemetryProcess>(parameters_, *robot_, bus_.name());
    DriverProcess driver(parameters_, *robot_, bus_.name());
    driver.open_driver(std::make_unique<MujocoPlant>(robot_->machine(), parameters_.plant, parameters_.loop.period()));
    const std::int64_t give_up_ns = monotonic_ns() + static_cast<std::int64_t>(timeout_s * 1e9);
    std::atomic<bool> operated{false};
    std::jthread operator_thread([&] {
      if (operate == nullptr) return;
      operate(driver);
      operated.store(true);
    });
    while (!driver.finished() && !operated.load()) {
      if (monotonic_ns() > give_up_ns) {
        driver.stop();  // ends what the operator waits for
        throw std::runtime_error("the four nodes did not end in time");
      }
      driver.poll();
      if (telemetry != nullptr) {
        telemetry->poll();
        telemetry->drain();
      }
      sleep_ns(kPollNs);
    }
    operator_thread.join();
    driver.stop();
    sleep_ns(10 * kPollNs);  // the others append their last rows after the driver has their frames
    if (telemetry != nullptr) telemetry->finish();
    return driver.real_time_factor();
  }

  ChildProcess& controller() noexcept { return controller_; }

 private:
  static constexpr std::int64_t kPollNs = 10'000'000;

  template <class Node>
  int consume() {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    Node node(parameters_, *robot_, bus_.name());
    for (;;) {
      node.poll();
      sleep_ns(kPollNs);
    }
  }

  ScopedBus bus_;
  Parameters parameters_;
  std::shared_ptr<const Robot> robot_;
  bool record_;
  ChildProcess estimator_;
  ChildProcess controller_;
  ChildProcess monitor_;
};

}  // namespace robot_control
