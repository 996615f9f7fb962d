#include "files/message_text.h"

#include <algorithm>

namespace robot_control {
namespace {

bool continues(char c) {
  return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U;
}

/// Returns whether a character that begins with these two bytes is too long an encoding, a surrogate, or beyond
/// U+10FFFF.
bool is_forbidden(unsigned char first, unsigned char second) {
  return (first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) || (first == 0xf0 && second < 0x90) ||
         (first == 0xf4 && second >= 0x90);
}

/// Returns the number of bytes of the UTF-8 character at the beginning of `text`; 0 if there is none.
std::size_t character_bytes(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  const std::size_t bytes = first < 0x80   ? 1
                            : first < 0xc2 ? 0
                            : first < 0xe0 ? 2
                            : first < 0xf0 ? 3
                            : first < 0xf5 ? 4
                                           : 0;
  if (bytes == 0 || bytes > text.size()) return 0;
  for (std::size_t i = 1; i < bytes; ++i) {
    if (!continues(text[i])) return 0;
  }
  return bytes > 2 && is_forbidden(first, static_cast<unsigned char>(text[1])) ? 0 : bytes;
}

bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  const bool c1 = character.size() == 2 && first == 0xc2 && static_cast<unsigned char>(character[1]) < 0xa0;
  return first < 0x20 || first == 0x7f || c1;
}

void append_character(std::string& to, std::string_view character) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (const char c : character) {
    const auto byte = static_cast<unsigned char>(c);
    to += {'\\', 'x', kDigits[byte / 16U], kDigits[byte % 16U]};
  }
}

/// Returns the end of the part that begins at `from`: after the closing quote, else before the next blank.
std::size_t end_of_part(std::string_view text, std::size_t from) {
  if (text[from] == '"' || text[from] == '\'') {
    const std::size_t close = text.find(text[from], from + 1);
    if (close != std::string_view::npos) return close + 1;
  }
  return std::min(text.find_first_of(" \n", from), text.size());
}

}  // namespace

std::size_t utf8_end(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t bytes = character_bytes(text.substr(at));
    if (bytes == 0) return at;
    at += bytes;
  }
  return at;
}

std::string printable(std::string_view text, std::size_t max_bytes) {
  std::string result;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t bytes = character_bytes(text.substr(at));
    const std::string_view character = text.substr(at, std::max<std::size_t>(bytes, 1));
    if (at + character.size() > max_bytes) return result + "…";
    if (bytes == 0 || is_control(character)) {
      append_character(result, character);
    } else {
      result += character;
    }
    at += character.size();
  }
  return result;
}

std::string fit_for_message(std::string_view sentence) {
  std::string result;
  for (std::size_t at = 0; at < sentence.size();) {
    if (result.size() > kMaxSentence) return result + " …";
    if (sentence[at] == ' ' || sentence[at] == '\n') {
      result += sentence[at++];
      continue;
    }
    const std::size_t end = end_of_part(sentence, at);
    result += printable(sentence.substr(at, end - at));
    at = end;
  }
  return result;
}

}  // namespace robot_control
