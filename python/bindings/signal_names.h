#pragma once
/// signal_names returns the names of signals/names.h for Python.

#include <pybind11/pybind11.h>

namespace robot_control {

/// The keys are the words that logs use as the unit of a column. For bits the value is a list of (name, sentence,
/// remedy, unit of the evidence), lowest bit first. Roles and topics stand in braces there (signals/robot_kinds.h).
/// Roles are (role, program) in the order of Role. For states it is a list of names in the order of their numbers.
pybind11::dict signal_names();

}  // namespace robot_control
