#pragma once
/// Checks whether the loaded roscpp really calls the functions by which this program replaces roscpp's own.
///
/// The dynamic linker looks up the imported functions of a shared library in the global scope. The executable comes
/// first there (System V gABI, "Shared Object Dependencies"). So a function that the executable defines and exports
/// replaces the library's function of this name. This requires that the library's table of relocations refers to the
/// function by name. A library built with -Bsymbolic, or with the function inlined, does not.

#include <dlfcn.h>

#include <cstring>
#include <string>
#include <vector>

namespace robot_control {

struct Interposed {
  std::string library;      ///< part of the library's file name: "libroscpp.so"
  std::string symbol;       ///< mangled name of the function
  std::string description;  ///< words for the warning: "the parser of connection headers"
};

/// Returns whether the loaded library refers to `symbol` by name and that name is resolved to this program. Returns
/// false if no such library is loaded.
bool leads_here(const Interposed& function);

/// Returns the library's member function that this program replaces. It must not be virtual.
template <class Member>
Member original(const char* symbol) {
  void* const address = dlsym(RTLD_NEXT, symbol);
  Member member{};
  std::memcpy(&member, &address, sizeof address);  // the pointer is its address and 0
  return member;
}

/// Returns the descriptions of those functions for which `leads_here` is false.
std::vector<std::string> not_replaced(const std::vector<Interposed>& functions);

}  // namespace robot_control
