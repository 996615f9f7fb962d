#pragma once
/// Functions of roscpp that this program replaces by checked ones: does the loaded roscpp really call ours?
///
/// A shared library finds a function that it imports through the global scope, and there the executable comes first
/// (System V gABI, "Shared Object Dependencies"): a function that the executable defines and exports replaces that of a
/// library. That holds as long as the library refers to it by name, in its table of relocations; a library built with
/// -Bsymbolic, or one that had the function inlined, would not.

#include <string>
#include <vector>

namespace robot_control {

struct Interposed {
  std::string library;      ///< part of its file's name: "libroscpp.so"
  std::string symbol;       ///< mangled
  std::string description;  ///< for the warning: "the parser of connection headers"
};

/// The loaded library refers to `symbol` by name, and that name leads into this program. False where no such library is
/// loaded.
bool leads_here(const Interposed& function);

/// Descriptions of those that do not lead here.
std::vector<std::string> not_replaced(const std::vector<Interposed>& functions);

}  // namespace robot_control
