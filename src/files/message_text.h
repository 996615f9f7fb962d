#pragma once
/// These functions prepare text from outside for a message.
///
/// A message repeats at most kMaxEcho bytes of an input and no control character. A name of a megabyte, a NUL or an
/// escape sequence of the terminal must not reach the screen.

#include <string>
#include <string_view>

namespace robot_control {

inline constexpr std::size_t kMaxEcho = 200;       ///< bytes
inline constexpr std::size_t kMaxSentence = 1500;  ///< bytes of a sentence with several inputs

/// Replaces control characters and bytes that are no UTF-8 by \xNN. A text of more than `max_bytes` is cut between two
/// characters, and … is added.
std::string printable(std::string_view text, std::size_t max_bytes = kMaxEcho);

/// Returns the number of bytes from the beginning that are valid UTF-8.
std::size_t utf8_end(std::string_view text);

/// Prepares a complete sentence that contains inputs. `printable` cuts every word and every quoted part at kMaxEcho;
/// the sentence is cut at kMaxSentence. Line breaks are kept.
std::string fit_for_message(std::string_view sentence);

}  // namespace robot_control
