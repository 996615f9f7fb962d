#include "parameters/problem_list.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "parameters/parameters.h"

namespace robot_control {
namespace {

std::string line_of(const Problem& problem) {
  std::string line(problem.path);
  if (!problem.value.empty()) line.append(" = ").append(problem.value);
  line.append(": ").append(problem.rule);
  if (!problem.origin.empty()) line.append(" [").append(problem.origin).append("]");
  if (!problem.remedy.empty()) line.append("; ").append(problem.remedy);
  return line;
}

}  // namespace

std::vector<std::string> ProblemList::lines() const {
  std::vector<std::string> lines;
  for (const Problem& problem : problems_) lines.push_back(line_of(problem));
  return lines;
}

void ProblemList::throw_if_any(std::string_view subject) const {
  if (!problems_.empty()) throw ParameterError(listing(subject, lines()));
}

std::string listing(std::string_view subject, const std::vector<std::string>& lines) {
  std::string message(subject);
  message.append(": ").append(std::to_string(lines.size())).append(lines.size() == 1 ? " problem" : " problems");
  for (const std::string& line : lines) message.append("\n  ").append(line);
  return message;
}

std::string printable(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::size_t end = std::min(text.size(), kLongest);
  const auto continues = [&](std::size_t at) { return (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80; };
  while (end > 0 && end < text.size() && continues(end)) --end;  // no half of a UTF-8 character
  std::string result;
  for (const char character : text.substr(0, end)) {
    const auto byte = static_cast<unsigned char>(character);
    if (byte >= 0x20 && byte != 0x7f) {
      result += character;
    } else {
      result += {'\\', 'x', kDigits[byte / 16], kDigits[byte % 16]};
    }
  }
  return text.size() > end ? result + "…" : result;
}

std::string shortest(double value) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

}  // namespace robot_control
