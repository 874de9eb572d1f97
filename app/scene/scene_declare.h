#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "app/scene/scene_schema.h"
#include "core/units.h"

/// The small language in which scene_schema.cc declares the keys of a scene.
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
  const char* name;
  T value;
};

/// Further properties of a key, chained behind its declaration.
class Declared {
 public:
  explicit Declared(Parameter& p) : p_(p) {}
  Declared& required() { return p_.presence = Parameter::Presence::required, *this; }
  Declared& fallback(Value value, const char* why) {
    p_.presence = Parameter::Presence::defaulted;
    p_.default_value = std::move(value);
    p_.note = why;
    return *this;
  }
  /// Kinds of stages that have this key.
  Declared& only(std::vector<StageKind> kinds) { return p_.kinds = std::move(kinds), *this; }
  Declared& required_for(std::vector<StageKind> kinds) { return p_.required_for = std::move(kinds), *this; }
  Declared& absent(const char* what_then) { return p_.note = what_then, *this; }
  Declared& from(double low, double high) { return p_.low = low, p_.high = high, *this; }
  Declared& above(double low, double high) { return p_.low_included = false, from(low, high); }
  /// Most values of a list.
  Declared& longest(std::size_t values) { return p_.longest = values, *this; }
  Declared& infinite() { return p_.may_be_infinite = true, *this; }

 private:
  Parameter& p_;
};

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
  /// Kinds of stages that have this table.
  Declarations& only(std::vector<StageKind> kinds) {
    table_.kinds = std::move(kinds);
    return *this;
  }
  Table done() { return std::move(table_); }

  template <class Base, class T>
  Declared key(const char* name, T Base::*member, const char* meaning) {
    Parameter& p = declare(name, meaning);
    constexpr bool is = std::is_same_v<T, double> || std::is_same_v<T, std::optional<double>>;
    if constexpr (is) {
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
    for (const auto& c : choices) p.choices.emplace_back(c.name);
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
