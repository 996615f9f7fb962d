#pragma once
/// The message of a refusal, which must be the only output: libraries that parse would write to stderr or stdout.

#include <gtest/gtest.h>

#include "support/message_of.h"

namespace robot_control {

/// The message of the Error that `act` throws, or "accepted".
template <class Error, class Act>
std::string quiet_refusal(Act act) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  const std::string message = message_of<Error>(act, "accepted");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  return message;
}

}  // namespace robot_control
