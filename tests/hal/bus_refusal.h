#pragma once
/// What a bus says when it refuses.

#include <string>

#include "hal/bus.h"

namespace robot_control {

/// "": it does not.
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
