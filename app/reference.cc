#include "app/reference.h"

#include <toml++/toml.h>

#include "core/errors.h"

namespace annulus::app {

namespace {

std::string text_of(const toml::table& table, const char* key, bool required, const std::string& file) {
  const auto value = table[key].value<std::string>();
  if (!value && required) {
    throw InputError(file + ":" + std::to_string(table.source().begin.line) + ": '" + key + "' is missing");
  }
  return value.value_or("");
}

Reference::Order order_of(const toml::table& table, const std::string& file) {
  Reference::Order order{.quantity = text_of(table, "quantity", true, file),
                         .rings = {},
                         .values = {},
                         .margin = table["margin"].value_or(0.0),
                         .statement = text_of(table, "statement", true, file),
                         .where = text_of(table, "where", false, file)};
  if (const auto* rings = table["rings"].as_array()) {
    for (const auto& ring : *rings) order.rings.push_back(ring.value_or(std::string()));
  }
  if (const auto* values = table["values"].as_array()) {
    for (const auto& value : *values) order.values.push_back(value.value_or(0.0));
  }
  if (order.rings.empty()) throw InputError(file + ": an [[order]] names no rings");
  if (!order.values.empty() && order.values.size() != order.rings.size()) {
    throw InputError(file + ": an [[order]] needs one value per ring, or none");
  }
  return order;
}

}  // namespace

Reference read_reference(const std::filesystem::path& file) {
  toml::table root;
  try {
    root = toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    throw InputError(file.string() + ":" + std::to_string(error.source().begin.line) + ": " +
                     std::string(error.description()));
  }
  const std::string name = file.string();
  Reference reference;
  reference.source = text_of(root, "source", true, name);
  reference.doi = text_of(root, "doi", false, name);
  reference.note = text_of(root, "note", false, name);
  if (const auto* orders = root["order"].as_array()) {
    for (const auto& order : *orders) {
      if (const auto* table = order.as_table()) reference.orders.push_back(order_of(*table, name));
    }
  }
  if (const auto* pins = root["at_pin"].as_array()) {
    for (const auto& pin : *pins) {
      const auto* table = pin.as_table();
      if (!table) continue;
      reference.at_pins.push_back({text_of(*table, "ring", true, name), text_of(*table, "statement", true, name),
                                   text_of(*table, "where", false, name)});
    }
  }
  if (const auto* values = root["value"].as_array()) {
    for (const auto& value : *values) {
      const auto* table = value.as_table();
      if (!table) continue;
      const auto number = (*table)["value"].value<double>();
      if (!number) throw InputError(name + ": a [[value]] needs the published number, value = ...");
      reference.values.push_back({text_of(*table, "quantity", true, name), *number, (*table)["within"].value_or(0.0),
                                  text_of(*table, "statement", true, name), text_of(*table, "where", false, name)});
    }
  }
  return reference;
}

}  // namespace annulus::app
