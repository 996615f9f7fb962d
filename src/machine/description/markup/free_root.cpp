#include "machine/description/markup/free_root.h"

#include <set>

namespace robot_control {
namespace {

std::string text_of(const TiXmlElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value == nullptr ? "" : value;
}

std::string link_at(const TiXmlElement& joint, const char* end) {
  const TiXmlElement* element = joint.FirstChildElement(end);
  return element == nullptr ? "" : text_of(*element, "link");
}

/// Returns the first of these elements with the name; null: there is none.
const TiXmlElement* named(const TiXmlElement& robot, const char* kind, const std::string& name) {
  const TiXmlElement* element = robot.FirstChildElement(kind);
  while (element != nullptr && text_of(*element, "name") != name) element = element->NextSiblingElement(kind);
  return element;
}

bool is_empty(const TiXmlElement& link) {
  return link.FirstChildElement("inertial") == nullptr && link.FirstChildElement("visual") == nullptr &&
         link.FirstChildElement("collision") == nullptr;
}

void remove_child(TiXmlElement& robot, const TiXmlElement* element) {
  TiXmlNode* node = robot.FirstChild();
  while (node != element) node = node->NextSibling();
  robot.RemoveChild(node);
}

}  // namespace

bool is_free(const TiXmlElement& joint) {
  const std::string type = text_of(joint, "type");
  return type == "floating" || type == "planar";
}

const TiXmlElement* free_joint(const TiXmlElement& robot) {
  std::multiset<std::string> ends;
  for (const TiXmlElement* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    ends.insert({link_at(*joint, "parent"), link_at(*joint, "child")});
  }
  for (const TiXmlElement* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const std::string parent = link_at(*joint, "parent");
    if (!is_free(*joint) || ends.count(parent) != 1) continue;
    const TiXmlElement* const link = named(robot, "link", parent);
    if (link != nullptr && is_empty(*link)) return joint;
  }
  return nullptr;
}

FreeRoot take_free_root(TiXmlElement& robot) {
  const TiXmlElement* const joint = free_joint(robot);
  if (joint == nullptr) return {};
  FreeRoot root{.joint = text_of(*joint, "name"),
                .type = text_of(*joint, "type"),
                .link = link_at(*joint, "parent"),
                .base = link_at(*joint, "child")};
  remove_child(robot, joint);
  remove_child(robot, named(robot, "link", root.link));
  return root;
}

}  // namespace robot_control
