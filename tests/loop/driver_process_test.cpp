/// Tests which thread may call the driver's process and the services of its simulated machine.

#include "loop/processes/driver_process.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "cycle_fixture.h"
#include "robots/differential_drive.h"
#include "rt/futex.h"
#include "support/bus/scoped_bus.h"

namespace robot_control::tests {

constexpr std::int64_t kMoment = 1'000'000;  // ns

/// A machine that resets slowly, and notes in a plain number that it is in use.
class SlowMachine final : public Simulator {
 public:
  /// `again` becomes true once the machine is being reset.
  explicit SlowMachine(std::atomic<bool>& again) : again_(again) {}

  void start() override {
    if (touched > 0) {
      again_.store(true);
      sleep_ns(250 * kMoment);  // more than the 100 ms after which a parked loop looks for its end
    }
    ++touched;
  }
  void read(SensorFrame& sensors) noexcept override {
    sensors.driver_state = DriverState::kRunning;
    sensors.joint_count = 2;
    ++touched;
  }
  void write(std::span<const JointCommand> /*commands*/) noexcept override {}
  void stop() noexcept override {}
  bool accepts(JointMode) const noexcept override { return true; }
  void truth(TruthFrame&) noexcept override {}
  void inject(const InjectedFaults&) noexcept override {}

  int touched = 0;  // not atomic: a race is the thread sanitizer's to find

 private:
  std::atomic<bool>& again_;
};

struct DriverProcessTest : testing::Test {
  DriverProcessTest() { parameters_.loop.realtime = RealtimePolicy::kOff; }

  DriverProcess& opened() {
    process_ = std::make_unique<DriverProcess>(parameters_, DifferentialDrive(parameters_, two_wheels()), bus_.name());
    process_->open_driver(std::make_unique<SlowMachine>(reset_under_way_));
    return *process_;
  }
  /// The loop ticks.
  DriverProcess& running() {
    DriverProcess& process = opened();
    process.poll();
    SensorFrame sensors;
    while (process.sensors().newest(sensors) != Lookup::kFrame) sleep_ns(kMoment);
    return process;
  }

  ScopedBus bus_;
  Parameters parameters_;
  std::atomic<bool> reset_under_way_{false};
  std::unique_ptr<DriverProcess> process_;
};

TEST_F(DriverProcessTest, ItsServicesNameTheNodesThatTheLoopWaitsFor) {
  parameters_.loop.wait_for_nodes = true;
  DriverProcess& process = opened();
  EXPECT_EQ(process.services()->set_pause(false).message, "running") << "no cycle has looked yet";
  process.poll();
  EXPECT_EQ(process.services()->set_pause(false).message,
            "running; waiting for state_estimator, diff_drive_controller, safety_monitor");
}

/// Channels appear and disappear while an operator makes requests.
TEST_F(DriverProcessTest, ItsServicesMayBeCalledWhileItLooksForTheOthers) {
  parameters_.loop.wait_for_nodes = true;
  DriverProcess& process = opened();
  std::atomic<bool> done{false};
  std::thread asking([&] {
    while (!done.load()) process.services()->set_pause(false);
  });
  for (int round = 0; round < 50; ++round) {
    const OwnedChannel<LatestFrames<StateFrame>> state(bus_.name(), ChannelNames::kState);
    attach_to_run(state.memory()->head, attached_run(process.sensors().memory()->head));
    process.poll();
    std::filesystem::remove("/dev/shm" + bus_object_name(bus_.name(), ChannelNames::kState));
  }
  done.store(true);
  asking.join();
}

TEST_F(DriverProcessTest, AnEndDuringAResetLeavesTheMachineToTheReset) {
  DriverProcess& process = running();
  ServiceAnswer answer;
  std::thread resetting([&] { answer = process.services()->reset(); });
  while (!reset_under_way_.load()) sleep_ns(kMoment);
  process.stop();
  resetting.join();
  EXPECT_TRUE(answer.success) << answer.message;
}

TEST_F(DriverProcessTest, AResetAfterTheEndSaysThatItHasEnded) {
  parameters_.plant.cycles = 5;
  DriverProcess& process = running();
  while (!process.finished()) sleep_ns(kMoment);
  const ServiceAnswer answer = process.services()->reset();
  EXPECT_FALSE(answer.success);
  EXPECT_EQ(answer.message, "the run has ended");
}

}  // namespace robot_control::tests
