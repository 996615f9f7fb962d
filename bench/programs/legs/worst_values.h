#pragma once
/// The worst values and the means of one robot, by name.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bench/programs/rows.h"

namespace robot_control::bench {

class WorstValues {
 public:
  /// Keeps the largest of all values of this name; what is not finite is the largest.
  void add(const std::string& name, double value, const std::string& unit) {
    const double counted = std::isfinite(value) ? value : std::numeric_limits<double>::max();
    const auto known = std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) { return row.name == name; });
    if (known == rows_.end())
      rows_.push_back({.name = name, .value = counted, .unit = unit});
    else
      known->value = std::max(known->value, counted);
  }

  /// Keeps the mean of all values of this name.
  void average(const std::string& name, double value, const std::string& unit) {
    const double count = (counts_[name] += 1);
    const auto known = std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) { return row.name == name; });
    if (known == rows_.end())
      rows_.push_back({.name = name, .value = value, .unit = unit});
    else
      known->value += (value - known->value) / count;
  }

  /// Appends them in the order of their first `add`, each with the robot's name in front.
  void write(const std::string& robot, std::vector<Row>& rows) const {
    for (Row row : rows_) {
      row.name = robot + " " + row.name;
      rows.push_back(row);
    }
  }

 private:
  std::vector<Row> rows_;
  std::map<std::string, double> counts_;  // of averages
};

}  // namespace robot_control::bench
