#include "control/legged/walk/own_gaits.h"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "control/legged/walk/gait_table.h"
#include "machine/gravity.h"

namespace robot_control {
namespace {

/// Two pairs of feet, by LegPlace. Each is beside the body's centre.
struct FeetBeside {
  const char* words;
  std::array<std::bitset<kLegs>, 2> pairs;
  double factor;  ///< k
};
const std::array kFeetBeside{FeetBeside{"the feet of one side", {0b0101, 0b1010}, 1},
                             FeetBeside{"the front or the rear feet", {0b0011, 0b1100}, 1.5}};

constexpr std::size_t kMinFeet = 2;  // that bear: the forces of one foot do not hold a body
constexpr std::array<std::string_view, 5> kMembers{"name", "period", "duty", "phases", "lift"};

Gait gait_of(const OwnGait& own) {
  Gait gait{{}, *own.period, *own.duty, *own.phases, *own.lift};
  own.name.copy(gait.name.data(), kMaxGaitName);
  return gait;
}

bool is_word(const std::string& name) {
  return name.size() <= kMaxGaitName && std::all_of(name.begin(), name.end(), [](char c) {
           return c == '_' || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
         });
}

/// Returns the names of these members in words.
std::string listed(const std::vector<std::string_view>& members) {
  std::string names;
  for (const std::string_view member : members) names.append(names.empty() ? "" : ", ").append(member);
  return names;
}

/// Returns the value in s with three decimals at most.
std::string rounded(double value) {
  return shortest(std::round(1000 * value) / 1000);
}

/// Returns why a body tips over with this gait; empty: it does not.
std::string tipping(const Gait& gait) {
  constexpr double kHeight = 0.7 * kReferenceLeg;  // m, control/legged/leg_tuning.h
  const double fall = std::sqrt(kHeight / kGravity);
  for (const FeetBeside& beside : kFeetBeside) {
    double longest = 0, part = 0;
    for_each_support(gait, [&](double length, const std::bitset<kLegs>& feet) {
      if (std::find(beside.pairs.begin(), beside.pairs.end(), feet) == beside.pairs.end()) return;
      longest = std::max(longest, length * gait.period);
      part += length;
    });
    const double limit = 0.7 * beside.factor * fall, part_limit = 0.4 * beside.factor * fall;
    if (longest <= limit && longest * part <= part_limit) continue;
    return std::string("lets ") + beside.words + " are in stance by themselves for " + rounded(longest) + " s, in " +
           rounded(part) + " of the period, so the body tips over: at most " + rounded(limit) +
           " s, and time · part of the period at most " + rounded(part_limit) + " s";
  }
  return {};
}

/// Returns true if each member is given and valid by itself.
bool is_whole(const std::string& path, GivenValues& given) {
  std::vector<std::string_view> accepted, missing;
  for (const std::string_view member : kMembers) {
    const std::string at = path + std::string(member);
    if (given.accepted(at)) accepted.push_back(member);
    if (!given.accepted(at) && !given.refused(at)) missing.push_back(member);
  }
  if (!accepted.empty() && !missing.empty())
    given.refuse(path + std::string(accepted.front()), "does not describe a gait by itself", "add " + listed(missing));
  return accepted.size() == kMembers.size();
}

}  // namespace

Keys keys(OwnGaits& gaits) {
  Keys all;
  for (std::size_t i = 0; i < gaits.size(); ++i) {
    OwnGait& gait = gaits[i];
    all.insert(all.end(), {{"name", &gait.name, {}, 0, 0, kOptional, {}, kOwnGaits[i]},
                           {"period", &gait.period, "s", 0.1, 3, kOptional, {}, kOwnGaits[i]},
                           {"duty", &gait.duty, {}, 0.5, 0.95, kOptional, {}, kOwnGaits[i]},
                           {"phases", &gait.phases, {}, 0, 1, kOptional, {}, kOwnGaits[i]},
                           {"lift", &gait.lift, "m", 0.01, 0.12, kOptional, {}, kOwnGaits[i]}});
  }
  return all;
}

void check(const OwnGaits& gaits, const std::string& block, GivenValues& given) {
  std::vector<std::string> names = gait_words(all_gaits({}));
  names.emplace_back(kGaits[kStandGait].name.data());
  for (std::size_t i = 0; i < gaits.size(); ++i) {
    const std::string path = block + "." + std::string(kOwnGaits[i]) + ".";
    if (!is_whole(path, given)) continue;
    const OwnGait& own = gaits[i];
    if (!is_word(own.name)) {
      given.refuse(path + "name", "must be at most " + std::to_string(kMaxGaitName) + " of a … z, 0 … 9 and _");
      continue;
    }
    if (std::find(names.begin(), names.end(), own.name) != names.end())
      given.refuse(path + "name", "is already the name of a gait", "set another name");
    names.push_back(own.name);
    const Gait gait = gait_of(own);
    if (gait.swing_time() < kMinSwing)
      given.refuse(path + "period",
                   "lets a foot swing for less than " + shortest(kMinSwing) + " s, period · (1 - duty)",
                   "set a longer period or a smaller duty");
    if (const std::size_t feet = fewest_feet(gait); feet < kMinFeet)
      given.refuse(path + "phases",
                   "must leave two feet on the ground at any time; at the duty " + shortest(gait.duty) +
                       " they leave " + std::to_string(feet),
                   "set a larger duty or other phases");
    else if (const std::string why = tipping(gait); !why.empty())
      given.refuse(path + "duty", why, "set a larger duty or a shorter period");
  }
}

std::vector<Gait> all_gaits(const OwnGaits& own) {
  std::vector<Gait> gaits(kGaits.begin(), kGaits.end());
  for (const OwnGait& gait : own)
    if (!gait.name.empty()) gaits.push_back(gait_of(gait));
  return gaits;
}

std::vector<std::string> gait_words(const std::vector<Gait>& gaits) {
  std::vector<std::string> words{"auto"};
  for (std::size_t i = 1; i < gaits.size(); ++i) words.emplace_back(gaits[i].name.data());
  return words;
}

}  // namespace robot_control
