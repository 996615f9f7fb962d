/// `start_angle` finds errors of a drive file before any torque. Quadbot lies behind simulated drives, and the driver
/// reads a wrong file. A zero that is off by a turn of the rotor, and a sign, are found in each joint. Exchanged motors
/// are found where their joints lie at different angles; those of equal angles are left to scripts/zero_joints.py.

#include <filesystem>
#include <fstream>
#include <numbers>

#include "drivers/table/factory.h"
#include "robots/quadruped_fixture.h"
#include "simulation/machines/simulated_machine.h"
#include "support/matchers.h"

namespace robot_control::tests {

constexpr double kGear = 9;  // of the motors in the examples

class StartAngles : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    parameters_ = QuadrupedLoop::parameters(0, ErrorLevel::kIdeal);
    const std::vector<Word> words = words_of(DriverName());
    parameters_.driver = static_cast<DriverName>(std::ranges::find(words, "can", &Word::text)->value);
    std::ifstream example(PROJECT_DIRECTORY "/config/drives/" + GetParam() + ".yaml");
    text_ = {std::istreambuf_iterator<char>(example), {}};
    for (const char bus : {'0', '1', '2', '3'}) {
      const std::string address = std::string("can") + bus;
      for (std::size_t at = text_.find(address); at != std::string::npos; at = text_.find(address, at + 1))
        text_.replace(at, address.size(), "unix:" + folder_ + bus);
    }
  }
  void TearDown() override {
    for (const std::string& path : {true_, wrong_}) std::filesystem::remove(path);
    for (const char bus : {'0', '1', '2', '3'}) std::filesystem::remove_all(folder_ + bus);
  }

  const std::string& joint(std::size_t i) const { return robot_.joints[i].name; }
  double rest(std::size_t i) const { return robot_.joints[i].rest_position; }

  /// Returns the file with a key more in the block of a joint.
  std::string with(std::string text, std::size_t i, const std::string& key) const {
    const std::string head = joint(i) + ":\n";
    text.insert(text.find(head) + head.size(), "  " + key + "\n");
    return text;
  }
  std::string with_exchanged(std::size_t a, std::size_t b) const {
    const auto place = [this](std::size_t i) {
      const std::size_t at = text_.find("  bus:", text_.find(joint(i) + ":\n"));
      return std::pair{at, text_.find("\n", text_.find("  node:", at)) - at};
    };
    std::string text = text_;
    const auto [first, first_size] = place(std::min(a, b));
    const auto [second, second_size] = place(std::max(a, b));
    text.replace(second, second_size, text_.substr(first, first_size));
    text.replace(first, first_size, text_.substr(second, second_size));
    return text;
  }

  /// Returns the words of the driver that reads `wrong` on the robot of `text_`; "" if it runs. No joint may have had a
  /// torque where it does not.
  std::string refusal(const std::string& wrong) {
    std::ofstream(true_) << text_;
    std::ofstream(wrong_) << wrong;
    parameters_.drives = true_;
    const std::vector<Brake> brakes = Quadruped(parameters_, robot_).brakes();
    std::int64_t now_ns = 0;
    const auto machine = make_device_simulator(parameters_, robot_, brakes);
    parameters_.drives = wrong_;
    const auto driver =
        make_driver(parameters_, robot_, brakes, [&] { return CanTime{.time_ns = now_ns, .utc_ns = 0}; });
    driver->start();
    SensorFrame sensors;
    for (int i = 0; i < 600; ++i) {
      driver->read(sensors);
      driver->write(std::vector<JointCommand>(kLegsJoints));
      machine->step();
      now_ns += parameters_.loop.period_ns();
    }
    driver->stop();
    return sensors.driver_state == DriverState::kRunning ? "" : driver->warning();
  }

  const std::string folder_ = testing::TempDir() + "start_bus_";
  const std::string true_ = testing::TempDir() + "start_true.yaml", wrong_ = testing::TempDir() + "start_wrong.yaml";
  std::string text_;
  Parameters parameters_;
  const LegModel robot_ = legged_robot("quadbot");
};

TEST_P(StartAngles, TheRightFileRuns) {
  EXPECT_EQ(refusal(text_), "");
}

TEST_P(StartAngles, AZeroThatIsOffByATurnOfTheRotorIsRefused) {
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    const double turn = (i % 2 == 0 ? 2 : -2) * std::numbers::pi / kGear;
    EXPECT_THAT(refusal(with(text_, i, "offset: " + std::to_string(turn))),
                AllOf(HasSubstr(joint(i)), HasSubstr("fault; the drive differs from the drive file: start_angle")));
  }
}

TEST_P(StartAngles, AWrongSignIsRefused) {
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    EXPECT_THAT(refusal(with(text_, i, "direction: -1")),
                AllOf(HasSubstr(joint(i)), HasSubstr("fault; the drive differs from the drive file: start_angle")));
  }
}

TEST_P(StartAngles, ExchangedMotorsAreRefusedWhereTheirJointsLieAtOtherAngles) {
  int refused = 0;
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    const std::size_t other = (i + 3) % kLegsJoints;
    const bool differ = std::abs(rest(i) - rest(other)) > std::numbers::pi / kGear;
    const std::string words = refusal(with_exchanged(i, other));
    EXPECT_EQ(!words.empty(), differ) << joint(i) << ": " << words;
    if (!words.empty()) ++refused;
  }
  EXPECT_EQ(refused, 4);  // the hips
}

INSTANTIATE_TEST_SUITE_P(Motors, StartAngles, testing::Values("damiao", "cybergear", "ak", "moteus"),
                         [](const auto& each) { return each.param; });

}  // namespace robot_control::tests
