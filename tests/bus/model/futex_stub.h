#pragma once
/// The model wakes no thread: it only checks what a reader finds after it has read `sequence`.

#include "bus/model/memory_model.h"

namespace robot_control::model {

inline void futex_wake_all(ModelAtomic<std::uint32_t>&) noexcept {}

}  // namespace robot_control::model
