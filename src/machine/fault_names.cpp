#include "machine/fault_names.h"

#include <algorithm>

#include "signals/names.h"

namespace robot_control {
namespace {

std::string word_of(std::string_view joints, FaultComponent component) {
  return std::string(joints).append("_").append(name_of(component));
}

InjectedFault fault_of_joint(FaultComponent component, std::size_t joint, FaultKind kind = FaultKind::kOk) {
  return {.component = component, .index = static_cast<std::uint8_t>(joint), .kind = kind};
}

std::vector<InjectedFault> of_joints(FaultComponent component, const std::vector<std::size_t>& joints, FaultKind kind) {
  std::vector<InjectedFault> faults;
  for (const std::size_t joint : joints) faults.push_back(fault_of_joint(component, joint, kind));
  return faults;
}

std::string unknown(std::string_view what, std::string_view word, const std::string& known) {
  return std::string("unknown ").append(what).append(" \"").append(word).append("\"; there are ") + known;
}

/// Returns the groups whose name no joint with components has.
std::vector<JointGroup> named_groups(const MachineModel& machine) {
  std::vector<JointGroup> groups = machine.groups;
  for (const std::size_t joint : actuated_joint_indices(machine)) {
    std::erase_if(groups, [&](const JointGroup& group) { return group.name == machine.joints[joint].name; });
  }
  return groups;
}

/// Returns the words of all components that exist once, and of those of groups: "left_encoder".
std::vector<std::string> common_words(const MachineModel& machine) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < kFaultComponents; ++i) {
    const auto component = static_cast<FaultComponent>(i);
    if (!is_of_joint(component))
      words.emplace_back(name_of(component));
    else
      for (const JointGroup& group : named_groups(machine)) words.push_back(word_of(group.name, component));
  }
  return words;
}

std::string known_components(const MachineModel& machine) {
  std::string text;
  for (const std::string& word : common_words(machine)) text += word + " ";
  return text + "and NAME_encoder, NAME_motor of each driven or held joint";
}

}  // namespace

std::vector<std::string> fault_words(const MachineModel& machine) {
  std::vector<std::string> words = common_words(machine);
  for (const std::size_t joint : actuated_joint_indices(machine)) {
    for (std::size_t i = 0; i < kFaultComponents; ++i) {
      const auto component = static_cast<FaultComponent>(i);
      if (is_of_joint(component)) words.push_back(word_of(machine.joints[joint].name, component));
    }
  }
  return words;
}

std::vector<InjectedFault> components_of(const MachineModel& machine, std::string_view word) {
  for (std::size_t i = 0; i < kFaultComponents; ++i) {
    const auto component = static_cast<FaultComponent>(i);
    if (!is_of_joint(component)) {
      if (word == name_of(component)) return {{.component = component}};
      continue;
    }
    for (const JointGroup& group : named_groups(machine)) {
      if (word == word_of(group.name, component)) return of_joints(component, group.joints, FaultKind::kOk);
    }
    for (std::size_t joint = 0; joint < machine.joints.size(); ++joint) {
      const JointModel& model = machine.joints[joint];
      if (model.role != JointRole::kPassive && word == word_of(model.name, component)) {
        return {fault_of_joint(component, joint)};
      }
    }
  }
  return {};
}

std::string set_fault(InjectedFaults& faults, const MachineModel& machine, std::string_view component,
                      std::string_view kind) {
  const std::vector<InjectedFault> components = components_of(machine, component);
  if (components.empty()) return unknown("component", component, known_components(machine));
  const auto found = index_of(kFaultKindNames, kind);
  if (!found) {
    std::string known;
    for (const std::string_view word : kFaultKindNames) known.append(known.empty() ? "" : " ").append(word);
    return unknown("kind of fault", kind, known);
  }
  InjectedFaults changed = faults;
  for (InjectedFault fault : components) {
    fault.kind = static_cast<FaultKind>(*found);
    if (set_fault(changed, fault)) continue;
    return "at most " + std::to_string(kMaxInjectedFaults) +
           " components fail at one time; now: " + names_of(faults, machine) + ". Set one to the kind ok first.";
  }
  faults = changed;
  return {};
}

std::string names_of(const InjectedFaults& faults, const MachineModel& machine) {
  std::vector<InjectedFault> left(faults.begin(), faults.end());
  std::erase_if(left, [](const InjectedFault& fault) { return fault.kind == FaultKind::kOk; });
  std::string text;
  while (!left.empty()) {
    const InjectedFault first = left.front();
    std::vector<InjectedFault> named{first};
    std::string word(name_of(first.component));
    if (is_of_joint(first.component)) {
      word = first.index < machine.joints.size() ? word_of(machine.joints[first.index].name, first.component)
                                                 : word_of("joint " + std::to_string(first.index), first.component);
      for (const JointGroup& group : named_groups(machine)) {
        const std::vector<InjectedFault> all = of_joints(first.component, group.joints, first.kind);
        const auto fails = [&](const InjectedFault& fault) { return std::ranges::count(left, fault) > 0; };
        if (std::ranges::count(all, first) == 0 || !std::ranges::all_of(all, fails)) continue;
        word = word_of(group.name, first.component);
        named = all;
        break;
      }
    }
    text.append(text.empty() ? "" : ", ").append(word).append(" ").append(name_of(first.kind));
    std::erase_if(left, [&](const InjectedFault& fault) { return std::ranges::count(named, fault) > 0; });
  }
  return text.empty() ? "none" : text;
}

}  // namespace robot_control
