#include "app/scene/key_rules.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <string>
#include <vector>

#include "app/scene/overrides.h"
#include "app/scene/scene_declare.h"
#include "app/scene/scene_kind.h"
#include "app/study/studies.h"
#include "app/systems/planetary/planetary_input.h"
#include "core/errors.h"
#include "tests/app/bad_scenes.h"
#include "tests/app/scene_edit.h"
#include "tests/app/scene_refusal.h"

/// Rules between keys, on tables of the test's own and on those of the program.
namespace annulus {

namespace {

using app::given;
using app::is;

/// A key as it stands in a scene; without value: absent.
app::Input written(const std::string& key, app::Value value, std::size_t entry = 0) {
  return {.key = key, .value = std::move(value), .origin = app::Origin::scene, .line = 7, .entry = entry};
}
app::Input absent(const std::string& key, std::size_t entry = 0) {
  return {.key = key, .origin = app::Origin::default_value, .line = 5, .entry = entry};
}

/// A table with a choice `shape` and a key `depth`, on which each test declares its rules.
template <class Rules>
std::vector<app::Table> shapes(Rules rules) {
  app::Declarations<app::RingInput> t("shape", "", [](app::Scene& s, std::size_t i) -> app::RingInput& {
    auto& rings = planetary(s).rings;
    if (rings.size() <= i) rings.resize(i + 1);
    return rings[i];
  });
  t.choice(
      "form", &app::RingInput::structure,
      {{"flat", app::Structure::traditional}, {"deep", app::Structure::pinned}, {"holed", app::Structure::splined}},
      "Form.");
  t.key("width_mm", &app::RingInput::hoop_width, "Width.");
  rules(t.key("depth_mm", &app::RingInput::free_length, "Depth."));
  return {t.done()};
}

std::vector<app::Problem> rule_problems(const std::vector<app::Table>& tables, std::vector<app::Input> inputs,
                                        app::Scene* result = nullptr) {
  app::Scene scene;
  scene.inputs = std::move(inputs);
  std::vector<app::Problem> problems;
  app::check_key_rules(tables, scene, problems);
  if (result != nullptr) *result = scene;
  return problems;
}

std::string the_only_message(const std::vector<app::Problem>& problems) {
  BOOST_TEST_REQUIRE(problems.size() == 1U);
  return problems.front().message;
}

app::Input form_of(const char* value) { return written("shape.form", std::string(value)); }
app::Input depth_of(double value) { return written("shape.depth_mm", value); }

}  // namespace

BOOST_AUTO_TEST_SUITE(key_rules)

BOOST_AUTO_TEST_CASE(conditions_hold_fail_or_are_unknown) {
  const auto tables = shapes([](app::Declared) {});
  const std::vector<app::Input> inputs = {form_of("deep"), absent("shape.width_mm"), depth_of(3),
                                          written("shape.form", std::monostate{}, 1)};
  const app::KeyValues keys(inputs, tables);
  const auto holds = [&](const app::Condition& c, std::size_t entry = 0) { return c.holds(keys, "shape", entry); };
  BOOST_TEST((holds(is("form", {"flat", "deep"})) == true));
  BOOST_TEST((holds(is("form", {"flat"})) == false));
  BOOST_TEST((holds(is("shape.form", {"deep"})) == true));
  BOOST_TEST((holds(given("depth_mm")) == true));
  BOOST_TEST((holds(given("width_mm")) == false));
  BOOST_TEST((holds(given("[shape]")) == true));
  BOOST_TEST((holds(given("[other]")) == false));
  const std::vector<app::Input> below = {written("shape.part.depth_mm", 3.0)};
  BOOST_TEST((given("[shape]").holds(app::KeyValues(below, tables), "", 0) == false));
  BOOST_TEST((given("[shape.part]").holds(app::KeyValues(below, tables), "", 0) == true));
  BOOST_TEST((holds(!given("width_mm")) == true));
  // A refused value: only what the other part decides is known.
  BOOST_TEST(!holds(is("form", {"flat"}), 1).has_value());
  BOOST_TEST(!holds(!is("form", {"flat"}), 1).has_value());
  BOOST_TEST((holds(is("form", {"flat"}) && given("[other]"), 1) == false));
  BOOST_TEST(!holds(is("form", {"flat"}) && given("[shape]"), 1).has_value());
  BOOST_TEST((holds(is("form", {"flat"}) || given("[shape]"), 1) == true));
  BOOST_TEST(!holds(is("form", {"flat"}) || given("[other]"), 1).has_value());
  // A required one that is missing is not known either; a table that is absent is.
  BOOST_TEST(!holds(is("form", {"flat"}), 2).has_value());
  BOOST_TEST((holds(is("other.form", {"flat"})) == false));
}

BOOST_AUTO_TEST_CASE(conditions_as_text) {
  BOOST_TEST(is("form", {"flat", "deep", "holed"}).text("shape") == "form = \"flat\", \"deep\" or \"holed\"");
  BOOST_TEST(is("shape.form", {"flat"}).text("shape") == "form = \"flat\"");
  BOOST_TEST(is("shape.form", {"flat"}).text("other") == "shape.form = \"flat\"");
  BOOST_TEST((!is("form", {"flat"})).text("shape") == "form other than \"flat\"");
  BOOST_TEST((given("[shape]") && !given("depth_mm")).text("shape") == "[shape] and no depth_mm");
  const auto tables = shapes([](app::Declared) {});
  const std::vector<app::Input> inputs = {form_of("deep")};
  const app::KeyValues keys(inputs, tables);
  BOOST_TEST((is("form", {"flat", "deep"}) || given("[other]")).cause(keys, "shape", 0) == "form = \"deep\"");
}

BOOST_AUTO_TEST_CASE(keys_that_apply_or_are_needed_under_a_condition) {
  const auto only = shapes([](app::Declared d) { d.only_if(is("form", {"deep"}), "flat ones have none"); });
  BOOST_TEST(rule_problems(only, {form_of("deep"), depth_of(3)}).empty());
  BOOST_TEST(rule_problems(only, {form_of("deep"), absent("shape.depth_mm")}).empty());
  BOOST_TEST(rule_problems(only, {form_of("flat"), absent("shape.depth_mm")}).empty());
  BOOST_TEST(the_only_message(rule_problems(only, {form_of("flat"), depth_of(3)})) ==
             "shape.depth_mm = 3: has a meaning only with form = \"deep\": flat ones have none");
  BOOST_TEST(rule_problems(only, {form_of("flat"), depth_of(3)}).front().line == 7);
  // A refused form is a problem of its own.
  BOOST_TEST(rule_problems(only, {written("shape.form", std::monostate{}), depth_of(3)}).empty());

  const auto needed = shapes([](app::Declared d) { d.needed_if(is("form", {"deep"})); });
  BOOST_TEST(the_only_message(rule_problems(needed, {form_of("deep"), absent("shape.depth_mm")})) ==
             "shape.depth_mm: is required by form = \"deep\"");
  BOOST_TEST(rule_problems(needed, {form_of("deep"), absent("shape.depth_mm")}).front().line == 5);
  BOOST_TEST(rule_problems(needed, {form_of("flat"), absent("shape.depth_mm")}).empty());
  BOOST_TEST(rule_problems(needed, {form_of("flat"), depth_of(3)}).size() == 1U);

  const auto refused = shapes([](app::Declared d) { d.refused_if(given("width_mm"), "one follows from the other"); });
  BOOST_TEST(rule_problems(refused, {depth_of(3), absent("shape.width_mm")}).empty());
  BOOST_TEST(the_only_message(rule_problems(refused, {depth_of(3), written("shape.width_mm", 2.0)})) ==
             "shape.depth_mm = 3: cannot be used together with width_mm: one follows from the other");
}

BOOST_AUTO_TEST_CASE(each_entry_of_an_array_has_its_own_conditions) {
  const auto tables = shapes([](app::Declared d) { d.needed_if(is("form", {"deep"})); });
  const auto problems =
      rule_problems(tables, {form_of("flat"), absent("shape.depth_mm"), written("shape.form", std::string("deep"), 1),
                             absent("shape.depth_mm", 1), written("shape.form", std::string("deep"), 2),
                             written("shape.depth_mm", 3.0, 2)});
  BOOST_TEST(the_only_message(problems) == "shape.depth_mm: is required by form = \"deep\"");
}

BOOST_AUTO_TEST_CASE(partners_and_alternatives) {
  const auto together = shapes([](app::Declared d) { d.together_with("width_mm"); });
  const auto width = written("shape.width_mm", 2.0);
  BOOST_TEST(rule_problems(together, {width, depth_of(3)}).empty());
  BOOST_TEST(rule_problems(together, {absent("shape.width_mm"), absent("shape.depth_mm")}).empty());
  BOOST_TEST(the_only_message(rule_problems(together, {width, absent("shape.depth_mm")})) ==
             "shape.width_mm = 2: needs shape.depth_mm as well");
  BOOST_TEST(the_only_message(rule_problems(together, {absent("shape.width_mm"), depth_of(3)})) ==
             "shape.depth_mm = 3: needs shape.width_mm as well");

  const auto either = shapes([](app::Declared d) { d.only_if(is("form", {"deep"})).instead_of({"width_mm"}); });
  BOOST_TEST(rule_problems(either, {form_of("deep"), width, absent("shape.depth_mm")}).empty());
  BOOST_TEST(rule_problems(either, {form_of("deep"), absent("shape.width_mm"), depth_of(3)}).empty());
  BOOST_TEST(the_only_message(rule_problems(either, {form_of("deep"), width, depth_of(3)})) ==
             "shape.depth_mm = 3: give either width_mm or depth_mm");
  BOOST_TEST(
      the_only_message(rule_problems(either, {form_of("deep"), absent("shape.width_mm"), absent("shape.depth_mm")})) ==
      "shape.width_mm: width_mm or depth_mm is required by form = \"deep\"");
  BOOST_TEST(rule_problems(either, {form_of("flat"), absent("shape.width_mm"), absent("shape.depth_mm")}).empty());
}

BOOST_AUTO_TEST_CASE(defaults_that_hold_where_a_key_applies) {
  const auto tables = shapes([](app::Declared d) { d.only_if(is("form", {"deep"})).fallback(4.0, "usual"); });
  app::Scene scene;
  BOOST_TEST(rule_problems(tables, {form_of("deep"), absent("shape.depth_mm")}, &scene).empty());
  BOOST_TEST(planetary(scene).rings.front().free_length.value() == 4e-3);
  BOOST_TEST(std::get<double>(scene.inputs.back().value) == 4.0);
  BOOST_TEST(scene.inputs.back().note == "usual");
  BOOST_TEST(rule_problems(tables, {form_of("flat"), absent("shape.depth_mm")}, &scene).empty());
  BOOST_TEST((planetary(scene).rings.empty() || !planetary(scene).rings.front().free_length));
  BOOST_TEST(std::holds_alternative<std::monostate>(scene.inputs.back().value));
  BOOST_TEST(rule_problems(tables, {form_of("flat"), depth_of(4)}).size() == 1U);
}

BOOST_AUTO_TEST_CASE(of_a_group_one_or_some_are_given) {
  const auto one = shapes([](app::Declared key) { key.one_of({"width_mm"}); });
  const auto some = shapes([](app::Declared key) { key.some_of({"width_mm"}); });
  const auto width = written("shape.width_mm", 2.0);
  for (const auto* tables : {&one, &some}) {
    BOOST_TEST(the_only_message(rule_problems(*tables, {absent("shape.depth_mm"), absent("shape.width_mm")}))
                   .find("one of depth_mm, width_mm is required") != std::string::npos);
    BOOST_TEST(rule_problems(*tables, {depth_of(3), absent("shape.width_mm")}).empty());
    BOOST_TEST(rule_problems(*tables, {absent("shape.depth_mm"), width}).empty());
  }
  BOOST_TEST(the_only_message(rule_problems(one, {depth_of(3), width})).find("is given beside depth_mm") !=
             std::string::npos);
  BOOST_TEST(rule_problems(some, {depth_of(3), width}).empty());
}

BOOST_AUTO_TEST_CASE(rules_name_keys_that_exist) {
  for (const auto& kind : app::scene_kinds())
    for (const auto& table : app::schema(kind.name))
      for (const auto& p : table.parameters) {
        const auto exists = [&](const std::string& name) {
          return std::any_of(table.parameters.begin(), table.parameters.end(),
                             [&](const app::Parameter& other) { return other.name == name; });
        };
        for (const auto& name : p.together_with) BOOST_TEST(exists(name), p.key() << " together with " << name);
        for (const auto& name : p.instead_of) BOOST_TEST(exists(name), p.key() << " instead of " << name);
        for (const auto& name : p.one_of) BOOST_TEST(exists(name), p.key() << " one of " << name);
        for (const auto& name : p.some_of) BOOST_TEST(exists(name), p.key() << " some of " << name);
        for (const auto& choice : p.old_choices)
          BOOST_TEST((std::find(p.choices.begin(), p.choices.end(), choice.name) != p.choices.end()), p.key());
      }
}

BOOST_AUTO_TEST_CASE(rules_are_explained) {
  const auto about = [](const char* key) { return app::explain(*app::find_parameter(key)); };
  const auto has = [&](const char* key, const char* words) {
    BOOST_TEST(about(key).find(words) != std::string::npos, about(key) << " lacks " << words);
  };
  has("ring.splines", "required, and permitted only, with structure = \"splined\"");
  has("ring.pin_clearance_um", "only with structure = \"pinned\"");
  has("ring.pin_angles_deg", "either this or pins");
  has("ring.hoop_thickness_mm", "together with hoop_width_mm");
  has("sun.mass_kg", "required by [dynamics]");
  has("planet.bore_diameter_mm", "mesh.ring_planet.stiffness = \"computed\" (planetary)");
  has("errors.mesh_error_um", "refused beside [manufacturing_error]");
  has("sweep.values", "either this or from, to and count");
  has("stage.centre_distance_mm", "required for planetary, else conditional");
}

BOOST_AUTO_TEST_CASE(earlier_names_are_refused_with_the_present_one) {
  int renamed = 0;
  for (const auto& good : test::good_scenes())
    for (const auto& table : app::schema(good.kind))
      for (const auto& p : table.parameters) {
        for (const auto& old : p.old_names) {
          test::SceneEdit scene(good.text);
          (void)scene.set(table, old, "1");
          const auto message = test::scene_refusal(scene.text());
          BOOST_TEST(message.find(old + " = 1: is now `" + p.key() + "`") != std::string::npos, message);
          ++renamed;
        }
        for (const auto& choice : p.old_choices) {
          test::SceneEdit scene(good.text);
          (void)scene.set(table, p.name, '"' + choice.old_name + '"');
          const auto message = test::scene_refusal(scene.text());
          BOOST_TEST(message.find("is now \"" + choice.name + "\"") != std::string::npos, message);
          ++renamed;
        }
      }
  BOOST_TEST(renamed > 0);
  const auto message = test::scene_refusal(test::quick_scene() + "[assumed]\nerrors.sun_installation_um = \"x\"\n");
  BOOST_TEST(message.find("is now `errors.sun_position_error_um`") != std::string::npos, message);
  const auto scene = app::parse_scene(test::quick_scene(), "s");
  BOOST_CHECK_EXCEPTION(
      (void)app::find_input(scene, "errors.planet_installation_um[1]"), InputError, [](const InputError& error) {
        return std::string(error.what()).find("is now errors.planet_pin_position_error_um") != std::string::npos;
      });
}

BOOST_AUTO_TEST_CASE(kinds_have_names_of_their_own) {
  for (const auto& kind : app::scene_kinds()) {
    BOOST_TEST(app::scene_kind(kind.name).name == kind.name);
    BOOST_TEST(app::find_parameter("stage.kind")->choices.size() == app::scene_kinds().size());
    BOOST_TEST(!kind.results().empty());
  }
  BOOST_CHECK_THROW((void)app::scene_kind("no such kind"), InternalError);
  BOOST_TEST(app::find_parameter("optimise.optimisers")->choices == app::optimiser_names(),
             boost::test_tools::per_element());
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
