#include "parameters/problem_list.h"

namespace robot_control {
namespace {

std::string line_of(const Problem& problem) {
  std::string line = printable(problem.path);
  if (!problem.value.empty()) line.append(" = ").append(printable(problem.value));
  if (!line.empty()) line.append(": ");
  line.append(fit_for_message(problem.rule));
  if (!problem.origin.empty()) line.append(" [").append(printable(problem.origin)).append("]");
  if (!problem.remedy.empty()) line.append("; ").append(fit_for_message(problem.remedy));
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
  std::string message = fit_for_message(subject);
  message.append(": ").append(std::to_string(lines.size())).append(lines.size() == 1 ? " problem" : " problems");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i > 0 && message.size() + lines[i].size() > kMaxListing) {
      return message.append("\n  … and ").append(std::to_string(lines.size() - i)).append(" more");
    }
    message.append("\n  ").append(lines[i]);
  }
  return message;
}

}  // namespace robot_control
