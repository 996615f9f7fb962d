#include "parameters/value_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

#include "files/given_path.h"
#include "parameters/schema.h"

namespace robot_control {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return text;
}

// Reads YAML's spellings of numbers that are not finite, which from_chars does not know.
std::optional<double> not_finite(const std::string& text) {
  const std::string word = lower(text);
  const std::string bare = word.starts_with('+') || word.starts_with('-') ? word.substr(1) : word;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (bare == ".nan" || bare == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (bare == ".inf" || bare == "inf" || bare == "infinity") return word[0] == '-' ? -kInfinity : kInfinity;
  return std::nullopt;
}

template <class Number>
std::errc parse(std::string_view text, Number& number) {
  if (text.starts_with('+') && !text.substr(1).starts_with('-')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end != text.data() + text.size()) return std::errc::invalid_argument;
  return error;
}

// Finds the allowed word. YAML 1.1 (PyYAML, the parameter server) turns a plain `off` into a boolean, `false`. Some old
// words are booleans.
const Word* find_word(const Entry& entry, const Choice& choice) {
  const std::string small = lower(entry.text);
  const std::string text = small == "false" ? "off" : entry.text;
  for (const Word& allowed : choice.words) {
    if (allowed.text == text || (!allowed.now.empty() && allowed.text == small)) return &allowed;
  }
  return nullptr;
}

class Reader {
 public:
  Reader(const Entry& entry, const std::string& path, const Key& key, ProblemList& problems)
      : entry_(entry), path_(path), key_(key), problems_(problems) {}

  template <class Number>
  bool operator()(Number* to) {
    return number(entry_, *to);
  }
  template <class Value>
  bool operator()(std::optional<Value>* to) {
    Value value{};
    if (!(*this)(&value)) return false;
    *to = value;
    return true;
  }
  template <std::size_t N>
  bool operator()(NumberList<N>* to) {
    NumberList<N> value{};
    if (entry_.kind != Entry::Kind::kList || entry_.items.size() != N) return refuse("must be " + rule_of(key_));
    for (std::size_t i = 0; i < N; ++i) {
      if (!number(entry_.items[i], value[i])) return false;
    }
    *to = value;
    return true;
  }
  bool operator()(std::vector<std::string>* to) {
    // A single name stands for a list of one.
    const std::vector<Entry> items = entry_.kind == Entry::Kind::kList ? entry_.items : std::vector{entry_};
    std::vector<std::string> names;
    for (const Entry& item : items) {
      const bool text = item.kind == Entry::Kind::kPlain || item.kind == Entry::Kind::kQuoted;
      const bool name = text && !item.text.empty() && item.text.find('\0') == std::string::npos;
      if (!name) return refuse("must be " + rule_of(key_));
      names.push_back(item.text);
    }
    *to = std::move(names);
    return true;
  }

  bool operator()(bool* to) {
    constexpr auto kYes = std::to_array<std::string_view>({"true", "yes", "on"});
    constexpr auto kNo = std::to_array<std::string_view>({"false", "no", "off"});
    const std::string word = lower(entry_.text);
    const bool yes = std::find(kYes.begin(), kYes.end(), word) != kYes.end();
    const bool no = std::find(kNo.begin(), kNo.end(), word) != kNo.end();
    if (!plain() || (!yes && !no)) return refuse("must be " + rule_of(key_));
    *to = yes;
    return true;
  }

  bool operator()(std::string* to) {
    if (!plain() && entry_.kind != Entry::Kind::kQuoted) return refuse("must be " + rule_of(key_));
    if (entry_.text.empty() && (key_.traits & kMayBeEmpty) == 0) return refuse("must be " + rule_of(key_));
    if (entry_.text.find('\0') != std::string::npos) return refuse("must not contain the character 0");
    const bool file = (key_.traits & kPath) != 0 && !entry_.text.empty();
    *to = file ? resolved_path(entry_.text, entry_.folder) : entry_.text;
    return true;
  }

  bool operator()(const Choice& to) {
    const Word* allowed = find_word(entry_, to);
    if (allowed == nullptr) return refuse("must be " + rule_of(key_));
    to.set(to.place, allowed->value);
    return true;
  }

 private:
  bool plain() const { return entry_.kind == Entry::Kind::kPlain; }

  bool refuse(const std::string& rule) {
    problems_.add({path_, as_written(entry_), rule, entry_.origin, ""});
    return false;
  }

  template <class Number>
  bool number(const Entry& entry, Number& to) {
    if (entry.kind != Entry::Kind::kPlain) return refuse("must be " + rule_of(key_));
    if (not_finite(entry.text)) return refuse("must be finite, " + rule_of(key_));
    Number value = 0;
    if (parse(entry.text, value) != std::errc()) return refuse("must be " + rule_of(key_));
    const auto real = static_cast<double>(value);
    const bool off = (key_.traits & kZeroIsOff) != 0 && value == Number{0};
    if (!off && !(real >= key_.min && real <= key_.max)) return refuse("must be " + rule_of(key_));
    to = value;
    return true;
  }

  const Entry& entry_;
  const std::string& path_;
  const Key& key_;
  ProblemList& problems_;
};

}  // namespace

std::string as_written(const Entry& entry) {
  switch (entry.kind) {
    case Entry::Kind::kPlain:
      return printable(entry.text);
    case Entry::Kind::kQuoted:
      return std::string("\"").append(printable(entry.text)).append("\"");
    case Entry::Kind::kNothing:
      return "(nothing)";
    case Entry::Kind::kMap:
      return "(a block)";
    case Entry::Kind::kList:
      break;
  }
  constexpr std::size_t kShown = 8;
  std::string text = "[";
  for (std::size_t i = 0; i < entry.items.size() && i < kShown; ++i) {
    const Entry& item = entry.items[i];
    text.append(i == 0 ? "" : ", ").append(item.kind == Entry::Kind::kList ? "[…]" : as_written(item));
  }
  return text.append(entry.items.size() > kShown ? ", …]" : "]");
}

std::string_view word_now(const Entry& entry, const Field& field) {
  const auto* choice = std::get_if<Choice>(&field);
  const Word* word = choice == nullptr ? nullptr : find_word(entry, *choice);
  return word == nullptr ? std::string_view() : word->now;
}

bool read_value(const Entry& entry, const std::string& path, const Key& key, ProblemList& problems) {
  return std::visit(Reader(entry, path, key, problems), key.field);
}

}  // namespace robot_control
