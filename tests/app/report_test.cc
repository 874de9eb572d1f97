#include "app/run/pipeline.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/report/plot/chart.h"
#include "app/report/text/packed.h"
#include "app/systems/planetary/planetary_run.h"
#include "app/systems/planetary/report/stage_report_parts.h"
#include "core/files.h"
#include "tests/app/made_up_solution.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"

namespace annulus {

namespace {

app::RunResult run_of(const char* scene, const std::function<void(app::MeshResult&)>& change = {}) {
  return test::made_up_run(app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/" + scene + ".toml"), 4,
                           change);
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t times = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++times;
  return times;
}

bool contains(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

/// Every tag that is opened is closed, and nothing that is not a number was printed as one.
void check_svg(const std::string& page) {
  // Without scripts and the numbers of plots, which are no pictures.
  std::string text;
  static const std::string opening = "<script", closing = "</script>";
  for (std::size_t at = 0; at < page.size();) {
    const auto begin = std::min(page.find(opening, at), page.size());
    text += page.substr(at, begin - at);
    const auto end = page.find(closing, begin);
    at = end == std::string::npos ? page.size() : end + closing.size();
  }
  BOOST_TEST(count(text, "<svg") == count(text, "</svg>"));
  BOOST_TEST(count(text, "<g") == count(text, "</g>"));
  BOOST_TEST(!contains(text, "nan"));
  BOOST_TEST(!contains(text, "inf\""));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(report)

BOOST_AUTO_TEST_CASE(texts_are_escaped_whatever_their_look) {
  const auto text = app::phrase("{} & {:.1f} {}", app::bold("a<b"), 2.34, app::code("k")) + app::line_break() +
                    app::link("more", "there") + app::tag(app::Text::Look::agrees, "yes") + app::subscript("x");
  BOOST_TEST(
      app::html(text) ==
      "<b>a&lt;b</b> &amp; 2.3 <code>k</code><br><a href=\"#there\">more</a><span class=\"tag agrees\">yes</span>"
      "<sub>x</sub>");
  BOOST_TEST(text.plain() == "a<b & 2.3 k moreyesx");
  BOOST_TEST(app::html(app::phrase("{}{}", app::Text(), "b")) == "b");
  // What a user wrote cannot name a part of the phrase that does not exist.
  const std::string forged = {'\x1f', '7'};
  BOOST_TEST(app::phrase("{}, {}", forged, app::bold("b")).plain() == ", b");
  BOOST_TEST(app::enumerated({"a", app::bold("b"), "c"}).plain() == "a, b and c");
}

BOOST_AUTO_TEST_CASE(tables_have_headings_of_rows) {
  const app::PageTable table{.head = {"", "A"},
                             .rows = {{"first", "1"}, {"second", app::muted("2")}, {"group"}},
                             .style = app::PageTable::Style::numbers};
  const auto section = app::html(app::Section{"s", "Name", table});
  BOOST_TEST(contains(section, "<h2 id=\"s\">Name</h2>"));
  BOOST_TEST(contains(section, "<table class=\"numbers\"><tr><td></td><th>A</th></tr>"));
  BOOST_TEST(contains(section, "<tr><td>second</td><td><span class=\"muted\">2</span></td></tr>"));
  BOOST_TEST(contains(section, "<td class=\"group\" colspan=\"2\">group</td>"));
}

BOOST_AUTO_TEST_CASE(pages_are_made_of_their_sections) {
  app::Page page{.title = "T<1>", .sub = "below", .summary = app::verdict_box(app::paragraph("answer"))};
  page.sections = {
      {"empty", "Empty"},
      {"words", "Words", app::heading("part", "part") + app::details("more", app::List{{"a", "b"}}), "A longer title"}};
  const auto html = app::page_html(page);
  for (const auto* part : {"<title>T&lt;1&gt;</title>", "<h1>T&lt;1&gt;</h1>", "<p class=\"sub\">below</p>",
                           "<div class=\"verdict\">\n<p>answer</p>\n</div>", "<li><a href=\"#words\">Words</a></li>",
                           "<h2 id=\"words\">A longer title</h2>\n<h3 id=\"part\">part</h3>",
                           "<details><summary>more</summary><ul><li>a</li>"})
    BOOST_TEST(contains(html, part), part);
  BOOST_TEST(!contains(html, "Empty"));
  BOOST_TEST(!contains(html, "{{"));
  BOOST_TEST(!contains(html, "class=\"library\""));  // nothing interactive
}

BOOST_AUTO_TEST_CASE(a_plot_has_one_source_for_picture_and_numbers) {
  const app::Plot plot{.title = "</script>", .series = {{.label = "s", .x = {0, 1, 2}, .y = {1, NAN, 1.23456789}}}};
  const app::Page page{.title = "p", .sections = {{"plots", "Plots", app::Pictures{{plot}, {{"s", 0}}, "below"}}}};
  const auto made = app::rendered(page);
  const auto numbers = app::plot_data(plot).dump();
  BOOST_TEST(contains(numbers, "\"y\":[1.0,null,1.23457]"));
  BOOST_TEST(contains(made.html, app::packed(numbers)));
  BOOST_TEST(contains(made.html, "<figcaption>below</figcaption>"));
  BOOST_TEST(contains(made.html, "<div class=\"row one narrow\">"));
  BOOST_REQUIRE(made.pictures.size() == 1U);
  BOOST_TEST(made.pictures.front().section == "plots");
  BOOST_TEST(made.pictures.front().svg == app::to_svg(plot));
  BOOST_TEST(contains(made.html, made.pictures.front().svg));
}

// Which earlier ones annulus may remove, the folder of a run knows (result_folder.h).
BOOST_AUTO_TEST_CASE(pictures_become_files) {
  const test::TemporaryFolder folder("report_pictures");
  app::BarChart chart{.title = "New, ⌀ mm", .bars = {{.label = "b", .value = 1}}};
  const app::Page page{.title = "p", .sections = {{"bars", "Bars", app::Pictures{{chart}}}}};
  app::write_report(folder.path() / "report.html", page);
  const auto file = folder.path() / "pictures" / "01_bars_new_mm.svg";
  BOOST_TEST_REQUIRE(std::filesystem::exists(file));
  BOOST_TEST(contains(read_file(file), "<svg"));
}

BOOST_AUTO_TEST_CASE(maps_join_equal_neighbours) {
  app::ColourMap map{.title = "m", .y_range = {0, 2}, .values = {0, 10}, .grey = "none"};
  app::ColourMap::Panel panel{.title = "a<b", .x_range = {0, 4}};
  for (int i = 0; i < 4; ++i) panel.cells.push_back({.x = {0.0 + i, 1.0 + i}, .y = {0, 1}, .value = 5});
  panel.cells.push_back({.x = {0, 4}, .y = {1, 2}});
  map.panels = {panel};
  const auto svg = app::to_svg(map);
  check_svg(svg);
  BOOST_TEST(contains(svg, "a&lt;b"));
  // One rectangle of four equal cells and one grey one: two paths of one subpath each between the group tags.
  const auto cells = svg.substr(svg.find("crispEdges"), svg.find("</g>") - svg.find("crispEdges"));
  BOOST_TEST(count(cells, "<path") == 2U);
  BOOST_TEST(count(cells, "M") == 2U);
  BOOST_TEST(contains(svg, ">none<"));
}

BOOST_AUTO_TEST_CASE(scale_goes_both_ways_below_zero) {
  app::ColourMap map{.y_range = {0, 1}, .values = {-4, 2}};
  map.panels.push_back({.title = {}, .x_range = {0, 1}, .cells = {{.x = {0, 1}, .y = {0, 1}, .value = 0}}});
  const auto svg = app::to_svg(map);
  check_svg(svg);
  // Symmetric about zero, where the colour is the neutral one up to half a step of the scale.
  BOOST_TEST(contains(svg, ">-4<"));
  BOOST_TEST(contains(svg, ">4<"));
}

BOOST_AUTO_TEST_CASE(supports_show_who_touches) {
  const auto result = run_of("ring_structures");
  const auto section = app::html(app::supports_section(result));
  check_svg(section);
  for (const auto* title :
       {"pins24: pins", "bolts24: bolts", "irregular-pins: pins", "one-pin: pins", "splined: spline teeth"})
    BOOST_TEST(contains(section, title), title);
  BOOST_TEST(!contains(section, "traditional"));
  BOOST_TEST(contains(section, "lifted off"));
  BOOST_TEST(section.size() < 1500000U);
  // Without pins there is no section.
  auto held = result;
  while (held.rings.size() > 1) held.rings.pop_back();
  BOOST_TEST(app::supports_section(held).blocks.empty());
}

BOOST_AUTO_TEST_CASE(contact_shows_face_width_pressure_and_stress) {
  const auto run = run_of("misaligned_set");
  const auto section = app::html(app::contact_section(app::named_meshes(run)));
  check_svg(section);
  BOOST_TEST(contains(section, "Load over the face width"));
  BOOST_TEST(contains(section, "thin-walled (KHβ 1.5"));
  BOOST_TEST(contains(section, "pair 1, 60 % of the load"));
  BOOST_TEST(contains(section, "traditional, mesh phase 0<"));
  for (const auto* curve :
       {"Tooth root of the planet", "Tooth root of the ring", "Tooth root of the sun", "Rim of the ring, outside"})
    BOOST_TEST(contains(section, curve), curve);
}

BOOST_AUTO_TEST_CASE(plane_meshes_show_their_pressure_as_lines) {
  auto result = run_of("ring_structures");
  while (result.rings.size() > 1) result.rings.pop_back();
  const auto section = app::html(app::contact_section(app::named_meshes(result)));
  check_svg(section);
  BOOST_TEST(!contains(section, "Load over the face width"));
  BOOST_TEST(contains(section, "roll length from the theoretical contact point"));
}

BOOST_AUTO_TEST_CASE(nothing_is_shown_of_what_is_not_known) {
  const auto result = run_of("ring_structures", [](app::MeshResult& mesh) {
    for (const auto& [name, table] : app::side_tables) (mesh.*table).rows.clear();
    mesh.positions.rows.clear();
  });
  BOOST_TEST(app::contact_section(app::named_meshes(result)).blocks.empty());
  BOOST_TEST(app::supports_section(result).blocks.empty());
  const auto page = app::page_html(app::stage_report(result));
  BOOST_TEST(!contains(page, "#contact"));
  BOOST_TEST(!contains(page, "#supports"));
}

BOOST_AUTO_TEST_CASE(summary_has_the_peaks_with_their_position) {
  const auto json = app::summary_json(run_of("misaligned_set"));
  const auto tolerance = boost::test_tools::tolerance(1e-12);
  const auto& mesh = json["rings"]["thin-walled"]["ring_planet"];
  BOOST_TEST(mesh["face_load_factor"]["value"].get<double>() == 1.5, tolerance);
  BOOST_TEST(mesh["face_load_factor"]["mesh_phase"].get<double>() == 0.0);
  BOOST_TEST(mesh["face_load_factor"]["ring_tooth"].get<int>() == 0);
  BOOST_TEST(mesh["max_stress_Pa"]["ring_root_von_mises"]["value"].get<double>() == 160e6, tolerance);
  BOOST_TEST(mesh["max_stress_Pa"]["planet_root_compression"]["value"].get<double>() == -180e6, tolerance);
  BOOST_TEST(json["rings"]["thin-walled"]["sun_planet"]["max_stress_Pa"].contains("sun_root_tension"));
  // Plane meshes have no face load factor.
  const auto plane = app::summary_json(run_of("ring_structures"));
  BOOST_TEST(!plane["rings"]["traditional"]["ring_planet"].contains("face_load_factor"));
  BOOST_TEST(plane["rings"]["flange"]["ring_planet"].contains("face_load_factor"));
}

BOOST_AUTO_TEST_CASE(whole_page) {
  const auto page = app::page_html(app::stage_report(run_of("misaligned_set")));
  check_svg(page.substr(page.find("<main>")));
  BOOST_TEST(contains(page, "<a href=\"#definition-face_load_factor\">Face load factor, ring mesh</a> K<sub>Hβ</sub>"));
  BOOST_TEST(contains(page, "Root stress (tension) of the ring, ring mesh</a>, MPa"));
  BOOST_TEST(contains(page, "href=\"#contact\""));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
