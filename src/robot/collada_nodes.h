#pragma once
/// A look at a COLLADA text before assimp sees it: assimp 5.2 follows its nodes by recursion, without an end when
/// they stand for each other in a circle, and out of its stack when they nest too deep.

#include <string>
#include <string_view>

namespace robot_control {

inline constexpr int kDeepestElement = 256;           ///< one in another, instances of nodes included
inline constexpr std::size_t kMostNodes = 1'000'000;  ///< of all instances, each with what it holds

/// What is wrong with the nodes: elements or instances nest deeper than kDeepestElement (in a circle they do),
/// or come to more than kMostNodes. Empty: nothing.
std::string collada_node_problem(std::string_view xml);

}  // namespace robot_control
