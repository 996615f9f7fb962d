#pragma once
/// All YAML keys: one table per block, one line per parameter, or per condition of the safety
/// monitor, which is a group of keys: `tilt: {limit: 0.35, persistence: 0.05, reaction: brake}`.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "parameters/parameters.h"

namespace robot_control {

/// Where a value goes; the type of the pointer is the type of the parameter.
using Field =
    std::variant<double*, std::optional<double>*, Vector3*, std::optional<Vector3>*, std::optional<CovarianceDiagonal>*,
                 std::int64_t*, std::uint64_t*, bool*, std::string*, std::vector<std::string>*, ClockMode*,
                 RealtimePolicy*, TyreModel*, ErrorLevel*, Reaction*, FailAction*, RecordMode*>;

/// What a key allows beyond its range; bits of Key::traits.
enum KeyTrait : unsigned {
  kOptional = 1u << 0,     ///< may be absent
  kZeroIsOff = 1u << 1,    ///< 0 is allowed beside the range and switches the function off
  kTimeout = 1u << 2,      ///< s; at least two periods of the loop, else jitter alone would trip it
  kPublishRate = 1u << 3,  ///< Hz; at most the rate of the loop
  kPath = 1u << 4,         ///< a file; made absolute
  kMayBeEmpty = 1u << 5,   ///< a text that may be ""
  kLive = 1u << 6,         ///< may change while its node runs (live_parameters.h); double, optional<double> or bool
  kNoEffect = 1u << 7,     ///< of an earlier version; accepted with a warning
};

struct Key {
  std::string_view name;
  Field (*field)(Parameters&);
  std::string_view unit = {};
  double min = 0;  ///< numbers only; of a vector, each of its three
  double max = 0;
  unsigned traits = 0;
  std::string_view other_name_of = {};  ///< the key of this block whose value this one is, too
  std::string_view group = {};          ///< the map of the block in which it stands; empty: in the block itself
};

struct Block {
  std::string_view name;
  std::span<const Key> keys;
};

std::span<const Block> schema();

/// "block.key" or "block.group.key".
std::string path_of(const Block& block, const Key& key);

/// "block.group"; empty where the key stands in the block itself.
std::string group_path_of(const Block& block, const Key& key);

/// "a map of limit, persistence, reaction": what stands at a group's path. Empty: there is no such group.
std::string rule_of_group(std::string_view path);

/// What is allowed, in words: "a number of 100 … 2000 Hz", "one of wall, lockstep".
std::string rule_of(const Key& key);

/// The words an enum may take in YAML. `off` comes back from ROS and PyYAML, which follow YAML 1.1, as `false`.
struct Word {
  std::string_view text;
  int value;
  std::string_view now = {};  ///< of an old word, which is accepted with a warning: the one that replaced it
};
std::span<const Word> words_of(const Field& field);

}  // namespace robot_control
