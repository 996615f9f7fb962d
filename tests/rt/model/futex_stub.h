#pragma once
/// Whom a publication wakes is none of the model's affair: what counts is what a reader finds who saw `sequence`.

#include "rt/model/memory_model.h"

namespace robot_control::model {

inline void futex_wake_all(ModelAtomic<std::uint32_t>&) noexcept {}

}  // namespace robot_control::model
