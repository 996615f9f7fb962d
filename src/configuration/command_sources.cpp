#include "configuration/command_sources.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "parameters/problem_list.h"
#include "parameters/text_file.h"
#include "signals/roles.h"

namespace robot_control {
namespace {

constexpr std::size_t kMaxSourceFile = 65536;  // bytes
constexpr std::size_t kMaxEntries = 32;        // entries of each list
constexpr double kMaxTimeout = 60;             // s
constexpr int kMaxPriority = 255;              // twist_mux's
constexpr const char* kListRemedy = "docs/driving.md shows a list";

/// An EntryReader reads one entry of a list key by key.
class EntryReader {
 public:
  EntryReader(const YAML::Node& node, std::string path, const std::string& file, ProblemList& problems)
      : node_(node), path_(std::move(path)), file_(file), problems_(problems) {}

  std::string text(const std::string& key, const std::string& allowed, const std::string& rule) {
    const std::string value = scalar<std::string>(key, rule).value_or("");
    const bool good = !value.empty() && value.find_first_not_of(allowed) == std::string::npos;
    if (!good && known_.contains(key) && node_[key]) problem(key, rule);
    return value;
  }

  double number(const std::string& key, double max, const std::string& rule) {
    const double value = scalar<double>(key, rule).value_or(0);
    if (!(std::isfinite(value) && value >= 0 && value <= max)) problem(key, rule);
    return value;
  }

  int whole(const std::string& key, int max, const std::string& rule) {
    const int value = scalar<int>(key, rule).value_or(0);
    if (value < 0 || value > max) problem(key, rule);
    return value;
  }

  bool flag(const std::string& key) {
    known_.insert(key);
    return node_[key] ? scalar<bool>(key, "true or false").value_or(false) : false;
  }

  void refuse_other_keys() {
    for (const auto& pair : node_) {
      const std::string key = pair.first.as<std::string>("?");
      if (!known_.contains(key)) problem(key, "unknown key");
    }
  }

 private:
  template <class Value>
  std::optional<Value> scalar(const std::string& key, const std::string& rule) {
    known_.insert(key);
    const YAML::Node value = node_[key];
    if (!value) {
      problems_.add({path_ + "." + key, "", "missing: " + rule, file_, kListRemedy});
      return {};
    }
    Value result{};
    if (value.IsScalar() && YAML::convert<Value>::decode(value, result)) return result;
    problem(key, rule);
    return {};
  }

  void problem(const std::string& key, const std::string& rule) {
    const YAML::Node value = node_[key];
    const std::string text = value && value.IsScalar() ? value.Scalar() : "";
    problems_.add({path_ + "." + key, printable(text), rule, file_, kListRemedy});
  }

  YAML::Node node_;
  std::string path_;
  std::string file_;
  ProblemList& problems_;
  std::set<std::string> known_;
};

const std::string kNameLetters = "abcdefghijklmnopqrstuvwxyz0123456789_";
const std::string kTopicLetters = kNameLetters + "ABCDEFGHIJKLMNOPQRSTUVWXYZ/";

template <class Entry>
Entry read_common(EntryReader& reader) {
  Entry entry;
  entry.name = reader.text("name", kNameLetters, "lower-case letters, digits and _");
  entry.topic = reader.text("topic", kTopicLetters, "the name of a topic");
  entry.timeout = reader.number("timeout", kMaxTimeout, "a number of 0 … 60 s (0 = never)");
  entry.priority = reader.whole("priority", kMaxPriority, "a whole number of 0 … 255");
  return entry;
}

CommandSource read_entry(EntryReader& reader, CommandSource /*kind*/) {
  auto source = read_common<CommandSource>(reader);
  source.stamped = reader.flag("stamped");
  return source;
}

CommandLock read_entry(EntryReader& reader, CommandLock /*kind*/) {
  return read_common<CommandLock>(reader);
}

template <class Entry>
std::vector<Entry> read_list(const YAML::Node& list, const std::string& name, const std::string& file,
                             ProblemList& problems) {
  std::vector<Entry> entries;
  if (!list.IsSequence() || list.size() > kMaxEntries) {
    problems.add({name, "", "must be a list of at most 32 entries", file, kListRemedy});
    return entries;
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string path = name + "[" + std::to_string(i) + "]";
    if (!list[i].IsMap()) {
      problems.add({path, "", "must be a map of name, topic, timeout and priority", file, kListRemedy});
      continue;
    }
    EntryReader reader(list[i], path, file, problems);
    entries.push_back(read_entry(reader, Entry{}));
    reader.refuse_other_keys();
  }
  return entries;
}

template <class Entry, class Value>
void refuse_twice(const std::vector<Entry>& entries, Value Entry::*member, const std::string& what,
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
  const auto text = read_text_file(path, kMaxSourceFile, "name a file that can be read, or \"\" for none", problems);
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
  refuse_twice(list.sources, &CommandSource::name, "topics: name", path, problems);
  refuse_twice(list.sources, &CommandSource::topic, "topics: topic", path, problems);
  refuse_twice(list.sources, &CommandSource::priority, "topics: priority", path, problems);
  refuse_twice(list.locks, &CommandLock::name, "locks: name", path, problems);
  refuse_twice(list.locks, &CommandLock::topic, "locks: topic", path, problems);
  problems.throw_if_any(subject);
  std::ranges::sort(list.sources, std::ranges::greater{}, &CommandSource::priority);
  return list;
}

}  // namespace robot_control
