#pragma once
/// The schema lists all YAML keys in one table per block, with one line per parameter. A condition of the safety
/// monitor is a group of keys with one line: `tilt: {limit: 0.35, persistence: 0.05, reaction: brake}`.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "parameters/parameters.h"

namespace robot_control {

/// A Field points to the member that receives a value; the type of the pointer is the type of the parameter.
using Field =
    std::variant<double*, std::optional<double>*, Vector3*, std::optional<Vector3>*, std::optional<CovarianceDiagonal>*,
                 std::int64_t*, std::uint64_t*, bool*, std::string*, std::vector<std::string>*, ClockMode*,
                 RealtimePolicy*, TyreModel*, ErrorLevel*, Reaction*, FailAction*, RecordMode*>;

/// Properties of a key beside its range; bits of Key::traits.
enum KeyTrait : unsigned {
  kOptional = 1u << 0,     ///< may be absent
  kZeroIsOff = 1u << 1,    ///< 0 is allowed beside the range and switches the function off
  kTimeout = 1u << 2,      ///< s; at least two periods of the loop, otherwise jitter alone would exceed it
  kPublishRate = 1u << 3,  ///< Hz; at most the rate of the loop
  kPath = 1u << 4,         ///< a file; made absolute
  kMayBeEmpty = 1u << 5,   ///< a text that may be ""
  kLive = 1u << 6,         ///< may change while its node runs (live_parameters.h); double, optional<double> or bool
  kNoEffect = 1u << 7,     ///< key of an earlier version; accepted with a warning
};

struct Key {
  std::string_view name;
  Field (*field)(Parameters&);
  std::string_view unit = {};
  double min = 0;  ///< numbers only; applies to each component of a vector
  double max = 0;
  unsigned traits = 0;
  std::string_view other_name_of = {};  ///< another key of this block that sets the same value
  std::string_view group = {};          ///< the map in the block that contains the key; empty: the block itself
};

struct Block {
  std::string_view name;
  std::span<const Key> keys;
};

std::span<const Block> schema();

/// Returns "block.key" or "block.group.key".
std::string path_of(const Block& block, const Key& key);

/// Returns "block.group"; "" if the key is in the block itself.
std::string group_path_of(const Block& block, const Key& key);

/// Returns the rule for a group's path, "a map of limit, persistence, reaction"; "" if there is no such group.
std::string rule_of_group(std::string_view path);

/// Returns the allowed values in words: "a number of 100 … 2000 Hz", "one of wall, lockstep".
std::string rule_of(const Key& key);

/// A word that an enum may have in YAML. ROS and PyYAML follow YAML 1.1 and turn `off` into `false`.
struct Word {
  std::string_view text;
  int value;
  std::string_view now = {};  ///< if `text` is an old word, accepted with a warning: the present one
};
std::span<const Word> words_of(const Field& field);

}  // namespace robot_control
