#pragma once
/// Fills the response of a service that answers with `success` and `message`.

#include <string>

#include "files/ascii.h"

namespace robot_control {

/// Returns true: roscpp then sends the response.
template <class Response>
bool answer(Response& response, bool success, const std::string& text) {
  response.success = success ? 1 : 0;
  response.message = ascii(text);
  return true;
}

}  // namespace robot_control
