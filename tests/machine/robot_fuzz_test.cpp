/// A URDF with any changes is read as a consistent robot, or refused by a message.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "machine/bodies/rigid_bodies.h"
#include "machine/random_text.h"
#include "machine/urdf_text.h"
#include "signals/joint.h"
#include "support/robots/diffbot_urdf.h"

namespace robot_control::tests {

// A reading takes about 0.3 ms, ten times that in a sanitizer build: the time ends the test, not the count.
constexpr int kRounds = 4000;
constexpr std::chrono::seconds kEnough{4};

/// [begin, end) of a random quoted value; empty when there is none.
std::pair<std::size_t, std::size_t> quoted(const std::string& text, Random& random) {
  const std::size_t open = text.find("=\"", below(random, text.size()));
  if (open == std::string::npos) return {0, 0};
  const std::size_t close = text.find('"', open + 2);
  return close == std::string::npos ? std::pair<std::size_t, std::size_t>{0, 0} : std::pair{open + 2, close};
}

/// [begin, end) of a random tag.
std::pair<std::size_t, std::size_t> tag(const std::string& text, Random& random) {
  const std::size_t open = text.find('<', below(random, text.size()));
  if (open == std::string::npos) return {0, 0};
  const std::size_t close = text.find('>', open);
  return close == std::string::npos ? std::pair<std::size_t, std::size_t>{0, 0} : std::pair{open, close + 1};
}

std::string mutated(std::string text, Random& random) {
  static const std::vector<std::string> kValues{
      "",     "0",     "-1",        "1e308",    "-1e308",    "nan",        "inf",      "1e-320",   "1 2",
      "x",    "0 0 0", "1e9 0 0",   "0 0 1e-9", "base_link", "left_wheel", "fixed",    "floating", "revolute",
      "9e99", "true",  "prismatic", "180",      "-180",      "1,5",        "\xff\xfe", "0x10",     "left_wheel_link"};
  switch (below(random, 6)) {
    case 0:  // a byte
      if (!text.empty()) text[below(random, text.size())] = static_cast<char>(below(random, 256));
      return text;
    case 1:  // the end
      return text.substr(0, below(random, text.size()));
    case 2: {  // a value for another
      const auto [begin, end] = quoted(text, random);
      return text.replace(begin, end - begin, kValues[below(random, kValues.size())]);
    }
    case 3: {  // two values change places
      const auto [a, a_end] = quoted(text, random);
      const auto [b, b_end] = quoted(text, random);
      const std::string value = text.substr(b, b_end - b);
      return text.replace(a, a_end - a, value);
    }
    case 4: {  // a tag goes
      const auto [begin, end] = tag(text, random);
      return text.erase(begin, end - begin);
    }
    default: {  // a tag comes twice
      const auto [begin, end] = tag(text, random);
      return text.insert(begin, text.substr(begin, end - begin));
    }
  }
}

void expect_sound(const DriveTrain& robot) {
  ASSERT_NE(robot.bodies, nullptr);
  ASSERT_GE(robot.wheels.size(), 2u);
  EXPECT_EQ(robot.wheels.size() % 2, 0u);
  EXPECT_LE(robot.wheels.size(), kMaxWheels);
  EXPECT_LE(robot.joints.size(), kMaxJoints);
  EXPECT_EQ(robot.joints.size(), robot.bodies->moving_joints.size());
  EXPECT_EQ(robot.bodies->bodies.size(), robot.joints.size() + 1);
  EXPECT_TRUE(robot.mass > 0 && std::isfinite(robot.mass));
  EXPECT_TRUE(robot.wheel_base > 0 && std::isfinite(robot.wheel_base));
  EXPECT_TRUE(robot.wheel_base_multiplier >= 1 && std::isfinite(robot.wheel_base_multiplier));
  EXPECT_TRUE(robot.yaw_inertia > 0 && std::isfinite(robot.yaw_inertia));
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    const WheelModel& wheel = robot.wheels[i];
    EXPECT_EQ(wheel.joint, i);
    EXPECT_TRUE(wheel.radius > 0 && std::isfinite(wheel.radius));
    EXPECT_TRUE(wheel.inertia > 0 && std::isfinite(wheel.inertia));
    EXPECT_TRUE(robot.joints[i].effort_limit > 0 && std::isfinite(robot.joints[i].effort_limit));
    EXPECT_EQ(wheel.side, i < robot.wheels.size() / 2 ? Side::kLeft : Side::kRight);
  }
  for (const RigidBody& body : robot.bodies->bodies) {
    EXPECT_TRUE(body.mass > 0 && std::isfinite(body.mass)) << body.name;
    EXPECT_TRUE(body.inertia.allFinite() && body.centre_of_gravity.allFinite()) << body.name;
  }
}

std::vector<RobotDescription> seeds() {
  return {diffbot_urdf(),
          robot_of(two_wheels() + wheel("rear_left", "-0.3 0.25 0") + wheel("rear_right", "-0.3 -0.25 0") +
                   transmission("left") + transmission("right")),
          robot_of(two_wheels() + link("arm", inertial("1")) +
                   joint({.name = "arm_joint",
                          .child = "arm",
                          .type = "revolute",
                          .rest = "<limit lower=\"-1\" upper=\"1\" effort=\"5\" velocity=\"1\"/><mimic "
                                  "joint=\"left\"/><dynamics damping=\"1\" friction=\"1\"/>"}) +
                   link("slide", "<visual><geometry><mesh filename=\"x.stl\" scale=\"1 1 1\"/></geometry></visual>") +
                   joint({.name = "slide_joint",
                          .child = "slide",
                          .type = "prismatic",
                          .axis = "<axis xyz=\"0 0 1\"/>",
                          .rest = "<limit lower=\"0\" upper=\"1\" effort=\"5\" velocity=\"1\"/>",
                          .parent = "arm"}))};
}

TEST(RobotFuzz, AMutatedUrdfIsARobotOrAMessage) {
  const std::vector<RobotDescription> originals = seeds();
  const auto end = std::chrono::steady_clock::now() + kEnough;
  int accepted = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < kRounds && std::chrono::steady_clock::now() < end; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    RobotDescription description = originals[seed % originals.size()];
    const std::size_t mutations = 1 + below(random, 3);
    for (std::size_t i = 0; i < mutations; ++i) description.text = mutated(description.text, random);
    try {
      expect_sound(read_drive_train(description, {}));
      ++accepted;
    } catch (const RobotError& error) {
      EXPECT_NE(std::string(error.what()).find(description.source), std::string::npos) << error.what();
      ++refused;
    }
    if (testing::Test::HasFailure()) FAIL() << "seed " << seed << ":\n" << description.text;
  }
  EXPECT_GT(accepted, 0);
  EXPECT_GT(refused, 0);
  RecordProperty("accepted", accepted);
  RecordProperty("refused", refused);
}

}  // namespace robot_control::tests
