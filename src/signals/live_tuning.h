#pragma once
/// A LiveTuning holds the limits and gains with which a controller runs, where they may change meanwhile. Its content
/// is a struct of numbers that only the kind of robot knows (signals/wheeled/drive_tuning.h). The loop hands it over
/// between two cycles, compares it, and writes it to every row of the controller's trace.

#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <type_traits>

namespace robot_control {

/// A kind without such values leaves every byte 0.
struct LiveTuning {
  alignas(std::uint64_t) std::array<std::byte, 640> content{};

  bool operator==(const LiveTuning&) const = default;
};

/// Returns the content, const if the LiveTuning is. The zero bytes of a new LiveTuning are a Content of zeros.
template <class Content>
auto& content_of(auto& tuning) noexcept {
  static_assert(std::is_trivially_copyable_v<Content> && sizeof(Content) <= sizeof tuning.content &&
                alignof(Content) <= alignof(std::uint64_t));
  using View = std::conditional_t<std::is_const_v<std::remove_reference_t<decltype(tuning)>>, const Content, Content>;
  return *std::launder(reinterpret_cast<View*>(tuning.content.data()));
}

template <class Content>
LiveTuning tuning_of(const Content& content) noexcept {
  LiveTuning tuning;
  content_of<Content>(tuning) = content;
  return tuning;
}

}  // namespace robot_control
