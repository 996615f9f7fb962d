#pragma once
/// Error frames of a CAN controller in words, for messages. Source: linux/can/error.h.

#include <string>

#include "drivers/line/can_frame.h"

namespace robot_control {

/// Returns everything that the frame reports, separated by commas; "" of a frame without an identifier.
std::string can_error_words(const can_frame& error);

}  // namespace robot_control
