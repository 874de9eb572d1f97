#include "app/scene/reference.h"

#include <fmt/format.h>

#include "app/scene/scene_declare.h"
#include "app/scene/toml/values.h"

namespace annulus::app {

namespace {

constexpr double widest = 1e30;

/// The tables [[path]].
template <class Entry>
Declarations<Entry> entries(const char* path, const char* meaning, std::vector<Entry> Reference::*list) {
  Declarations<Entry> table(path, meaning, list);
  table.optional();
  return table;
}

/// What the paper says, and where.
template <class Entry>
Table stated(Declarations<Entry>& table) {
  table.key("statement", &Entry::statement, "The published statement.").required();
  table.key("where", &Entry::where, "Section or figure of the source.");
  return table.done();
}

std::vector<Table> reference_tables() {
  Declarations<Reference> top("", "");
  top.key("source", &Reference::source, "Where the values were published.").required();
  top.key("doi", &Reference::doi, "Its digital object identifier.");
  top.key("note", &Reference::note, "Remarks that help to judge the comparison.");

  using Order = Reference::Order;
  auto order = entries("order", "Variants in the order of one result.", &Reference::orders);
  order.key("quantity", &Order::quantity, "The result.").required();
  order.key("variants", &Order::variants, "That with the largest value first; a single one is larger than all others.")
      .not_empty("variant")
      .required();
  order.key("values", &Order::values, "Published numbers, one per variant or none.").from(-widest, widest);
  order.key("margin", &Order::margin, "Published relative difference.").from(0, widest);

  using AtPin = Reference::AtPin;
  auto at_pin = entries("at_pin", "A ring stiffer at a pin than between pins.", &Reference::at_pins);
  at_pin.key("ring", &AtPin::ring, "Its name.").required();

  using Number = Reference::Value;
  auto value = entries("value", "A published number.", &Reference::values);
  value.key("quantity", &Number::quantity, "The result.").required();
  value.key("value", &Number::value, "The published number.").required().from(-widest, widest);
  value.key("within", &Number::within, "Relative difference that counts as agreement.").from(0, widest);
  return {top.done(), stated(order), stated(at_pin), stated(value)};
}

}  // namespace

Reference read_reference(const std::filesystem::path& file) {
  static const auto tables = reference_tables();
  const Scene holder = read_tables(parse_toml(text_of_file(file), file.string()), file, &tables);
  auto reference = holder.own<Reference>();
  for (std::size_t i = 0; i < reference.orders.size(); ++i) {
    const auto& order = reference.orders[i];
    if (order.values.empty() || order.values.size() == order.variants.size()) continue;
    const Input& values = *holder.find("order.values", i);
    throw SceneError(file.string(),
                     {{values.line, values.column,
                       fmt::format("order.values: needs one value per variant, or none: {} values for {} variants",
                                   order.values.size(), order.variants.size())}});
  }
  return reference;
}

}  // namespace annulus::app
