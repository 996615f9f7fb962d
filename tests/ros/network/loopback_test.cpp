// Checks the address of a socket that was bound to every address.
#include "ros/network/loopback.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>

namespace robot_control::tests {

/// The healthy case is a process that has requested it, with ROS on the loopback.
struct LoopbackTest : testing::Test {
  LoopbackTest() {
    bind_as_ros_is_configured();
    unsetenv("ROS_HOSTNAME");
    setenv("ROS_IP", "127.0.0.1", 1);
  }
  ~LoopbackTest() override {
    unsetenv("ROS_HOSTNAME");
    unsetenv("ROS_IP");
  }

  /// IPv4 address of a socket bound to `wanted` and any port.
  static std::string bound_to(const char* wanted) {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    inet_pton(AF_INET, wanted, &address.sin_addr);
    EXPECT_EQ(bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    socklen_t length = sizeof(address);
    getsockname(socket, reinterpret_cast<sockaddr*>(&address), &length);
    close(socket);
    std::string text(INET_ADDRSTRLEN, '\0');
    inet_ntop(AF_INET, &address.sin_addr, text.data(), INET_ADDRSTRLEN);
    return text.c_str();
  }
};

TEST_F(LoopbackTest, EveryAddressBecomesTheLoopback) {
  EXPECT_EQ(bound_to("0.0.0.0"), "127.0.0.1");
}

TEST_F(LoopbackTest, AnAddressThatIsNamedStays) {
  EXPECT_EQ(bound_to("127.0.0.2"), "127.0.0.2");
}

TEST_F(LoopbackTest, WithoutAWordEveryAddressStays) {
  unsetenv("ROS_IP");
  EXPECT_EQ(bound_to("0.0.0.0"), "0.0.0.0");
}

TEST_F(LoopbackTest, OnANetworkEveryAddressStays) {
  setenv("ROS_IP", "192.0.2.7", 1);
  EXPECT_EQ(bound_to("0.0.0.0"), "0.0.0.0");
}

// As in ROS, ROS_HOSTNAME takes precedence over ROS_IP.
TEST_F(LoopbackTest, TheHostNameIsAskedFirst) {
  setenv("ROS_HOSTNAME", "robot", 1);
  EXPECT_FALSE(listens_on_the_loopback_alone());
  setenv("ROS_HOSTNAME", "localhost", 1);
  EXPECT_TRUE(listens_on_the_loopback_alone());
  setenv("ROS_HOSTNAME", "", 1);
  EXPECT_TRUE(listens_on_the_loopback_alone());
}

TEST_F(LoopbackTest, ARefusalOfTheKernelIsPassedOn) {
  const sockaddr_in address{};
  EXPECT_EQ(bind(-1, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), -1);
  EXPECT_EQ(errno, EBADF);
}

}  // namespace robot_control::tests
