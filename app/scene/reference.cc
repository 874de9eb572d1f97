#include "app/scene/reference.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene_limits.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

/// One file of references, whose entries are refused with their line.
class ReferenceReader {
 public:
  explicit ReferenceReader(std::string file) : file_(std::move(file)) {}

  [[nodiscard]] InputError refusal(const toml::node& at, const std::string& what) const {
    return InputError(fmt::format("{}:{}: {}", file_, std::max<std::uint32_t>(1, at.source().begin.line), what));
  }

  [[nodiscard]] std::string text(const toml::table& table, const char* key, bool required) const {
    const auto* node = table.get(key);
    if (!node && !required) return "";
    const auto value = node ? node->value_exact<std::string>() : std::nullopt;
    if (!value)
      throw refusal(node ? *node : table,
                    fmt::format("'{}' {}", key, node ? "must be a text in quotes" : "is missing"));
    if (has_controls(*value))
      throw refusal(*node, fmt::format("'{}' must be one line without control characters", key));
    return *value;
  }

  [[nodiscard]] double number(const toml::table& table, const char* key, double low,
                              std::optional<double> absent) const {
    const auto* node = table.get(key);
    if (!node && absent) return *absent;
    if (!node) throw refusal(table, fmt::format("a [[value]] needs the published number, {} = ...", key));
    return number(*node, key, low);
  }

  [[nodiscard]] double number(const toml::node& node, const char* key, double low) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value) || *value < low)
      throw refusal(node, fmt::format("'{}' must be a number{}", key, low < 0 ? "" : " from zero on"));
    return *value;
  }

  [[nodiscard]] const toml::array* list(const toml::table& table, const char* key) const {
    const auto* node = table.get(key);
    if (node && !node->is_array()) throw refusal(*node, fmt::format("'{}' must be a list", key));
    return node ? node->as_array() : nullptr;
  }

  /// The tables [[key]].
  [[nodiscard]] std::vector<const toml::table*> tables(const toml::table& root, const char* key) const {
    std::vector<const toml::table*> result;
    if (const auto* array = list(root, key))
      for (const auto& entry : *array) {
        if (!entry.is_table()) throw refusal(entry, fmt::format("write each {0} as [[{0}]]", key));
        result.push_back(entry.as_table());
      }
    return result;
  }

  [[nodiscard]] Reference::Order order(const toml::table& table) const {
    Reference::Order order{.quantity = text(table, "quantity", true),
                           .rings = {},
                           .values = {},
                           .margin = number(table, "margin", 0, 0.0),
                           .statement = text(table, "statement", true),
                           .where = text(table, "where", false)};
    if (const auto* rings = list(table, "rings"))
      for (const auto& ring : *rings) {
        if (!ring.is_string()) throw refusal(ring, "'rings' must be names of rings in quotes");
        order.rings.push_back(**ring.as_string());
      }
    if (const auto* values = list(table, "values"))
      for (const auto& value : *values) order.values.push_back(number(value, "values", -HUGE_VAL));
    if (order.rings.empty()) throw refusal(table, "an [[order]] names no rings");
    if (!order.values.empty() && order.values.size() != order.rings.size())
      throw refusal(table, "an [[order]] needs one value per ring, or none");
    return order;
  }

  [[nodiscard]] toml::table parsed() const {
    std::ifstream in(file_, std::ios::binary);
    if (!in || std::filesystem::is_directory(file_)) throw InputError(file_ + ":1: cannot be read; is the path right?");
    std::string text(largest_scene + 1, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
    check_scene_text(text, file_);
    try {
      return toml::parse(text, file_);
    } catch (const toml::parse_error& error) {
      throw InputError(fmt::format("{}:{}: {}", file_, error.source().begin.line, error.description()));
    }
  }

 private:
  std::string file_;
};

}  // namespace

Reference read_reference(const std::filesystem::path& file) {
  const ReferenceReader reader(file.string());
  const auto root = reader.parsed();
  Reference reference;
  reference.source = reader.text(root, "source", true);
  reference.doi = reader.text(root, "doi", false);
  reference.note = reader.text(root, "note", false);
  for (const auto* table : reader.tables(root, "order")) reference.orders.push_back(reader.order(*table));
  for (const auto* table : reader.tables(root, "at_pin"))
    reference.at_pins.push_back({reader.text(*table, "ring", true), reader.text(*table, "statement", true),
                                 reader.text(*table, "where", false)});
  for (const auto* table : reader.tables(root, "value"))
    reference.values.push_back({reader.text(*table, "quantity", true),
                                reader.number(*table, "value", -HUGE_VAL, std::nullopt),
                                reader.number(*table, "within", 0, 0.0), reader.text(*table, "statement", true),
                                reader.text(*table, "where", false)});
  return reference;
}

}  // namespace annulus::app
