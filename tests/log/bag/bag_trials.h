#pragma once
/// Each seed gives one damaged bag: bits flipped, lengths overwritten, bytes removed or inserted, records exchanged,
/// repeated or removed, cut off, foreign. BagReader is right with the verdict
///   refused    with byte and field
///   accepted   every connection, time and content of a message is that of the undamaged bag
///   cut        the same of what is read, which is the begin of the undamaged bag
/// within a processor time and a memory that follow from the file's size.

#include <cstdint>
#include <optional>
#include <string>

namespace robot_control {

struct BagFigures {
  std::uint64_t refused = 0, cut = 0, whole = 0;
};

/// Describes a wrong verdict on the bag of `seed`; none if it is right. Adds to `figures`.
std::optional<std::string> bag_violation(std::uint64_t seed, BagFigures& figures);

}  // namespace robot_control
