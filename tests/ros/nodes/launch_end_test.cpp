#include "ros/nodes/launch_end.h"

#include <gtest/gtest.h>

namespace robot_control::tests {

using namespace std::string_literals;

TEST(LaunchEnd, KnowsRoslaunchByItsProgramAlone) {
  EXPECT_TRUE(is_roslaunch("/usr/bin/python3\0/usr/bin/roslaunch\0robot_control\0sim.launch\0"s));
  EXPECT_TRUE(is_roslaunch("roslaunch\0"s));
  EXPECT_FALSE(is_roslaunch("/usr/bin/python3\0/usr/bin/rostest\0roslaunch\0"s));
  EXPECT_FALSE(is_roslaunch("bash\0-c\0roslaunch robot_control sim.launch\0"s));
  EXPECT_FALSE(is_roslaunch("/usr/bin/python3\0/home/roslaunch/rosrun\0"s));
  EXPECT_FALSE(is_roslaunch(""));
}

TEST(LaunchEnd, LeavesALaunchAloneThatDoesNotAskForIt) {
  unsetenv(kEndsLaunch);
  EXPECT_FALSE(end_launch());
  setenv(kEndsLaunch, "true", 1);
  EXPECT_FALSE(end_launch()) << "this test's parent is no roslaunch";
  unsetenv(kEndsLaunch);
}

}  // namespace robot_control::tests
