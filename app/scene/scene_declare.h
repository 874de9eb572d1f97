#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "app/scene/scene_schema.h"
#include "core/units.h"

/// The small language in which the tables of a scene are declared.
namespace annulus::app {

/// Below any body of a gear set; lighter ones on stiff springs have frequencies beyond any number.
inline constexpr double lightest_kg = 1e-9, least_inertia_kg_m2 = 1e-18;

struct Unit {
  const char* suffix;
  const char* text;
  double si;
};
// The longest suffix wins, so the compound ones stand first.
inline constexpr Unit key_units[] = {
    {"_kg_per_m3", "kg/m³", 1}, {"_N_per_m", "N/m", 1},      {"_kg_m2", "kg m²", 1},   {"_mm", "mm", units::mm},
    {"_um", "µm", units::um},   {"_GPa", "GPa", units::GPa}, {"_kW", "kW", units::kW}, {"_rpm", "r/min", units::rpm},
    {"_deg", "°", units::deg},  {"_Nm", "N m", 1},           {"_kg", "kg", 1},         {"_Nm_per_rad", "N m/rad", 1},
};

template <class T>
struct Choice {
  std::string name;
  T value;
  std::string old_name{};  ///< refused with `name`
};

/// Further properties of a key, chained behind its declaration. Conditions name keys of the same table, keys of others
/// with their table, and "[tables]" (condition.h).
class Declared {
 public:
  explicit Declared(Parameter& p) : p_(p) {}
  Declared& required() { return p_.presence = Parameter::Presence::required, *this; }
  /// A key stored in an optional has its default only where its conditions (only_if) hold.
  Declared& fallback(Value value, const char* why) {
    p_.presence = Parameter::Presence::defaulted;
    p_.default_value = std::move(value);
    p_.note = why;
    return *this;
  }
  /// What absence means.
  Declared& absent(const char* what_then) { return p_.note = what_then, *this; }
  /// What conditions take this key for when its table is absent.
  Declared& without_table(const char* value) { return p_.without_table = value, *this; }

  Declared& from(double low, double high) { return p_.low = low, p_.high = high, *this; }
  Declared& above(double low, double high) { return p_.low_included = false, from(low, high); }
  /// Most values of a list.
  Declared& longest(std::size_t values) { return p_.longest = values, *this; }
  Declared& infinite() { return p_.may_be_infinite = true, *this; }
  /// The only permitted texts of a list of texts.
  Declared& among(std::vector<std::string> names) { return p_.choices = std::move(names), *this; }

  /// Refused elsewhere. A default that holds everywhere may be written everywhere.
  Declared& only_if(Condition when, const char* why = "") { return add(p_.only_if, std::move(when), why); }
  Declared& required_if(Condition when, const char* why = "") { return add(p_.required_if, std::move(when), why); }
  Declared& refused_if(Condition when, const char* why) { return add(p_.refused_if, std::move(when), why); }
  /// Required there, refused elsewhere.
  Declared& needed_if(const Condition& when, const char* why = "") { return required_if(when, why).only_if(when, why); }
  /// Both keys are given, or none.
  Declared& together_with(const char* key) { return p_.together_with.emplace_back(key), *this; }
  /// Exactly one is given where the conditions of this key hold: this key, or all of `keys`.
  Declared& instead_of(std::vector<std::string> keys) { return p_.instead_of = std::move(keys), *this; }
  /// An earlier name, refused with the present one.
  Declared& formerly(const char* name) { return p_.old_names.emplace_back(name), *this; }

 private:
  Declared& add(std::vector<KeyRule>& rules, Condition when, const char* why) {
    rules.push_back({std::move(when), why, {}});
    return *this;
  }

  Parameter& p_;
};

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

/// Builds a table whose keys are bound to the members of `Section`.
template <class Section>
class Declarations {
 public:
  Declarations(std::string path, std::string meaning, Section& (*section)(Scene&, std::size_t)) : section_(section) {
    table_.path = std::move(path);
    table_.meaning = std::move(meaning);
  }

  Declarations& repeated(std::function<void(Scene&, std::size_t)> resize) {
    table_.repeated = true;
    table_.resize = std::move(resize);
    return *this;
  }
  Declarations& optional() { return table_.required = false, *this; }
  /// Optional, and without effect when absent.
  Declarations& on_request() { return table_.on_request = true, optional(); }
  /// A table of studies, refused without [dynamics].
  Declarations& study() {
    table_.role = Table::Role::study;
    return on_request().only_if(given("[dynamics]"), "studies vary what the lumped model answers");
  }
  /// Refused elsewhere.
  Declarations& only_if(Condition when, const char* why = "") {
    table_.only_if.push_back({std::move(when), why, {}});
    return *this;
  }
  Table done() { return std::move(table_); }

  template <class Base, class T>
  Declared key(const char* name, T Base::*member, const char* meaning) {
    Parameter& p = declare(name, meaning);
    constexpr bool real = std::is_same_v<T, double> || std::is_same_v<T, std::optional<double>>;
    p.default_where_it_applies = is_optional<T>;
    if constexpr (real) {
      p.kind = Parameter::Kind::real;
      store(p, member, [si = p.si](const Value& v) { return std::get<double>(v) * si; });
    } else if constexpr (std::is_same_v<T, int> || std::is_same_v<T, std::optional<int>>) {
      p.kind = Parameter::Kind::integer;
      store(p, member, [](const Value& v) { return static_cast<int>(std::get<long>(v)); });
    } else if constexpr (std::is_same_v<T, std::string> || std::is_same_v<T, std::optional<std::string>>) {
      p.kind = Parameter::Kind::text;
      store(p, member, [](const Value& v) { return std::get<std::string>(v); });
    } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
      p.kind = Parameter::Kind::texts;
      store(p, member, [](const Value& v) { return std::get<std::vector<std::string>>(v); });
    } else {
      static_assert(std::is_same_v<T, std::vector<double>>);
      p.kind = Parameter::Kind::reals;
      store(p, member, [si = p.si](const Value& v) {
        auto list = std::get<std::vector<double>>(v);
        for (auto& x : list) x *= si;
        return list;
      });
    }
    return Declared(p);
  }

  template <class Base, class T>
  Declared choice(const char* name, T Base::*member, std::vector<Choice<T>> choices, const char* meaning) {
    Parameter& p = declare(name, meaning);
    p.kind = Parameter::Kind::choice;
    for (const auto& c : choices) {
      p.choices.push_back(c.name);
      if (!c.old_name.empty()) p.old_choices.push_back({c.old_name, c.name});
    }
    store(p, member, [choices = std::move(choices)](const Value& v) {
      const auto& text = std::get<std::string>(v);
      return std::find_if(choices.begin(), choices.end(), [&](const auto& c) { return c.name == text; })->value;
    });
    return Declared(p);
  }

 private:
  Parameter& declare(const char* name, const char* meaning) {
    Parameter& p = table_.parameters.emplace_back();
    p.table = table_.path;
    p.name = name;
    p.meaning = meaning;
    for (const auto& unit : key_units) {
      const std::string suffix = unit.suffix;
      if (p.name.size() > suffix.size() && p.name.ends_with(suffix)) {
        p.unit = unit.text;
        p.si = unit.si;
        break;
      }
    }
    return p;
  }

  template <class Base, class T, class Convert>
  void store(Parameter& p, T Base::*member, Convert convert) {
    p.store = [section = section_, member, convert](Scene& scene, std::size_t index, const Value& value) {
      section(scene, index).*member = convert(value);
    };
  }

  Table table_;
  Section& (*section_)(Scene&, std::size_t);
};

}  // namespace annulus::app
