/// The memory of a channel is unlinked, cut off, or overwritten at full speed.

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <initializer_list>
#include <random>

#include "losses_fixture.h"

namespace robot_control::tests {

using enum LoopNode;

constexpr unsigned bits(std::initializer_list<LoopNode> nodes) {
  unsigned all = 0;
  for (const LoopNode node : nodes) all |= 1U << index_of(node);
  return all;
}

struct Channel {
  const char* name;
  LoopNode writer;
  unsigned mapped;    ///< by whom, the writer included: one bit for each node
  bool by_this_test;  ///< which would end with them
};

// Every node and this test map the first one; every node but not this test maps the second. The plant does not map the
// third: it lives on and brakes.
const Channel kChannels[] = {
    {"sensors", kPlant, bits({kPlant, kEstimator, kController, kMonitor}), true},
    {"state", kEstimator, bits({kEstimator, kController, kMonitor, kPlant}), false},
    {"trace_monitor", kMonitor, bits({kMonitor}), false},
};

const Channel kNightlyChannels[] = {
    {"command", kController, bits({kController, kPlant, kMonitor}), false},
    {"permit", kMonitor, bits({kMonitor, kPlant, kController}), true},
    {"truth", kPlant, bits({kPlant}), true},
    {"trace_plant", kPlant, bits({kPlant}), true},
    {"trace_estimator", kEstimator, bits({kEstimator}), false},
    {"trace_controller", kController, bits({kController}), false},
};

void PrintTo(const Channel& channel, std::ostream* out) {
  *out << channel.name;
}

struct AWoundedChannel : Losses, ::testing::WithParamInterface<Channel> {
  const char* channel() const { return GetParam().name; }
  std::filesystem::path file() { return "/dev/shm" + bus_object_name(nodes().bus(), channel()); }
  bool maps(LoopNode node) const { return (GetParam().mapped & bits({node})) != 0; }

  void overwrite_with_random_bytes(std::uint64_t seed) {
    const int descriptor = open(file().c_str(), O_RDWR | O_CLOEXEC);
    struct stat status {};
    ASSERT_EQ(fstat(descriptor, &status), 0) << file();
    std::mt19937_64 random(seed);
    std::vector<std::uint64_t> bytes(static_cast<std::size_t>(status.st_size) / sizeof(std::uint64_t));
    for (std::uint64_t& word : bytes) word = random();
    EXPECT_EQ(pwrite(descriptor, bytes.data(), bytes.size() * 8, 0), static_cast<ssize_t>(bytes.size() * 8));
    close(descriptor);
  }

  /// The robot brakes permanently or drives as before: never on numbers that no node wrote.
  void expect_brakes_or_drives_on(std::uint64_t before) {
    robot_.await([&] { return log().rested(DrivingRobot::kRestCycles) || !nodes().lives(LoopNode::kPlant); }, 1.0);
    if (!nodes().lives(LoopNode::kPlant)) return;
    expect_no_jump();
    if (!log().rested(DrivingRobot::kRestCycles)) return expect_drives_on(300);
    const std::uint64_t braked = *log().braking_since();
    std::printf("  %s: brake after %llu cycles\n", channel(), static_cast<unsigned long long>(braked - before));
    EXPECT_LE(braked, before + kBrakeWithin);
  }
};

TEST_P(AWoundedChannel, UnlinkedIsStillSharedAndItsNextWriterIsFound) {
  std::filesystem::remove(file());
  expect_undisturbed();
  if (GetParam().writer == kPlant) {
    nodes().end(kPlant);
  } else {
    robot_.lose(GetParam().writer, SIGKILL);
  }
  robot_.restart(GetParam().writer);
  EXPECT_TRUE(robot_.await([&] { return log().rested(DrivingRobot::kRestCycles); })) << robot_.situation();
  robot_.drive_at_full_speed();
  expect_undisturbed();
}

TEST_P(AWoundedChannel, CutOffEndsThoseAloneWhoMapItAndTheRobotBrakes) {
  const std::uint64_t before = robot_.cycle();
  if (GetParam().by_this_test) robot_.close_channels();
  std::filesystem::resize_file(file(), 0);
  EXPECT_TRUE(robot_.await([&] { return !nodes().lives(GetParam().writer); })) << "its writer does not notice";
  if (!maps(kPlant)) {
    EXPECT_TRUE(robot_.await([&] { return log().rested(DrivingRobot::kRestCycles); })) << robot_.situation();
    EXPECT_LE(log().braking_since().value_or(before + 1000), before + kBrakeWithin) << robot_.situation();
  }
  std::string ended;
  for (const LoopNode node : kLoop) {
    if (!maps(node)) {
      expect_lives(node);
    } else if (!nodes().lives(node)) {
      ended.append(" ").append(name_of(node));
      expect_crash_report(node, SIGBUS, "SIGBUS");
    }
  }
  std::printf("  %s: ended by SIGBUS:%s\n", channel(), ended.c_str());
  robot_.restart_all();
  robot_.reopen_channels();
  robot_.drive_at_full_speed();
  expect_undisturbed();
}

TEST_P(AWoundedChannel, OverwrittenIsNotTrusted) {
  const std::uint64_t before = robot_.cycle();
  log().forget();
  robot_.keep_mappings();
  overwrite_with_random_bytes(before);
  expect_brakes_or_drives_on(before);
  for (const LoopNode node : kLoop) {
    if (nodes().lives(node)) continue;
    std::printf("  %s: %s ends\n", channel(), name_of(node));
    EXPECT_EQ(nodes().process(node).code(), 1) << name_of(node) << ":\n" << nodes().said(node);
    EXPECT_NE(nodes().said(node).find(std::string("channel '") + channel()), std::string::npos) << nodes().said(node);
  }
  robot_.restart_all();
  robot_.reopen_channels();
  robot_.drive_at_full_speed();
  expect_undisturbed();
}

INSTANTIATE_TEST_SUITE_P(Each, AWoundedChannel, ::testing::ValuesIn(kChannels),
                         [](const auto& each) { return std::string(each.param.name); });
INSTANTIATE_TEST_SUITE_P(Nightly, AWoundedChannel, ::testing::ValuesIn(kNightlyChannels),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace robot_control::tests
