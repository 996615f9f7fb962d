#pragma once
/// GoogleTest and GoogleMock, with the names of the matchers that most tests use.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace robot_control {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Optional;
using ::testing::SizeIs;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;
using ::testing::UnorderedElementsAre;

}  // namespace robot_control
