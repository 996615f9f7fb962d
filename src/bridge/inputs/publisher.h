#pragma once
/// A publisher of an input topic.

#include <boost/shared_ptr.hpp>
#include <string>

namespace robot_control {

struct Publisher {
  std::string name;                          ///< of its node
  boost::shared_ptr<const void> connection;  ///< not null; what roscpp keeps for the connection until it has ended
};

}  // namespace robot_control
