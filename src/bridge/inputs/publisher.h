#pragma once
/// A publisher of an input topic: one connection of one node.

#include <boost/shared_ptr.hpp>
#include <string>

namespace robot_control {

struct Publisher {
  std::string name;                               ///< of its node
  boost::shared_ptr<const void> connection = {};  ///< what roscpp keeps for the connection until it has ended
  std::string uri = {};                           ///< of its XML-RPC server, host and port; empty: not known
};

/// A restarted node has another URI. Where one of the two is not known, equal names are one process.
inline bool same_process(const Publisher& one, const Publisher& other) {
  return one.name == other.name && (one.uri == other.uri || one.uri.empty() || other.uri.empty());
}

}  // namespace robot_control
