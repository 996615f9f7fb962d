#pragma once
/// The message of a refusal, and that nothing else is said: libraries that parse would write to stderr or stdout.

#include <gtest/gtest.h>

#include <string>

namespace robot_control {

/// What `act` throws as an Error, or "accepted".
template <class Error, class Act>
std::string quiet_refusal(Act act) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  std::string message = "accepted";
  try {
    act();
  } catch (const Error& error) {
    message = error.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  return message;
}

}  // namespace robot_control
