#pragma once
/// A FixedVector is a short list that holds its elements itself. It never allocates and is trivially copyable, so that
/// the state of a law can be copied byte by byte (signals/law_snapshot.h).

#include <array>
#include <cstddef>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace robot_control {

template <class Element, std::size_t Capacity>
class FixedVector {
 public:
  FixedVector() noexcept = default;

  /// Throws std::length_error if `count` > Capacity.
  FixedVector(std::size_t count, const Element& element) {
    for (std::size_t i = 0; i < count; ++i) emplace_back(element);
  }

  /// Throws std::length_error if the list is full.
  template <class... Arguments>
  Element& emplace_back(Arguments&&... arguments) {
    if (size_ == Capacity) throw std::length_error("more than " + std::to_string(Capacity) + " elements");
    return *std::construct_at(data() + size_++, std::forward<Arguments>(arguments)...);
  }

  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }

  Element* data() noexcept { return std::launder(reinterpret_cast<Element*>(memory_.data())); }
  const Element* data() const noexcept { return std::launder(reinterpret_cast<const Element*>(memory_.data())); }
  Element& operator[](std::size_t index) noexcept { return data()[index]; }
  const Element& operator[](std::size_t index) const noexcept { return data()[index]; }
  Element* begin() noexcept { return data(); }
  Element* end() noexcept { return data() + size_; }
  const Element* begin() const noexcept { return data(); }
  const Element* end() const noexcept { return data() + size_; }

 private:
  static_assert(std::is_trivially_destructible_v<Element>);

  alignas(Element) std::array<std::byte, Capacity * sizeof(Element)> memory_{};
  std::size_t size_ = 0;
};

}  // namespace robot_control
