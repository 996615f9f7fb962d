/// A robot on legs loses a node, or the chain's core, while its body sways and while it trots. The gate folds the legs,
/// and it lies upright.

#include <cmath>
#include <numbers>

#include "control/legged/leg_controller.h"
#include "control/legged/walk/gait_table.h"
#include "hog.h"
#include "losses_fixture.h"
#include "machine/legs/leg_model.h"
#include "robots/quadruped.h"
#include "support/processes/stop_trials.h"

namespace robot_control {
namespace {

constexpr int kTrials = 20;
constexpr double kUpright = 0.15;            // rad
constexpr double kSpeed = 1.0;               // m/s, of the trot
constexpr std::uint64_t kFoldCycles = 2500;  // twice what a fold takes
constexpr std::uint64_t kUpCycles = 4500;    // until it stands, and until it trots at full speed

Parameters of_quadbot() {
  Parameters parameters = read_parameters(kParams);
  parameters.urdf = PROJECT_DIRECTORY "/urdf/quadbot.urdf";
  parameters.robot = {};
  parameters.leg_control.request_timeout = 0.5;
  return parameters;
}

class LossOfQuadbot : public ::testing::Test {
 protected:
  explicit LossOfQuadbot(const Parameters& parameters = of_quadbot())
      : robot_(parameters,
               std::make_shared<Quadruped>(parameters, read_legs(load_description(parameters.urdf), {}, {}))) {}

  /// False: a stall of this machine stopped it on the way.
  bool stand_and_sway() {
    robot_.make_ready();
    robot_.ask_for({.twist = {}, .posture = {}, .mode = {ModeKind::kStand}});
    robot_.await_cycles(2500);
    for (int k = 0; k < 30; ++k) {
      robot_.ask_for({.twist = {}, .posture = {.y = 0.04 * std::sin(std::numbers::pi * 0.02 * k)}});
      robot_.await_cycles(20);
    }
    return drives();
  }

  /// The same. Each walk ends at another phase of the gait.
  bool trot() {
    constexpr Mode kTrot{ModeKind::kGait, gait_named("trot")};
    const double period = 1000 * kGaits[gait_named("trot")].period;  // cycles
    robot_.make_ready();
    robot_.ask_for({.twist = {.linear = {kSpeed, 0, 0}}, .mode = kTrot});
    robot_.await_cycles(kUpCycles + static_cast<std::uint64_t>(period * walks_++ / kTrials));
    return drives() && robot_.speed() > 0.8 * kSpeed;
  }

  bool drives() {
    return robot_.permit().action == PermitAction::kDrive && robot_.log().last().verdict != GateVerdict::kBrake;
  }

  /// Calls `trial` until kTrials of them were measured. It returns false where a stall of this machine spoiled it.
  template <class Trial>
  void repeat(Trial trial) {
    int measured = 0;
    for (int tries = 0; tries < 2 * kTrials && measured < kTrials; ++tries) {
      if (trial()) {
        ++measured;
      } else {
        ASSERT_TRUE(disturbed_ || robot_.stalled()) << robot_.situation();
      }
      disturbed_ = false;
    }
    ASSERT_EQ(measured, kTrials);
  }

  void expect_lies() {
    const std::uint64_t from = robot_.cycle();
    robot_.await([&] { return robot_.cycle() >= from + kFoldCycles; });
    const TruthFrame truth = robot_.truth();
    const Quaternion& attitude = truth.pose_world.orientation;
    EXPECT_LE(2 * std::hypot(attitude[0], attitude[1]), kUpright);
    EXPECT_LT(truth.pose_world.position[2], lay_ + 0.02) << "it lies";
    EXPECT_TRUE(robot_.log().rested(DrivingRobot::kRestCycles)) << robot_.situation();
  }

  /// Loses the node in each of the trials, which begin by `move`.
  template <class Move>
  void expect_folds(const LossCell& cell, Move move) {
    std::vector<double> cycles;
    repeat([&] {
      if (!move()) return false;
      const MeasuredStop stop = robot_.lose(cell.node, cell.signal);
      expect_lies();
      disturbed_ = !stop.measured();
      if (!disturbed_) cycles.push_back(static_cast<double>(stop.cycles));
      robot_.bring_back(cell.node, cell.signal);
      EXPECT_TRUE(robot_.await([&] { return robot_.permit().state == SupervisorState::kStopped; }))
          << robot_.situation();
      return !disturbed_;
    });
    if (cycles.empty()) return;
    std::printf("  %s: brake after %.0f cycles, at most %.0f\n", to_text(cell).c_str(), median_of(cycles),
                greatest_of(cycles));
    EXPECT_LE(greatest_of(cycles), kBrakeWithin);
  }

  DrivingRobot robot_;
  int walks_ = 0;
  bool disturbed_ = false;  ///< this machine spoiled the trial
  double lay_ = [this] {
    robot_.make_ready();
    return robot_.truth().pose_world.position[2];
  }();
};

class SwayingQuadbot : public LossOfQuadbot, public ::testing::WithParamInterface<LossCell> {};

TEST_P(SwayingQuadbot, FoldsWithin20CyclesAndLiesUpright) {
  expect_folds(GetParam(), [this] { return stand_and_sway(); });
}

INSTANTIATE_TEST_SUITE_P(Nightly, SwayingQuadbot, ::testing::ValuesIn(kLossCells),
                         [](const auto& each) { return to_name(each.param); });

class TrottingQuadbot : public LossOfQuadbot, public ::testing::WithParamInterface<LossCell> {};

TEST_P(TrottingQuadbot, FoldsWithin20CyclesAndLiesUpright) {
  expect_folds(GetParam(), [this] { return trot(); });
}

INSTANTIATE_TEST_SUITE_P(Nightly, TrottingQuadbot, ::testing::ValuesIn(kLossCells),
                         [](const auto& each) { return to_name(each.param); });

class PlantOfATrottingQuadbot : public LossOfQuadbot, public ::testing::WithParamInterface<int> {};

/// Its time stands still while it is stopped. A new one begins with a robot that lies.
TEST_P(PlantOfATrottingQuadbot, BrakesInItsFirstCyclesAndTheRobotLies) {
  repeat([&] {
    if (!trot()) return false;
    robot_.nodes().process(LoopNode::kPlant).send(GetParam());
    EXPECT_TRUE(robot_.await([&] { return (robot_.permit().causes & kCauseDriverLost) != 0; })) << robot_.situation();
    const std::uint64_t stood = GetParam() == SIGSTOP ? robot_.cycle() : 0;
    robot_.log().forget();
    robot_.bring_back(LoopNode::kPlant, GetParam());
    EXPECT_TRUE(robot_.await([&] { return robot_.log().rested(DrivingRobot::kRestCycles); })) << robot_.situation();
    EXPECT_LE(*robot_.log().braking_since(), stood + 2) << "the first cycles find the latched permit";
    expect_lies();
    return true;
  });
}

INSTANTIATE_TEST_SUITE_P(Nightly, PlantOfATrottingQuadbot, ::testing::Values(SIGKILL, SIGSTOP),
                         [](const auto& each) { return name_of_signal(each.param); });

class NightlyLateNode : public LossOfQuadbot, public ::testing::WithParamInterface<LoopNode> {};

/// The gate holds the last command for 3 cycles and then folds; the node that comes back finds a robot that trots.
TEST_P(NightlyLateNode, ATrottingRobotWalksOnAfterItWasLateBy12Cycles) {
  constexpr std::int64_t kLate = 12'000'000;  // ns; 20 cycles latch
  repeat([&] {
    if (!trot()) return false;
    robot_.nodes().process(GetParam()).send(SIGSTOP);
    sleep_ns(kLate);
    robot_.nodes().process(GetParam()).send(SIGCONT);
    robot_.await_cycles(1000);
    const bool walks = drives() && robot_.speed() > 0.8 * kSpeed;
    if (!walks) {
      EXPECT_TRUE(robot_.stalled()) << robot_.situation();
    }
    return walks;
  });
}

INSTANTIATE_TEST_SUITE_P(OfTheChain, NightlyLateNode,
                         ::testing::Values(LoopNode::kController, LoopNode::kEstimator, LoopNode::kMonitor));

/// The chain runs on core 0, the test elsewhere.
class HogOfATrottingQuadbot : public LossOfQuadbot {
 protected:
  static Parameters on_one_core() {
    Parameters parameters = of_quadbot();
    parameters.loop.core = 0;
    return parameters;
  }
  HogOfATrottingQuadbot() : LossOfQuadbot(on_one_core()) {}

  void SetUp() override {
    if (off_.problem != nullptr) GTEST_SKIP() << off_.problem;
  }

  OffTheChain off_;
};

TEST_F(HogOfATrottingQuadbot, NightlyAtTheControllersPriorityStarvesItAndTheRobotLiesUpright) {
  repeat([&] {
    Hog hog(static_cast<int>(LoopPriority::kController), 0);
    if (!trot()) return false;
    robot_.log().forget();
    const std::uint64_t before = robot_.cycle();
    hog.begin();
    const bool rests = robot_.await([&] { return robot_.log().rested(DrivingRobot::kRestCycles); }, kHogSeconds);
    hog.end();
    EXPECT_TRUE(rests) << robot_.situation();
    EXPECT_LE(robot_.log().braking_since().value_or(before + 1000), before + kBrakeWithin);
    expect_lies();
    return true;
  });
}

}  // namespace
}  // namespace robot_control
