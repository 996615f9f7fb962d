#pragma once
/// A Publisher is a publisher of an input topic: one connection of one node.

#include <boost/shared_ptr.hpp>
#include <string>

namespace robot_control {

struct Publisher {
  std::string name;                               ///< name of the node
  boost::shared_ptr<const void> connection = {};  ///< an object that roscpp keeps until the connection has ended
  std::string uri = {};                           ///< address of its XML-RPC server, host and port; empty: not known
  std::string topic = {};                         ///< to which the connection belongs
};

/// Returns whether two publishers are one process. A restarted node has another URI. If one URI is not known, equal
/// names count as one process.
inline bool same_process(const Publisher& one, const Publisher& other) {
  return one.name == other.name && (one.uri == other.uri || one.uri.empty() || other.uri.empty());
}

}  // namespace robot_control
