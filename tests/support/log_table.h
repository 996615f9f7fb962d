#pragma once
/// The columns of a log as numbers.

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "log/messages/trace_message.h"
#include "log/trace_reader.h"
#include "machine/wheeled/drive_train.h"

namespace robot_control {

inline std::vector<std::string> joint_names(const MachineModel& robot) {
  std::vector<std::string> names;
  for (const JointModel& joint : robot.joints) names.push_back(joint.name);
  return names;
}

class LogTable {
 public:
  /// `joints` and `contacts`: their names. `timing`: with the columns of wall-clock runs.
  LogTable(const std::vector<std::string>& joints, const std::vector<std::string>& contacts, double period, bool timing)
      : joints_(joints.size()), period_(period), columns_(log_columns(joints, contacts, timing)) {}
  LogTable(const MachineModel& robot, double period) : LogTable(joint_names(robot), robot.contacts, period, false) {}

  /// Reads run.bag.
  static LogTable of_bag(const std::string& path) {
    TraceReader reader(path);
    const LogHeader& header = reader.header();
    LogTable table(header.joints, header.contacts, header.period, header.clock == "wall");
    reader.read({.row = [&](const TraceRow& row, std::int64_t) {
      if (!row.repeats) table.append(row);
    }});
    return table;
  }

  /// Appends a row of a loop in this process, at the precision that a bag has.
  void add(const JoinedRow& row) {
    encode_trace({.row = row, .joints = joints_}, message_);
    decoder_.decode(message_, read_);
    append(read_);
  }

  std::size_t rows() const { return rows_.size(); }
  const std::vector<TraceColumn>& columns() const { return columns_; }
  std::size_t place(const std::string& name) const {
    const auto found = std::ranges::find(columns_, name, &TraceColumn::name);
    if (found == columns_.end()) throw std::out_of_range("no column " + name);
    return static_cast<std::size_t>(found - columns_.begin());
  }
  double at(std::size_t row, std::size_t place) const { return rows_.at(row).at(place); }
  double at(std::size_t row, const std::string& name) const { return at(row, place(name)); }

  /// The first difference of two tables in words; "" where they are equal bit for bit.
  static std::string difference(const LogTable& first, const LogTable& second) {
    if (first.rows() != second.rows()) {
      return std::to_string(first.rows()) + " rows, not " + std::to_string(second.rows());
    }
    for (std::size_t row = 0; row < first.rows(); ++row) {
      for (std::size_t i = 0; i < first.columns_.size(); ++i) {
        if (same(first.at(row, i), second.at(row, i))) continue;
        return first.columns_[i].name + " in row " + std::to_string(row) + ": " + std::to_string(first.at(row, i)) +
               ", not " + std::to_string(second.at(row, i));
      }
    }
    return "";
  }

  /// The same bits, or both missing.
  static bool same(double a, double b) {
    return (std::isnan(a) && std::isnan(b)) || std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  }

 private:
  void append(const TraceRow& row) {
    const JoinedRow joined = row.joined(period_);
    std::vector<double>& cells = rows_.emplace_back();
    for (const TraceColumn& column : columns_) cells.push_back(column.value(joined, column.element));
  }

  std::size_t joints_;
  double period_;
  std::vector<TraceColumn> columns_;
  std::vector<std::vector<double>> rows_;
  TraceDecoder decoder_{trace_definition()};
  std::string message_;
  TraceRow read_;
};

}  // namespace robot_control
