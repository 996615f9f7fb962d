#pragma once
/// Expectations of an exploration. In a mutation every access of the tested code is broken in every way, one at a time.
/// A mutant that no scenario notices is an order or a check that is not needed, or not tested.

#include <gtest/gtest.h>

#include <cstdio>

#include "bus/model/memory_model.h"

namespace robot_control::model {

inline void expect_no_violation(const Report& report) {
  EXPECT_EQ(report.violation, "") << "in schedule " << report.schedules;
  std::printf("%llu schedules\n", static_cast<unsigned long long>(report.schedules));
}

using Scenario = std::function<Report()>;

/// Runs the scenarios unbroken, so that every access is known, then once per mutant of that file. Returns the mutants
/// that no scenario notices.
inline std::set<std::string> unnoticed(MemoryModel& model, const std::string& file,
                                       const std::vector<Scenario>& scenarios) {
  std::set<std::string> names;
  for (const Scenario& scenario : scenarios) {
    if (const std::string violation = scenario().violation; !violation.empty()) names.insert("unbroken: " + violation);
  }
  for (const Mutant& mutant : model.mutants(file)) {
    model.set_mutant(mutant);
    bool noticed = false;
    for (const Scenario& scenario : scenarios) noticed = noticed || !scenario().violation.empty();
    model.set_mutant(std::nullopt);
    if (!noticed) names.insert(model.to_string(mutant));
  }
  return names;
}

}  // namespace robot_control::model
