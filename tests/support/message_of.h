#pragma once
/// The message of a refusal.

#include <string>

namespace robot_control {

/// The message of the Error that `act` throws, or `otherwise`.
template <class Error, class Act>
std::string message_of(Act act, const char* otherwise = "") {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return otherwise;
}

}  // namespace robot_control
