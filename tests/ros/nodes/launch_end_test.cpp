#include "ros/nodes/launch_end.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>

#include "support/processes/child_process.h"

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

TEST(LaunchEnd, KnowsTheFirstOfSeveralProcessesThatRefuse) {
  std::array<int, 2> answered{};
  ASSERT_EQ(pipe(answered.data()), 0);
  const ChildProcess first([&] {
    const char answer = first_to_refuse() ? 'y' : 'n';
    if (::write(answered[1], &answer, 1) == 1) pause();
    return 0;
  });
  char answer = 0;
  ASSERT_EQ(::read(answered[0], &answer, 1), 1);
  EXPECT_EQ(answer, 'y');
  EXPECT_EQ(ChildProcess([] { return first_to_refuse() ? 1 : 0; }).wait(), 0) << "the first one lives";
}

}  // namespace robot_control::tests
