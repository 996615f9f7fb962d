/// Each cycle hands its inputs to its law and publishes what it returns. The laws here only note what they are given.

#include <gtest/gtest.h>

#include "cycle_fixture.h"
#include "loop/build_id.h"

namespace robot_control::tests {

constexpr std::uint64_t kHash = 7;
constexpr std::uint64_t kRun = 5;

std::int64_t now_ns = 0;  // of these tests
std::int64_t test_clock() {
  return now_ns;
}

template <class Role>
struct Saved : Role {
  void save(LawSnapshot& snapshot) const noexcept override { snapshot.bytes = 1; }
  bool restore(const LawSnapshot&) noexcept override { return true; }
};

struct NotedEstimator final : Saved<EstimatorLaw> {
  std::unique_ptr<EstimatorLaw> clone() const override { return std::make_unique<NotedEstimator>(*this); }
  void enter_run() noexcept override { ++runs; }
  void resume(const StateFrame& last) noexcept override { resumed = last.head.cycle; }
  void set_pose(const Vector3& wanted) noexcept override {
    pose = wanted;
    ++poses;
  }
  void step(const SensorFrame&, StateFrame&) noexcept override {}
  int runs = 0, poses = 0;
  Vector3 pose{};
  std::optional<std::uint64_t> resumed;
};

struct NotedController final : Saved<ControllerLaw> {
  std::unique_ptr<ControllerLaw> clone() const override { return std::make_unique<NotedController>(*this); }
  void enter_run(const VelocityCommand& inbox, bool zero) noexcept override {
    entered = inbox;
    with_zero = zero;
    ++runs;
  }
  void tune(const LiveTuning& wanted) noexcept override {
    in_force = wanted;
    ++tunes;
  }
  LiveTuning tuning() const noexcept override { return in_force; }
  void step(const ControlInput& wanted, CommandFrame&) noexcept override {
    input = wanted;
    permit = wanted.permit == nullptr ? std::nullopt : std::optional(wanted.permit->head.cycle);
  }
  LiveTuning in_force = numbered(1);
  VelocityCommand entered;
  ControlInput input;
  std::optional<std::uint64_t> permit;
  bool with_zero = false;
  int runs = 0, tunes = 0;

  static LiveTuning numbered(unsigned number) {
    LiveTuning tuning;
    tuning.content[0] = static_cast<std::byte>(number);
    return tuning;
  }
};

struct NotedMonitor final : Saved<MonitorLaw> {
  std::unique_ptr<MonitorLaw> clone() const override { return std::make_unique<NotedMonitor>(*this); }
  void step(const MonitorInput& wanted, Permit& out) noexcept override {
    input = wanted;
    if (wanted.inherited != nullptr) inherited = *wanted.inherited;
    out.causes = causes;
    ++steps;
  }
  MonitorInput input;
  InheritedLatch inherited;
  std::uint64_t causes = 0;
  int steps = 0;
};

/// The channels of a loop whose driver is the test.
struct Bench : testing::Test, TestChannels {
  Bench() {
    now_ns = 1'000'000'000;
    attach(kRun);
    sensors.memory->head.robot_hash.store(kHash);
  }
  void attach(std::uint64_t run) { sensors.memory->head.attached_run.store(run); }

  SensorFrame sensors_of(std::uint64_t cycle, std::uint64_t run = kRun) const {
    SensorFrame frame;
    frame.head = {.run = run, .cycle = cycle, .stamp_ns = stamp(cycle)};
    return frame;
  }
  static std::int64_t stamp(std::uint64_t cycle) { return 500 + static_cast<std::int64_t>(cycle) * kPeriodNs; }
  void sense(std::uint64_t cycle, std::uint64_t run = kRun) {
    SensorFrame frame = sensors_of(cycle, run);
    sensors.writer.publish(frame);
  }
  template <class Frame>
  static Frame publish(TestChannel<Frame>& channel, std::uint64_t cycle, std::uint64_t run = kRun) {
    Frame frame;
    frame.head = {.run = run, .cycle = cycle, .stamp_ns = stamp(cycle)};
    channel.writer.publish(frame);
    return frame;
  }
  template <class Frame>
  static void spoil(TestChannel<Frame>& channel, std::uint64_t cycle) {
    Frame frame;
    frame.head = {.run = kRun, .cycle = cycle, .stamp_ns = -1};
    seal(frame);
    frame.head.checksum += 1;
    channel.writer.store(frame);
  }
};

using CycleClockTest = Bench;

TEST_F(CycleClockTest, TellsALaterFrameFromAnEarlierOneAndAnotherRun) {
  CycleClock clock(nullptr);
  EXPECT_EQ(clock.compare({.run = kRun, .cycle = 0}), Arrival::kNewRun);
  clock.accept({.run = kRun, .cycle = 7});
  EXPECT_EQ(clock.run(), kRun);
  EXPECT_EQ(clock.cycle(), 7u);
  EXPECT_EQ(clock.compare({.run = kRun, .cycle = 6}), Arrival::kOld);
  EXPECT_EQ(clock.compare({.run = kRun, .cycle = 7}), Arrival::kOld);
  EXPECT_EQ(clock.compare({.run = kRun, .cycle = 8}), Arrival::kNext);
  EXPECT_EQ(clock.compare({.run = kRun + 1, .cycle = 7}), Arrival::kNewRun);
}

TEST_F(CycleClockTest, GivesTimesFromWhenACycleIsDueAndZeroInVirtualTime) {
  SensorFrame frame = sensors_of(0);
  frame.slipped_ns = 20;
  frame.held_ns = 3;
  const CycleClock clock(test_clock), none(nullptr);
  EXPECT_EQ(clock.now(), now_ns);
  EXPECT_EQ(none.now(), 0);
  const std::int64_t due = 500 + 20 + 3;
  EXPECT_EQ(clock.timing(900, frame).woke_ns, 900 - due);
  EXPECT_EQ(clock.timing(900, frame).published_ns, now_ns - due);
  EXPECT_EQ(none.timing(900, frame).woke_ns, 0);
  EXPECT_EQ(none.timing(900, frame).published_ns, 0);
}

TEST_F(CycleClockTest, TakesFramesOfThisRunAndThisRobotAlone) {
  const FrameHead head{.run = kRun, .cycle = 3};
  EXPECT_TRUE(current(sensors.reader, head, kHash));
  EXPECT_FALSE(current(sensors.reader, head, kHash + 1));
  EXPECT_FALSE(current(sensors.reader, {.run = kRun + 1, .cycle = 3}, kHash));
  EXPECT_FALSE(current(FrameReader<SensorFrame>(), head, kHash)) << "the channel is not mapped";
}

TEST_F(CycleClockTest, FindsTheLastCycleThatAnEarlierProcessPublishedInThisRun) {
  EXPECT_EQ(published_before(command.writer, kRun), std::nullopt);
  publish(command, 41);
  EXPECT_EQ(published_before(command.writer, kRun), 41u);
  EXPECT_EQ(published_before(command.writer, kRun + 1), std::nullopt);
  command.writer.publish_token({.run = kRun, .cycle = 42});
  EXPECT_EQ(published_before(command.writer, kRun), 42u);
  spoil(command, 43);
  EXPECT_EQ(published_before(command.writer, kRun), std::nullopt);
}

TEST(Rows, AreNumberedAndBeginEmpty) {
  MonitorCalls noted = first_row<MonitorCalls>(), row;
  EXPECT_EQ(noted.law.process, 1u);
  EXPECT_EQ(noted.law.number, 0u);
  noted.law.process = 12;
  noted.corrupt = 3;
  close_row(true, noted, 100, 200, row);
  EXPECT_EQ(row.law.process, 12u);
  EXPECT_EQ(row.law.number, 0u);
  EXPECT_EQ(row.law.sensors, 100u);
  EXPECT_EQ(row.law.output, 200u);
  EXPECT_EQ(row.corrupt, 3u);
  EXPECT_EQ(noted.law.process, 12u);
  EXPECT_EQ(noted.law.number, 1u);
  EXPECT_EQ(noted.law.sensors, 0u);
  EXPECT_EQ(noted.corrupt, 0u);
}

TEST(Rows, AreNumberedButNotFilledWithoutChecksums) {
  MonitorCalls noted = first_row<MonitorCalls>(), row;
  noted.corrupt = 3;
  close_row(false, noted, 100, 200, row);
  EXPECT_EQ(row.law.sensors, 0u);
  EXPECT_EQ(row.corrupt, 0u);
  EXPECT_EQ(noted.law.number, 1u);
  EXPECT_EQ(noted.corrupt, 0u);
}

TEST(LawSnapshots, AreTakenInTheFirstTwoRowsInANewRunAndEveryKSnapshotCycles) {
  Snapshots snapshots(LawName::kMonitor);
  const NotedMonitor law;
  EXPECT_EQ(snapshots.taken(), nullptr);
  bool seals = true;
  const auto taken = [&](std::uint64_t number, std::uint64_t cycle, std::uint64_t new_run = 0) {
    snapshots.copy_if_due(law, {.process = 3, .number = number, .new_run = new_run},
                          {.checksum = 1, .run = kRun, .cycle = cycle, .stamp_ns = 77}, seals);
    return snapshots.taken() != nullptr;
  };
  EXPECT_TRUE(taken(0, 100));
  EXPECT_TRUE(taken(1, 101));
  EXPECT_FALSE(taken(2, 102));
  EXPECT_FALSE(taken(3, kSnapshotCycles - 1));
  EXPECT_TRUE(taken(4, kSnapshotCycles));
  EXPECT_FALSE(taken(5, kSnapshotCycles + 1));
  EXPECT_TRUE(taken(6, 2 * kSnapshotCycles + 5)) << "the cycle itself was skipped";
  EXPECT_TRUE(taken(7, 2 * kSnapshotCycles + 6, 1));
  const LawSnapshot& copy = *snapshots.taken();
  EXPECT_EQ(copy.law, LawName::kMonitor);
  EXPECT_EQ(copy.build, build_id());
  EXPECT_EQ(copy.head.run, kRun);
  EXPECT_EQ(copy.head.cycle, 2 * kSnapshotCycles + 6);
  EXPECT_EQ(copy.head.stamp_ns, 77);
  EXPECT_EQ(copy.head.checksum, 0u);
  EXPECT_EQ(copy.process, 3u);
  EXPECT_EQ(copy.number, 7u);
  EXPECT_EQ(copy.bytes, 1u);
  seals = false;
  EXPECT_FALSE(taken(8, 3 * kSnapshotCycles)) << "a replay could not use it";
}

struct EstimatorCycleTest : Bench {
  EstimatorCycleTest() { start(); }
  void start(Now clock = nullptr) {
    auto law = std::make_unique<NotedEstimator>();
    law_ = law.get();
    cycle_ = std::make_unique<EstimatorCycle>(std::move(law), kHash, sensors.reader, state.writer, clock);
  }
  NotedEstimator* law_ = nullptr;
  std::unique_ptr<EstimatorCycle> cycle_;
};

TEST_F(EstimatorCycleTest, ResumesFromTheLastFrameOfTheSameRunAlone) {
  publish(state, 9);
  sense(10);
  ASSERT_TRUE(cycle_->step());
  EXPECT_EQ(law_->runs, 1);
  EXPECT_EQ(law_->resumed, 9u);
  EXPECT_EQ(state.newest().first_cycle, 10u);
  EXPECT_EQ(state.newest().head.cycle, 10u);
  EXPECT_EQ(state.newest().head.stamp_ns, stamp(10));

  attach(kRun + 1);
  law_->resumed.reset();
  sense(0, kRun + 1);
  ASSERT_TRUE(cycle_->step());
  EXPECT_EQ(law_->runs, 2);
  EXPECT_EQ(law_->resumed, std::nullopt) << "of another run";
  EXPECT_EQ(state.newest().first_cycle, 0u);
  EXPECT_EQ(state.newest().head.run, kRun + 1);
}

TEST_F(EstimatorCycleTest, ResumesFromNoTokenAndNoCorruptFrame) {
  state.writer.publish_token({.run = kRun, .cycle = 9});
  sense(10);
  ASSERT_TRUE(cycle_->step());
  EXPECT_EQ(law_->resumed, std::nullopt);
  spoil(state, 11);
  start();
  sense(12);
  ASSERT_TRUE(cycle_->step());
  EXPECT_EQ(law_->resumed, std::nullopt);
}

TEST_F(EstimatorCycleTest, StepsOnceForEachWholeFrameOfThisRun) {
  EXPECT_FALSE(cycle_->step()) << "no frame";
  sense(0);
  EXPECT_TRUE(cycle_->step());
  EXPECT_FALSE(cycle_->step());
  spoil(sensors, 1);
  EXPECT_FALSE(cycle_->step());
  sense(2, kRun + 1);
  EXPECT_FALSE(cycle_->step()) << "the driver is in another run";
  sense(3);
  EXPECT_TRUE(cycle_->step());
  EXPECT_EQ(law_->runs, 1);
  EXPECT_EQ(cycle_->trace().calls.law.number, 1u);
  EXPECT_EQ(cycle_->trace().calls.law.new_run, 0u);
  EXPECT_EQ(cycle_->trace().calls.first_cycle, 0u);
}

TEST_F(EstimatorCycleTest, SetsAPoseOncePerRequest) {
  sense(5);
  cycle_->step();
  EXPECT_EQ(law_->poses, 0);
  cycle_->request_pose({1, 2, 3});
  for (const std::uint64_t cycle : {6, 7}) {
    sense(cycle);
    cycle_->step();
    EXPECT_EQ(cycle_->trace().calls.pose_set, cycle == 6 ? 1u : 0u);
    EXPECT_EQ(cycle_->trace().calls.first_cycle, 5u);
  }
  EXPECT_EQ(law_->poses, 1);
  EXPECT_EQ(law_->pose, (Vector3{1, 2, 3}));
}

TEST_F(EstimatorCycleTest, NotesItsTimesAndProcess) {
  start(test_clock);
  cycle_->set_process(44);
  sense(1);
  ASSERT_TRUE(cycle_->step());
  EXPECT_EQ(cycle_->trace().timing.woke_ns, now_ns - stamp(1));
  EXPECT_EQ(cycle_->trace().timing.published_ns, now_ns - stamp(1));
  EXPECT_EQ(cycle_->trace().calls.law.process, 44u);
  ASSERT_NE(cycle_->snapshot(), nullptr);
  EXPECT_EQ(cycle_->snapshot()->law, LawName::kEstimator);
  EXPECT_EQ(cycle_->snapshot()->head.cycle, 1u);
}

struct ControllerCycleTest : Bench {
  ControllerCycleTest() { start(); }
  void start(CommandScript script = {}, Now clock = nullptr) {
    auto law = std::make_unique<NotedController>();
    law_ = law.get();
    cycle_ = std::make_unique<ControllerCycle>(std::move(law), kHash, of_controller(), std::move(script), clock);
  }
  bool step(std::uint64_t cycle) {
    sense(cycle);
    publish(state, cycle);
    return cycle_->step();
  }
  Lookup command_at(std::uint64_t cycle) { return command.reader.at(kRun, cycle, frame_); }
  NotedController* law_ = nullptr;
  std::unique_ptr<ControllerCycle> cycle_;
  CommandFrame frame_;
};

TEST_F(ControllerCycleTest, StepsOnceForEachWholeStateWithItsSensors) {
  EXPECT_FALSE(cycle_->step()) << "no state";
  EXPECT_TRUE(step(0));
  EXPECT_FALSE(cycle_->step());
  publish(state, 1);
  EXPECT_FALSE(cycle_->step()) << "no sensors of that cycle";
  EXPECT_EQ(command_at(1), Lookup::kMissing);
  publish(state, 2, kRun + 1);
  EXPECT_FALSE(cycle_->step()) << "the driver is in another run";
  EXPECT_TRUE(step(3));
  EXPECT_EQ(law_->runs, 1);
  EXPECT_EQ(command_at(3), Lookup::kFrame);
  EXPECT_EQ(frame_.head.stamp_ns, stamp(3));
  EXPECT_EQ(cycle_->trace().calls.law.new_run, 0u);
  EXPECT_EQ(cycle_->trace().calls.law.number, 1u);
}

TEST_F(ControllerCycleTest, AnswersATokenByItsHeadEvenWithoutSensors) {
  ASSERT_TRUE(step(0));
  state.writer.publish_token({.run = kRun, .cycle = 1, .stamp_ns = 123});
  EXPECT_FALSE(cycle_->step());
  EXPECT_EQ(command_at(1), Lookup::kToken);
  EXPECT_EQ(frame_.head.stamp_ns, 123);
}

TEST_F(ControllerCycleTest, AnswersACorruptStateByTheHeadOfItsSensors) {
  ASSERT_TRUE(step(0));
  sense(1);
  spoil(state, 1);
  EXPECT_FALSE(cycle_->step());
  EXPECT_EQ(command_at(1), Lookup::kToken);
  EXPECT_EQ(frame_.head.stamp_ns, stamp(1)) << "nothing of a corrupt frame is passed on";
  spoil(state, 2);
  EXPECT_FALSE(cycle_->step());
  EXPECT_EQ(command_at(2), Lookup::kMissing) << "its cycle may be corrupt, too";
  EXPECT_TRUE(step(3));
}

TEST_F(ControllerCycleTest, UsesTheNewestPermitThatHasNotExpired) {
  const auto permit_of = [&](std::uint64_t cycle, std::uint64_t expiry) {
    Permit frame;
    frame.head = {.run = kRun, .cycle = cycle};
    frame.expiry = expiry;
    permit.writer.publish(frame);
  };
  permit_of(0, 9);
  step(0);
  EXPECT_EQ(law_->permit, std::nullopt) << "of this cycle";
  EXPECT_EQ(cycle_->trace().calls.permit.found, Lookup::kMissing);
  step(1);
  EXPECT_EQ(law_->permit, 0u);
  step(4);
  EXPECT_EQ(law_->permit, 0u);
  EXPECT_EQ(cycle_->trace().calls.permit.found, Lookup::kFrame);
  step(5);
  EXPECT_EQ(law_->permit, std::nullopt) << "it lives for four cycles";
  permit_of(5, 7);
  step(6);
  EXPECT_EQ(law_->permit, 5u);
  step(7);
  EXPECT_EQ(law_->permit, 5u);
  step(8);
  EXPECT_EQ(law_->permit, std::nullopt) << "it has expired";
  EXPECT_EQ(cycle_->trace().calls.permit.found, Lookup::kMissing);
  permit_of(8, 12);
  spoil(permit, 9);
  step(10);
  EXPECT_EQ(law_->permit, std::nullopt) << "the newest one is corrupt";
}

TEST_F(ControllerCycleTest, HandsOnTheInboxAsItIs) {
  ASSERT_TRUE(step(0));
  VelocityCommand wanted{.content = {.twist = kAhead}, .count = 3};
  wanted.age_ns = 11;
  wanted.stale = 12;
  wanted.crowded = 13;
  wanted.revoked = 14;
  wanted.not_finite = 15;
  wanted.many_senders = 1;
  wanted.contested = 2;
  cycle_->inbox().store(wanted);
  step(1);
  for (const VelocityCommand& request : {law_->input.request, cycle_->trace().calls.request}) {
    EXPECT_EQ(request.content.twist.linear[0], 0.5);
    EXPECT_EQ(request.count, 3u);
    EXPECT_EQ(request.age_ns, 11);
    EXPECT_EQ(request.stale, 12u);
    EXPECT_EQ(request.crowded, 13u);
    EXPECT_EQ(request.revoked, 14u);
    EXPECT_EQ(request.not_finite, 15u);
    EXPECT_EQ(request.many_senders, 1u);
    EXPECT_EQ(request.contested, 2u);
  }
  ASSERT_NE(law_->input.sensors, nullptr);
  EXPECT_EQ(law_->input.sensors->head.cycle, 1u);
  EXPECT_EQ(law_->input.state->head.cycle, 1u);
  EXPECT_EQ(cycle_->trace().calls.state, state.newest().head.checksum);
}

TEST_F(ControllerCycleTest, EntersARunWithWhatIsInTheInboxThen) {
  VelocityCommand wanted{.content = {.twist = kAhead}, .count = 3};
  wanted.stale = 2;
  cycle_->inbox().store(wanted);
  step(0);
  EXPECT_EQ(law_->entered.stale, 2u);
  EXPECT_EQ(law_->entered.count, 0u) << "a command from before the run is none";
  EXPECT_EQ(law_->input.request.count, 0u);
  EXPECT_EQ(cycle_->trace().calls.inbox.stale, 2u);
  EXPECT_EQ(cycle_->trace().calls.law.new_run, 1u);
  EXPECT_EQ(cycle_->trace().calls.with_zero, 0u);
  EXPECT_FALSE(law_->with_zero);
}

TEST_F(ControllerCycleTest, AddsTheScriptToTheInboxInTheOrderOfArrival) {
  start(CommandScript::parse("cycle,linear,angular\n0,0.1,0\n2,0.2,0\n3,0.3,0\n", "test"));
  step(0);
  EXPECT_EQ(law_->input.request.content.twist.linear[0], 0.1);
  EXPECT_EQ(law_->input.request.count, 1u);
  EXPECT_TRUE(law_->with_zero);
  EXPECT_EQ(cycle_->trace().calls.with_zero, 1u);
  VelocityCommand wanted{.content = {.twist = kAhead}, .count = 2};
  wanted.age_ns = 11;
  wanted.content.posture.height = 1;
  cycle_->inbox().store(wanted);
  step(1);
  EXPECT_EQ(law_->input.request.content.twist.linear[0], 0.5);
  EXPECT_EQ(law_->input.request.count, 3u);
  step(4);
  EXPECT_EQ(law_->input.request.content.twist.linear[0], 0.3);
  EXPECT_EQ(law_->input.request.content.posture.height, 0) << "of the inbox";
  EXPECT_EQ(law_->input.request.age_ns, 0);
  EXPECT_EQ(law_->input.request.count, 5u);
}

TEST_F(ControllerCycleTest, ContinuesTheScriptOfAnEarlierProcessWithoutAZero) {
  publish(command, 2);
  start(CommandScript::parse("cycle,linear,angular\n0,0.1,0\n2,0.2,0\n3,0.3,0\n", "test"));
  step(3);
  EXPECT_EQ(law_->input.request.count, 1u) << "row 3 alone";
  EXPECT_EQ(law_->input.request.content.twist.linear[0], 0.3);
  EXPECT_FALSE(law_->with_zero);
  attach(kRun + 1);
  sense(0, kRun + 1);
  publish(state, 0, kRun + 1);
  ASSERT_TRUE(cycle_->step());
  EXPECT_EQ(law_->input.request.content.twist.linear[0], 0.1) << "a new run begins with the first row";
  EXPECT_TRUE(law_->with_zero);
  EXPECT_EQ(law_->runs, 2);
}

TEST_F(ControllerCycleTest, TunesOncePerOtherTuning) {
  step(0);
  EXPECT_EQ(cycle_->trace().tuning, NotedController::numbered(1));
  EXPECT_EQ(cycle_->trace().calls.tuned, 0u);
  cycle_->tunings().store(NotedController::numbered(1));
  step(1);
  EXPECT_EQ(law_->tunes, 0) << "it is in force";
  cycle_->tunings().store(NotedController::numbered(2));
  step(2);
  EXPECT_EQ(law_->tunes, 1);
  EXPECT_EQ(law_->in_force, NotedController::numbered(2));
  EXPECT_EQ(cycle_->trace().tuning, NotedController::numbered(2));
  EXPECT_EQ(cycle_->trace().calls.tuned, 1u);
  step(3);
  EXPECT_EQ(law_->tunes, 1);
  EXPECT_EQ(cycle_->trace().calls.tuned, 0u);
}

TEST_F(ControllerCycleTest, NotesItsTimesAndProcess) {
  start({}, test_clock);
  cycle_->set_process(44);
  ASSERT_TRUE(step(1));
  EXPECT_EQ(cycle_->trace().timing.woke_ns, now_ns - stamp(1));
  EXPECT_EQ(cycle_->trace().calls.law.process, 44u);
  ASSERT_NE(cycle_->snapshot(), nullptr);
  EXPECT_EQ(cycle_->snapshot()->law, LawName::kController);
  EXPECT_EQ(cycle_->snapshot()->head.cycle, 1u);
}

struct MonitorCycleTest : Bench {
  MonitorCycleTest() { start(); }
  void start(CommandScript script = {}, Now clock = nullptr, InheritedLatch latch = {}, std::uint64_t causes = 0) {
    auto law = std::make_unique<NotedMonitor>();
    law->causes = causes;
    law_ = law.get();
    cycle_ =
        std::make_unique<MonitorCycle>(std::move(law), kHash, kLossNs, of_monitor(), std::move(script), clock, latch);
  }
  bool step(std::uint64_t cycle) {
    sense(cycle);
    return cycle_->step();
  }
  NotedMonitor* law_ = nullptr;
  std::unique_ptr<MonitorCycle> cycle_;
};

TEST_F(MonitorCycleTest, InheritsTheLatchOfItsPredecessor) {
  EXPECT_EQ(law_->steps, 1);
  EXPECT_EQ(law_->inherited.permit, nullptr);
  EXPECT_EQ(law_->inherited.causes, 0u);
  publish(permit, 3);
  start();
  EXPECT_NE(law_->inherited.permit, nullptr);
  EXPECT_EQ(law_->inherited.causes, 0u);
}

TEST_F(MonitorCycleTest, LatchesAPermitThatCannotBeRead) {
  for (std::uint64_t cycle = 0; cycle < kFrameSlots; ++cycle) spoil(permit, cycle);
  InheritedLatch latch;
  latch.causes = latch.first_cause = kCauseEmergencyStopService;
  start({}, nullptr, latch);
  EXPECT_EQ(law_->inherited.permit, nullptr);
  EXPECT_EQ(law_->inherited.causes, std::uint64_t{kCauseEmergencyStopService} | kCauseLatchUnreadable);
  EXPECT_EQ(law_->inherited.first_cause, std::uint64_t{kCauseLatchUnreadable});
}

TEST_F(MonitorCycleTest, AddsUpEveryInputOfTheOperatorAndTheScript) {
  start(CommandScript::parse("cycle,linear,angular,event\n0,,,e_stop\n2,,,e_stop_reset\n", "test"));
  OperatorInput operator_input{.e_stop_level = 1,
                               .e_stop_messages = 2,
                               .e_stop_triggers = 3,
                               .e_stop_services = 4,
                               .resets = 5,
                               .heartbeats = 6,
                               .clearances = 7,
                               .clearance = 0.8};
  const auto expect = [&](std::uint64_t factor, std::uint64_t resets) {
    for (const OperatorInput& seen : {law_->input.operator_input, cycle_->trace().calls.operator_input}) {
      EXPECT_EQ(seen.e_stop_level, 1u);
      EXPECT_EQ(seen.e_stop_messages, 2 * factor);
      EXPECT_EQ(seen.e_stop_triggers, 3 * factor);
      EXPECT_EQ(seen.e_stop_services, 4 * factor + 1);
      EXPECT_EQ(seen.resets, 5 * factor + resets);
      EXPECT_EQ(seen.heartbeats, 6 * factor);
      EXPECT_EQ(seen.clearances, 7 * factor);
      EXPECT_EQ(seen.clearance, 0.8);
    }
  };
  cycle_->inbox().store(operator_input);
  step(0);
  expect(1, 0);
  step(1);
  expect(1, 0);
  for (std::uint64_t* counted :
       {&operator_input.e_stop_messages, &operator_input.e_stop_triggers, &operator_input.e_stop_services,
        &operator_input.resets, &operator_input.heartbeats, &operator_input.clearances}) {
    *counted *= 2;
  }
  cycle_->inbox().store(operator_input);
  step(3);
  expect(2, 1);
}

TEST_F(MonitorCycleTest, ContinuesTheScriptOfAnEarlierProcess) {
  publish(permit, 1);
  start(CommandScript::parse("cycle,linear,angular,event\n0,,,e_stop\n1,,,e_stop_reset\n2,,,e_stop\n", "test"));
  step(2);
  EXPECT_EQ(law_->input.operator_input.e_stop_services, 1u);
  EXPECT_EQ(law_->input.operator_input.resets, 0u);
  attach(kRun + 1);
  sense(0, kRun + 1);
  ASSERT_TRUE(cycle_->step());
  EXPECT_EQ(cycle_->trace().calls.law.new_run, 1u);
  EXPECT_EQ(law_->input.operator_input.e_stop_services, 2u) << "a new run begins with the first row";
}

TEST_F(MonitorCycleTest, ReadsCommandAndStateOfTheCycleBefore) {
  publish(command, 0);
  publish(state, 0);
  step(0);
  EXPECT_EQ(law_->input.command, nullptr) << "cycle 0 has none before it";
  EXPECT_EQ(law_->input.state, nullptr);
  EXPECT_EQ(cycle_->trace().calls.state.found, Lookup::kMissing);
  StateFrame late;
  late.first_cycle = 9;
  late.head = {.run = kRun, .cycle = 9};
  state.writer.publish(late);
  const CommandFrame frame = publish(command, 9);
  step(10);
  ASSERT_NE(law_->input.command, nullptr);
  EXPECT_EQ(cycle_->trace().calls.command.checksum, frame.head.checksum);
  ASSERT_NE(law_->input.state, nullptr);
  EXPECT_EQ(law_->input.state->first_cycle, 9u);
  EXPECT_EQ(cycle_->trace().calls.state.cycle, 9u);
  EXPECT_EQ(law_->input.corrupt, 0u);
  EXPECT_EQ(law_->input.silence, SensorSilence::kNone);
  step(11);
  EXPECT_EQ(law_->input.command, nullptr);
  EXPECT_EQ(law_->input.state, nullptr);
}

TEST_F(MonitorCycleTest, CountsACorruptFrameOfEachKind) {
  step(0);
  spoil(command, 0);
  step(1);
  EXPECT_EQ(law_->input.corrupt, 1u);
  EXPECT_EQ(cycle_->trace().calls.corrupt, 1u);
  spoil(state, 1);
  step(2);
  EXPECT_EQ(law_->input.corrupt, 1u);
  spoil(sensors, 3);
  EXPECT_FALSE(cycle_->step());
  step(4);
  EXPECT_EQ(law_->input.corrupt, 1u);
  step(5);
  EXPECT_EQ(law_->input.corrupt, 0u);
}

TEST_F(MonitorCycleTest, StepsOncePerThirdCorruptFrameInARow) {
  step(0);
  const int steps = law_->steps;
  for (int k = 1; k <= 2; ++k) {
    spoil(sensors, static_cast<std::uint64_t>(k));
    EXPECT_FALSE(cycle_->step());
  }
  spoil(sensors, 3);
  EXPECT_TRUE(cycle_->step());
  EXPECT_EQ(law_->input.corrupt, 3u);
  EXPECT_EQ(law_->input.sensors, nullptr);
  EXPECT_EQ(law_->steps, steps + 1);
  spoil(sensors, 4);
  EXPECT_FALSE(cycle_->step());
  EXPECT_FALSE(cycle_->idle()) << "it is the same fact";
}

TEST_F(MonitorCycleTest, PublishesPermitsOfTheRunOfTheSensors) {
  EXPECT_EQ(cycle_->published_run(), 0u);
  step(6);
  EXPECT_EQ(cycle_->published_run(), kRun);
  EXPECT_EQ(permit.newest().head.run, kRun);
  EXPECT_EQ(permit.newest().head.cycle, 6u);
  EXPECT_EQ(permit.newest().head.stamp_ns, stamp(6));
  EXPECT_FALSE(step(6));
  sense(7, kRun + 1);
  EXPECT_FALSE(cycle_->step()) << "the driver is in another run";
  EXPECT_TRUE(step(8));
  EXPECT_EQ(cycle_->trace().calls.law.new_run, 0u);
  EXPECT_EQ(permit.newest().head.cycle, 8u);
}

TEST_F(MonitorCycleTest, LatchesBeforeTheFirstFrameInARunThatNoGateUses) {
  EXPECT_FALSE(cycle_->idle());
  EXPECT_EQ(law_->steps, 1) << "nothing has happened";
  cycle_->inbox().store({.resets = 1});
  EXPECT_FALSE(cycle_->idle()) << "it has no row";
  EXPECT_EQ(law_->steps, 2);
  EXPECT_EQ(law_->input.silence, SensorSilence::kNone);
  EXPECT_EQ(cycle_->published_run(), MonitorCycle::kRunBeforeDriver);
  EXPECT_EQ(permit.newest().head.run, 1u);
}

TEST_F(MonitorCycleTest, PublishesAnInheritedStopBeforeTheFirstFrameOnce) {
  publish(permit, 3);
  start({}, nullptr, {}, kCauseEmergencyStopService);
  cycle_->idle();
  EXPECT_EQ(permit.newest().causes, std::uint64_t{kCauseEmergencyStopService});
  EXPECT_EQ(cycle_->published_run(), MonitorCycle::kRunBeforeDriver);
  const int steps = law_->steps;
  cycle_->idle();
  EXPECT_EQ(law_->steps, steps);
}

TEST_F(MonitorCycleTest, StepsWithoutAFrameForEachRequestOfTheOperator) {
  step(0);
  int steps = law_->steps;
  for (const OperatorInput& input :
       {OperatorInput{.e_stop_level = 1}, OperatorInput{.e_stop_level = 1, .e_stop_messages = 1},
        OperatorInput{.e_stop_level = 1, .e_stop_messages = 1, .e_stop_services = 1},
        OperatorInput{.e_stop_level = 1, .e_stop_messages = 1, .e_stop_services = 1, .resets = 1}}) {
    cycle_->inbox().store(input);
    EXPECT_TRUE(cycle_->idle());
    EXPECT_EQ(law_->steps, ++steps);
    EXPECT_FALSE(cycle_->idle());
    EXPECT_EQ(cycle_->trace().calls.law.sensors, 0u);
    EXPECT_EQ(permit.newest().head.cycle, 0u) << "of the last frame";
  }
}

TEST_F(MonitorCycleTest, DistinguishesADriverThatPausesOrEndsFromASilentOne) {
  for (const DriverState driver : {DriverState::kPaused, DriverState::kEnded, DriverState::kRunning}) {
    start();
    SensorFrame frame = sensors_of(0);
    frame.driver_state = driver;
    sensors.writer.publish(frame);
    ASSERT_TRUE(cycle_->step());
    const bool pauses = driver == DriverState::kPaused;
    EXPECT_EQ(cycle_->time_out(), !pauses) << "a pause alone is no fact";
    const SensorSilence expected = driver == DriverState::kEnded ? SensorSilence::kEnded : SensorSilence::kTimedOut;
    if (!pauses) {
      EXPECT_EQ(cycle_->trace().calls.silence, expected);
    }
    EXPECT_FALSE(cycle_->time_out()) << "once";
  }
}

TEST_F(MonitorCycleTest, AnswersRequestsWhenAFrameIsPublishedAgainAsPausedOrEnded) {
  step(4);
  cycle_->inbox().store({.resets = 1});
  SensorFrame again = sensors_of(4);
  sensors.writer.publish(again);
  EXPECT_FALSE(cycle_->step()) << "it does not pause";
  again.driver_state = DriverState::kPaused;
  again.head.cycle = 3;
  sensors.writer.publish(again);
  EXPECT_FALSE(cycle_->step()) << "it is an older one";
  again.head.cycle = 4;
  sensors.writer.publish(again);
  EXPECT_TRUE(cycle_->step());
  EXPECT_EQ(law_->input.silence, SensorSilence::kPaused);
  again.driver_state = DriverState::kEnded;
  sensors.writer.publish(again);
  EXPECT_TRUE(cycle_->step());
  EXPECT_EQ(law_->input.silence, SensorSilence::kEnded);
}

TEST_F(MonitorCycleTest, TimesOutAfterTheLossTimeWithFramesOfAnotherRun) {
  start({}, test_clock);
  cycle_->set_process(44);
  ASSERT_TRUE(step(0));
  EXPECT_EQ(cycle_->trace().timing.woke_ns, now_ns - stamp(0));
  EXPECT_EQ(cycle_->trace().calls.law.process, 44u);
  ASSERT_NE(cycle_->snapshot(), nullptr);
  EXPECT_EQ(cycle_->snapshot()->law, LawName::kMonitor);
  const std::int64_t seen = now_ns;
  now_ns = seen + kLossNs - 1;
  sense(1, kRun + 1);
  EXPECT_FALSE(cycle_->step());
  now_ns = seen + kLossNs;
  sense(2, kRun + 1);
  EXPECT_TRUE(cycle_->step());
  EXPECT_EQ(law_->input.silence, SensorSilence::kTimedOut);
  EXPECT_EQ(cycle_->trace().timing.woke_ns, now_ns - stamp(0)) << "from when the last current cycle was due";
  now_ns += kLossNs;
  EXPECT_TRUE(step(3));
  EXPECT_EQ(law_->input.silence, SensorSilence::kNone);
}

TEST_F(MonitorCycleTest, NeverTimesOutBeforeItsFirstFrame) {
  start({}, test_clock);
  now_ns += 10 * kLossNs;
  sense(1, kRun + 1);
  EXPECT_FALSE(cycle_->step());
  EXPECT_FALSE(cycle_->time_out());
  EXPECT_EQ(law_->steps, 1);
}

struct DriverCycleTest : Bench {
  DriverCycleTest() {
    driver_.set_driver_instance(99);
    driver_.begin_run(kRun);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) driver_.step();
  }
  DriveTrain robot_ = two_wheels();
  StandingMachine machine_;
  DriverCycle driver_{machine_, robot_, of_driver(), kPeriodNs, test_clock};
};

TEST_F(DriverCycleTest, StampsItsCyclesFromTheStart) {
  driver_.set_start(700);
  steps(3);
  EXPECT_EQ(sensors.newest().head.run, kRun);
  EXPECT_EQ(sensors.newest().head.cycle, 2u);
  EXPECT_EQ(sensors.newest().head.stamp_ns, 700 + 2 * kPeriodNs);
  EXPECT_EQ(sensors.newest().driver_instance, 99u);
  EXPECT_EQ(driver_.run(), kRun);
  EXPECT_EQ(driver_.trace().timing.woke_ns, now_ns - 700 - 2 * kPeriodNs);
  EXPECT_EQ(driver_.trace().timing.published_ns, now_ns - 700 - 2 * kPeriodNs);
  const TruthFrame seen = truth.newest();
  EXPECT_EQ(seen.head.cycle, 2u);
  EXPECT_EQ(seen.head.run, kRun);
  EXPECT_EQ(seen.head.stamp_ns, 700 + 2 * kPeriodNs);
}

TEST_F(DriverCycleTest, CountsOverrunsSlipHoldsAndResumes) {
  driver_.set_start(0);
  steps(4);
  driver_.count_overrun();
  driver_.count_slip(300);
  driver_.count_slip(700);
  driver_.count_resume();
  driver_.set_due(4 * kPeriodNs + 1500);
  driver_.step();
  EXPECT_EQ(sensors.newest().overruns, 1u);
  EXPECT_EQ(sensors.newest().slipped_ns, 1000u);
  EXPECT_EQ(sensors.newest().resumes, 1u);
  EXPECT_EQ(sensors.newest().held_ns, 500u) << "the part of its lag that has not slipped";
  driver_.count_slip(5 * kPeriodNs - 1000);
  EXPECT_DOUBLE_EQ(driver_.real_time_factor(), 0.5);
  driver_.begin_run(kRun + 1);
  driver_.step();
  EXPECT_EQ(sensors.newest().head.cycle, 0u);
  EXPECT_EQ(sensors.newest().overruns, 0u);
  EXPECT_EQ(sensors.newest().slipped_ns, 0u);
  EXPECT_EQ(sensors.newest().resumes, 1u);
  EXPECT_EQ(driver_.trace().calls.law.new_run, 1u);
}

TEST_F(DriverCycleTest, AnnouncesARunAndWakesItsReaders) {
  const std::uint32_t before = sensors.reader.sequence();
  driver_.begin_run(kRun + 1);
  EXPECT_EQ(sensors.reader.sequence(), before + 1);
  EXPECT_EQ(sensors.memory->head.attached_run.load(), kRun + 1);
  EXPECT_EQ(sensors.memory->head.robot_hash.load(), kHash);
  EXPECT_EQ(driver_.trace().sensors.head.run, 0u) << "nothing is left of the run before";
}

TEST_F(DriverCycleTest, RepeatsItsLastFrameAsPausedOrEndedButKeepsAFault) {
  driver_.publish_paused();
  EXPECT_EQ(sensors.newest().head.run, 0u) << "nothing before the first tick";
  driver_.step();
  driver_.publish_paused();
  EXPECT_EQ(sensors.newest().driver_state, DriverState::kPaused);
  driver_.publish_ended();
  EXPECT_EQ(sensors.newest().driver_state, DriverState::kEnded);
  EXPECT_EQ(sensors.newest().head.cycle, 0u);
  machine_.state = DriverState::kFault;
  driver_.step();
  driver_.publish_ended();
  EXPECT_EQ(sensors.newest().driver_state, DriverState::kFault);
}

TEST_F(DriverCycleTest, UsesCommandAndPermitOfTheLastCyclesOfThisRun) {
  publish(command, 0);
  publish(permit, 0);
  driver_.step();
  EXPECT_EQ(driver_.trace().calls.command.found, Lookup::kMissing) << "none is older than cycle 0";
  EXPECT_EQ(driver_.trace().calls.permit.found, Lookup::kMissing);
  for (std::uint64_t cycle = 1; cycle <= kCommandLife; ++cycle) {
    driver_.step();
    EXPECT_EQ(driver_.trace().calls.command.found, Lookup::kFrame) << cycle;
    EXPECT_EQ(driver_.trace().calls.command.cycle, 0u);
  }
  driver_.step();
  EXPECT_EQ(driver_.trace().calls.command.found, Lookup::kMissing) << "a command lives for four cycles";
  EXPECT_EQ(driver_.trace().calls.permit.found, Lookup::kFrame) << "an expired permit is found";
  steps(2);
  EXPECT_EQ(driver_.trace().calls.permit.found, Lookup::kFrame);
  driver_.step();
  EXPECT_EQ(driver_.trace().calls.permit.found, Lookup::kMissing);
}

TEST_F(DriverCycleTest, ResetsItsMachineOncePerHandledReset) {
  const auto permit_with = [&](std::uint64_t resets) {
    Permit frame;
    frame.head = {.run = kRun, .cycle = driver_.next_cycle() - 1};
    frame.resets_handled = resets;
    permit.writer.publish(frame);
    driver_.step();
    return machine_.resets;
  };
  driver_.step();
  EXPECT_EQ(permit_with(3), 0) << "of the time before this process";
  EXPECT_EQ(permit_with(4), 1);
  EXPECT_EQ(permit_with(4), 1);
  EXPECT_EQ(permit_with(0), 1) << "the monitor was restarted";
  EXPECT_EQ(permit_with(1), 2);
  steps(9);
  EXPECT_EQ(permit_with(2), 3);
}

TEST_F(DriverCycleTest, InjectsFaultsOncePerChange) {
  InjectedFaults faults{};
  set_fault(faults, {.component = FaultComponent::kController, .kind = FaultKind::kWrong});
  driver_.inject(faults);
  EXPECT_EQ(machine_.faults, faults);
  machine_.faults = {};
  driver_.inject(faults);
  EXPECT_EQ(machine_.faults, InjectedFaults{}) << "it is the same";
  driver_.inject({});
  driver_.inject(faults);
  EXPECT_EQ(machine_.faults, faults);
}

TEST_F(DriverCycleTest, WritesTheRowOfItsGate) {
  steps(2);
  const GateCalls& calls = driver_.trace().calls;
  EXPECT_EQ(calls.law.number, 1u);
  EXPECT_EQ(calls.law.process, 99u);
  EXPECT_EQ(calls.law.sensors, sensors.newest().head.checksum);
  EXPECT_EQ(machine_.mode, JointMode::kBrake);
  ASSERT_NE(driver_.snapshot(), nullptr) << "of the first two cycles";
  EXPECT_EQ(driver_.snapshot()->law, LawName::kGate);
  const GateReport report = driver_.trace().gate;
  driver_.step();
  EXPECT_EQ(sensors.newest().gate.verdict, report.verdict) << "the report of the tick before";
  EXPECT_EQ(sensors.newest().gate.reasons, report.reasons);
}

}  // namespace robot_control::tests
