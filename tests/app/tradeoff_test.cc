#include "app/tradeoff/tradeoff.h"
#include "app/systems/planetary/planetary_model.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <csignal>
#include <iterator>
#include <limits>
#include <map>

#include "app/process/measured_work.h"
#include "app/tradeoff/trade_report.h"
#include "core/errors.h"
#include "core/log.h"
#include "tests/app/pair_scenes.h"
#include "tests/app/scenes.h"
#include "tests/app/two_k_v_scenes.h"

namespace annulus {

namespace {

constexpr const char *sun_stiffness = "sun_planet_mean_stiffness_N_per_m",
                     *ring_stiffness = "ring_planet_mean_stiffness_N_per_m", *sun_lte = "sun_planet_lte_peak_to_peak_m",
                     *sun_factor = "sun_planet_peak_factor";

app::TradePoint made_up(const std::string& settings, double wall, double error) {
  app::TradePoint p{.fidelity = "plane", .settings = settings};
  p.cost = {wall, wall, 100};
  p.values = {{sun_stiffness, 1e9, error / 2, error}, {ring_stiffness, 2e9, error, 2 * error}};
  return p;
}

app::VariantTrade made_up_ring() {
  app::VariantTrade ring{.name = "held", .figures = {}, .points = {}};
  ring.figures = {{sun_stiffness, "mean stiffness of the sun mesh", Guarantee::always},
                  {ring_stiffness, "mean stiffness of the ring mesh", Guarantee::always},
                  {sun_lte, "transmission error of the sun mesh, peak to peak", Guarantee::none},
                  {sun_factor, "peak factor of the sun meshes", Guarantee::while_in_contact}};
  ring.points = {made_up("a", 1, 0.05), made_up("b", 2, 0.2), made_up("c", 4, 0.008), made_up("d", 3, 0.009),
                 made_up("finest", 50, 0)};
  ring.points.back().finest = true;
  auto failed = made_up("failed", 0.1, 0);
  failed.failure = "no convergence, \"alas\"";
  ring.points.push_back(failed);
  // Dearer than its equals, and no competitor of the fixed settings; its range of the transmission error is no promise.
  auto planned = made_up("for 1 %", 2, 0);
  planned.planned_for = 0.01;
  planned.fidelity = "planned";
  planned.values = {{sun_stiffness, 1e9, 0.007, 0.01}, {sun_lte, 1e-6, 0.2, 0.01}};
  ring.points.push_back(planned);
  return ring;
}

/// A light set of gears whose meshes are computed.
std::string computed_ring_scene() {
  auto text = test::quick_scene();
  const auto begin = text.find("[mesh.sun_planet]"), end = text.find("[dynamics]");
  text.erase(begin, end - begin);
  text = test::replaced(text, "planet_eccentricity_um", "planet_pin_position_error_um");
  text = test::replaced(text, "[carrier]\n", "bore_diameter_mm = 172\n[carrier]\n");
  text = test::replaced(text, "[planet]\n", "bore_diameter_mm = 130\n[planet]\n");
  return test::replaced(text, "mesh_cycles = 110\n", "");
}

}  // namespace

/// Suites that ran before in the same process leave threads behind; CTest gives this one a process of its own.
const auto in_a_process_of_its_own = boost::unit_test::precondition([](boost::unit_test::test_unit_id) {
  boost::test_tools::assertion_result result = app::has_its_first_threads_alone();
  result.message() << "other suites have left threads behind";
  return result;
});

BOOST_AUTO_TEST_SUITE(tradeoff)

BOOST_AUTO_TEST_CASE(work_is_measured_in_a_process_of_its_own, *in_a_process_of_its_own) {
  const auto answer = app::measured([] { return std::string("seven"); });
  BOOST_TEST(answer.answer == "seven");
  BOOST_TEST(answer.failure == "");
  BOOST_TEST(answer.cost.wall > 0);
  BOOST_TEST(answer.cost.peak_memory_MB > 0.5);

  // Two hundred megabytes are seen, and given back with the process.
  const auto large = app::measured([] {
    std::vector<char> block(200'000'000, 1);
    return std::to_string(block[123'456'789]);
  });
  BOOST_TEST(large.answer == "1");
  BOOST_TEST(large.cost.peak_memory_MB > answer.cost.peak_memory_MB + 180);
  BOOST_TEST(app::measured([] { return std::string(); }).cost.peak_memory_MB < answer.cost.peak_memory_MB + 50);

  int here = 1;
  const auto thrown = app::measured([&]() -> std::string {
    here = 2;
    throw InputError("no such ring");
  });
  BOOST_TEST(thrown.failure == "no such ring");
  BOOST_TEST(thrown.answer == "");
  BOOST_TEST(here == 1);
  const auto killed = app::measured([]() -> std::string {
    std::raise(SIGKILL);
    return "never";
  });
  BOOST_TEST(killed.failure.find("killed") != std::string::npos);
  // Longer than a pipe holds at once.
  BOOST_TEST(app::measured([] { return std::string(1'000'000, 'x'); }).answer.size() == 1'000'000U);
}

BOOST_AUTO_TEST_CASE(the_front_and_the_cheapest) {
  const auto ring = made_up_ring();
  const auto front = ring.front(app::TradePart::mesh);
  std::vector<std::string> names;
  for (const auto* p : front) names.push_back(p->settings);
  BOOST_TEST(names == (std::vector<std::string>{"a", "d", "c"}), boost::test_tools::per_element());
  BOOST_TEST(ring.cheapest(app::TradePart::mesh, 0.1)->settings == "a");
  BOOST_TEST(ring.cheapest(app::TradePart::mesh, 0.01)->settings == "d");
  BOOST_TEST(ring.cheapest(app::TradePart::mesh, 0.0085)->settings == "c");
  BOOST_TEST(!ring.cheapest(app::TradePart::mesh, 0.001));
  BOOST_TEST(ring.front(app::TradePart::dynamics).empty());
  BOOST_TEST(ring.points[0].worst()->key == ring_stiffness);
  // Of one figure: errors are half as large for the first, and not known for the third.
  BOOST_TEST(ring.cheapest(app::TradePart::mesh, 0.0045, sun_stiffness)->settings == "d");
  BOOST_TEST(!ring.cheapest(app::TradePart::mesh, 1.0, sun_factor));
  BOOST_TEST(ring.front(app::TradePart::mesh, sun_factor).empty());

  app::TradeOff trade{
      .scene = app::parse_scene(test::quick_scene(), "scene.toml"), .variants = {ring}, .total_seconds = 60};
  const auto text = app::trade_text(trade);
  BOOST_TEST(text.find("For 1 %: plane, d; 3.0 s, 100 MB; errors up to 0.9 % (mean stiffness of the ring mesh).") !=
                 std::string::npos,
             text);
  BOOST_TEST(text.find("For 0.1 %: only the finest setting.") != std::string::npos);
  BOOST_TEST(text.find("The planner for 1 %: 2.0 s, 100 MB; errors up to 0.7 % (mean stiffness of the sun mesh)") !=
                 std::string::npos,
             text);
  BOOST_TEST(ring.guaranteed_error(*ring.planned(0.01)) == 0.007);
  BOOST_TEST(!ring.planned(0.02));
  // Where contact is lost, peak factors are not covered either.
  auto losing_contact = *ring.planned(0.01);
  losing_contact.values.push_back({sun_factor, 1.2, 0.3, 0.4});
  BOOST_TEST(ring.guaranteed_error(losing_contact) == 0.3);
  losing_contact.contact_loss = 0.1;
  BOOST_TEST(ring.guaranteed_error(losing_contact) == 0.007);
  const auto csv = app::trade_csv(trade);
  BOOST_TEST(csv.find("held,mesh,plane,a,0,sun_planet_mean_stiffness_N_per_m,1000000000,") != std::string::npos, csv);
  BOOST_TEST(csv.find("\"no convergence, \"\"alas\"\"\"") != std::string::npos);
  const auto page = app::trade_html(trade);
  BOOST_TEST(page.find("no convergence, &quot;alas&quot;") != std::string::npos);
  BOOST_TEST(page.find("<svg") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_ring_on_which_everything_fails_is_reported) {
  app::VariantTrade ring{.name = "held", .figures = {}, .points = {}};
  ring.figures = {{sun_stiffness, "mean stiffness of the sun mesh", Guarantee::always},
                  {ring_stiffness, "mean stiffness of the ring mesh", Guarantee::always},
                  {sun_lte, "transmission error of the sun mesh, peak to peak", Guarantee::none},
                  {sun_factor, "peak factor of the sun meshes", Guarantee::while_in_contact}};
  for (const char* name : {"a", "finest"}) {
    app::TradePoint p{.fidelity = "solid", .settings = name, .finest = std::string(name) == "finest"};
    p.failure = "the rim is too thin";
    ring.points.push_back(p);
  }
  ring.points.push_back({.fidelity = "planned", .settings = "for 1 %", .planned_for = 0.01, .failure = "refused"});
  const app::TradeOff trade{
      .scene = app::parse_scene(test::quick_scene(), "scene.toml"), .variants = {ring}, .total_seconds = 1};
  BOOST_TEST(app::trade_text(trade).find("refused") != std::string::npos);
  BOOST_TEST(app::trade_csv(trade).find("the rim is too thin") != std::string::npos);
  BOOST_TEST(app::trade_html(trade).find("The finest setting failed") != std::string::npos);
  const test::TemporaryFolder folder("tradeoff_failed");
  BOOST_CHECK_NO_THROW(app::write_tradeoff(trade, folder.path()));
}

BOOST_AUTO_TEST_CASE(settings_keep_the_problem_but_for_what_they_set) {
  const auto scene = app::parse_scene(computed_ring_scene(), "scene.toml");
  const auto planned = app::ring_mesh_model(scene, app::make_geometry(scene), 0);
  const double nominal = planned.problem->loads[planned.nominal_load()];
  int finest = 0;
  std::vector<std::string> folders;
  for (const auto& setting : app::mesh_settings(planned, app::AlongFace::uniform)) {
    const auto model = setting.applied(planned, app::AlongFace::uniform);
    finest += setting.finest;
    folders.push_back(setting.folder());
    BOOST_TEST(model.problem->loads[model.nominal_load()] == nominal);
    BOOST_TEST(model.problem->loads.size() == static_cast<std::size_t>(setting.loads));
    BOOST_TEST(model.problem->phases == setting.phases);
    BOOST_TEST(model.problem->face_width == planned.problem->face_width);
  }
  BOOST_TEST(finest == 1);
  std::sort(folders.begin(), folders.end());
  BOOST_TEST((std::adjacent_find(folders.begin(), folders.end()) == folders.end()));
}

BOOST_AUTO_TEST_CASE(errors_fall_toward_the_finest_and_measurements_are_kept, *in_a_process_of_its_own) {
  log::set_level(log::Level::quiet);
  const test::TemporaryFolder folder("tradeoff");
  const auto scene = app::parse_scene(computed_ring_scene(), "scene.toml");
  const app::RunOptions options{.out = folder.path(), .threads = 1};
  app::TradeLists lists;
  lists.mesh = [](const app::MeshModel&, app::AlongFace face) {
    BOOST_TEST((face == app::AlongFace::uniform));
    using fem::Fidelity;
    return std::vector<app::MeshSetting>{
        {.fidelity = Fidelity::closed_form, .phases = 16, .loads = 1},
        {.fidelity = Fidelity::plane, .degree = 1, .level = 1, .phases = 16, .loads = 1},
        {.fidelity = Fidelity::plane, .degree = 1, .level = 3, .phases = 16, .loads = 1},
        {.fidelity = Fidelity::plane, .degree = 2, .level = 2, .phases = 16, .loads = 1, .finest = true}};
  };
  const auto trade = app::measure_tradeoff(scene, options, lists);
  BOOST_TEST_REQUIRE(trade.variants.size() == 1U);
  const auto& points = trade.variants.front().points;
  for (const auto& p : points) BOOST_TEST(p.failure == "", p.settings << ": " << p.failure);
  // Mean stiffness of the ring mesh: the closed form is not controlled, linear elements approach the quadratic ones.
  const auto error = [&](std::size_t point) { return points[point].values[1].error; };
  BOOST_TEST(error(1) > 2 * error(2));
  BOOST_TEST(error(2) > 0);
  BOOST_TEST(error(3) == 0);
  BOOST_TEST(error(0) < 0.05);
  // The estimates of the linear elements hold.
  for (const std::size_t i : {std::size_t{1}, std::size_t{2}})
    BOOST_TEST(error(i) <= 3 * points[i].values[1].error_estimate);
  // The dynamics: few samples are worse than many, held planets are another model.
  const auto named = [&](const std::string& settings) {
    const auto found =
        std::find_if(points.begin(), points.end(), [&](const auto& p) { return p.settings == settings; });
    BOOST_TEST_REQUIRE((found != points.end()), settings);
    return *found;
  };
  BOOST_TEST(named("8 samples per mesh cycle").error() > 5 * named("32 samples per mesh cycle").error());
  BOOST_TEST(named("Cash-Karp 5(4), relative tolerance 1e-06").error() <= 1e-3);
  BOOST_TEST(named("planet bearings rigid").changes_model);
  BOOST_TEST(named("planet bearings rigid").error() > 0.05);
  BOOST_TEST(named("64 samples per mesh cycle").error() <= 1e-3);

  // Nothing is measured twice: times and all.
  const auto again = app::measure_tradeoff(scene, options, lists);
  BOOST_TEST(app::trade_csv(again) == app::trade_csv(trade));
  app::write_tradeoff(trade, folder.path());
  for (const auto* file : {"tradeoff.csv", "tradeoff.html", "tradeoff_held_mesh.svg", "tradeoff_held_dynamics.svg"})
    BOOST_TEST(std::filesystem::exists(folder.path() / file), file);
}

/// Every setting of the motion by its name, errors of it with those of other models left out.
std::map<std::string, double> motion_errors(const app::VariantTrade& variant) {
  std::map<std::string, double> errors;
  for (const auto& p : variant.points) {
    BOOST_TEST(p.failure == "", p.settings << ": " << p.failure);
    BOOST_TEST((p.part == app::TradePart::dynamics));
    if (!p.changes_model) errors[p.settings] = p.error();
  }
  return errors;
}

// Where the stiffness is prescribed there is one table, and the motion on it is what can be traded.
BOOST_AUTO_TEST_CASE(prescribed_stiffness_leaves_the_motion, *in_a_process_of_its_own) {
  log::set_level(log::Level::quiet);
  const test::TemporaryFolder folder("tradeoff_given");
  const auto text = test::replaced(test::quick_scene(), "mesh_cycles = 110\n", "");
  const auto scene =
      app::parse_scene(test::replaced(text, "planet_eccentricity_um", "planet_pin_position_error_um"), "s.toml");
  const auto trade = app::measure_tradeoff(scene, {.out = folder.path() / "planetary", .threads = 1});
  BOOST_TEST_REQUIRE(trade.variants.size() == 1U);
  const auto errors = motion_errors(trade.variants.front());
  BOOST_TEST(errors.at("8 samples per mesh cycle") > errors.at("64 samples per mesh cycle"));
  BOOST_TEST(errors.at("64 samples per mesh cycle") <= 1e-3);
  BOOST_TEST(errors.at("128 samples per mesh cycle") == 0);
}

BOOST_AUTO_TEST_CASE(a_pair_is_traded_too, *in_a_process_of_its_own) {
  log::set_level(log::Level::quiet);
  const test::TemporaryFolder folder("tradeoff_pair");
  // Its motion on a prescribed stiffness.
  const auto given = app::measure_tradeoff(app::parse_scene(test::quick_pair(), "s.toml"),
                                           {.out = folder.path() / "given", .threads = 1});
  BOOST_TEST_REQUIRE(given.variants.size() == 1U);
  const auto errors = motion_errors(given.variants.front());
  BOOST_TEST(errors.at("8 samples per mesh cycle") >= errors.at("64 samples per mesh cycle"));
  BOOST_TEST(errors.at("64 samples per mesh cycle") <= 1e-3);
  BOOST_TEST(errors.at("Cash-Karp 5(4), relative tolerance 1e-08") <= 1e-3);

  // Its mesh by elements.
  app::TradeLists lists;
  lists.accuracies = {0.1};
  lists.motions = false;
  lists.mesh = [](const app::MeshModel&, app::AlongFace face) {
    const auto fidelity = face == app::AlongFace::varying ? fem::Fidelity::solid : fem::Fidelity::plane;
    return std::vector<app::MeshSetting>{
        {.fidelity = fidelity, .degree = 1, .level = 1, .phases = 8, .loads = 1},
        {.fidelity = fidelity, .degree = 2, .level = 1, .phases = 8, .loads = 1, .finest = true}};
  };
  const auto solved = app::measure_tradeoff(app::parse_scene(test::solved_pair(), "s.toml"),
                                            {.out = folder.path() / "solved", .threads = 1}, lists);
  const auto& points = solved.variants.front().points;
  BOOST_TEST_REQUIRE(points.size() == 3U);
  for (const auto& p : points) {
    BOOST_TEST(p.failure == "", p.settings << ": " << p.failure);
    BOOST_TEST(p.cost.wall > 0);
    BOOST_TEST_REQUIRE(p.values.size() == solved.variants.front().figures.size());
    BOOST_TEST(p.values[0].error <= 3 * p.values[0].error_estimate);
  }
  // Linear elements are too stiff; of the entries those count that stand at the same positions.
  BOOST_TEST(points[0].values[1].error <= 3 * points[0].values[1].error_estimate);
  BOOST_TEST(points[0].values[0].value > points[1].values[0].value);
  BOOST_TEST(points[0].values[1].error > 0);
  BOOST_TEST(points[1].values[1].error == 0);
  BOOST_TEST(solved.variants.front().stiffness_estimate(points[0]) == points[0].values[1].error_estimate);
  app::write_tradeoff(solved, folder.path());
  BOOST_TEST(std::filesystem::exists(folder.path() / "tradeoff_pinion_and_wheel_mesh.svg"));
  BOOST_TEST(app::trade_csv(solved).find("\npinion and wheel,mesh,") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_motion_of_a_reducer_is_traded, *in_a_process_of_its_own) {
  log::set_level(log::Level::quiet);
  const test::TemporaryFolder folder("tradeoff_reducer");
  const auto text = test::replaced(test::reducer_scene(), "stiffness = \"constant\"\nmean_N_per_m = 1.4e8",
                                   "stiffness = \"harmonic\"\nmean_N_per_m = 1.4e8\nripple = 0.15");
  const auto trade = app::measure_tradeoff(app::parse_scene(text, "s.toml"), {.out = folder.path(), .threads = 1});
  BOOST_TEST_REQUIRE(trade.variants.size() == 1U);
  const auto errors = motion_errors(trade.variants.front());
  BOOST_TEST(errors.at("Cash-Karp 5(4), relative tolerance 1e-09") == 0);
  BOOST_TEST(errors.at("Cash-Karp 5(4), relative tolerance 1e-06") <= 1e-3);
  BOOST_TEST(errors.at("BDF, relative tolerance 1e-06") <= 1e-3);
}

BOOST_AUTO_TEST_CASE(nothing_to_trade_is_said_so) {
  const auto refusal = [](const std::string& text) {
    try {
      (void)app::measure_tradeoff(app::parse_scene(text, "scene.toml"), {});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto text = test::quick_scene();
  const auto without_motion = text.substr(0, text.find("[dynamics]"));
  BOOST_TEST(refusal(without_motion).find("no settings to compare") != std::string::npos, refusal(without_motion));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
