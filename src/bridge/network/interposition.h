#pragma once
/// Functions of roscpp that this program replaces by checked ones: does the loaded roscpp really call ours?
///
/// A shared library finds a function that it imports through the global scope, and there the executable comes first
/// (System V gABI, "Shared Object Dependencies"): a function that the executable defines and exports replaces that of a
/// library. That holds as long as the library refers to it by name, in its table of relocations; a library built with
/// -Bsymbolic, or one that had the function inlined, would not.

#include <dlfcn.h>

#include <cstring>
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

/// The function of this type that the program's own one replaces: a member that is not virtual.
template <class Member>
Member original(const char* symbol) {
  void* const address = dlsym(RTLD_NEXT, symbol);
  Member member{};
  std::memcpy(&member, &address, sizeof address);  // its address and 0
  return member;
}

/// Descriptions of those that do not lead here.
std::vector<std::string> not_replaced(const std::vector<Interposed>& functions);

}  // namespace robot_control
