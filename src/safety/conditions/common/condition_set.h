#pragma once
/// The conditions of one robot kind: the Observer of the kind measures, and each condition judges these measurements.
/// The set is the KindConditions of monitor.h.
///
/// The Observer has these members. The result of its `step` refers to it, and has a member `elapsed`.
///
///   Observer(const SafetyParameters&, const Machine&, double period)
///   driven_joints(const Machine&), moving(), standing(), sliding()    those of KindConditions
///   enter_run()                                                       a new run
///   step(const MonitorInput&, elapsed, speed_limit)                   one cycle; returns what is measured

#include <cstddef>
#include <cstdint>

#include "safety/conditions/common/condition_list.h"
#include "safety/monitor_input.h"

namespace robot_control {

template <class Observer, class... Conditions>
class ConditionSet {
 public:
  template <class Machine>
  ConditionSet(const SafetyParameters& parameters, const Machine& machine, double period)
      : observer_(parameters, machine, period), conditions_(parameters, machine, period) {}

  static std::size_t driven_joints(const auto& machine) noexcept { return Observer::driven_joints(machine); }

  void enter_run() noexcept {
    observer_.enter_run();
    conditions_.enter_run();
  }
  void step(const MonitorInput& input, std::uint64_t elapsed, double speed_limit, ActiveCauses& out) noexcept {
    conditions_.step(observer_.step(input, elapsed, speed_limit), out);
  }

  bool moving() const noexcept { return observer_.moving(); }
  bool standing() const noexcept { return observer_.standing(); }
  bool sliding() const noexcept { return observer_.sliding(); }

 private:
  Observer observer_;
  ConditionList<Conditions...> conditions_;
};

}  // namespace robot_control
