#pragma once
/// An array of a received message takes no more memory than its bytes justify.
///
/// ros/serialization.h resizes an array to the length that the sender wrote, up to 2³² elements. It checks the length
/// of the message afterwards. The function here is preferred to the one there for every std::vector. It throws
/// StreamOverrunException, which roscpp catches: the message or request is refused. Every source that is compiled with
/// ROS includes this file (cmake/ros.cmake).

#include <ros/serialization.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace ros::serialization {

/// A string grows the most: 4 bytes on the wire are 32 in memory. No element of a message grows more.
inline constexpr std::uint64_t kMaxGrowth = 8;

template <class T, class Stream>
void deserialize(Stream& stream, std::vector<T>& to) {
  std::uint32_t count = 0;
  if (stream.getLength() < sizeof count) throwStreamOverrun();
  std::memcpy(&count, stream.getData(), sizeof count);
  if (std::uint64_t{count} * sizeof(T) > kMaxGrowth * (stream.getLength() - sizeof count)) throwStreamOverrun();
  VectorSerializer<T, std::allocator<T>>::read(stream, to);
}

}  // namespace ros::serialization
