#include "drivers/line/udp_socket.h"

#include <gtest/gtest.h>

#include <array>

#include "drivers/driver.h"
#include "drivers/line/free_port.h"
#include "support/allocation_guard.h"
#include "support/matchers.h"
#include "support/message_of.h"

namespace robot_control::tests {

using Bytes = std::array<std::uint8_t, 4>;

struct UdpSocketTest : testing::Test {
  const std::string device_ = "127.0.0.1:" + std::to_string(free_port());
  const std::uint16_t port_ = free_port();
};

TEST(UdpAddress, IsFourNumbersAndAPort) {
  for (const char* good : {"192.168.123.10:8007", "127.0.0.1:1", "10.0.0.1:65535"})
    EXPECT_TRUE(udp_address(good)) << good;
  for (const char* bad : {"", ":8007", "192.168.123.10", "192.168.123.10:", "192.168.123.10:0", "192.168.123.10:65536",
                          "192.168.123:8007", "go1:8007", "192.168.123.10:80x", "192.168.123.10:-1"})
    EXPECT_FALSE(udp_address(bad)) << bad;
}

TEST_F(UdpSocketTest, ADatagramEachWayArrivesWholeAndNothingBlocks) {
  const auto robot = UdpSocket::device_end(device_);
  const auto host = UdpSocket::host_end(device_, port_);
  Bytes bytes{};
  EXPECT_EQ(robot->receive(bytes), 0U);
  EXPECT_FALSE(robot->send(bytes)) << "there is no sender yet";
  const AllocationGuard guard;
  ASSERT_TRUE(host->send(Bytes{1, 2, 3, 4}));
  ASSERT_EQ(robot->receive(bytes), 4U);
  EXPECT_EQ(bytes, (Bytes{1, 2, 3, 4}));
  ASSERT_TRUE(robot->send(Bytes{5, 6, 7, 8}));
  ASSERT_EQ(host->receive(bytes), 4U);
  EXPECT_EQ(bytes, (Bytes{5, 6, 7, 8}));
  EXPECT_EQ(host->receive(bytes), 0U);
  EXPECT_EQ(guard.count(), 0U);
}

TEST_F(UdpSocketTest, EmptyDatagramsDelayNothing) {
  const auto robot = UdpSocket::device_end(device_);
  const auto host = UdpSocket::host_end(device_, port_);
  Bytes bytes{};
  ASSERT_TRUE(host->send(Bytes{1}));
  ASSERT_EQ(robot->receive(bytes), 4U);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(robot->send({}));
  ASSERT_TRUE(robot->send(Bytes{2}));
  ASSERT_EQ(host->receive(bytes), 4U);
  EXPECT_EQ(bytes[0], 2);
}

TEST_F(UdpSocketTest, TheSizeOfALongerDatagramIsKnown) {
  const auto robot = UdpSocket::device_end(device_);
  const auto host = UdpSocket::host_end(device_, port_);
  ASSERT_TRUE(host->send(std::array<std::uint8_t, 10>{9}));
  Bytes bytes{};
  EXPECT_EQ(robot->receive(bytes), 10U);
  EXPECT_EQ(bytes[0], 9);
}

TEST_F(UdpSocketTest, ADatagramOfAnotherSenderIsNotTaken) {
  const auto host = UdpSocket::host_end(device_, port_);
  const auto stranger = UdpSocket::host_end("127.0.0.1:" + std::to_string(port_), free_port());
  ASSERT_TRUE(stranger->send(Bytes{1}));
  Bytes bytes{};
  EXPECT_EQ(host->receive(bytes), 0U);
}

TEST_F(UdpSocketTest, AnAbsentRobotIsSilence) {
  const auto host = UdpSocket::host_end(device_, port_);
  Bytes bytes{};
  for (int i = 0; i < 3; ++i) {
    host->send(bytes);
    EXPECT_EQ(host->receive(bytes), 0U);
  }
  const auto robot = UdpSocket::device_end(device_);
  host->send(bytes);  // reports that the last one was refused
  EXPECT_TRUE(host->send(bytes));
  EXPECT_EQ(robot->receive(bytes), 4U);
}

TEST_F(UdpSocketTest, WhatCannotBeUsedIsNamed) {
  const auto host = UdpSocket::host_end(device_, port_);
  EXPECT_THAT(
      message_of<DriverError>([&] { UdpSocket::host_end(device_, port_); }),
      AllOf(HasSubstr("UDP " + device_), HasSubstr("port " + std::to_string(port_)), HasSubstr("stop the program")));
  EXPECT_THAT(message_of<DriverError>([&] { UdpSocket::host_end("go1", port_); }), HasSubstr("IPV4:PORT"));
  EXPECT_THAT(message_of<DriverError>([] { UdpSocket::device_end("203.0.113.1:8007"); }),
              HasSubstr("an address of this computer"));
}

}  // namespace robot_control::tests
