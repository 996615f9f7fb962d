#pragma once
/// Text from outside made fit for a message.
///
/// A message repeats at most kMaxEcho characters of any one input, and no control character as it is: a name of a
/// megabyte, a NUL or an escape sequence of the terminal in a file must not reach the screen.

#include <string>
#include <string_view>

namespace robot_control {

inline constexpr std::size_t kMaxEcho = 200;       ///< bytes
inline constexpr std::size_t kMaxSentence = 1500;  ///< bytes, of a sentence with several inputs in it

/// Control characters and bytes that are no UTF-8 as \xNN, cut after at most `most` bytes of the input, between
/// characters, with … behind.
std::string printable(std::string_view text, std::size_t max_bytes = kMaxEcho);

/// Bytes from the beginning that are UTF-8: all, or the place of the first byte that is not.
std::size_t utf8_end(std::string_view text);

/// A whole sentence in which inputs stand already: every word and every quoted part longer than kMaxEcho is cut as
/// by `printable`, the sentence at kMaxSentence. Lines stay lines.
std::string fit_for_message(std::string_view sentence);

}  // namespace robot_control
