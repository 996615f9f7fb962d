#pragma once
/// The worst values, means and 95th percentiles of one robot, by name.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "bench/programs/rows.h"

namespace robot_control::bench {

class WorstValues {
 public:
  /// Keeps the largest of all values of this name; what is not finite is the largest.
  void add(const std::string& name, double value, const std::string& unit) {
    const double counted = std::isfinite(value) ? value : std::numeric_limits<double>::max();
    double& kept = kept_of(name, counted, unit);
    kept = std::max(kept, counted);
  }

  /// Keeps the smallest of all values of this name.
  void add_least(const std::string& name, double value, const std::string& unit) {
    double& kept = kept_of(name, value, unit);
    kept = std::min(kept, value);
  }

  /// Keeps the smallest value that 95 % of all values of this name do not exceed.
  void add_p95(const std::string& name, double value, const std::string& unit) {
    std::vector<double>& values = sorted_[name];
    values.insert(std::upper_bound(values.begin(), values.end(), value), value);
    kept_of(name, value, unit) = values[(19 * values.size() + 19) / 20 - 1];
  }

  /// Keeps the mean of all values of this name.
  void average(const std::string& name, double value, const std::string& unit) {
    const double count = (counts_[name] += 1);
    double& kept = kept_of(name, value, unit);
    kept += (value - kept) / count;
  }

  /// Appends them in the order of their first `add`, each with the robot's name in front.
  void write(const std::string& robot, std::vector<Row>& rows) const {
    for (Row row : rows_) {
      row.name = robot + " " + row.name;
      rows.push_back(row);
    }
  }

 private:
  /// Returns what is kept of this name, `value` at first.
  double& kept_of(const std::string& name, double value, const std::string& unit) {
    const auto known = std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) { return row.name == name; });
    if (known != rows_.end()) return known->value;
    rows_.push_back({.name = name, .value = value, .unit = unit});
    return rows_.back().value;
  }

  std::vector<Row> rows_;
  std::map<std::string, double> counts_;               // of averages
  std::map<std::string, std::vector<double>> sorted_;  // of p95
};

}  // namespace robot_control::bench
