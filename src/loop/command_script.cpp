#include "loop/command_script.h"

#include <charconv>

#include "files/input_file.h"
#include "parameters/problem_list.h"
#include "parameters/text_file.h"

namespace robot_control {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

template <class Number>
bool parse_number(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

class CommandScript::Parser {
 public:
  Parser(const std::string& source, std::uint64_t executable, ProblemList& problems)
      : source_(source), executable_(executable), problems_(problems) {}

  void line(std::string_view text) {
    ++line_;
    const std::string_view content = trimmed(text);
    if (content.empty() || content.starts_with('#')) return;
    const std::vector<std::string_view> cells = cells_of(content);
    if (columns_ == 0) {
      header(cells, content);
    } else {
      row(cells, content);
    }
  }

  void end() {
    if (columns_ == 0) problem("", "", "the header line is missing", "begin with cycle,linear,angular,event");
  }

  std::vector<Row> rows;

 private:
  void problem(std::string_view column, std::string_view value, const std::string& rule, const std::string& remedy) {
    std::string path = "line " + std::to_string(line_);
    if (!column.empty()) path += ", " + std::string(column);
    const bool named_but_empty = value.empty() && !column.empty();
    problems_.add({path, named_but_empty ? "(empty)" : printable(value), rule, source_, remedy});
  }

  void header(const std::vector<std::string_view>& cells, std::string_view content) {
    const std::vector<std::string_view> full{"cycle", "linear", "angular", "event"};
    const bool right = cells == full || cells == std::vector(full.begin(), full.end() - 1);
    if (!right) problem("header", content, "must be cycle,linear,angular or cycle,linear,angular,event", "");
    columns_ = right ? cells.size() : full.size();
  }

  void row(const std::vector<std::string_view>& cells, std::string_view content) {
    if (cells.size() != columns_) {
      problem("", content, "must have " + std::to_string(columns_) + " columns, has " + std::to_string(cells.size()),
              "");
      return;
    }
    Row result;
    if (!parse_number(cells[0], result.cycle)) {
      problem("cycle", cells[0], "must be a whole number of cycles, 0 or more", "");
    } else if (result.cycle < last_cycle_) {
      problem("cycle", cells[0], "must not be less than the cycle before it, " + std::to_string(last_cycle_),
              "sort the rows");
    } else {
      last_cycle_ = result.cycle;
    }
    result.event = columns_ > 3 ? event(cells[3]) : Event::kNone;
    if (result.event == Event::kNone || !cells[1].empty() || !cells[2].empty()) result.twist = twist(cells);
    rows.push_back(result);
  }

  Event event(std::string_view cell) {
    if (cell == "e_stop") return Event::kEmergencyStop;
    if (cell == "e_stop_reset") return Event::kReset;
    if (!cell.empty()) problem("event", cell, "must be empty, e_stop or e_stop_reset", "");
    return Event::kNone;
  }

  Twist twist(const std::vector<std::string_view>& cells) {
    Twist result;
    speed("linear", cells[1], "m/s", kPartLinearX, result.linear[0]);
    speed("angular", cells[2], "rad/s", kPartAngularZ, result.angular[2]);
    return result;
  }

  void speed(std::string_view column, std::string_view cell, const std::string& unit, RequestPart part, double& value) {
    if (!parse_number(cell, value)) {
      problem(column, cell, "must be a number of " + unit, "");
    } else if (value != 0 && (executable_ & part) == 0) {
      problem(column, cell, "must be 0, because this robot would ignore it (part_ignored)", "");
    }
  }

  const std::string& source_;
  std::uint64_t executable_;
  ProblemList& problems_;
  std::size_t line_ = 0;
  std::size_t columns_ = 0;
  std::uint64_t last_cycle_ = 0;
};

CommandScript CommandScript::parse(std::string_view text, const std::string& source, std::uint64_t executable) {
  ProblemList problems;
  Parser parser(source, executable, problems);
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    parser.line(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  parser.end();
  problems.throw_if_any("command script refused (" + source + ")");
  CommandScript script;
  script.rows_ = std::move(parser.rows);
  script.begin_with_zero();
  return script;
}

CommandScript::CommandScript(const std::string& path, std::uint64_t executable) {
  ProblemList problems;
  const auto text = read_text_file(path, kMaxScript, "set a CSV file, or leave robot.command_script empty", problems);
  problems.throw_if_any("command script refused");
  *this = parse(*text, path, executable);
}

ScriptEvents CommandScript::advance(std::uint64_t cycle) noexcept {
  ScriptEvents events;
  for (; next_ < rows_.size() && rows_[next_].cycle <= cycle; ++next_) {
    const Row& row = rows_[next_];
    if (row.twist) {
      events.has_twist = true;
      events.twist = *row.twist;
      ++events.twists;
    }
    if (row.event == Event::kEmergencyStop) ++events.e_stops;
    if (row.event == Event::kReset) ++events.resets;
  }
  return events;
}

}  // namespace robot_control
