#include "machine/description/markup/free_root.h"

#include <set>

#include "machine/description/markup/elements.h"

namespace robot_control {
namespace {

std::string link_at(const TiXmlElement& joint, const char* end) {
  const TiXmlElement* element = joint.FirstChildElement(end);
  return element == nullptr ? "" : attribute(*element, "link");
}

/// Null: there is no such link.
const TiXmlElement* named_link(const TiXmlElement& robot, const std::string& name) {
  const TiXmlElement* link = robot.FirstChildElement("link");
  while (link != nullptr && attribute(*link, "name") != name) link = link->NextSiblingElement("link");
  return link;
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
  const std::string type = attribute(joint, "type");
  return type == "floating" || type == "planar";
}

const TiXmlElement* free_joint(const TiXmlElement& robot) {
  std::multiset<std::string> ends;
  for (const TiXmlElement* joint : children(robot, "joint"))
    ends.insert({link_at(*joint, "parent"), link_at(*joint, "child")});
  for (const TiXmlElement* joint : children(robot, "joint")) {
    const std::string parent = link_at(*joint, "parent");
    if (!is_free(*joint) || ends.count(parent) != 1) continue;
    const TiXmlElement* const link = named_link(robot, parent);
    if (link != nullptr && is_empty(*link)) return joint;
  }
  return nullptr;
}

FreeRoot take_free_root(TiXmlElement& robot) {
  const TiXmlElement* const joint = free_joint(robot);
  if (joint == nullptr) return {};
  FreeRoot root{.joint = attribute(*joint, "name"),
                .type = attribute(*joint, "type"),
                .link = link_at(*joint, "parent"),
                .base = link_at(*joint, "child")};
  remove_child(robot, joint);
  remove_child(robot, named_link(robot, root.link));
  return root;
}

}  // namespace robot_control
