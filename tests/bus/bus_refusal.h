#pragma once
/// The message with which a bus refuses.

#include <string>

#include "bus/bus.h"
#include "support/message_of.h"

namespace robot_control {

/// "" if it does not refuse.
template <class Call>
std::string error_of(Call call) {
  return message_of<BusError>([&] { call(); });
}

}  // namespace robot_control
