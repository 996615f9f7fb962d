#pragma once
/// The names of signals/names.h for Python.

#include <pybind11/pybind11.h>

namespace robot_control {

/// By the word that stands as the unit of a log's column: of bits a list of (name, sentence, remedy, unit of its
/// evidence), lowest first; of states a
/// list of names in the order of their numbers.
pybind11::dict signal_names();

}  // namespace robot_control
