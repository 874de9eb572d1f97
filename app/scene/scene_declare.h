#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
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
    {"_kg_per_m3", "kg/m³", 1},
    {"_N_per_m", "N/m", 1},
    {"_kg_m2", "kg m²", 1},
    {"_mm", "mm", units::mm},
    {"_um", "µm", units::um},
    {"_GPa", "GPa", units::GPa},
    {"_kW", "kW", units::kW},
    {"_rpm", "r/min", units::rpm},
    {"_deg", "°", units::deg},
    {"_Nm", "N m", 1},
    {"_kg", "kg", 1},
    {"_Nm_per_rad", "N m/rad", 1},
    {"_N", "N", 1},
    {"_m_per_s2", "m/s²", 1},
    {"_h", "h", units::hour},
    {"_per_s", "1/s", 1},
    {"_s", "s", 1},
    {"_mPas", "mPa s", 1e-3},
};

template <class T>
struct Choice {
  std::string name;
  T value;
  std::string old_name{};  ///< refused with `name`
};

/// Further properties of a key, chained behind its declaration. Conditions name keys of the same table, keys of others
/// with their table, and "[tables]" (key_rules.h).
class Declared {
 public:
  explicit Declared(Parameter& p) : p_(p) {}
  Declared& required() { return p_.presence = Parameter::Presence::required, *this; }
  /// A key stored in an optional has its default only where its conditions (only_if) hold.
  Declared& fallback(Value value, const char* why = "") {
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
  /// A list that may not be empty; `what`: one of its values, for messages.
  Declared& not_empty(const char* what) { return p_.at_least_one = what, *this; }
  Declared& distinct() { return p_.distinct = true, *this; }
  Declared& infinite() { return p_.may_be_infinite = true, *this; }
  /// Seldom known: [sensitivity] varies it where it names no inputs.
  Declared& often_assumed() { return p_.often_assumed = true, *this; }
  /// A text for a value of a number: "rigid".
  Declared& word(const char* text, double value) { return p_.words.emplace_back(text, value), *this; }
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
  /// Exactly one of this key and `keys` is given.
  Declared& one_of(std::vector<std::string> keys) { return p_.one_of = std::move(keys), *this; }
  /// At least one of this key and `keys` is given.
  Declared& some_of(std::vector<std::string> keys) { return p_.some_of = std::move(keys), *this; }
  /// An earlier name, refused with the present one.
  Declared& formerly(std::string name) { return p_.old_names.push_back(std::move(name)), *this; }

 private:
  Declared& add(std::vector<KeyRule>& rules, Condition when, const char* why) {
    rules.push_back({std::move(when), why, {}});
    return *this;
  }

  Parameter& p_;
};

template <class T>
struct ValueOf {
  using Type = T;
};
template <class T>
struct ValueOf<std::optional<T>> {
  using Type = T;
};
/// The type of what a member or an optional one holds.
template <class T>
using value_of = typename ValueOf<T>::Type;

/// A checked value (in the unit of the file) as a member holds it.
template <class T>
T in_si(const Value& value, double si) {
  if constexpr (std::is_same_v<T, int>) {
    return static_cast<int>(std::get<long>(value));
  } else {
    T result = std::get<T>(value);
    if constexpr (std::is_same_v<T, double>) result *= si;
    if constexpr (std::is_same_v<T, std::vector<double>>)
      for (double& x : result) x *= si;
    return result;
  }
}

/// The scene itself, or a struct of inputs that it owns.
template <class Holder>
Holder& held_by(Scene& scene) {
  if constexpr (std::is_base_of_v<Holder, Scene>)
    return scene;
  else
    return scene.own<Holder>();
}

/// Builds a table whose keys are bound to the members of `Section`, a member of the scene or of inputs that it owns:
/// alone, in an optional that is there with the table, or one in a vector for each [[table]].
template <class Section>
class Declarations {
 public:
  Declarations(std::string path, std::string meaning, std::function<Section&(Scene&, std::size_t)> section)
      : section_(std::move(section)) {
    table_.path = std::move(path);
    table_.meaning = std::move(meaning);
  }
  /// Keys of the scene itself, or of a struct of inputs that it owns as a whole.
  Declarations(std::string path, std::string meaning)
      : Declarations(std::move(path), std::move(meaning),
                     [](Scene& s, std::size_t) -> Section& { return held_by<Section>(s); }) {}
  template <class Holder>
  Declarations(std::string path, std::string meaning, Section Holder::*member)
      : Declarations(std::move(path), std::move(meaning),
                     [member](Scene& s, std::size_t) -> Section& { return held_by<Holder>(s).*member; }) {}
  template <class Holder>
  Declarations(std::string path, std::string meaning, std::optional<Section> Holder::*member)
      : Declarations(std::move(path), std::move(meaning), [member](Scene& s, std::size_t) -> Section& {
          auto& section = held_by<Holder>(s).*member;
          return section ? *section : section.emplace();
        }) {}
  /// [[path]]: `resize` makes room for the tables.
  Declarations(std::string path, std::string meaning, std::function<Section&(Scene&, std::size_t)> section,
               std::function<void(Scene&, std::size_t)> resize)
      : Declarations(std::move(path), std::move(meaning), std::move(section)) {
    table_.repeated = true;
    table_.resize = std::move(resize);
  }
  template <class Holder>
  Declarations(std::string path, std::string meaning, std::vector<Section> Holder::*member)
      : Declarations(
            std::move(path), std::move(meaning),
            [member](Scene& s, std::size_t i) -> Section& { return (held_by<Holder>(s).*member).at(i); },
            [member](Scene& s, std::size_t n) { (held_by<Holder>(s).*member).resize(n); }) {}

  /// Its tables are the variants of a comparison; they have a key "name".
  Declarations& variants() { return table_.variants = true, *this; }
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
  /// The keys of another table of this path.
  Declarations& add(Table more) {
    std::move(more.parameters.begin(), more.parameters.end(), std::back_inserter(table_.parameters));
    return *this;
  }
  Table done() { return std::move(table_); }

  template <class Base, class T>
  Declared key(const std::string& name, T Base::*member, std::string meaning) {
    using Kind = Parameter::Kind;
    using V = value_of<T>;
    Parameter& p = declare(name, std::move(meaning));
    p.default_where_it_applies = !std::is_same_v<T, V>;
    p.kind = std::is_same_v<V, double>                ? Kind::real
             : std::is_same_v<V, int>                 ? Kind::integer
             : std::is_same_v<V, std::string>         ? Kind::text
             : std::is_same_v<V, std::vector<double>> ? Kind::reals
                                                      : Kind::texts;
    store(p, member, [si = p.si](const Value& v) { return in_si<V>(v, si); });
    return Declared(p);
  }

  /// What follows from the value of the key declared last, as the contents of a file; its InputError is a problem of
  /// the key.
  void then(std::function<void(const Scene&, Section&)> follow) {
    auto& store = table_.parameters.back().store;
    store = [first = std::move(store), section = section_, follow = std::move(follow)](Scene& scene, std::size_t index,
                                                                                       const Value& value) {
      first(scene, index, value);
      follow(scene, section(scene, index));
    };
  }

  template <class Base, class T>
  Declared choice(const std::string& name, T Base::*member, std::vector<Choice<T>> choices, std::string meaning) {
    Parameter& p = declare(name, std::move(meaning));
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
  Parameter& declare(const std::string& name, std::string meaning) {
    Parameter& p = table_.parameters.emplace_back();
    p.table = table_.path;
    p.name = name;
    p.meaning = std::move(meaning);
    const auto unit = std::find_if(std::begin(key_units), std::end(key_units),
                                   [&](const Unit& u) { return name.ends_with(u.suffix); });
    if (unit == std::end(key_units)) return p;
    p.unit = unit->text;
    p.si = unit->si;
    return p;
  }

  template <class Base, class T, class Convert>
  void store(Parameter& p, T Base::*member, Convert convert) {
    p.store = [section = section_, member, convert](Scene& scene, std::size_t index, const Value& value) {
      section(scene, index).*member = convert(value);
    };
  }

  Table table_;
  std::function<Section&(Scene&, std::size_t)> section_;
};

}  // namespace annulus::app
