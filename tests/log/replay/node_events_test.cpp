/// Events of nodes in real time come in random order: late and skipped cycles, pauses, silence, corrupt frames,
/// restarts, new runs. Requests come in the middle of all that. The results are computed again, bit by bit.

#include <gtest/gtest.h>

#include <random>

#include "log/replay/recorded.h"
#include "log/rows/join.h"
#include "loop/cycle_fixture.h"
#include "robots/differential_drive.h"
#include "signals/names.h"

namespace robot_control::tests {

class RandomNodes {
 public:
  explicit RandomNodes(unsigned seed) : random_(seed) {}

  /// One cycle, and perhaps an event before it.
  void cycle() {
    if (chance(0.02)) act();
    loop_.driver.step();
    constexpr double kLate = 0.03;
    const EstimatorTrace* state = chance(kLate) ? nullptr : loop_.step_estimator();
    const ControllerTrace* command = chance(kLate) ? nullptr : loop_.step_controller();
    const MonitorTrace* permit = chance(kLate) ? nullptr : loop_.step_monitor();
    add(loop_.driver.snapshot(), loop_.driver.trace());
    if (state != nullptr) add(loop_.estimator->snapshot(), *state);
    if (command != nullptr) add(loop_.controller->snapshot(), *command);
    if (permit != nullptr) add(loop_.monitor->snapshot(), *permit);
  }

  ReplayReport replay() {
    join_.finish();
    return recording.replay(composed(), kPeriod);
  }

  ReplayReport replay_messages() { return robot_control::replay(messages_, recording.snapshots, composed(), kPeriod); }

  /// Number of states that an estimator with the same parameters would compute differently from the log.
  int varied_otherwise() {
    join_.finish();
    int otherwise = 0;
    Replay again(composed(), kPeriod);
    again.vary(composed(), [&](const VariedRow& row) {
      if (row.state == nullptr) return;
      otherwise += row.varied_state->base.pose_odom.position != row.state->base.pose_odom.position ? 1 : 0;
    });
    for (const LawSnapshot& snapshot : recording.snapshots) again.add(snapshot);
    for (const RecordedRow& row : recording.rows) again.add(row.joined());
    return otherwise;
  }

  Recording recording;

 private:
  DifferentialDrive composed() const { return {parameters(), loop_.robot}; }

  static Parameters parameters() {
    Parameters found;
    found.loop.rate = 1 / kPeriod;
    return found;
  }

  template <class Row>
  void add(const LawSnapshot* snapshot, const Row& row) {
    recording.add(snapshot);
    join_.add(row);
  }

  /// A row of the monitor outside of `cycle`. As in ClosedLoop, no fault of a node changes it.
  void add_silence(bool has_row) {
    if (has_row) add(loop_.monitor->snapshot(), loop_.monitor->trace());
  }

  bool chance(double probability) { return std::uniform_real_distribution<>()(random_) < probability; }

  void act() {
    switch (std::uniform_int_distribution<>(0, 11)(random_)) {
      case 0:
        loop_.controller->inbox().store({.content = {.twist = chance(0.5) ? kAhead : Twist{}}, .count = ++count_});
        return;
      case 1:
        loop_.estimator->request_pose({1, -2, 0.5 * static_cast<double>(++count_)});
        return;
      case 2:
        loop_.driver.begin_run(loop_.driver.run() + 1);
        return;
      case 3:
        loop_.restart_estimator();
        loop_.estimator->set_process(++processes_);
        return;
      case 4:
        loop_.restart_controller();
        loop_.controller->set_process(++processes_);
        return;
      case 5:
        loop_.restart_monitor();
        loop_.monitor->set_process(++processes_);
        requests_ = {};
        return;
      case 6:
        return pause();
      case 7:
        add_silence(loop_.monitor->time_out());
        return request_stop_or_reset();
      case 8:
        return corrupt();
      case 9:
        loop_.machine.faults = {};
        return;
      case 10:
        set_fault(loop_.machine.faults, {.component = FaultComponent::kMonitor,
                                         .kind = chance(0.5) ? FaultKind::kIntermittent : FaultKind::kGarbage});
        return;
      default:
        return request_stop_or_reset();
    }
  }

  /// An emergency stop or a reset, in time or during silence.
  void request_stop_or_reset() {
    if (chance(0.3)) {
      ++requests_.e_stop_services;
    } else {
      ++requests_.resets;
    }
    loop_.monitor->inbox().store(requests_);
    if (chance(0.5)) add_silence(loop_.monitor->idle());
  }

  void pause() {
    for (int i = 0; i < 3; ++i) {
      loop_.driver.publish_paused();
      if (chance(0.5)) request_stop_or_reset();
      add_silence(loop_.monitor->step());
    }
  }

  void corrupt() {
    if (loop_.driver.next_cycle() == 0) return;
    SensorFrame broken = loop_.driver.trace().sensors;
    broken.head.cycle += 1;
    broken.head.checksum = 0;
    loop_.sensors.writer.store(broken);
    for (int i = 0; i < 3; ++i) {
      add_silence(loop_.monitor->step());
    }
  }

  std::mt19937 random_;
  std::vector<LoggedMessage> messages_;
  Loop loop_;
  Join join_{kPeriod, [this](const JoinedRow& row) {
               recording.rows.emplace_back(row);
               log(row, loop_.robot.joints.size(), messages_);
             }};
  std::uint64_t count_ = 0;
  std::uint64_t processes_ = 1;
  OperatorInput requests_;
};

TEST(ReplayedNodes, AreComputedAgainBitForBitWhateverHappens) {
  constexpr unsigned kSeeds = 20;
  constexpr int kCycles = 2000;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    RandomNodes nodes(seed);
    for (int k = 0; k < kCycles; ++k) nodes.cycle();
    const ReplayReport report = nodes.replay();
    EXPECT_TRUE(report.exact()) << "seed " << seed << "\n" << text_of(report);
    EXPECT_TRUE(report.gaps.empty()) << "seed " << seed << "\n" << text_of(report);
    const ReplayReport of_log = nodes.replay_messages();
    EXPECT_TRUE(of_log.exact()) << "seed " << seed << "\n" << text_of(of_log);
    EXPECT_EQ(of_log.different_rows, 0u);
  }
}

TEST(ReplayedNodes, KeepTheirPoseOverRestartsWithTheSameParameters) {
  constexpr unsigned kSeeds = 5;
  constexpr int kCycles = 2000;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    RandomNodes nodes(seed);
    for (int k = 0; k < kCycles; ++k) nodes.cycle();
    EXPECT_EQ(nodes.varied_otherwise(), 0) << "seed " << seed;
  }
}

}  // namespace robot_control::tests
