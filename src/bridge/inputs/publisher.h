#pragma once
/// A publisher of an input topic.

#include <memory>
#include <string>

namespace robot_control {

struct Publisher {
  std::string name;                        ///< of its node
  std::shared_ptr<const void> connection;  ///< not null; its address identifies the connection until it has ended
};

}  // namespace robot_control
