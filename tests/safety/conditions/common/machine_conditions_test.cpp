// The machine reports its overruns of the last second.

#include "safety/conditions/common/machine_conditions.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

/// At 1 kHz, more than 50 overruns within a second are reported after a tenth of it.
struct MachineConditionsTest : testing::Test {
  bool overruns(std::uint64_t counted, std::uint64_t cycles = 1) {
    bool reported = false;
    sensors_.overruns = counted;
    for (std::uint64_t i = 0; i < cycles; ++i) {
      active_.clear();
      facts_.step(sensors_, 1, active_);
      reported = reported || (active_.with(Reaction::kWarn) & kCauseOverruns) != 0;
    }
    return reported;
  }

  static SafetyParameters parameters() {
    SafetyParameters parameters;
    parameters.overruns = {50, 0.1, Reaction::kWarn};
    return parameters;
  }

  MachineConditions facts_{parameters(), 1e-3};
  ActiveCauses active_;
  SensorFrame sensors_;
};

TEST_F(MachineConditionsTest, OverrunsOfTheLastSecondCount) {
  EXPECT_FALSE(overruns(0, 2000));
  EXPECT_FALSE(overruns(50, 2000));
  EXPECT_TRUE(overruns(101, 200));
  overruns(101, 1000);
  EXPECT_FALSE(overruns(101, 1000));
}

TEST_F(MachineConditionsTest, AMachineThatIsReadyIsNotStarting) {
  EXPECT_FALSE(facts_.starting());
}

// A loop of 20 Hz cannot be late 50 times in a second.
TEST_F(MachineConditionsTest, OverrunsOfHalfOfTheCyclesCountInASlowLoop) {
  facts_ = MachineConditions(parameters(), 0.05);
  EXPECT_FALSE(overruns(0, 40));
  EXPECT_FALSE(overruns(10, 10));
  EXPECT_TRUE(overruns(21, 10));
}

// A monitor starts, or restarts, beside a driver that has run for hours.
TEST_F(MachineConditionsTest, OverrunsOfBeforeTheFirstLookDoNotCount) {
  EXPECT_FALSE(overruns(1000, 2000));
  EXPECT_TRUE(overruns(1051, 200));
}

TEST_F(MachineConditionsTest, ANewRunRestartsTheCount) {
  overruns(1000, 2000);
  facts_.enter_run();
  EXPECT_FALSE(overruns(0, 100));
  EXPECT_TRUE(overruns(51, 200));
}

}  // namespace robot_control::tests
