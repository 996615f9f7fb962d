/// Checks which black boxes are kept: after stops, after a telemetry that was killed, after an orderly end.

#include "log/black_box/black_box_keeper.h"

#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "log/log_error.h"
#include "log/trace_reader.h"
#include "loop/log_header.h"
#include "recorded_drive.h"
#include "support/matchers.h"
#include "support/recorded_loop.h"
#include "support/temporary_folder.h"

namespace robot_control::tests {

struct ABlackBoxKeeper : testing::Test {
  static constexpr std::int64_t kSecond = 1'000'000'000;
  static constexpr std::size_t kKeep = 2;

  std::unique_ptr<BlackBoxKeeper> start(std::size_t keep = kKeep) {
    auto keeper = std::make_unique<BlackBoxKeeper>(folder.path() / "box", 12 << 20, keep,
                                                   log_header(drive_parameters(), loop.robot()));
    keeper->watch(0, now_ns);
    return keeper;
  }

  void store(BlackBoxKeeper& keeper, const JoinedRow& row) {
    keeper.add(*row.driver);
    keeper.add(*row.estimator);
    keeper.add(*row.controller);
    keeper.add(*row.monitor);
    keeper.flush();
    keeper.watch(row.monitor->permit.causes, now_ns += kSecond / 1000);
  }

  void drive_on(BlackBoxKeeper& keeper, std::uint64_t cycles) {
    drive(loop, cycles, [&](const JoinedRow& row) { store(keeper, row); });
  }

  void stand(BlackBoxKeeper& keeper, std::uint64_t cycles) {
    loop.command({});
    for (std::uint64_t i = 0; i < cycles; ++i) {
      loop.step();
      store(keeper, loop.row());
    }
  }

  /// Waits until all due black boxes are saved; returns the messages without the sizes, which are small here.
  std::vector<std::string> notes(BlackBoxKeeper& keeper, std::size_t count) {
    std::vector<std::string> all;
    for (int tries = 0; tries < 100'000 && all.size() < count; ++tries) {
      keeper.poll(now_ns);
      for (std::string& note : keeper.take_notes()) {
        if (note.find(" GB holds ") == std::string::npos) all.push_back(std::move(note));
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return all;
  }

  void stop_and_release(BlackBoxKeeper& keeper) {
    loop.e_stop();
    drive_on(keeper, 1000);
    stand(keeper, 1000);
    loop.e_stop_reset();
    stand(keeper, 3100);
    ASSERT_EQ(loop.row().monitor->permit.causes, 0u) << "released";
  }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "box")) {
      names.push_back(entry.path().filename());
    }
    return names;
  }

  std::uint64_t rows_of(const std::string& name) const {
    std::uint64_t rows = 0;
    TraceReader(folder.path() / "box" / name).read({.row = [&](const TraceRow&, std::int64_t) { ++rows; }});
    return rows;
  }

  TemporaryFolder folder;
  RecordedLoop loop{drive_parameters()};
  std::int64_t now_ns = kSecond;
};

TEST_F(ABlackBoxKeeper, BeginsAnotherRingWhereItWasRemovedAndSaysSoOnce) {
  const auto keeper = start();
  drive_on(*keeper, 500);
  keeper->poll(now_ns);
  EXPECT_THAT(keeper->take_notes(), ElementsAre());
  std::filesystem::remove_all(folder.path() / "box");
  now_ns += kSecond;
  keeper->poll(now_ns);
  EXPECT_THAT(keeper->take_notes(), ElementsAre(HasSubstr("ring was removed or cannot be written; another one")));
  EXPECT_THAT(names(), UnorderedElementsAre("ring"));
  drive_on(*keeper, 500);
  loop.e_stop();
  drive_on(*keeper, 100);
  now_ns += 5 * kSecond;
  EXPECT_THAT(notes(*keeper, 1), ElementsAre(HasSubstr("saved")));
  EXPECT_EQ(rows_of("stop.1.bag"), 600u) << "since then";
}

TEST_F(ABlackBoxKeeper, SaysOnceThatNoOtherRingCanBeMadeAndTriesAgain) {
  const auto keeper = start();
  std::filesystem::remove_all(folder.path() / "box");
  folder.write("box", "a file");
  for (int second = 0; second < 8; ++second) keeper->poll(now_ns += kSecond);
  EXPECT_THAT(keeper->take_notes(), ElementsAre(HasSubstr("no other can be made")));
  std::filesystem::remove(folder.path() / "box");
  keeper->poll(now_ns += BlackBoxKeeper::kRetryNs);
  EXPECT_THAT(keeper->take_notes(), ElementsAre(HasSubstr("another one was begun")));
}

TEST_F(ABlackBoxKeeper, SaysHowManySecondsItHoldsWhereTheyAreFewerThanPromised) {
  const auto keeper = start();
  drive_on(*keeper, 11'000);
  keeper->poll(now_ns);
  const std::vector<std::string> said = keeper->take_notes();
  ASSERT_THAT(said, ElementsAre(HasSubstr("telemetry.black_box of 0.0126 GB holds ")));
  double held = 0, promised = 0, needed = 0;
  ASSERT_EQ(std::sscanf(said[0].c_str(), "telemetry.black_box of 0.0126 GB holds %lf s of this robot; %lf s need %lf",
                        &held, &promised, &needed),
            3);
  EXPECT_GT(held, 3);
  EXPECT_LT(held, 20);
  EXPECT_EQ(promised, 60);
  EXPECT_NEAR(needed, 0.0126 * 60 / held, 0.2 * needed);
  now_ns += kSecond;
  keeper->poll(now_ns);
  EXPECT_THAT(keeper->take_notes(), ElementsAre()) << "once";
}

/// A process that may open the ring may hold its lock, and so prevent telemetry from starting. A log is an ordinary
/// file.
TEST_F(ABlackBoxKeeper, KeepsItsRingToItsUserAndItsIncidentsAsTheUmaskSays) {
  const mode_t before = umask(027);
  const auto keeper = start();
  drive_on(*keeper, 100);
  loop.e_stop();
  drive_on(*keeper, 100);
  now_ns += 5 * kSecond;
  notes(*keeper, 1);
  umask(before);
  const auto mode = [&](const char* name) {
    return std::filesystem::status(folder.path() / "box" / name).permissions();
  };
  EXPECT_EQ(static_cast<int>(mode("ring")), 0700);
  EXPECT_EQ(static_cast<int>(mode("ring/0.bag")), 0600);
  EXPECT_EQ(static_cast<int>(mode("stop.1.bag")), 0640);
}

TEST_F(ABlackBoxKeeper, SavesWhatWasBeforeAStopAndFiveSecondsAfterItAndKeepsTheNewest) {
  const auto keeper = start();
  drive_on(*keeper, 500);
  for (const char* stop : {"stop.1.bag: ", "stop.2.bag: ", "stop.3.bag: "}) {
    stop_and_release(*keeper);
    EXPECT_THAT(notes(*keeper, 1), ElementsAre(AllOf(HasSubstr(stop), HasSubstr("e_stop"))));
    if (stop[5] == '1') {
      EXPECT_EQ(rows_of("stop.1.bag"), 5600u);
    }
  }
  EXPECT_EQ(keeper->saved(), 3u);
  EXPECT_THAT(names(), UnorderedElementsAre("ring", "stop.2.bag", "stop.3.bag"));
}

TEST_F(ABlackBoxKeeper, SavesWithTheHeaderThatHeldWhereTheRingBegins) {
  const auto keeper = start();
  LogHeader later = log_header(drive_parameters(), loop.robot());
  later.parameters = "other: 1\n";
  drive_on(*keeper, 500);
  keeper->poll(now_ns);
  keeper->set_header(later);
  for (int second = 0; second < 12; ++second) {  // more than the ring holds
    keeper->poll(now_ns);
    drive_on(*keeper, 1000);
  }
  loop.e_stop();
  drive_on(*keeper, 100);
  keeper->finish();
  EXPECT_EQ(TraceReader(folder.path() / "box" / "stop.1.bag").header().parameters, later.parameters);
}

TEST_F(ABlackBoxKeeper, SavesAtTheNextStartWhatATelemetryLeftThatWasKilled) {
  for (int i = 0; i < 3; ++i) drive_on(*start(), 300);  // not finished
  const auto keeper = start();
  EXPECT_THAT(notes(*keeper, 2).back(), HasSubstr("crash.3.bag: telemetry had not ended orderly"));
  EXPECT_THAT(names(), UnorderedElementsAre("ring", "crash.2.bag", "crash.3.bag"));
  EXPECT_EQ(rows_of("crash.3.bag"), 300u);
}

TEST_F(ABlackBoxKeeper, SavesAStopThatWaitedAtAnOrderlyEnd) {
  const auto first = start();
  drive_on(*first, 500);
  loop.e_stop();
  drive_on(*first, 100);
  first->finish();
  EXPECT_THAT(first->take_notes(), ElementsAre(HasSubstr("stop.1.bag: e_stop_service")));
  EXPECT_EQ(rows_of("stop.1.bag"), 600u);
}

/// Its thread gets little time on a busy machine.
TEST_F(ABlackBoxKeeper, SavesAtItsEndWhatItsThreadIsSavingWithThePriorityOfItsCaller) {
  const auto keeper = start();
  drive_on(*keeper, 2000);
  loop.e_stop();
  drive_on(*keeper, 100);
  now_ns += 5 * kSecond;
  keeper->poll(now_ns);
  keeper->finish();
  EXPECT_THAT(keeper->take_notes(), ElementsAre(HasSubstr("stop.1.bag: e_stop_service")));
  EXPECT_THAT(names(), UnorderedElementsAre("ring", "stop.1.bag"));
  EXPECT_EQ(rows_of("stop.1.bag"), 2100u);
}

TEST_F(ABlackBoxKeeper, LeavesAStopForWhichThereIsNoTimeToTheNextOne) {
  auto first = start();
  drive_on(*first, 500);
  loop.e_stop();
  drive_on(*first, 100);
  first->finish([] { return true; });
  EXPECT_THAT(first->take_notes(), ElementsAre(HasSubstr("not saved (e_stop_service): telemetry ends")));
  EXPECT_THAT(names(), ElementsAre("ring")) << "nothing half written";
  first.reset();
  const auto second = start();
  EXPECT_THAT(notes(*second, 1), ElementsAre(HasSubstr("crash.1.bag: ")));
  EXPECT_EQ(rows_of("crash.1.bag"), 600u);
}

TEST_F(ABlackBoxKeeper, KeepsTheRingOfAnOrderlyEndUntilTheNextOne) {
  for (int i = 0; i < 2; ++i) {
    const auto keeper = start();
    drive_on(*keeper, 100);
    keeper->finish();
  }
  EXPECT_THAT(names(), UnorderedElementsAre("ring", "ring.before"));
}

TEST_F(ABlackBoxKeeper, DoesNotKeepAnEmptyRing) {
  start();
  const auto keeper = start();
  for (int tries = 0; tries < 10'000 && names().size() > 1; ++tries) {
    keeper->poll(now_ns);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  keeper->finish();
  EXPECT_THAT(keeper->take_notes(), ElementsAre());
  EXPECT_THAT(names(), ElementsAre("ring"));
}

TEST_F(ABlackBoxKeeper, SavesNoneWithoutIncidents) {
  drive_on(*start(0), 100);
  const auto keeper = start(0);
  drive_on(*keeper, 100);
  loop.e_stop();
  drive_on(*keeper, 100);
  keeper->finish();
  EXPECT_THAT(names(), UnorderedElementsAre("ring", "ring.before"));
}

TEST_F(ABlackBoxKeeper, IsRefusedInTheFolderOfAnotherOne) {
  const auto keeper = start();
  EXPECT_THAT([this] { start(); }, ThrowsMessage<LogError>(HasSubstr("is written by another telemetry")));
  EXPECT_THAT(names(), ElementsAre("ring")) << "it is still there";
}

TEST_F(ABlackBoxKeeper, SaysWhereAnIncidentCannotBeSaved) {
  const auto keeper = start();
  drive_on(*keeper, 500);
  std::filesystem::create_directories(folder.path() / "box" / "stop.1.bag" / "in the way");
  std::filesystem::create_directories(folder.path() / "box" / "saving" / "run.bag");
  loop.e_stop();
  drive_on(*keeper, 10);
  keeper->finish();
  EXPECT_THAT(keeper->take_notes(), ElementsAre(HasSubstr("not saved (e_stop_service): ")));
}

}  // namespace robot_control::tests
