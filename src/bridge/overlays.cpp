#include "bridge/overlays.h"

#include <xmlrpcpp/XmlRpcValue.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace robot_control {
namespace {

std::string number(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

/// As a YAML scalar that is a text whatever stands in it: the server knows types.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\n') {
      result += "\\n";
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string text_of(XmlRpc::XmlRpcValue value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value) ? "true" : "false";
    case XmlRpc::XmlRpcValue::TypeInt:
      return std::to_string(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return number(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString:
      return quoted(static_cast<std::string>(value));
    case XmlRpc::XmlRpcValue::TypeArray: {
      std::string text = "[";
      for (int i = 0; i < value.size(); ++i) text.append(i == 0 ? "" : ", ").append(text_of(value[i]));
      return text.append("]");
    }
    default:
      return quoted(value.toXml());  // what no parameter is: the schema refuses it
  }
}

}  // namespace

std::vector<Overlay> overlays_of(const XmlRpc::XmlRpcValue& tree, const std::string& block,
                                 const std::string& server_name, const std::vector<std::string>& ignored) {
  std::vector<Overlay> overlays;
  if (tree.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    if (tree.valid()) overlays.push_back({block, text_of(tree), server_name});
    return overlays;
  }
  XmlRpc::XmlRpcValue copy = tree;  // its iterators are not const
  for (auto& [key, value] : copy) {
    if (std::ranges::find(ignored, key) != ignored.end()) continue;
    const std::vector<Overlay> inner = overlays_of(value, block + "." + key, server_name + "/" + key);
    overlays.insert(overlays.end(), inner.begin(), inner.end());
  }
  return overlays;
}

}  // namespace robot_control
