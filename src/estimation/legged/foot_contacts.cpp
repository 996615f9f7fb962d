#include "estimation/legged/foot_contacts.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "machine/gravity.h"

namespace robot_control {
namespace {

using Eigen::Vector3d;
using Map = Eigen::Map<Vector3d>;
using ConstMap = Eigen::Map<const Vector3d>;

bool all_measured(const SensorFrame& sensors) noexcept {
  return sensors.contact_count >= kLegs && std::all_of(sensors.contacts.begin(), sensors.contacts.begin() + kLegs,
                                                       [](const ContactSample& contact) { return contact.valid != 0; });
}

double valid_effort(const JointSample& joint) noexcept {
  return has(joint, kValidEffort) && std::isfinite(joint.effort) ? joint.effort : 0;
}

}  // namespace

bool feet_asked(const SensorFrame& sensors) noexcept {
  return std::ranges::any_of(sensors.gate.contact_schedule, [](double part) { return part > 0; });
}

FootContacts::FootContacts(const LegModel& robot) : dynamics_(robot), share_(dynamics_.mass() * kGravity / kLegs) {}

void FootContacts::step(const SensorFrame& sensors, const FeetMotion& feet, const Vector3d& rate, const Vector3d& force,
                        const Vector3d& up, double dt, State& state) const noexcept {
  const double gain = state.begun != 0 ? dt / (kObserverTime + dt) : 1;
  state.begun = 1;
  LeggedMotion motion{.angles = feet.angles, .angular = rate};
  LeggedAcceleration change;
  for (std::size_t i = 0; i < kLegsJoints; ++i) {
    state.rates[i] += gain * (feet.rates[i] - state.rates[i]);
    state.efforts[i] += gain * (valid_effort(sensors.joints[i]) - state.efforts[i]);
    change.joints[i] = (feet.rates[i] - state.rates[i]) / kObserverTime;
  }
  Map(state.angular.data()) += gain * (rate - ConstMap(state.angular.data()));
  Map(state.force.data()) += gain * (force - ConstMap(state.force.data()));
  change.angular = (rate - ConstMap(state.angular.data())) / kObserverTime;
  motion.rates = state.rates;
  motion.gravity = -ConstMap(state.force.data());
  const bool measured = all_measured(sensors);
  const bool asked = feet_asked(sensors);
  for (std::size_t leg = 0; leg < kLegs; ++leg) {
    double load = 0;
    if (measured) {
      load = up.dot(ConstMap(sensors.contacts[leg].force.data()));
    } else {
      const Vector3d missing = dynamics_.efforts(leg, motion, change) - LegModel::angles_of(state.efforts, leg);
      load = up.dot(feet.jacobian[leg].transpose().inverse() * missing);
    }
    state.loads[leg] = std::isfinite(load) ? load : 0;
    state.lifted[leg] = asked && sensors.gate.contact_schedule[leg] <= 0 ? state.lifted[leg] + dt : 0;
    const double bound = sensors.gate.contact_schedule[leg] > 0 ? kAsked : asked ? kSwings : kNotAsked;
    state.probability[leg] = std::clamp(0.5 + (state.loads[leg] / share_ - bound) / kBlur, 0.0, 1.0);
    if (state.lifted[leg] > 0 && state.lifted[leg] < kLift) state.probability[leg] = 0;
  }
}

}  // namespace robot_control
