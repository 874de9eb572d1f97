#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>
#include <optional>

#include "app/model/gear_system.h"
#include "app/plan/plan.h"
#include "app/scene/scene_schema.h"
#include "app/study/studies.h"
#include "core/errors.h"
#include "tests/app/bad_scenes.h"
#include "tests/app/scene_edit.h"

/// Every key of every table, in a good scene of each kind, with every kind of bad value that the schema can name. What
/// is refused has to say where, what and why; what is accepted has to be allowed by the schema and to make a plan.
namespace annulus {

namespace {

using app::Parameter;

/// A value as it stands in the file, and as a message shows it.
struct Written {
  std::string text, shown;
  Written(const char* both) : text(both), shown(both) {}
  Written(std::string both) : text(both), shown(std::move(both)) {}
  Written(std::string as_text, std::string as_shown) : text(std::move(as_text)), shown(std::move(as_shown)) {}
};

struct Count {
  int tried = 0, refused = 0, accepted = 0;
};

/// What came of one scene.
struct Outcome {
  std::string message;  ///< of the refusal; empty: accepted
  bool by_schema = false;
};

Outcome outcome_of(const std::string& text) {
  try {
    const auto scene = app::parse_scene(text, "scene.toml");
    try {
      app::check_stage(scene);
      app::check_studies(scene);
      (void)app::to_text(app::make_plan(scene));
      return {};
    } catch (const InputError& error) {
      return {error.what()};
    }
  } catch (const app::SceneError& error) {
    return {error.what(), true};
  }  // anything else ends the test
}

/// The line of a message that starts with this place and names the key; empty without.
std::string line_about(const std::string& message, int line, const std::string& key) {
  const std::string place = fmt::format("scene.toml:{}:", line);
  for (std::size_t begin = 0; begin < message.size();) {
    const auto end = std::min(message.find('\n', begin), message.size());
    const auto one = message.substr(begin, end - begin);
    if (one.starts_with(place) && one.find(key) != std::string::npos) return one;
    begin = end + 1;
  }
  return "";
}

class Corruptions {
 public:
  Corruptions(const test::GoodScene& good, std::map<std::string, Count>& counts) : good_(good), counts_(counts) {}

  void all() {
    for (const auto& table : app::schema()) {
      for (const auto& p : table.parameters) {
        // The kind itself decides which keys there are.
        if (p.key() == "stage.kind") continue;
        BOOST_TEST_CONTEXT(good_.name << ", " << p.key()) {
          if (table.applies_to(good_.kind) && p.applies_to(good_.kind))
            key(table, p);
          else
            must_refuse("of another kind", table, p, some_value(p), "has no meaning", "");
        }
      }
    }
  }

 private:
  static Written some_value(const Parameter& p) {
    switch (p.kind) {
      case Parameter::Kind::integer:
        return {"10"};
      case Parameter::Kind::real:
        return {"1.5"};
      case Parameter::Kind::reals:
        return {"[1.0]", ""};
      case Parameter::Kind::texts:
        return {"[\"x\"]", ""};
      case Parameter::Kind::choice:
        return {'"' + p.choices.front() + '"'};
      case Parameter::Kind::text:
        break;
    }
    return {"\"x\""};
  }

  void key(const app::Table& table, const Parameter& p) {
    missing(table, p);
    for (const auto& value : wrong_types(p)) must_refuse("wrong type", table, p, value, p.type_text());
    if (p.kind == Parameter::Kind::integer || p.kind == Parameter::Kind::real || p.kind == Parameter::Kind::reals)
      numbers(table, p);
    if (p.kind == Parameter::Kind::text || p.kind == Parameter::Kind::texts) texts(table, p);
    if (p.kind == Parameter::Kind::reals || p.kind == Parameter::Kind::texts) lists(table, p);
    duplicate(table, p);
    unknown(table, p);
  }

  void missing(const app::Table& table, const Parameter& p) {
    test::SceneEdit scene(good_.text);
    const int line = scene.find(table, p.name);
    if (line == 0) return;
    scene.remove(line);
    const auto outcome = count("missing", outcome_of(scene.text()));
    if (p.required(good_.kind)) BOOST_TEST(!outcome.message.empty());
    if (outcome.message.empty()) return;
    BOOST_TEST(outcome.message.find("scene.toml") == 0U, outcome.message);
    // Told by the name of the key, or of what it belongs to where one of several would do.
    BOOST_TEST(outcome.message.find(p.name) != std::string::npos, outcome.message);
  }

  static std::vector<Written> wrong_types(const Parameter& p) {
    static const Written text{"\"x\""}, truth{"true"}, table{"{a = 1}", "{...}"}, date{"1979-05-27"}, whole{"3"},
        real{"1.5"}, empty{"\"\""};
    switch (p.kind) {
      case Parameter::Kind::integer:
        return {text, empty, truth, table, date, real, {"[1]", "[ 1 ]"}, {"2.0"}, {"\"3\""}, {"1e3", "1000.0"}};
      case Parameter::Kind::real:
        return {text, empty, truth, table, date, {"[1.5]", "[ 1.5 ]"}, {"\"1.5\""}, {"\"nan\""}};
      case Parameter::Kind::text:
        return {truth, table, date, whole, real, {"[\"x\"]", "[ 'x' ]"}};
      case Parameter::Kind::choice:
        return {text, empty, truth, table, date, whole, real, {"\"Computed\""}, {"[\"computed\"]", "[ 'computed' ]"}};
      case Parameter::Kind::reals:
        return {text,
                truth,
                table,
                date,
                whole,
                real,
                {"[\"x\"]", "[ 'x' ]"},
                {"[[1.5]]", "[ [ 1.5 ] ]"},
                {"[1, true]", "[ 1, true ]"}};
      case Parameter::Kind::texts:
        break;
    }
    return {text,
            truth,
            table,
            date,
            whole,
            real,
            {"[1]", "[ 1 ]"},
            {"[[\"x\"]]", "[ [ 'x' ] ]"},
            {"[\"x\", 1]", "[ 'x', 1 ]"}};
  }

  void numbers(const app::Table& table, const Parameter& p) {
    // Without bounds a value could be as large as it likes.
    BOOST_TEST(std::isfinite(p.low));
    BOOST_TEST(std::isfinite(p.high));
    if (p.kind == Parameter::Kind::integer) {
      for (const double x : {p.low - 1, p.high + 1, -1.0, 0.0, 1.0, p.low, p.high})
        number("out of range", table, p, x, fmt::format("{:.0f}", x));
      for (const auto* huge : {"9223372036854775807", "-9223372036854775808", "4294967296"})
        number("huge", table, p, std::stod(huge), huge);
      for (const auto* beyond : {"9223372036854775808",
                                 "1"
                                 "0000000000000000000000000000000"})
        must_refuse("huge", table, p, {beyond, ""}, "not valid TOML", "");
      for (const auto* none : {"nan", "inf", "-inf"}) must_refuse(none, table, p, {none}, p.type_text());
      return;
    }
    const bool list = p.kind == Parameter::Kind::reals;
    // A number with a point, so that it is read, and shown, as one that is not whole.
    const auto digits = [](double x) {
      const auto text = fmt::format("{:.17g}", x);
      return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
    };
    const auto write = [&](const std::string& x) { return list ? "[" + x + "]" : x; };
    const double step = std::max(1e-9, 1e-9 * std::max(std::abs(p.low), std::abs(p.high)));
    for (const double x : {p.low, p.low - step, p.low + step, p.high, p.high - step, p.high + step, -1.0, 0.0, -0.0,
                           1.0, 1e-300, 5e-324})
      number("out of range", table, p, x, write(digits(x)));
    for (const double x : {1e300, -1e300, 1.7e308, 1e15, -1e15}) number("huge", table, p, x, write(digits(x)));
    number("nan", table, p, std::nan(""), write("nan"));
    number("inf", table, p, app::rigid, write("inf"));
    number("-inf", table, p, -app::rigid, write("-inf"));
    if (list) number("nan", table, p, std::nan(""), "[" + digits(p.high) + ", nan]");
  }

  /// Refused with the range where the schema does not permit it.
  void number(const char* what, const app::Table& table, const Parameter& p, double x, const std::string& text) {
    if (p.in_range(x)) return may_refuse(what, table, p, text);
    must_refuse(what, table, p, {text, shown(p, x)}, p.range_text());
  }

  static std::string shown(const Parameter& p, double x) {
    if (p.kind == Parameter::Kind::reals) return "";  // the list as a whole
    if (p.kind == Parameter::Kind::integer) return fmt::format("{:.0f}", x).substr(0, 15);
    if (std::isnan(x)) return "nan";
    const auto text = app::to_text(x, 15);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
  }

  void texts(const app::Table& table, const Parameter& p) {
    const bool list = p.kind == Parameter::Kind::texts;
    const auto write = [&](const std::string& x) { return list ? "[\"" + x + "\"]" : "\"" + x + "\""; };
    for (const auto* control : {"a\\nb", "a\\u0000b", "\\u001b[31m", "a\\tb", "\\u007f"})
      must_refuse("control characters", table, p, {write(control), ""}, "control characters");
    must_refuse("long text", table, p, {write(std::string(1001, 'a')), ""}, "at most 1000");
    for (const auto* text : {"", " ", "/etc/passwd", "../../x", "a/b", "<script>", "\\\"", "å", "nan", "%s{}"})
      may_refuse("odd text", table, p, write(text));
  }

  void lists(const app::Table& table, const Parameter& p) {
    may_refuse("empty list", table, p, "[]");
    std::string item = p.kind == Parameter::Kind::texts ? "\"x\"" : fmt::format("{:g}", p.high);
    std::string few = "[" + item + ", " + item + "]", many = "[" + item;
    for (std::size_t i = 0; i < p.longest; ++i) many += "," + item;
    may_refuse("list of another length", table, p, few);
    must_refuse("long list", table, p, {many + "]", ""}, fmt::format("at most {}", p.longest));
    // Those of single teeth have a rule of their own (app.pitch_deviations).
    if (p.table == "errors" && p.name.find("pitch_deviations") == std::string::npos)
      for (const auto* length : {"[]", "[1]", "[1, 1]", "[1, 1, 1, 1]", "[1, 1, 1, 1, 1, 1]"})
        must_refuse("list of another length", table, p, {length}, "one value per planet");
  }

  void duplicate(const app::Table& table, const Parameter& p) {
    test::SceneEdit scene(good_.text);
    const int line = scene.set(table, p.name, some_value(p).text);
    scene.repeat(line);
    const auto outcome = count("duplicate", outcome_of(scene.text()));
    BOOST_TEST(!line_about(outcome.message, line + 1, p.name).empty(), outcome.message);
  }

  void unknown(const app::Table& table, const Parameter& p) {
    test::SceneEdit scene(good_.text);
    const int line = scene.set(table, p.name + "x", "1");
    const auto outcome = count("unknown", outcome_of(scene.text()));
    const auto about = line_about(outcome.message, line, p.key() + "x");
    BOOST_TEST(about.find("unknown key") != std::string::npos, outcome.message);
    BOOST_TEST((about.find("did you mean") != std::string::npos || about.find("annulus explain") != std::string::npos),
               about);
  }

  void must_refuse(const char* what, const app::Table& table, const Parameter& p, const Written& value,
                   const std::string& rule) {
    must_refuse(what, table, p, value, rule, p.key());
  }
  /// The line about the value names key, value and rule.
  void must_refuse(const char* what, const app::Table& table, const Parameter& p, const Written& value,
                   const std::string& rule, const std::string& key) {
    test::SceneEdit scene(good_.text);
    const int line = scene.set(table, p.name, value.text);
    const auto outcome = count(what, outcome_of(scene.text()));
    // A table of another kind is told of at its header.
    auto about = line_about(outcome.message, line, key);
    if (about.empty() && key.empty()) about = line_about(outcome.message, line - 1, "");
    BOOST_TEST_CONTEXT(p.name << " = " << value.text.substr(0, 60)) {
      BOOST_TEST(outcome.by_schema);
      BOOST_TEST(!about.empty(), "line " << line << ": " << outcome.message);
      BOOST_TEST(about.find(rule) != std::string::npos, about << " lacks " << rule);
      if (!key.empty() && !value.shown.empty())
        BOOST_TEST(about.find("= " + value.shown) != std::string::npos, about << " lacks " << value.shown);
    }
  }

  /// Good by the schema; what else is wrong with it is told with its place.
  void may_refuse(const char* what, const app::Table& table, const Parameter& p, const std::string& value) {
    test::SceneEdit scene(good_.text);
    (void)scene.set(table, p.name, value);
    const auto outcome = count(what, outcome_of(scene.text()));
    if (outcome.message.empty()) return;
    BOOST_TEST_CONTEXT(p.name << " = " << value.substr(0, 60)) {
      const bool placed = outcome.message.starts_with("scene.toml:");
      BOOST_TEST(placed, outcome.message);
      const auto after = outcome.message.find(": ");
      BOOST_TEST((after != std::string::npos && outcome.message.size() > after + 20), outcome.message);
      for (const auto* never : {"nan mm", " -nan", "inf mm", "internal error"})
        BOOST_TEST(outcome.message.find(never) == std::string::npos, outcome.message);
    }
  }

  Outcome count(const std::string& what, Outcome outcome) {
    auto& c = counts_[what];
    ++c.tried;
    ++(outcome.message.empty() ? c.accepted : c.refused);
    return outcome;
  }

  const test::GoodScene& good_;
  std::map<std::string, Count>& counts_;
};

}  // namespace

BOOST_AUTO_TEST_SUITE(bad_input)

BOOST_AUTO_TEST_CASE(good_scenes_are_good) {
  for (const auto& good : test::good_scenes()) {
    const auto outcome = outcome_of(good.text);
    BOOST_TEST(outcome.message.empty(), good.name << ": " << outcome.message);
  }
}

BOOST_AUTO_TEST_CASE(every_key_and_every_kind_of_bad_value) {
  std::map<std::string, Count> counts;
  for (const auto& good : test::good_scenes()) Corruptions(good, counts).all();
  Count all;
  for (const auto& [what, c] : counts) {
    BOOST_TEST_MESSAGE(
        fmt::format("{:24} {:6} tried {:6} refused {:6} accepted", what, c.tried, c.refused, c.accepted));
    all.tried += c.tried;
    all.refused += c.refused;
    all.accepted += c.accepted;
  }
  BOOST_TEST_MESSAGE(
      fmt::format("{:24} {:6} tried {:6} refused {:6} accepted", "all", all.tried, all.refused, all.accepted));
  BOOST_TEST(all.tried > 5000);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
