#pragma once

#include <deque>
#include <pugixml.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/scene.h"
#include "fem/problem/material.h"
#include "geometry/gear.h"

namespace annulus::app {

/// A REXS document as it grows; components and relations are numbered from 1.
class RexsWriter {
 public:
  explicit RexsWriter(const Scene& scene);

  struct Component {
    int id = 0;
    std::string type;
    pugi::xml_node node;

    void attribute(const std::string& name, const std::string& unit, const std::string& value);
    void attribute(const std::string& name, const std::string& unit, double value);
  };

  Component component(const std::string& type, const std::string& name);
  void relation(const char* type, const std::vector<std::pair<const char*, const Component*>>& roles);

  /// Values of the scene that REXS has no name for, of these tables (and ring): by their keys in a table, of several
  /// tables by whole keys.
  void custom_attributes(Component& component, const std::vector<std::string>& tables, const std::string& ring = "");
  /// A gear with its material, and both its flanks, which have pressure angle and profile shift.
  Component gear(const std::string& name, const GearInput& input, const geometry::Gear& gear);
  /// A cylindrical stage, part of a planetary stage or of the gear unit. The sign of the centre distance (m) is that of
  /// the product of the numbers of teeth.
  void stage(const std::string& name, double centre_distance, const Component& whole, const Component& first,
             const Component& second);

  [[nodiscard]] std::string text() const;

 private:
  const Component& material(const fem::Material& of);

  const Scene& scene_;
  pugi::xml_document document_;
  pugi::xml_node relations_, components_;
  int last_component_ = 0, last_relation_ = 0;
  std::deque<std::pair<fem::Material, Component>> materials_;  ///< each once
};

}  // namespace annulus::app
