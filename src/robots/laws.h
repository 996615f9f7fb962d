#pragma once
/// The roles of the loop as interfaces. A robot kind implements them by its laws; cycles, processes and the replay of a
/// log know no others. `step` is called once per cycle. No function allocates, locks or throws.
///
/// `save` and `restore` copy the complete state of a law (signals/law_snapshot.h). A snapshot restores a law that was
/// made with the same parameters for the same robot, by the same build. `clone` copies the law with its parameters.

#include <memory>
#include <utility>

#include "control/common/control_input.h"
#include "safety/monitor_input.h"
#include "signals/command_frame.h"
#include "signals/law_snapshot.h"
#include "signals/live_tuning.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"

namespace robot_control {

class Law {
 public:
  virtual ~Law() = default;
  virtual void save(LawSnapshot& snapshot) const noexcept = 0;
  /// Returns false if the snapshot has another size.
  virtual bool restore(const LawSnapshot& snapshot) noexcept = 0;
};

/// Sensors of a cycle → state of that cycle.
class EstimatorLaw : public Law {
 public:
  virtual std::unique_ptr<EstimatorLaw> clone() const = 0;
  /// Begins a new run: the pose is zero.
  virtual void enter_run() noexcept = 0;
  /// Continues from the last published frame after a restart within a run.
  virtual void resume(const StateFrame& last) noexcept = 0;
  /// The next frame has this pose (x [m], y [m], yaw [rad]).
  virtual void set_pose(const Vector3& pose) noexcept = 0;
  /// Fills everything but `out.head`.
  virtual void step(const SensorFrame& sensors, StateFrame& out) noexcept = 0;
};

/// Sensors, state, permit and request of a cycle → joint commands of that cycle.
class ControllerLaw : public Law {
 public:
  virtual std::unique_ptr<ControllerLaw> clone() const = 0;
  /// Begins a new run. Requests in the inbox do not count; with `with_zero` the run begins with a zero request.
  virtual void enter_run(const VelocityCommand& inbox, bool with_zero) noexcept = 0;
  /// Sets limits and gains between two cycles. They stay after `enter_run`.
  virtual void tune(const LiveTuning& tuning) noexcept = 0;
  virtual LiveTuning tuning() const noexcept = 0;
  /// Fills everything but `out.head`.
  virtual void step(const ControlInput& input, CommandFrame& out) noexcept = 0;
};

/// Sensors of a cycle, and command and state of the cycle before → permit of that cycle.
class MonitorLaw : public Law {
 public:
  virtual std::unique_ptr<MonitorLaw> clone() const = 0;
  /// Fills everything but `out.head`.
  virtual void step(const MonitorInput& input, Permit& out) noexcept = 0;
};

/// A law that is copied with its owner.
template <class Role>
class OwnedLaw {
 public:
  explicit OwnedLaw(std::unique_ptr<Role> law) noexcept : law_(std::move(law)) {}
  OwnedLaw(const OwnedLaw& other) : law_(other.law_->clone()) {}
  OwnedLaw& operator=(const OwnedLaw&) = delete;

  Role& operator*() noexcept { return *law_; }
  Role* operator->() noexcept { return law_.get(); }

 private:
  std::unique_ptr<Role> law_;
};

/// A law in one of these roles, whose state is saved as law_snapshot.h says.
template <class Role, class Implementation>
class SavedLaw : public Role {
 public:
  template <class... Arguments>
  explicit SavedLaw(Arguments&&... arguments) : law_(std::forward<Arguments>(arguments)...) {}
  void save(LawSnapshot& snapshot) const noexcept final { save_state(law_, snapshot); }
  bool restore(const LawSnapshot& snapshot) noexcept final { return restore_state(snapshot, law_); }

 protected:
  Implementation law_;
};

/// An estimator whose law has the functions of the role.
template <class Implementation>
class EstimatorOf final : public SavedLaw<EstimatorLaw, Implementation> {
 public:
  using SavedLaw<EstimatorLaw, Implementation>::SavedLaw;
  std::unique_ptr<EstimatorLaw> clone() const override { return std::make_unique<EstimatorOf>(*this); }
  void enter_run() noexcept override { this->law_.enter_run(); }
  void resume(const StateFrame& last) noexcept override { this->law_.resume(last); }
  void set_pose(const Vector3& pose) noexcept override { this->law_.set_pose(pose); }
  void step(const SensorFrame& sensors, StateFrame& out) noexcept override { this->law_.step(sensors, out); }
};

/// A controller whose law has the functions of the role. One without `tune` has no values that change while it runs.
template <class Implementation>
class ControllerOf final : public SavedLaw<ControllerLaw, Implementation> {
 public:
  using SavedLaw<ControllerLaw, Implementation>::SavedLaw;
  std::unique_ptr<ControllerLaw> clone() const override { return std::make_unique<ControllerOf>(*this); }
  void enter_run(const VelocityCommand& inbox, bool with_zero) noexcept override {
    this->law_.enter_run(inbox, with_zero);
  }
  void tune(const LiveTuning& tuning) noexcept override {
    if constexpr (kTuned) this->law_.tune(content_of<std::decay_t<decltype(this->law_.tuning())>>(tuning));
  }
  LiveTuning tuning() const noexcept override {
    if constexpr (kTuned) return tuning_of(this->law_.tuning());
    return {};
  }
  void step(const ControlInput& input, CommandFrame& out) noexcept override { this->law_.step(input, out); }

 private:
  static constexpr bool kTuned = requires(Implementation law) { law.tune(law.tuning()); };
};

/// A monitor whose law has the function of the role.
template <class Implementation>
class MonitorOf final : public SavedLaw<MonitorLaw, Implementation> {
 public:
  using SavedLaw<MonitorLaw, Implementation>::SavedLaw;
  std::unique_ptr<MonitorLaw> clone() const override { return std::make_unique<MonitorOf>(*this); }
  void step(const MonitorInput& input, Permit& out) noexcept override { this->law_.step(input, out); }
};

}  // namespace robot_control
