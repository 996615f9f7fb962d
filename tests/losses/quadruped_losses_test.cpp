/// A node of a robot on legs is killed or stopped while its body sways: the gate folds the legs, and it lies upright.

#include <cmath>
#include <numbers>

#include "control/legged/leg_controller.h"
#include "losses_fixture.h"
#include "machine/legs/leg_model.h"
#include "robots/quadruped.h"
#include "support/stop_trials.h"

namespace robot_control {
namespace {

constexpr int kTrials = 20;
constexpr double kUpright = 0.15;            // rad
constexpr std::uint64_t kFoldCycles = 2500;  // twice what a fold takes

Parameters of_quadbot() {
  Parameters parameters = read_parameters(kParams);
  parameters.urdf = PROJECT_DIRECTORY "/urdf/quadbot.urdf";
  parameters.robot = {};
  parameters.leg_control.request_timeout = 0.5;
  return parameters;
}

class SwayingQuadbot : public ::testing::TestWithParam<LossCell> {
 protected:
  static DrivingRobot robot() {
    const Parameters parameters = of_quadbot();
    return DrivingRobot(parameters,
                        std::make_shared<Quadruped>(parameters, read_legs(load_description(parameters.urdf), {}, {})));
  }

  /// False: a stall of this machine stopped it on the way.
  bool stand_and_sway() {
    robot_.make_ready();
    robot_.ask_for({.twist = {}, .posture = {}, .mode = kStanceStand});
    robot_.await_cycles(2500);
    for (int k = 0; k < 30; ++k) {
      robot_.ask_for({.twist = {}, .posture = {.y = 0.04 * std::sin(std::numbers::pi * 0.02 * k)}});
      robot_.await_cycles(20);
    }
    return robot_.permit().action == PermitAction::kDrive && robot_.log().last().verdict != GateVerdict::kBrake;
  }

  void bring_back() {
    robot_.bring_back(GetParam().node, GetParam().signal);
    EXPECT_TRUE(robot_.await([&] { return robot_.permit().state == SupervisorState::kStopped; })) << robot_.situation();
  }

  DrivingRobot robot_ = robot();
};

TEST_P(SwayingQuadbot, FoldsWithin20CyclesAndLiesUpright) {
  std::vector<double> cycles;
  for (int tries = 0; tries < 2 * kTrials && cycles.size() < kTrials; ++tries) {
    if (!stand_and_sway()) {
      ASSERT_TRUE(robot_.stalled()) << robot_.situation();
      continue;
    }
    const double standing = robot_.truth().pose_world.position[2];
    const MeasuredStop stop = robot_.lose(GetParam().node, GetParam().signal);
    robot_.await_cycles(kFoldCycles);
    const TruthFrame truth = robot_.truth();
    ASSERT_GT(truth.head.cycle, kFoldCycles);
    const Quaternion& attitude = truth.pose_world.orientation;
    EXPECT_LE(2 * std::hypot(attitude[0], attitude[1]), kUpright);
    EXPECT_LT(truth.pose_world.position[2], standing - 0.1) << "it lies";
    if (stop.measured()) cycles.push_back(static_cast<double>(stop.cycles));
    bring_back();
  }
  ASSERT_EQ(cycles.size(), kTrials);
  std::printf("  %s: brake after %.0f cycles, at most %.0f\n", to_text(GetParam()).c_str(), median_of(cycles),
              greatest_of(cycles));
  EXPECT_LE(greatest_of(cycles), kBrakeWithin);
}

INSTANTIATE_TEST_SUITE_P(Nightly, SwayingQuadbot, ::testing::ValuesIn(kLossCells),
                         [](const auto& each) { return to_name(each.param); });

}  // namespace
}  // namespace robot_control
