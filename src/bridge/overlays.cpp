#include "bridge/overlays.h"

#include <xmlrpcpp/XmlRpcValue.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace robot_control {
namespace {

std::string number(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << value;
  return text.str();
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
      return static_cast<std::string>(value);
    default:
      return value.toXml();  // a list where a value belongs: the schema refuses it
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
