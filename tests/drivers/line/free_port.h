#pragma once
/// A UDP port of the loopback for a test.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include "files/descriptor.h"

namespace robot_control::tests {

/// A port of the loopback that was free a moment ago.
inline std::uint16_t free_port() {
  const Descriptor probe(socket(AF_INET, SOCK_DGRAM, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const generic = static_cast<sockaddr*>(static_cast<void*>(&address));
  EXPECT_EQ(bind(probe.number(), generic, size), 0);
  EXPECT_EQ(getsockname(probe.number(), generic, &size), 0);
  return ntohs(address.sin_port);
}

}  // namespace robot_control::tests
