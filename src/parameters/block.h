#pragma once
/// A block of parameters is declared beside what it configures: a struct with safe defaults, and a function `keys` with
/// one line per member. This header needs neither YAML nor a law.
///
///   struct SirenParameters {
///     double volume = 60;  ///< dB
///   };
///   inline Keys keys(SirenParameters& siren) { return {{"volume", &siren.volume, "dB", 0, 120, kLive}}; }
///
/// Rules across keys are a function `check` beside it. A set of blocks is composed in configuration/.

#include <array>
#include <charconv>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace robot_control {

/// A word that an enum may have in YAML. ROS and PyYAML follow YAML 1.1 and turn `off` into `false`.
struct Word {
  template <class Enum>
  Word(std::string_view word, Enum meaning, std::string_view present_word = {})
      : text(word), value(static_cast<int>(meaning)), now(present_word) {}

  std::string_view text;
  int value;
  std::string_view now;  ///< if `text` is an old word, accepted with a warning: the present one
};

/// Returns the word of a value, by the `words_of(Enum)` that is declared beside the enum; "" if it has none.
template <class Enum>
requires std::is_enum_v<Enum> std::string word_of(Enum value) {
  for (const Word& word : words_of(value)) {
    if (word.value == static_cast<int>(value)) return std::string(word.text);
  }
  return "";
}

/// A Choice points to a member of an enum type. The words are those of `words_of(Enum)`, which is declared beside the
/// enum.
struct Choice {
  template <class Enum>
  requires std::is_enum_v<Enum> Choice(Enum* member)  // NOLINT(google-explicit-constructor): a place in a list of keys
      : place(member),
        words(words_of(Enum{})),
        get([](const void* from) { return static_cast<int>(*static_cast<const Enum*>(from)); }),
        set([](void* to, int value) { *static_cast<Enum*>(to) = static_cast<Enum>(value); }) {}

  void* place;
  std::vector<Word> words;
  int (*get)(const void* place);
  void (*set)(void* place, int value);
};

template <std::size_t N>
using NumberList = std::array<double, N>;

/// A Field points to the member that receives a value; the type of the pointer is the type of the parameter.
using Field = std::variant<double*, std::optional<double>*, NumberList<3>*, std::optional<NumberList<3>>*,
                           std::optional<NumberList<4>>*, std::optional<NumberList<6>>*, std::int64_t*, std::uint64_t*,
                           bool*, std::string*, std::vector<std::string>*, Choice>;

/// Properties of a key beside its range; bits of Key::traits.
enum KeyTrait : unsigned {
  kOptional = 1u << 0,     ///< may be absent
  kZeroIsOff = 1u << 1,    ///< 0 is allowed beside the range and switches the function off
  kLoopTimeout = 1u << 2,  ///< s; at least two periods of the loop, otherwise jitter alone would exceed it
  kPublishRate = 1u << 3,  ///< Hz of a topic, which comes at most once a cycle
  kPath = 1u << 4,         ///< a file; made absolute
  kMayBeEmpty = 1u << 5,   ///< a text that may be ""
  kLive = 1u << 6,         ///< may change while its node runs (live_parameters.h); double, optional<double> or bool
  kObsolete = 1u << 7,     ///< key of an earlier version; accepted with a warning
};

struct Key {
  std::string_view name;
  Field field;
  std::string_view unit = {};
  double min = 0;  ///< numbers only; applies to each component of a vector
  double max = 0;
  unsigned traits = 0;
  std::string_view other_name_of = {};  ///< another key of this block that sets the same value
  std::string_view group = {};          ///< the map in the block that contains the key; empty: the block itself
};
using Keys = std::vector<Key>;

/// Returns the keys of all parts, in their order.
inline Keys joined(std::initializer_list<Keys> parts) {
  Keys all;
  for (const Keys& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// The given values by path ("robot.rate"), for rules across keys.
class GivenValues {
 public:
  /// Returns whether the value was given and is valid by itself.
  virtual bool accepted(const std::string& path) const = 0;

  /// Returns whether the value was given and is not valid.
  virtual bool refused(const std::string& path) const = 0;

  /// Returns an accepted value for messages: "robot.rate = 500 [robot_params.yaml:12]".
  virtual std::string shown(const std::string& path) const = 0;

  /// Refuses an accepted value.
  virtual void refuse(const std::string& path, const std::string& rule, const std::string& remedy = "") = 0;

 protected:
  ~GivenValues() = default;
};

/// Returns the shortest text that is read back as the same number.
inline std::string shortest(double value) {
  std::array<char, 32> buffer;
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr};
}

}  // namespace robot_control
