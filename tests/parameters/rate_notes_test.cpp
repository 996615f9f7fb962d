#include "configuration/rate_notes.h"

#include "parameters/parameter_file.h"
#include "support/matchers.h"

namespace robot_control::tests {

std::vector<std::string> notes_at(const std::string& rate, std::string_view block) {
  return rate_notes(read_parameters(shipped_path(), {{"robot.rate", rate, "test"}}), block);
}

TEST(RateNotes, AreNoneFromThePromisedRateOn) {
  for (const Block& block : blocks()) EXPECT_THAT(notes_at("100", block.name), IsEmpty()) << block.name;
}

TEST(RateNotes, NameTheTopicsThatComeLessOften) {
  EXPECT_THAT(notes_at("50", "mujoco_plant"), ElementsAre("at robot.rate = 50 Hz, a message per cycle is published "
                                                          "instead of: mujoco_plant.imu_rate (100 Hz)"));
  EXPECT_THAT(notes_at("20", "leg_controller"), ElementsAre("at robot.rate = 20 Hz, a message per cycle is published "
                                                            "instead of: leg_controller.state_rate (50 Hz)"));
}

TEST(RateNotes, NameTheTimeFromALossToTheBrake) {
  EXPECT_THAT(
      notes_at("20", "safety_monitor"),
      ElementsAre("at robot.rate = 20 Hz, the brake follows within 20 cycles (loss_cycles), which are 1 s, after a "
                  "node of the loop has stopped: set lower speed limits or a higher robot.rate"));
}

}  // namespace robot_control::tests
