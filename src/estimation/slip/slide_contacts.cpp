#include "estimation/slip/slide_contacts.h"

#include <cmath>

#include "estimation/tuning.h"
#include "signals/state_frame.h"

namespace robot_control {

void SlideContacts::judge(const DifferenceSlope& excess, const DifferenceSlope& bend,
                          const Tolerance& tolerance) noexcept {
  for (const std::size_t i : {0U, 1U}) slips[i] = std::abs(excess.side(i)) > tolerance.path;
  if (std::abs(excess.turn) > tolerance.turn && both_roll()) {  // one side at least slips
    slips[std::abs(excess.side(0)) > std::abs(excess.side(1)) ? 0 : 1] = true;
  }
  for (const std::size_t i : {0U, 1U}) slips[i] = slips[i] || std::abs(bend.side(i)) > tolerance.bend;
  sideways = std::abs(excess.across) > tolerance.path || std::abs(bend.across) > tolerance.bend;
}

double SlideContacts::slipped(double along, double turn) const noexcept {
  if (both_slip()) return along;
  return slips[0] ? -turn / 2 : slips[1] ? turn / 2 : 0;
}

std::uint64_t SlideContacts::reasons(const DifferenceSlope& excess, double wheel_speed) const noexcept {
  std::uint64_t reasons = 0;
  if (slips[0]) reasons |= kSlipLeft;
  if (slips[1]) reasons |= kSlipRight;
  if (slips[0] != slips[1]) reasons |= kSlipTurn;
  if (sideways) reasons |= kSlipSideways;
  for (const std::size_t i : {0U, 1U}) {
    if (!slips[i]) continue;
    const bool faster = std::abs(wheel_speed) > std::abs(wheel_speed - excess.side(i));  // than the ground
    reasons |= faster ? kSlipSpinning : kSlipStalled;
  }
  return reasons;
}

}  // namespace robot_control
