#pragma once
/// The message with which a bus refuses.

#include <string>

#include "bus/bus.h"

namespace robot_control {

/// "" if it does not refuse.
template <class Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const BusError& error) {
    return error.what();
  }
  return {};
}

}  // namespace robot_control
