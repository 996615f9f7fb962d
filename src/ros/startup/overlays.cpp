#include "ros/startup/overlays.h"

#include <xmlrpcpp/XmlRpcValue.h>

#include <algorithm>

#include "files/message_text.h"
#include "parameters/parameters_text.h"

namespace robot_control {
namespace {

std::string text_of(XmlRpc::XmlRpcValue value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value) ? "true" : "false";
    case XmlRpc::XmlRpcValue::TypeInt:
      return std::to_string(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return yaml_number(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString:
      return yaml_quoted(static_cast<std::string>(value));
    case XmlRpc::XmlRpcValue::TypeArray: {
      std::string text = "[";
      for (int i = 0; i < value.size(); ++i) text.append(i == 0 ? "" : ", ").append(text_of(value[i]));
      return text.append("]");
    }
    default:
      return yaml_quoted(value.toXml());  // no parameter has this type: the schema refuses it
  }
}

ParameterError wrong_type(const XmlRpc::XmlRpcValue& value, const std::string& name, const std::string& rule) {
  const bool group = value.getType() == XmlRpc::XmlRpcValue::TypeStruct;
  const std::string shown = group ? " is a group of parameters" : " = " + printable(text_of(value));
  return ParameterError(name + shown + ": must be " + rule + "; set it, or remove it: " + "`rosparam delete " + name +
                        "`");
}

bool is_empty_text(XmlRpc::XmlRpcValue value) {
  return value.getType() == XmlRpc::XmlRpcValue::TypeString && static_cast<std::string>(value).empty();
}

}  // namespace

std::vector<Overlay> overlays_of(const XmlRpc::XmlRpcValue& tree, const std::string& block,
                                 const std::string& server_name, const std::vector<std::string>& ignored) {
  std::vector<Overlay> overlays;
  if (tree.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    if (tree.valid() && !is_empty_text(tree)) overlays.push_back({block, text_of(tree), server_name});
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

std::string text_parameter(const XmlRpc::XmlRpcValue& value, const std::string& name, const std::string& what) {
  if (!value.valid()) return "";
  if (value.getType() != XmlRpc::XmlRpcValue::TypeString) throw wrong_type(value, name, "a text, " + what);
  return static_cast<std::string>(XmlRpc::XmlRpcValue(value));
}

bool truth_parameter(const XmlRpc::XmlRpcValue& value, const std::string& name) {
  if (!value.valid()) return false;
  if (value.getType() != XmlRpc::XmlRpcValue::TypeBoolean) throw wrong_type(value, name, "true or false");
  return static_cast<bool>(XmlRpc::XmlRpcValue(value));
}

std::vector<std::string> override_lines(const std::vector<Overlay>& overlays, const std::string& file,
                                        const std::set<std::string>& unsaid) {
  std::vector<std::string> lines;
  for (const Overlay& overlay : overlays) {
    if (unsaid.contains(overlay.path.substr(overlay.path.find('.') + 1))) continue;
    lines.push_back(overlay.origin + " = " + overlay.text + " overrides " + overlay.path + " of " + file);
  }
  return lines;
}

}  // namespace robot_control
