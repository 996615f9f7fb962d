#include "control/wheeled/wheel_loops/wheel_loop.h"

#include <algorithm>

namespace robot_control {
namespace {

constexpr double kDecayTime = 0.1;  // s

}  // namespace

WheelLoop::WheelLoop(const WheelLoopGains& gains, double bandwidth, double effort_limit, double period)
    : gains_(gains), effort_limit_(effort_limit), period_(period), tracking_(bandwidth, period) {}

void WheelLoop::reset() noexcept {
  tracked_ = false;
  tracking_.reset();
  integral_ = 0;
  planned_hand_over_ = gain_hand_over_ = 0;
  load_ = 0;
  effort_residual_ = 0;
  last_gains_.reset();
  saturated_ = false;
}

void WheelLoop::tune(const WheelLoopGains& gains, double bandwidth, const FeedForwardDecrease& decrease) noexcept {
  tracking_.tune(bandwidth);
  tracking_.know_less(effort_residual_ / gains_.model_inertia - effort_residual_ / gains.model_inertia);
  if (!last_gains_ && (gains.kp != gains_.kp || gains.kd != gains_.kd)) last_gains_ = gains_;
  gains_ = gains;
  planned_hand_over_ += decrease.inertial;
  move_to_feed_forward(-decrease.steady);
}

void WheelLoop::move_to_feed_forward(double part) noexcept {
  integral_ = std::clamp(integral_ - part, -effort_limit_, effort_limit_);
  // The torques under way were planned with the old feed-forward. Without this the tracking loop would see a residual.
  load_ -= part;
  for (WheelPlan& plan : plans_) plan.feed_forward += part;
}

void WheelLoop::measure(const JointSample& sample, double periods, bool driven) noexcept {
  if (!tracked_) {
    tracking_.restart_from(sample.position, sample.velocity);
    tracked_ = true;
    effort_residual_ = 0;
    reset_to_measured();
    return;
  }
  // While cycles were skipped, the driver held the last command.
  if (periods > 1) {
    plans_[1] = plans_[0];
    efforts_[1] = efforts_[0];
  }
  const WheelPlan& plan = plans_[1];
  if (!driven) tracking_.know_less(effort_residual_ / gains_.model_inertia);
  taken_effort_ = driven ? efforts_[1] - sample.effort : 0;
  effort_residual_ = driven ? sample.effort - plan.feed_forward - load_ : 0;
  const double dt = periods * period_;
  off_plan_ += sample.position - tracking_.measured() - (plan.velocity - 0.5 * plan.acceleration * dt) * dt;
  tracking_.step(sample.position, driven ? plan.acceleration + effort_residual_ / gains_.model_inertia : 0.0, periods);
}

void WheelLoop::reset_to_measured() noexcept {
  plans_.fill({.velocity = velocity()});
  planned_hand_over_ = gain_hand_over_ = 0;
  load_ = integral_;
  efforts_.fill(0);
  taken_effort_ = excused_ = off_plan_ = 0;
  last_gains_.reset();
  saturated_ = false;
}

void WheelLoop::preload_integrator(double effort) noexcept {
  integral_ = std::clamp(effort + gains_.kd * tracking_.acceleration(), -effort_limit_, effort_limit_);
  load_ = integral_;
}

void WheelLoop::integrate(double error, double direct, double dt, bool clamped) noexcept {
  const double sum = direct + integral_;
  const double beyond = sum - std::clamp(sum, -effort_limit_, effort_limit_);
  const double taken = beyond + (clamped ? taken_effort_ : 0.0);
  if (gains_.kp > 0 && (taken != 0 || excused_ != 0)) {
    excused_ += std::min(1.0, dt * gains_.ki / gains_.kp) * (taken / gains_.kp - excused_);
    excused_ = std::clamp(excused_, std::min(error, 0.0), std::max(error, 0.0));
  }
  if (taken * error > 0) return;
  integral_ = std::clamp(integral_ + gains_.ki * (error - excused_) * dt, -effort_limit_, effort_limit_);
}

double WheelLoop::step(const WheelPlan& plan, double periods, bool clamped) noexcept {
  const double error = plans_[1].velocity - velocity();
  const double kept = 1 - std::min(1.0, periods * period_ / kDecayTime);
  planned_hand_over_ *= kept;
  gain_hand_over_ *= kept;
  const double planned = plan.feed_forward + planned_hand_over_;
  const auto direct_with = [&](const WheelLoopGains& gains) {
    return planned + gain_hand_over_ + gains.kp * error - gains.kd * tracking_.acceleration();
  };
  if (last_gains_) {
    const double effort = std::clamp(direct_with(*last_gains_) + integral_, -effort_limit_, effort_limit_);
    gain_hand_over_ += effort - integral_ - direct_with(gains_);
    last_gains_.reset();
  }
  const double direct = direct_with(gains_);
  if (gains_.ki == 0) integral_ *= kept;
  integrate(error, direct, periods * period_, clamped);

  unclamped_effort_ = direct + integral_;
  const double effort = std::clamp(unclamped_effort_, -effort_limit_, effort_limit_);
  saturated_ = effort != unclamped_effort_;
  plans_[1] = plans_[0];
  plans_[0] = plan;
  plans_[0].feed_forward = planned;
  efforts_ = {effort, efforts_[0]};
  return effort;
}

}  // namespace robot_control
