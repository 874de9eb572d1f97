#include "core/figure.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "core/errors.h"
#include "core/json.h"

namespace annulus {

namespace {

std::vector<FigureSpec> two_specs() {
  return {{.key = "a_m", .title = "A", .unit = "µm", .scale = 1e6, .axis = "peak to peak, µm"},
          {.key = "b", .title = "B", .unit = "%"}};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(figures)

BOOST_AUTO_TEST_CASE(sets_hold_results_by_key_in_order) {
  FigureSet set;
  set.set("b", {2, 0.1});
  set.set("a_m", 1.0);
  set.set("b", {3, 0.2}, {.discretisation = 0.15, .contact = 0.05});
  BOOST_TEST_REQUIRE(set.entries().size() == 2U);
  BOOST_TEST(set.entries().front().key == "b");
  BOOST_TEST(set.value("b") == 3.0);
  BOOST_TEST(set.find("b")->parts.contact == 0.05);
  BOOST_TEST(std::isnan(set.figure("a_m").error));
  BOOST_TEST(!set.find("c"));
  BOOST_TEST(std::isnan(set.value("c")));
  FigureSet other;
  other.set("a_m", {4, 0});
  set.add(other);
  BOOST_TEST(set.value("a_m") == 4.0);
  BOOST_TEST(set.entries().size() == 2U);
}

BOOST_AUTO_TEST_CASE(rows_know_their_declarations) {
  const auto specs = two_specs();
  FigureSet set;
  set.set("b", {2, 0.1});
  FigureRow row(specs, set);
  BOOST_TEST(row.value("b") == 2.0);
  BOOST_TEST(std::isnan(row.value("a_m")));
  BOOST_TEST(std::isnan(row.value("c")));
  BOOST_CHECK_THROW(row.set("c", 1), InternalError);
  BOOST_TEST(FigureRow().empty());
  BOOST_TEST(find_figure(specs, "a_m")->axis_label() == "peak to peak, µm");
  BOOST_TEST(find_figure(specs, "b")->axis_label() == "%");
  BOOST_TEST(!find_figure(specs, "c"));
  BOOST_TEST((figure_keys(specs) == std::vector<std::string>{"a_m", "b"}));
}

BOOST_AUTO_TEST_CASE(json_keeps_values_errors_and_parts) {
  FigureSet set;
  set.set("known", {3, 0.2}, {.discretisation = 0.15, .integration = 0.05});
  set.set("without_error", 1.5);
  const auto json = to_json(set);
  BOOST_TEST(json.at("without_error").at("error").is_null());
  BOOST_TEST(!json.at("without_error").contains("error_parts"));
  const auto read = figure_set_of(Json::parse(json.dump()));
  BOOST_TEST(read.entries().front().key == "known");
  BOOST_TEST(read.value("known") == 3.0);
  BOOST_TEST(read.figure("known").error == 0.2);
  BOOST_TEST(read.find("known")->parts.discretisation == 0.15);
  BOOST_TEST(std::isnan(read.figure("without_error").error));
  BOOST_CHECK_THROW((void)figure_set_of(Json::parse(R"({"a": 5})")), Json::exception);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
