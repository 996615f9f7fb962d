#pragma once
/// The rows of a law's last cycles, whose frames a channel of one thread refers to (FrameWriter::publish_in_place).

#include <cstddef>
#include <cstdint>
#include <vector>

namespace robot_control {

template <class Row>
class Rows {
 public:
  /// `kept` is the number of cycles that a row stays unchanged (FrameWriter::kept).
  explicit Rows(std::size_t kept) : rows_(kept) {}

  /// Returns the row of a new cycle, with the content of an earlier one.
  Row& begin(std::uint64_t cycle) noexcept {
    last_ = cycle % rows_.size();
    return rows_[last_];
  }

  Row& last() noexcept { return rows_[last_]; }
  const Row& last() const noexcept { return rows_[last_]; }

  /// Calls `change` with every row.
  template <class Change>
  void for_each(Change change) noexcept {
    for (Row& row : rows_) change(row);
  }

 private:
  std::vector<Row> rows_;
  std::size_t last_ = 0;
};

}  // namespace robot_control
