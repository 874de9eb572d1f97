#include "app/report/plot/chart.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "app/report/drawings/mesh.h"
#include "app/report/drawings/mode.h"
#include "app/report/text/svg.h"
#include "app/sections/report_parts.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/planetary_model.h"
#include "geometry/sector_mesh.h"
#include "tests/app/made_up_solution.h"

namespace annulus {

BOOST_AUTO_TEST_SUITE(svg)

BOOST_AUTO_TEST_CASE(ticks_are_round_and_inside) {
  for (const auto& [low, high] : {std::pair{0.0, 1.0},
                                  {-3.7, 12.2},
                                  {1e-9, 7e-9},
                                  {2963.0, 2964.5},
                                  {-1e6, 1e6},
                                  {4.04e6, 4.041e6},
                                  {4.04e-7, 4.041e-7}}) {
    const auto ticks = app::nice_ticks(low, high, 6);
    BOOST_TEST(ticks.size() >= 3U);
    BOOST_TEST(ticks.size() <= 9U);
    const double step = ticks[1] - ticks[0], slack = 1e-6 * step;
    BOOST_TEST(ticks.front() >= low - slack);
    BOOST_TEST(ticks.back() <= high + slack);
    const double leading = step / std::pow(10.0, std::floor(std::log10(step * (1 + 1e-9))));
    BOOST_TEST((std::abs(leading - 1) < 1e-6 || std::abs(leading - 2) < 1e-6 || std::abs(leading - 5) < 1e-6 ||
                std::abs(leading - 10) < 1e-6));
    const auto labels = app::tick_labels(ticks);
    for (std::size_t i = 1; i < labels.size(); ++i) BOOST_TEST(labels[i] != labels[i - 1]);
  }
  for (const double low : {0.12, 1.3, -0.87, 2.1e5})
    BOOST_TEST(!app::nice_ticks(low, low + 0.4 * std::abs(low), 1).empty(), low);
  BOOST_TEST(app::nice_ticks(1, 1, 5).size() == 1U);
}

BOOST_AUTO_TEST_CASE(long_titles_have_lines) {
  const std::string title = "Load sharing of the sun meshes, averaged over a mesh cycle";
  const auto lines = app::svg::title_lines(title, 430, 54);
  BOOST_TEST(lines.size() == 2U);
  BOOST_TEST(lines.front() + " " + lines.back() == title);
  BOOST_TEST(app::svg::title_lines("", 430).empty());
  BOOST_TEST(app::svg::title_lines("short", 430).size() == 1U);
  BOOST_TEST(app::svg::title_height(lines) > app::svg::title_height({"short"}));
}

// A turned and a shifted wheel: the sun at rest is drawn twice in the same place, and once more where it went.
BOOST_AUTO_TEST_CASE(mode_shapes_show_displaced_bodies) {
  app::ModeDrawing mode{.title = "a<b",
                        .sun_radius = 0.5,
                        .planet_radius = 0.4,
                        .ring_radius = 1.5,
                        .centre_distance = 1,
                        .planet_angles = {0, 2},
                        .planets = {{1, 0, 0}, {0, 0, 0}}};
  const auto circles = [&] {
    const auto svg = app::to_svg(mode);
    BOOST_TEST(svg.find("a&lt;b") != std::string::npos);
    BOOST_TEST(svg.find("nan") == std::string::npos);
    std::vector<std::string> places;
    for (auto at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1))
      places.push_back(svg.substr(at, svg.find(" fill", at) - at));
    return places;
  };
  auto places = circles();  // ring, planets, sun at rest, then displaced
  BOOST_REQUIRE(places.size() == 8U);
  BOOST_TEST(places[0] == places[4]);
  BOOST_TEST(places[1] != places[5]);
  BOOST_TEST(places[2] == places[6]);
  BOOST_TEST(places[3] == places[7]);
  mode.sun.u = 1;  // turning moves marks, not circles
  const auto before = app::to_svg(mode);
  places = circles();
  BOOST_TEST(places[3] == places[7]);
  mode.sun.u = -1;
  BOOST_TEST(app::to_svg(mode) != before);
}

BOOST_AUTO_TEST_CASE(notes_end_above_their_point) {
  app::Plot plot{.x_range = app::Range{0, 1},
                 .y_range = app::Range{0, 1},
                 .series = {{.x = {0, 1}, .y = {0, 1}}},
                 .notes = {{1, 0, "h<1"}}};
  const auto svg = app::to_svg(plot);
  // The right end of the axis, at x = 430 - 12, less a gap; the bottom, at y = 270 - 42, likewise.
  BOOST_TEST(svg.find("<text x=\"415.0\" y=\"225.0\" text-anchor=\"end\" fill=\"#666\">h&lt;1</text>") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(text_is_escaped) {
  BOOST_TEST(app::escape("<a href=\"x\">&") == "&lt;a href=&quot;x&quot;&gt;&amp;");
  app::Plot plot{.title = "<script>", .series = {{.label = "a<b", .x = {0, 1}, .y = {0, 1}}}, .legend = true};
  BOOST_TEST(app::to_svg(plot).find("<script>") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(ranges) {
  app::RangeFinder range;
  range.add({1, 3, std::nan(""), INFINITY});
  BOOST_TEST(range.range(0).low == 1);
  BOOST_TEST(range.range(0).high == 3);
  app::RangeFinder constant;
  constant.add(5);
  BOOST_TEST(constant.range().low < 5);
  BOOST_TEST(constant.range().high > 5);
}

BOOST_AUTO_TEST_CASE(gaps_break_lines) {
  const app::Plot plot{.series = {{.label = "s", .x = {0, 1, 2, 3}, .y = {0, std::nan(""), 1, 2}}}};
  const auto svg = app::to_svg(plot);
  BOOST_TEST(svg.find("nan") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(long_series_keep_their_peaks) {
  app::Series series{.label = "s"};
  for (int i = 0; i < 100000; ++i) {
    series.x.push_back(i);
    series.y.push_back(i == 77777 ? 1.0 : 0.0);
  }
  const app::Plot plot{.y_range = app::Range{0, 1}, .series = {series}};
  const auto svg = app::to_svg(plot);
  BOOST_TEST(svg.size() < 40000U);  // far below the million characters of all points
  const double top = 10;            // where y = 1 is drawn in a plot without title
  BOOST_TEST(svg.find(" " + std::to_string(static_cast<int>(top)) + ".0L") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(pictures_of_supports) {
  const auto scene = app::read_scene(std::string(ANNULUS_SOURCE_DIR) + "/data/scenes/ring_structures.toml");
  const auto geometry = app::make_geometry(scene);
  const auto picture = [&](std::size_t ring) {
    const auto model = app::ring_mesh_model(scene, geometry, ring);
    const auto& problem = *model.problem;
    auto solved = test::made_up_solution(model);
    const geometry::SectorResolution coarse{.flank_cells = 6, .fillet_cells = 2, .thickness_cells = 4, .root_cells = 1};
    solved.pinion_sector =
        geometry::make_sector_mesh(problem.pair.pinion(), {.support_radius = problem.pinion_bore_radius}, coarse);
    solved.wheel_sector =
        geometry::make_sector_mesh(problem.pair.wheel(), {.support_radius = problem.wheel_support_radius}, coarse);
    return app::mesh_picture(problem, solved, "p");
  };
  const auto find = [&](const std::string& name) {
    std::size_t i = 0;
    while (planetary(scene).rings.at(i).name != name) ++i;
    return i;
  };
  const auto pin = picture(find("one-pin"));
  BOOST_TEST(pin.find("<circle") != std::string::npos);
  BOOST_TEST(pin.find("stroke-dasharray") != std::string::npos);  // the bore of the housing
  BOOST_TEST(picture(find("pins24")).find("stroke-dasharray") == std::string::npos);
  const auto spline = picture(find("splined"));
  BOOST_TEST(spline.find("#7a3600") != std::string::npos);
  BOOST_TEST(spline.find("nan") == std::string::npos);
}

BOOST_AUTO_TEST_CASE(measured_values_carry_their_error) {
  BOOST_TEST(app::measured(1.36412, 0.0123) == "1.364 ± 0.012");
  BOOST_TEST(app::measured(2963.94, 1.3) == "2963.9 ± 1.3");
  BOOST_TEST(app::measured(1.12042592, 1.6e-7) == "1.1204 ± <0.0001");
  BOOST_TEST(app::measured(0.5, 0) == "0.5");
  BOOST_TEST(app::measured(std::nan(""), 0) == "not known");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
