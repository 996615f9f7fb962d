#include <array>

#include "parameters/schema/schema.h"

namespace robot_control {
namespace {

constexpr auto kClockWords = std::to_array<Word>({
    {"wall", static_cast<int>(ClockMode::kWall)},
    {"lockstep", static_cast<int>(ClockMode::kLockstep)},
});

constexpr auto kRealtimeWords = std::to_array<Word>({
    {"required", static_cast<int>(RealtimePolicy::kRequired)},
    {"preferred", static_cast<int>(RealtimePolicy::kPreferred)},
    {"off", static_cast<int>(RealtimePolicy::kOff)},
});

constexpr auto kTyreWords = std::to_array<Word>({
    {"brush", static_cast<int>(TyreModel::kBrush)},
    {"native", static_cast<int>(TyreModel::kNative)},
});

// true and false are the words of versions without levels.
constexpr auto kErrorLevelWords = std::to_array<Word>({
    {"ideal", static_cast<int>(ErrorLevel::kIdeal)},
    {"data_sheet", static_cast<int>(ErrorLevel::kDataSheet)},
    {"field", static_cast<int>(ErrorLevel::kField)},
    {"true", static_cast<int>(ErrorLevel::kDataSheet), "data_sheet"},
    {"yes", static_cast<int>(ErrorLevel::kDataSheet), "data_sheet"},
    {"on", static_cast<int>(ErrorLevel::kDataSheet), "data_sheet"},
    {"off", static_cast<int>(ErrorLevel::kIdeal), "ideal"},
    {"no", static_cast<int>(ErrorLevel::kIdeal), "ideal"},
});

constexpr auto kFailActionWords = std::to_array<Word>({
    {"brake", static_cast<int>(FailAction::kBrake)},
    {"coast", static_cast<int>(FailAction::kCoast)},
});

constexpr auto kReactionWords = std::to_array<Word>({
    {"off", static_cast<int>(Reaction::kOff)},
    {"warn", static_cast<int>(Reaction::kWarn)},
    {"slow", static_cast<int>(Reaction::kSlow)},
    {"ramp", static_cast<int>(Reaction::kRamp)},
    {"brake", static_cast<int>(Reaction::kBrake)},
});

constexpr auto kRecordWords = std::to_array<Word>({
    {"motion", static_cast<int>(RecordMode::kMotion)},
    {"always", static_cast<int>(RecordMode::kAlways)},
    {"request", static_cast<int>(RecordMode::kRequest)},
    {"off", static_cast<int>(RecordMode::kOff)},
});

}  // namespace

std::span<const Word> words_of(const Field& field) {
  if (std::holds_alternative<ClockMode*>(field)) return kClockWords;
  if (std::holds_alternative<RealtimePolicy*>(field)) return kRealtimeWords;
  if (std::holds_alternative<TyreModel*>(field)) return kTyreWords;
  if (std::holds_alternative<ErrorLevel*>(field)) return kErrorLevelWords;
  if (std::holds_alternative<Reaction*>(field)) return kReactionWords;
  if (std::holds_alternative<FailAction*>(field)) return kFailActionWords;
  if (std::holds_alternative<RecordMode*>(field)) return kRecordWords;
  return {};
}

}  // namespace robot_control
