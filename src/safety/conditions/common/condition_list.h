#pragma once
/// A condition is a class with these members, where Now is what is measured in one cycle (condition_set.h):
///
///   Condition(const SafetyParameters&, const Machine&, double period)
///   enter_run()                        a new run
///   step(const Now&, ActiveCauses&)    one cycle; adds its causes while they are active
///
/// A ConditionList is a condition, too. WatchedCondition makes one of a Law that measures:
///
///   Law(const SafetyParameters&, const Machine&, double period)
///   enter_run()
///   measure(const Now&, const ConditionWatch&)    by joint: also its index
///
/// Stateless makes a law of a function with the arguments of `measure`, or of a member of Now that holds a measurement.

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "safety/conditions/common/condition_watch.h"
#include "safety/latch/active_causes.h"
#include "safety/safety_parameters.h"
#include "signals/fixed_vector.h"

namespace robot_control {

/// All conditions, in the order in which they stand here.
template <class... Conditions>
class ConditionList : private Conditions... {
 public:
  template <class Machine>
  ConditionList(const SafetyParameters& parameters, const Machine& machine, double period)
      : Conditions(parameters, machine, period)... {}

  void enter_run() noexcept { (static_cast<Conditions&>(*this).enter_run(), ...); }
  template <class Now>
  void step(const Now& now, ActiveCauses& out) noexcept {
    (static_cast<Conditions&>(*this).step(now, out), ...);
  }
};

template <auto kMeasure>
class Stateless {
 public:
  template <class Machine>
  Stateless(const SafetyParameters&, const Machine&, double) noexcept {}
  void enter_run() noexcept {}
  template <class Now, class... Arguments>
  ConditionMeasurement measure(const Now& now, const Arguments&... arguments) const noexcept {
    if constexpr (std::is_member_object_pointer_v<decltype(kMeasure)>) {
      return now.*kMeasure;
    } else {
      return kMeasure(now, arguments...);
    }
  }
};

/// One measurement per cycle; with kJoints one of each of the first joints, which has its own persistence.
template <StopCause kCause, class Law, std::size_t kJoints = 0>
class WatchedCondition {
 public:
  template <class Machine>
  WatchedCondition(const SafetyParameters& parameters, const Machine& machine, double period)
      : watches_(std::max<std::size_t>(kJoints, 1), {kCause, condition_of<kCause>(parameters), period}),
        law_(parameters, machine, period) {}

  void enter_run() noexcept {
    for (ConditionWatch& watch : watches_) watch.reset();
    law_.enter_run();
  }
  template <class Now>
  void step(const Now& now, ActiveCauses& out) noexcept {
    for (std::size_t i = 0; i < watches_.size(); ++i) {
      const ConditionWatch& watch = watches_[i];
      if constexpr (kJoints == 0) out.update(watches_[i], law_.measure(now, watch), now.elapsed);
      if constexpr (kJoints > 0) out.update(watches_[i], law_.measure(now, watch, i), now.elapsed);
    }
  }

 private:
  FixedVector<ConditionWatch, std::max<std::size_t>(kJoints, 1)> watches_;
  Law law_;
};

}  // namespace robot_control
