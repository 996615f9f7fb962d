#include "configuration/command_sources.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <set>
#include <utility>

#include "files/message_text.h"
#include "parameters/parameter_tree.h"
#include "parameters/problem_list.h"
#include "parameters/text_file.h"
#include "parameters/tree_reader.h"
#include "signals/roles.h"

namespace robot_control {
namespace {

constexpr std::size_t kMaxSourceFile = 65536;  // bytes
constexpr std::size_t kMaxEntries = 32;        // entries of each list
constexpr double kMaxTimeout = 60;             // s
constexpr double kMaxPriority = 255;           // twist_mux's
constexpr const char* kListRemedy = "docs/driving.md shows a list";

const std::string kNameLetters = "abcdefghijklmnopqrstuvwxyz0123456789_";
const std::string kTopicLetters = kNameLetters + "ABCDEFGHIJKLMNOPQRSTUVWXYZ/";

Keys keys(CommandLock& entry) {
  return {
      {"name", &entry.name},
      {"topic", &entry.topic},
      {"timeout", &entry.timeout, "s", 0, kMaxTimeout, kZeroIsOff},
      {"priority", &entry.priority, {}, 0, kMaxPriority},
  };
}

Keys keys(CommandSource& entry) {
  return joined({keys(static_cast<CommandLock&>(entry)), {{"stamped", &entry.stamped, {}, 0, 0, kOptional}}});
}

/// Each entry is read as a block: topics[0], topics[1], …
template <class Entry>
std::vector<Entry> read_list(const YAML::Node& list, const std::string& name, const std::string& file,
                             ProblemList& problems) {
  if (!list.IsSequence() || list.size() > kMaxEntries) {
    problems.add({name, "", "must be a list of at most 32 entries", file, kListRemedy});
    return {};
  }
  std::vector<Entry> entries(list.size());
  std::vector<std::string> names;
  YAML::Node map(YAML::NodeType::Map);
  for (std::size_t i = 0; i < list.size(); ++i) {
    names.push_back(name + "[" + std::to_string(i) + "]");
    map[names.back()] = list[i];
  }
  Schema schema{.check = [&](const Schema&, GivenValues& given) {
    const auto check = [&given](const std::string& path, const std::string& value, const std::string& letters,
                                const std::string& rule) {
      if (given.accepted(path) && value.find_first_not_of(letters) != std::string::npos) given.refuse(path, rule);
    };
    for (std::size_t i = 0; i < entries.size(); ++i) {
      check(names[i] + ".name", entries[i].name, kNameLetters, "must be of lower-case letters, digits and _");
      check(names[i] + ".topic", entries[i].topic, kTopicLetters, "must be the name of a topic");
    }
  }};
  for (std::size_t i = 0; i < entries.size(); ++i) schema.blocks.push_back({names[i], keys(entries[i])});
  ParameterTree tree;
  read_document(map, file, {}, tree, problems);
  read_blocks(std::move(tree), schema, schema.blocks, file, problems);
  return entries;
}

template <class Entry, class Value>
void refuse_twice(const std::vector<Entry>& entries, Value CommandLock::*member, const std::string& what,
                  const std::string& file, ProblemList& problems) {
  std::set<Value> seen;
  for (const Entry& entry : entries) {
    if (!seen.insert(entry.*member).second) {
      problems.add({what, printable(entry.name), "must differ from that of every other entry", file, kListRemedy});
    }
  }
}

}  // namespace

CommandSourceList read_command_sources(const std::string& path) {
  const std::string subject = std::string(program_of(Role::kController)) + ".command_sources refused (" + path + ")";
  ProblemList problems;
  const auto text = read_text_file(path, kMaxSourceFile, "set a file that can be read, or \"\" for none", problems);
  problems.throw_if_any(subject);
  CommandSourceList list;
  try {
    const YAML::Node root = YAML::Load(*text);
    if (!root.IsMap() || !root["topics"]) {
      problems.add({"topics", "", "missing: the list of sources", path, kListRemedy});
      problems.throw_if_any(subject);
    }
    for (const auto& pair : root) {
      const std::string key = pair.first.as<std::string>("?");
      if (key != "topics" && key != "locks") problems.add({printable(key), "", "unknown block", path, kListRemedy});
    }
    list.sources = read_list<CommandSource>(root["topics"], "topics", path, problems);
    if (root["locks"]) list.locks = read_list<CommandLock>(root["locks"], "locks", path, problems);
  } catch (const YAML::Exception& error) {
    problems.add({path, "", std::string("is no YAML: ") + error.what(), "", kListRemedy});
  }
  if (list.sources.empty() && problems.empty()) problems.add({"topics", "", "names no source", path, kListRemedy});
  refuse_twice(list.sources, &CommandLock::name, "topics: name", path, problems);
  refuse_twice(list.sources, &CommandLock::topic, "topics: topic", path, problems);
  refuse_twice(list.sources, &CommandLock::priority, "topics: priority", path, problems);
  refuse_twice(list.locks, &CommandLock::name, "locks: name", path, problems);
  refuse_twice(list.locks, &CommandLock::topic, "locks: topic", path, problems);
  problems.throw_if_any(subject);
  std::ranges::sort(list.sources, std::ranges::greater{}, &CommandSource::priority);
  return list;
}

}  // namespace robot_control
