#pragma once
/// One word for a request and its response, in the two forms in which roscpp asks for it. The generated service headers
/// that would say it cannot be included in C++20, see messages.h.

namespace robot_control {

/// `Word::kText` is a hash (`rossrv md5 SERVICE`, of what stands in the .srv file, comments aside) or a type.
template <class Word>
struct ServiceText {
  static const char* value() { return Word::kText; }
  template <class Message>
  static const char* value(const Message&) {
    return Word::kText;
  }
};

}  // namespace robot_control
