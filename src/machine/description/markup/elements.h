#pragma once
/// Short words for elements of XML and their attributes.

#include <tinyxml.h>

#include <string>
#include <vector>

namespace robot_control {

/// "" if there is no such attribute.
inline std::string attribute(const TiXmlElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value == nullptr ? "" : value;
}

/// The elements directly within `parent`, in the order of the file; with `kind` those of that name. They may be removed
/// meanwhile.
template <class Element>
std::vector<Element*> children(Element& parent, const char* kind = nullptr) {
  std::vector<Element*> found;
  for (Element* child = parent.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    if (kind == nullptr || child->ValueStr() == kind) found.push_back(child);
  }
  return found;
}

}  // namespace robot_control
